//! The named fixed-point formats, angles, and conversions from and to decimals.
//!
//! `QI.F` is a two's complement number with I integer bits, which include the sign, and F fraction bits; `UI.F` has no sign. The
//! types are aliases of types of the [`fixed`] crate. Such a type may have more integer bits than the alias states; code that
//! computes a value keeps the value within the range of the alias. `FromStr` reads a decimal by integer arithmetic, rounds to
//! nearest with ties to even, and rejects out-of-range numbers. `Display` prints the shortest decimal that reads back as the same
//! bits.

use core::fmt;

pub use ::fixed;
use ::fixed::types::extra::{LeEqU32, LeEqU64, U11, U12, U14, U16, U20, U23, U24, U28, U30, U32};
use ::fixed::{FixedI16, FixedI32, FixedI64, FixedU16, FixedU32, FixedU64};

/// Format of positions and normals: units of 2^−14, in [−2, 2).
pub type Q2_14 = FixedI16<U14>;
/// Format of the numbers in wireframe programs: units of 2^−11, in [−16, 16).
pub type Q5_11 = FixedI16<U11>;
/// Format of moved points of wireframes: units of 2^−20, in [−2048, 2048).
pub type Q12_20 = FixedI32<U20>;
/// Format of a camera's basis: units of 2^−23, in [−2, 2), 25 bits in a 32-bit word.
pub type Q2_23 = FixedI32<U23>;
/// Format of the entries of a model matrix: units of 2^−24, in [−128, 128).
pub type Q8_24 = FixedI32<U24>;
/// Format of sines and cosines: units of 2^−30, in [−2, 2).
pub type Q2_30 = FixedI32<U30>;
/// Format of positions in the world, such as an eye: units of 2^−32.
pub type Q32_32 = FixedI64<U32>;
/// Format of times in seconds: units of 2^−32, in [0, 2^32), which is 136 years.
pub type U32_32 = FixedU64<U32>;
/// Format of the near plane of a camera: units of 2^−28, in [0, 16).
pub type U4_28 = FixedU32<U28>;
/// Format of the half width of a camera: units of 2^−28, in [0, 256).
pub type U8_28 = FixedU64<U28>;

/// Format of a position in a camera frame: units of 2^−12 pixels.
pub type U20_12 = FixedU32<U12>;
/// Format of fractions of a whole: units of 2^−16, in [0, 1).
pub type U0_16 = FixedU16<U16>;
/// Format of frequencies in Hz, and of their products with a time: units of 2^−16, in [0, 65536).
pub type U16_16 = FixedU32<U16>;
/// Format of values that a hand controls, in turns or world units: units of 2^−28, in [−8, 8).
pub type Q4_28 = FixedI32<U28>;

/// An angle in units of 2^−32 turns, modulo one turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Turns(pub u32);

impl Turns {
    /// A quarter of a turn, 90°.
    pub const QUARTER: Self = Self(1 << 30);
    /// Half a turn, 180°.
    pub const HALF: Self = Self(1 << 31);

    /// Returns the angle nearest to a number of degrees, modulo one turn.
    pub const fn from_degrees(degrees: Q32_32) -> Self {
        let bits = degrees.to_bits();
        let nearest = bits.div_euclid(360) + (bits.rem_euclid(360) >= 180) as i64;
        // The conversion to 32 bits drops the whole turns.
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

/// A number in a message: prints what the number's own `Display` prints without width and precision, whose code is several times as large.
#[derive(Clone, Copy, Debug)]
pub struct Decimal<T>(pub T);

/// Implements `Display` for numbers of a type of the [`fixed`] crate.
macro_rules! decimals {
    ($($number:ident<$bits:ident>, $is_negative:expr, $magnitude:expr;)+) => {
        $(
            impl<F: $bits> fmt::Display for Decimal<$number<F>> {
                fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
                    let bits = self.0.to_bits();
                    write_decimal(f, $is_negative(bits), $magnitude(bits).into(), F::U32)
                }
            }
        )+
    };
}

decimals! {
    FixedI32<LeEqU32>, i32::is_negative, i32::unsigned_abs;
    FixedI64<LeEqU64>, i64::is_negative, i64::unsigned_abs;
    FixedU32<LeEqU32>, |_| false, u32::from;
    FixedU64<LeEqU64>, |_| false, u64::from;
}

/// Writes the shortest decimal that is nearest to a number with at most 32 fraction bits.
// The only copy of this code for all formats.
#[inline(never)]
fn write_decimal(
    f: &mut fmt::Formatter,
    is_negative: bool,
    bits: u64,
    fraction: u32,
) -> fmt::Result {
    let sign = if is_negative { "-" } else { "" };
    write!(f, "{sign}{}", bits >> fraction)?;
    // In halves of the number's unit.
    let one = 2 << fraction;
    let mut rest = 2 * (bits & ((1 << fraction) - 1));
    if rest == 0 {
        return Ok(());
    }
    let (mut digits, mut count, mut half_unit) = (0, 0, 1_u64);
    // Ends when a half unit, times a power of ten, exceeds a half, so all numbers fit 64 bits.
    loop {
        rest *= 10;
        half_unit *= 10;
        digits = 10 * digits + (rest >> fraction >> 1);
        rest &= one - 1;
        count += 1;
        if rest < half_unit || one - rest < half_unit {
            break;
        }
    }
    // To nearest, ties to even. A number with a carry to the previous digit would have ended the loop before.
    digits += u64::from(rest > one / 2 || rest == one / 2 && digits % 2 == 1);
    write!(f, ".{digits:0count$}")
}

/// Reads a decimal as `FromStr` does; `None` for a malformed or out-of-range number.
///
/// All formats read numbers with 64 bits, so that the firmware has one function for integer parts.
pub(crate) fn parse_i32<F: LeEqU32 + LeEqU64>(text: &str) -> Option<FixedI32<F>> {
    text.parse::<FixedI64<F>>().ok()?.checked_to_num()
}

/// Returns the exact product of two 32-bit numbers.
pub(crate) const fn wide(a: i32, b: i32) -> i64 {
    a as i64 * b as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::lengths;
    use std::format;

    fn check<T: Copy + fmt::Display>(number: T)
    where
        Decimal<T>: fmt::Display,
    {
        assert_eq!(format!("{}", Decimal(number)), format!("{number}"));
    }

    #[test]
    fn decimals_equal_those_of_the_crate() {
        let mut random = lengths(1);
        let ends = [
            0,
            1,
            u64::MAX,
            u64::MAX >> 1,
            1 << 63,
            1 << 31,
            1 << 32,
            0x7FFF_FFFF,
            0xFFFF_FFFF,
        ];
        let numbers = (0..100_000).map(|_| random()).collect::<std::vec::Vec<_>>();
        for bits in ends
            .into_iter()
            .chain(numbers.iter().copied())
            .chain(numbers.iter().map(|bits| !bits))
        {
            check(Q32_32::from_bits(bits.cast_signed()));
            check(U32_32::from_bits(bits));
            check(U8_28::from_bits(bits));
            check(Q2_23::from_bits(bits as i32));
            check(Q8_24::from_bits(bits as i32));
            check(Q2_30::from_bits(bits as i32));
            check(Q12_20::from_bits(bits as i32));
            check(U4_28::from_bits(bits as u32));
            check(U20_12::from_bits(bits as u32));
        }
    }
}
