//! Functions that reduce the width of a number, each with its own rounding, and functions for squares and roots.

use glint_core::field::normalised_root;

/// Returns x·2^−`bits`, rounded down. For negative `bits` the number is multiplied.
pub(super) const fn floor(x: i64, bits: i32) -> i64 {
    if bits < 0 {
        x << -bits
    } else if bits < 64 {
        x >> bits
    } else {
        x >> 63
    }
}

/// Returns x·2^−`bits`, rounded to nearest, ties up. For negative `bits` the number is multiplied.
pub(super) const fn nearest(x: i64, bits: i32) -> i64 {
    if bits <= 0 {
        floor(x, bits)
    } else {
        (floor(x, bits - 1) + 1) >> 1
    }
}

/// Returns x, saturated to `bits` bits and a sign.
pub(super) const fn saturated(x: i64, bits: u32) -> i64 {
    let most = (1 << bits) - 1;
    if x > most {
        most
    } else if x < !most {
        !most
    } else {
        x
    }
}

/// Returns floor(x·2^`shift`), saturated to `bits` bits and a sign. The shift may be negative.
pub(super) const fn shifted(x: i64, shift: i32, bits: u32) -> i64 {
    let most = (1 << bits) - 1;
    if shift <= 0 {
        saturated(floor(x, -shift), bits)
    } else if x > most >> shift {
        most
    } else if x < !most >> shift {
        !most
    } else {
        x << shift
    }
}

/// The square of x minus the square of its lowest `cut` bits, computed as one product in which one factor is shorter than x.
pub(super) const fn squared(x: i64, cut: u32) -> i64 {
    let first = x >> cut << cut;
    first * (2 * x - first)
}

/// Returns a lower bound of 4·√(x·2^shift), in [2^18, 2^19), with a relative error of at most 2^−18, and the shift: the even number for
/// which x·2^shift is in [2^32, 2^34). x must be at least 1.
pub(super) fn normalised(x: i64) -> (u32, i32) {
    let shift = 32 - (x.ilog2() as i32 & !1);
    (normalised_root(shifted(x, shift, 34) as u64), shift)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reduction_rounds_as_stated() {
        assert_eq!([floor(-5, 1), floor(5, 1), floor(3, -2)], [-3, 2, 12]);
        assert_eq!([nearest(-5, 1), nearest(5, 1), nearest(3, -2)], [-2, 3, 12]);
        assert_eq!(
            [saturated(8, 3), saturated(-9, 3), saturated(-8, 3)],
            [7, -8, -8]
        );
        assert_eq!(
            [shifted(1, 2, 3), shifted(2, 2, 3), shifted(-2, 2, 3)],
            [4, 7, -8]
        );
        assert_eq!([shifted(-3, 2, 3), shifted(-17, -1, 3)], [-8, -8]);
    }
    #[test]
    fn a_square_lacks_that_of_its_lowest_bits() {
        for x in [-70_001_i64, -1, 0, 5, 123_457] {
            for cut in [0, 3, 6] {
                let low = x & ((1 << cut) - 1);
                assert_eq!(squared(x, cut), x * x - low * low, "{x}, {cut}");
            }
        }
    }

    #[test]
    fn roots_are_rounded_down() {
        for x in (0..62).flat_map(|bits| [1_i64 << bits, (1 << bits) + (1 << bits) / 3]) {
            let (found, shift) = normalised(x);
            let exact = (shifted(x, shift, 34) << 4).isqrt();
            let error = exact - i64::from(found);
            assert!((0..=2 + (exact >> 18)).contains(&error), "{x}: {found}");
        }
    }
}
