//! Scale of the gyroscope's counts.

use crate::fixed::Q32_32;
use crate::mpu6050::GYRO_LSB_PER_DPS;

/// Half angle per count and microsecond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    /// Half angle in radians with 80 fraction bits, for a rate of 2^−12 LSB over 1 µs.
    per_microsecond: u64,
}

/// Accepted LSB per °/s. With fewer LSB a step of [`super::rate::LONGEST_CURVE`] would overflow the formats.
pub const LSB_PER_DPS: [Q32_32; 2] = [Q32_32::lit("8"), Q32_32::lit("4096")];

impl Scale {
    /// An MPU-6050 at ±2000 °/s: 16.4 LSB per °/s.
    pub const MPU_6050: Self = Self::of(GYRO_LSB_PER_DPS);

    /// A scale in LSB per °/s; `None` outside [`LSB_PER_DPS`].
    pub fn new(lsb_per_dps: Q32_32) -> Option<Self> {
        (LSB_PER_DPS[0]..=LSB_PER_DPS[1])
            .contains(&lsb_per_dps)
            .then(|| Self::of(lsb_per_dps))
    }

    const fn of(lsb_per_dps: Q32_32) -> Self {
        // Half a degree is π/360 rad; the dividend is 10^−6·2^−12 times this, with 80 fraction bits plus the 32 of the divisor.
        let half_degree = (crate::trig::PI_Q60 << 40) / (360 * 1_000_000);
        Self {
            per_microsecond: (half_degree / lsb_per_dps.to_bits() as u128) as u64,
        }
    }

    /// The factor of rates over a step in µs, at most 2^20.
    pub(super) fn factor(self, step: u32) -> Factor {
        Factor(self.per_microsecond * u64::from(step))
    }
}

/// Half angle in radians with 80 fraction bits, for a rate of 2^−12 LSB over a step; at most 2^59.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factor(u64);

impl Factor {
    /// Half angle with 48 fraction bits of a rate with 12 fraction bits, to nearest.
    pub fn half_angle(self, rate: i32) -> i64 {
        let (high, low) = ((self.0 >> 32) as i32, self.0 as u32);
        let rate = i64::from(rate);
        rate * i64::from(high) + ((rate * i64::from(low) + (1 << 31)) >> 32)
    }

    /// h/12 as a factor with 32 fraction bits from a cross product of rates in 2^5 LSB² to 2^−12 LSB, for a step of at most
    /// [`super::rate::LONGEST_CURVE`]: twice the half angle over 12.
    pub fn coning(self) -> u32 {
        const TWELFTH: u64 = (1 << 32) / 12;
        // The first factor is below 2^36 for such a step.
        (((self.0 >> 18) * TWELFTH) >> 32) as u32
    }
}
