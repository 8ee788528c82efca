//! Arithmetic of the shapes, in Q2.14.

use crate::fixed::{Q2_14, Q2_30, Turns};
use crate::trig::sin_cos_q30;

/// 1.0 in Q2.14.
pub const ONE: i16 = 1 << 14;

/// Sine and cosine, rounded to nearest.
pub fn sin_cos(angle: Turns) -> (Q2_14, Q2_14) {
    let narrow = |x: Q2_30| Q2_14::from_bits(((x.to_bits() + (1 << 15)) >> 16) as i16);
    let (sin, cos) = sin_cos_q30(angle);
    (narrow(sin), narrow(cos))
}

/// The product of a factor and a length, in Q2.14, rounded down; the length is at most 2.
pub fn scaled(factor: Q2_14, length: i32) -> i32 {
    (i32::from(factor.to_bits()) * length) >> 14
}
