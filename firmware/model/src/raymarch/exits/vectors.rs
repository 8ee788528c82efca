//! Vectors of integers, and positive numbers with an exponent, for the constants of a frame.

use super::narrow::nearest;

/// A vector. A *unit vector* has the length 1 and 30 fraction bits.
pub(super) type Vector = [i64; 3];

/// Fraction bits of a unit vector.
const UNIT: u32 = 30;

pub(super) fn dot(a: Vector, b: Vector) -> i64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// The cross product.
pub(super) fn across(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// The unit vector of the direction of a vector. The vector 0 has the direction of the z axis.
pub(super) fn unit(vector: Vector) -> Vector {
    let most = vector.iter().fold(0, |all, part| all | part.unsigned_abs());
    if most == 0 {
        return [0, 0, 1 << UNIT];
    }
    // The largest component has 30 bits.
    let scaled = vector.map(|part| nearest(part, most.ilog2() as i32 + 1 - UNIT as i32));
    // One division: its quotient has 33 bits at most, and a component 30.
    let inverse = (1 << 62) / dot(scaled, scaled).isqrt();
    scaled.map(|part| nearest(part * inverse, 32))
}

/// A number of at least 0: a mantissa of 31 bits, rounded down, and an exponent of 2. The mantissa 0 is the number 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scaled {
    mantissa: i64,
    exponent: i32,
}

impl Scaled {
    const BITS: i32 = 31;

    pub(super) const ONE: Self = Self::new(1, 0);

    /// x·2^`exponent`, x at least 0.
    pub(super) const fn new(x: i64, exponent: i32) -> Self {
        if x == 0 {
            return Self {
                mantissa: 0,
                exponent: -64,
            };
        }
        let excess = x.ilog2() as i32 + 1 - Self::BITS;
        let mantissa = if excess > 0 {
            x >> excess
        } else {
            x << -excess
        };
        Self {
            mantissa,
            exponent: exponent + excess,
        }
    }

    /// The square root of x·2^`exponent`, x at least 0 and the exponent even.
    pub(super) const fn root(x: i64, exponent: i32) -> Self {
        if x == 0 {
            return Self::new(0, 0);
        }
        // Of 61 or 62 bits.
        let shift = (61 - x.ilog2() as i32) & !1;
        Self::new((x << shift).isqrt(), (exponent - shift) / 2)
    }

    /// The quotient. The divisor must not be 0.
    pub(super) const fn over(self, divisor: Self) -> Self {
        let quotient = (self.mantissa << Self::BITS) / divisor.mantissa;
        Self::new(quotient, self.exponent - divisor.exponent - Self::BITS)
    }

    /// The product.
    pub(super) const fn by(self, factor: Self) -> Self {
        let product = self.mantissa * factor.mantissa;
        Self::new(product, self.exponent + factor.exponent)
    }

    pub(super) const fn halved(self, times: u32) -> Self {
        Self {
            mantissa: self.mantissa,
            exponent: self.exponent - times as i32,
        }
    }

    /// The logarithm to the base 2, rounded down; of 0, a number far below all others.
    pub(super) const fn log2(self) -> i32 {
        self.exponent + Self::BITS - 1
    }

    /// The number with `fraction` fraction bits, rounded to nearest.
    pub(super) const fn fixed(self, fraction: u32) -> i64 {
        self.fixed_at(-(fraction as i32))
    }

    /// The number in units of 2^`exponent`, rounded to nearest.
    pub(super) const fn fixed_at(self, exponent: i32) -> i64 {
        nearest(self.mantissa, exponent - self.exponent)
    }

    /// The product with x, which has 60 fraction bits. The product has 30, rounded to nearest.
    pub(super) const fn times(self, x: i64) -> i64 {
        if x == 0 {
            return 0;
        }
        let excess = 64 - x.unsigned_abs().leading_zeros() as i32 - Self::BITS;
        let short = nearest(x, excess);
        nearest(short * self.mantissa, 30 - excess - self.exponent)
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
            let found = unit(vector).map(|part| part as f64 * (-30_f64).exp2());
            let length = found.map(|part| part * part).iter().sum::<f64>();
            assert!((length - 1.0).abs() < 1e-8, "{vector:?}: {found:?}");
        }
        assert_eq!(across([1, 0, 0], [0, 1, 0]), [0, 0, 1]);
    }

    #[test]
    fn scaled_numbers_are_exact_to_30_bits() {
        let three = Scaled::new(3, 0);
        assert_eq!(Scaled::root(9, 0).fixed(0), 3);
        assert_eq!(Scaled::root(9 << 20, -24).fixed(2), 3);
        assert_eq!(three.over(Scaled::new(1, 3)).fixed(16), 3 << 13);
        assert_eq!(three.halved(1).log2(), 0);
        assert_eq!(three.times(-5 << 58), -15 << 28);
        assert_eq!(
            (
                Scaled::new(0, 0).times(1 << 60),
                Scaled::root(0, 0).fixed(30)
            ),
            (0, 0)
        );
        let third = Scaled::ONE.over(three);
        assert!((third.fixed(30) - (1 << 30) / 3).abs() <= 1);
    }
}
