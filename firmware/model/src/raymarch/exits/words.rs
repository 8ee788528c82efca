//! Word lengths, and reciprocals of a direction's components.

use super::narrow::{nearest, shifted};

/// Number of integer bits of the parameter T, for depths up to 2^11 field units, times 2^e with e at most 3.
const PARAMETER_INTEGER: u32 = 14;

/// Word lengths of rays by exits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Words {
    /// Fraction bits of the magnitude of a direction's component whose reciprocal is taken, 24 to 27.
    pub component: u32,
    /// Fraction bits of the magnitude of a direction's component in the product T·D, 8 to 24.
    pub direction: u32,
    /// Fraction bits of the mantissa of a reciprocal, 8 to 24; with at most 22, the errors are those of the gateware's table.
    pub inverse: u32,
    /// Fraction bits of the parameter T, 8 to 16.
    pub parameter: u32,
    /// Fraction bits of the linear functions of a cone, for spheres of a list, 12 to 22.
    pub outline: u32,
    /// Fraction bits of q·D, where q is the vector from the centre of a lattice's sphere to the ray's point, 8 to 20.
    pub along: u32,
}

impl Words {
    /// The word lengths of the gateware (docs/raymarch-exits.md).
    pub const CHOSEN: Self = Self {
        component: 27,
        direction: 23,
        inverse: 22,
        parameter: 14,
        outline: 22,
        along: 14,
    };

    /// Truncates a component's magnitude, an odd number in u0.28, to [`component`](Self::component) fraction bits, and returns the middle
    /// of the truncation interval.
    pub(super) const fn component_of(&self, magnitude: u32) -> u32 {
        let cut = 27 - self.component;
        (magnitude >> 1 >> cut << 1 | 1) << cut
    }

    /// The parameter of a ray at a distance along an axis: the distance, of 25 bits with `fraction` fraction bits, times the reciprocal of
    /// the direction's component. Rounded down and saturated.
    pub(super) const fn divided(&self, distance: i64, fraction: u32, inverse: Inverse) -> i64 {
        let Inverse { mantissa, exponent } = inverse;
        let bits = fraction as i32 + self.inverse as i32 - exponent;
        self.parameter_of(distance * mantissa as i64, bits)
    }

    /// Converts a parameter x with `fraction` fraction bits to the format of T. Rounded down and saturated.
    pub(super) const fn parameter_of(&self, x: i64, fraction: i32) -> i64 {
        let bits = self.parameter as i32 - fraction;
        shifted(x, bits, PARAMETER_INTEGER + self.parameter)
    }
}

/// The reciprocal of a number, as a mantissa and an exponent.
///
/// Mantissas are close to 1, so that the gateware can compute x·mantissa as x + x·(mantissa − 1), with |mantissa − 1| below 1/2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inverse {
    /// The mantissa, from 3/4 to below 3/2, with the fraction bits of [`Words::inverse`].
    pub mantissa: u32,
    /// The exponent of 2 by which the mantissa is multiplied.
    pub exponent: i32,
}

impl Inverse {
    /// The reciprocal as the gateware stores it: in the low 30 bits the mantissa, shifted left by the exponent modulo 8; in the two highest
    /// bits the exponent divided by 8.
    pub const fn word(self) -> u32 {
        (self.exponent as u32 / 8) << 30 | self.mantissa << (self.exponent % 8)
    }

    /// The reciprocal that a [`word`](Self::word) represents. The mantissa may be larger than the original one, with a smaller exponent.
    pub const fn of_word(word: u32) -> Self {
        Self {
            mantissa: word & ((1 << 30) - 1),
            exponent: 8 * (word >> 30) as i32,
        }
    }

    /// The reciprocal of x, u0.28. An x of 0 counts as 2^−28.
    pub const fn of(x: u32, words: &Words) -> Self {
        let x = x | (x == 0) as u32;
        let lead = 27 - x.ilog2();
        // 2^27/x for an x from 2^27 to 2^28: from 1/2 to 1, 32 fraction bits. The table takes the first 25 bits of x.
        let exact = words.inverse > TABLE_BITS;
        let value = if exact {
            (1 << 59) / ((x as u64) << lead)
        } else {
            (interpolated(x << lead >> 3) as u64) << (32 - ENTRY)
        };
        let is_low = value < 3 << 30;
        let value = value << is_low as u32;
        let mantissa = nearest(value as i64, 32 - words.inverse as i32) as u32;
        let most = (3 << (words.inverse - 1)) - 1;
        Self {
            mantissa: if mantissa < most { mantissa } else { most },
            exponent: lead as i32 + !is_low as i32,
        }
    }
}

/// Largest number of fraction bits of a mantissa from [`TABLE`]; longer mantissas are divided exactly.
const TABLE_BITS: u32 = 22;

/// Number of bits of an index of [`TABLE`], and of the remaining bits of a number after its leading 1 and its index.
const INDEX: u32 = 10;
const REST: u32 = 24 - INDEX;
/// Fraction bits of the entries of [`TABLE`].
const ENTRY: u32 = 24;

/// Entry i: 1/(1 + i/2^10), u1.24, and the decrease to the next entry. The value is reduced by half of the largest error of the
/// interpolation between entries i and i + 1, so that errors have both signs.
const TABLE: [(u32, u32); 1 << INDEX] = {
    let mut table = [(0, 0); 1 << INDEX];
    let mut i = 0;
    while i < table.len() {
        let entry = point(i as u64);
        table[i] = (entry - excess(i), entry - point(i as u64 + 1));
        i += 1;
    }
    table
};

const fn point(i: u64) -> u32 {
    let divisor = (1 << INDEX) + i;
    let dividend = 1 << (ENTRY + INDEX);
    ((dividend + divisor / 2) / divisor) as u32
}

/// Half of the largest error of the interpolation between entries i and i + 1, rounded to nearest: 2/(1 + i/2^10)^3 units.
const fn excess(i: usize) -> u32 {
    match i {
        0..=103 => 2,
        104..=601 => 1,
        _ => 0,
    }
}

/// 2^24/x for x in [2^24, 2^25), interpolated linearly: u1.24, with an error of less than 2^−22.
const fn interpolated(x: u32) -> u32 {
    let (entry, decrease) = TABLE[(x >> REST & ((1 << INDEX) - 1)) as usize];
    let rest = x & ((1 << REST) - 1);
    entry - ((decrease * rest) >> REST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolated_reciprocals_have_errors_of_both_signs() {
        for x in (1 << 24..1 << 25).step_by(37) {
            let error = f64::from(interpolated(x))
                - f64::from(1_u32 << 24) / f64::from(x) * f64::from(1 << ENTRY);
            assert!((-2.5..3.5).contains(&error), "{x}: {error}");
        }
    }

    #[test]
    fn a_reciprocal_times_its_number_is_one() {
        for inverse in [18, 22, 24] {
            let words = Words {
                inverse,
                ..Words::CHOSEN
            };
            let numbers = [1, 3, 1 << 27, (1 << 28) - 1, 98_765_423, 201_326_592];
            for x in numbers.into_iter().chain((1..1 << 28).step_by(80_021)) {
                let Inverse { mantissa, exponent } = Inverse::of(x, &words);
                let found = f64::from(mantissa) * f64::from(exponent - inverse as i32 - 28).exp2();
                let error = (f64::from(x) * found - 1.0).abs();
                // The relative error of half a unit of a mantissa, which is at least 3/4, plus the error of the table.
                let limit = f64::from(-(inverse as i32)).exp2() / 1.5 + 3e-7;
                assert!(error < limit, "{x}: {error}");
                assert!(
                    (3 << inverse..=6 << inverse).contains(&(4 * mantissa)),
                    "{x}"
                );
            }
        }
    }
}
