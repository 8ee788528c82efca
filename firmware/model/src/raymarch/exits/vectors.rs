//! Vectors of integers, and positive numbers with an exponent, for the constants of a frame.
//!
//! On the soft core, most of the time for cones is spent in these functions. They are not inlined, so that their code stays in the
//! instruction cache, and they do not divide, because the soft core has no 64-bit division.

use glint_core::root::inverse_root;
use glint_core::vector::{self, cross, dot};

use super::narrow::nearest;

/// A vector of integers. A *unit vector* has length 1 and 30 fraction bits.
pub(super) type Vector = [i32; 3];

/// Fraction bits of a unit vector.
const UNIT: u32 = 30;

/// The scalar product of two vectors.
#[inline(never)]
pub(super) fn product(a: &Vector, b: &Vector) -> i64 {
    dot(*a, *b)
}

/// The unit vector in the direction of a vector; for the zero vector, the unit vector along the z axis.
pub(super) fn unit(vector: [i64; 3]) -> Vector {
    vector::unit::<UNIT>(vector).unwrap_or([0, 0, 1 << UNIT])
}

/// The unit vector perpendicular to two vectors, or to the first one if they are parallel.
#[inline(never)]
pub(super) fn perpendicular(a: &Vector, b: &Vector) -> Vector {
    unit(match cross(*a, *b) {
        [0, 0, 0] => cross(*a, shortest_axis(a)),
        vector => vector,
    })
}

/// The axis along which the vector's component has the smallest magnitude.
fn shortest_axis(vector: &Vector) -> Vector {
    let sizes = vector.map(i32::abs);
    let axis = (0..3).min_by_key(|&i| sizes[i]).unwrap_or_default();
    [0, 1, 2].map(|i: usize| i32::from(i == axis))
}

/// [`nearest`], but not inlined.
#[inline(never)]
pub(super) const fn rounded(x: i64, bits: i32) -> i64 {
    nearest(x, bits)
}

/// Number of bits of x without leading zeros; 0 for 0.
#[inline(never)]
pub(super) const fn bits(x: u64) -> i32 {
    let (high, low) = ((x >> 32) as u32, x as u32);
    let (mut word, mut bits) = if high == 0 { (low, 0) } else { (high, 32) };
    // The soft core has no instruction that counts leading zeros.
    let mut step = 16;
    while step > 0 {
        if word >> step != 0 {
            word >>= step;
            bits += step;
        }
        step /= 2;
    }
    bits + word as i32
}

/// A non-negative floating-point number: a mantissa of 31 bits, rounded down, times 2^`exponent`. The mantissa is 0 only for the number 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scaled {
    mantissa: u32,
    exponent: i32,
}

impl Scaled {
    const BITS: i32 = 31;

    pub(super) const ONE: Self = Self::new(1, 0);

    /// x·2^`exponent`.
    #[inline(never)]
    pub(super) const fn new(x: u64, exponent: i32) -> Self {
        if x == 0 {
            return Self {
                mantissa: 0,
                exponent: -64,
            };
        }
        let excess = bits(x) - Self::BITS;
        let mantissa = if excess > 0 {
            x >> excess
        } else {
            x << -excess
        };
        Self {
            mantissa: mantissa as u32,
            exponent: exponent + excess,
        }
    }

    /// The reciprocal of the square root of x·2^`exponent`, for an x of at least 1 and an even exponent. The relative error is at most
    /// 5·10^−9.
    #[inline(never)]
    pub(super) fn inverse_root(x: u64, exponent: i32) -> Self {
        // The argument is in [1, 4), with 30 fraction bits: x is this integer times 2^(32 − shift).
        let shift = (64 - bits(x)) & !1;
        let root = inverse_root::<2>((x << shift >> 32) as u32);
        Self {
            mantissa: root.clamp(1 << (Self::BITS - 1), (1 << Self::BITS) - 1),
            exponent: (shift - exponent) / 2 - 62,
        }
    }

    /// The product of two numbers.
    pub(super) const fn by(self, factor: Self) -> Self {
        let product = self.mantissa as u64 * factor.mantissa as u64;
        // The product has 61 or 62 bits.
        let excess = Self::BITS - 1 + (product >> (2 * Self::BITS - 1)) as i32;
        Self {
            mantissa: (product >> excess) as u32,
            exponent: self.exponent + factor.exponent + excess,
        }
    }

    pub(super) const fn halved(self, times: u32) -> Self {
        Self {
            mantissa: self.mantissa,
            exponent: self.exponent - times as i32,
        }
    }

    /// The base-2 logarithm, rounded down; for 0, a number far below all other logarithms.
    pub(super) const fn log2(self) -> i32 {
        self.exponent + Self::BITS - 1
    }

    /// The number with `fraction` fraction bits, rounded to nearest.
    pub(super) const fn fixed(self, fraction: u32) -> i64 {
        self.fixed_at(-(fraction as i32))
    }

    /// The number in units of 2^`exponent`, rounded to nearest.
    pub(super) const fn fixed_at(self, exponent: i32) -> i64 {
        rounded(self.mantissa as i64, exponent - self.exponent)
    }

    /// The product with x, which has 60 fraction bits, rounded to nearest, to 30 fraction bits.
    #[inline(never)]
    pub(super) const fn times(self, x: i64) -> i64 {
        // The product of 95 bits, without the lowest 32 bits.
        let low = (self.mantissa as u64 * (x as u32 as u64)) >> 32;
        let high = self.mantissa as i64 * (x >> 32);
        rounded(high + low as i64, -2 - self.exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_vectors_have_the_length_1() {
        for vector in [
            [1, 0, 0],
            [-3, 4, 12],
            [1 << 25, -7, 3],
            [1 << 55, 1 << 54, -9],
        ] {
            let found = unit(vector).map(|part| f64::from(part) * (-30_f64).exp2());
            let length = found.map(|part| part * part).iter().sum::<f64>();
            assert!((length - 1.0).abs() < 1e-8, "{vector:?}: {found:?}");
        }
    }

    #[test]
    fn scaled_numbers_are_exact_to_30_bits() {
        let three = Scaled::new(3, 0);
        assert_eq!(three.by(Scaled::new(1, 3)).fixed(0), 24);
        assert_eq!(three.halved(1).log2(), 0);
        assert_eq!(three.times(-5 << 58), -15 << 28);
        assert_eq!(Scaled::new(0, 0).times(1 << 60), 0);
        for (square, exponent) in [(9, 0), (9 << 20, -20), (9 << 60, -60)] {
            let third = Scaled::inverse_root(square, exponent).fixed(30);
            assert!((third - (1 << 30) / 3).abs() <= 2, "{third}");
        }
    }
}
