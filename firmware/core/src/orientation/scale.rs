//! What a count of the gyroscope is worth.

use crate::fixed::Q32_32;

/// Half an angle for each count and microsecond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    /// Half an angle in radians with 80 fraction bits, for a rate of 2^−12 LSB over 1 µs.
    per_microsecond: u64,
}

/// The LSB per °/s that are accepted. Below them a step of [`super::rate::LONGEST_CURVE`] would leave its formats.
pub const LSB_PER_DPS: [Q32_32; 2] = [Q32_32::lit("8"), Q32_32::lit("4096")];

impl Scale {
    /// An MPU-6050 at ±2000 °/s: 16.4 LSB per °/s.
    pub const MPU_6050: Self = Self::of(Q32_32::lit("16.4"));

    /// So many LSB per °/s, if they are within [`LSB_PER_DPS`].
    pub fn new(lsb_per_dps: Q32_32) -> Option<Self> {
        (LSB_PER_DPS[0]..=LSB_PER_DPS[1])
            .contains(&lsb_per_dps)
            .then(|| Self::of(lsb_per_dps))
    }

    const fn of(lsb_per_dps: Q32_32) -> Self {
        // π/360 rad are half a degree; 10^−6·2^−12 of that with 80 fraction bits, and the 32 of the divisor.
        let half_degree = (crate::trig::PI_Q60 << 40) / (360 * 1_000_000);
        Self {
            per_microsecond: (half_degree / lsb_per_dps.to_bits() as u128) as u64,
        }
    }

    /// Half the angle of a rate with 12 fraction bits over a time in µs, 48 fraction bits, to nearest. The time is at most 2^20 µs.
    pub(super) fn half_angle(self, rate: i32, time: u32) -> i64 {
        // At most 1.3·2^38 a microsecond, so the product has 59 bits.
        let factor = self.per_microsecond * u64::from(time);
        let (high, low) = ((factor >> 32) as i64, factor as u32);
        let rate = i64::from(rate);
        rate * high + ((rate * i64::from(low) + (1 << 31)) >> 32)
    }

    /// h/12·(A × E) as a rate with 12 fraction bits, to nearest, from the cross product in LSB² with 20 fraction bits and a
    /// step in µs, at most [`super::rate::LONGEST_CURVE`].
    pub(super) fn coning(self, cross: i64, step: u32) -> i32 {
        // Twice the half angle over 12, for 2^5 LSB², with 32 fraction bits: at most 2^32 at the longest step.
        let factor = ((self.per_microsecond * u64::from(step)) >> 18) / 12;
        let cross = (cross >> 25).clamp(-(1 << 30), 1 << 30);
        ((cross * factor as i64 + (1 << 31)) >> 32) as i32
    }
}
