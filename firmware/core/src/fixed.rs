//! The named fixed-point formats, angles, and decimals.
//!
//! `QI.F` is a two's complement number with I integer bits, which include the sign, and F fraction bits; `UI.F` has no sign.
//! The types are those of the [`fixed`] crate: an alias may hold more integer bits than its name says, and the creator of
//! a value keeps its range. Their `FromStr` reads a decimal by integer arithmetic, rounds to nearest with ties to even,
//! and refuses numbers out of range; their `Display` prints the shortest decimal that
//! reads back as the same bits.

pub use ::fixed;
use ::fixed::types::extra::{U14, U23, U28, U30, U32};
use ::fixed::{FixedI16, FixedI32, FixedI64, FixedU32};

/// Positions, normals: 1/16384 in [−2, 2).
pub type Q2_14 = FixedI16<U14>;
/// The basis of a camera: 2^−23 in [−2, 2), 25 bits in a 32-bit word.
pub type Q2_23 = FixedI32<U23>;
/// Sines and cosines: 2^−30 in [−2, 2).
pub type Q2_30 = FixedI32<U30>;
/// Position of an eye: 2^−32.
pub type Q32_32 = FixedI64<U32>;
/// The half width of a picture and the near plane: 2^−28 in [0, 16).
pub type U4_28 = FixedU32<U28>;

/// An angle in units of 2^−32 turns, modulo one turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Turns(pub u32);

impl Turns {
    /// A quarter of a turn, 90°.
    pub const QUARTER: Self = Self(1 << 30);
    /// Half a turn, 180°.
    pub const HALF: Self = Self(1 << 31);

    /// The angle nearest to a number of degrees, modulo one turn.
    pub const fn from_degrees(degrees: Q32_32) -> Self {
        let bits = degrees.to_bits();
        let nearest = bits.div_euclid(360) + (bits.rem_euclid(360) >= 180) as i64;
        // Truncation drops the whole turns.
        Self(nearest as u32)
    }

    /// The angle in degrees, in [0, 360), exactly.
    pub const fn to_degrees(self) -> Q32_32 {
        Q32_32::from_bits(self.0 as i64 * 360)
    }

    /// The angle in degrees, in [−180, 180), exactly.
    pub const fn to_signed_degrees(self) -> Q32_32 {
        Q32_32::from_bits(self.0 as i32 as i64 * 360)
    }

    /// The sum of two angles, modulo one turn.
    #[must_use]
    pub const fn wrapping_add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

impl core::ops::Neg for Turns {
    type Output = Self;

    fn neg(self) -> Self {
        Self(self.0.wrapping_neg())
    }
}

/// The product of two numbers, exact.
pub(crate) const fn wide(a: i32, b: i32) -> i64 {
    a as i64 * b as i64
}
