//! The scale of the gyroscope's counts, which converts rates in LSB to angles.

use crate::fixed::Q32_32;
use crate::mpu6050::GYRO_LSB_PER_DPS;

/// Scale from counts to angles: half the angle by which a body turns per count of its rate and microsecond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    /// Half angle in radians with 80 fraction bits, for a rate of 2^−12 LSB over 1 µs.
    per_microsecond: u64,
}

/// Smallest and largest accepted LSB per °/s. With fewer LSB per °/s, a step of [`super::rate::LONGEST_CURVE`] would
/// overflow the number formats.
pub const LSB_PER_DPS: [Q32_32; 2] = [Q32_32::lit("8"), Q32_32::lit("4096")];

impl Scale {
    /// The scale of an MPU-6050 with the range ±2000 °/s: 16.4 LSB per °/s.
    pub const MPU_6050: Self = Self::of(GYRO_LSB_PER_DPS);

    /// Makes a scale from LSB per °/s; `None` outside [`LSB_PER_DPS`].
    pub fn new(lsb_per_dps: Q32_32) -> Option<Self> {
        (LSB_PER_DPS[0]..=LSB_PER_DPS[1])
            .contains(&lsb_per_dps)
            .then(|| Self::of(lsb_per_dps))
    }

    const fn of(lsb_per_dps: Q32_32) -> Self {
        // Half a degree is π/360 rad. `half_degree` is 10^−6·2^−12 times half a degree, with 112 fraction bits: 80 for the
        // quotient and 32 for the divisor.
        let half_degree = (crate::trig::PI_Q60 << 40) / (360 * 1_000_000);
        Self {
            per_microsecond: (half_degree / lsb_per_dps.to_bits() as u128) as u64,
        }
    }

    /// Computes the factor that converts rates to half angles, for a step of `step` µs, which is at most 2^20.
    pub(super) fn factor(self, step: u32) -> Factor {
        Factor((self.per_microsecond * u64::from(step)) >> 1)
    }
}

/// The half angle of a step for a rate of 2^−13 LSB, in radians with 80 fraction bits; at most 2^58.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Factor(u64);

impl Factor {
    /// Computes the half angle of the step, in radians with 48 fraction bits, rounded to nearest. The rate is in
    /// LSB with 13 fraction bits.
    pub fn half_angle(self, rate: i32) -> i64 {
        let (high, low) = ((self.0 >> 32) as i32, self.0 as u32);
        // The low word is rounded by its highest bit, which takes fewer instructions than a sum of 64 bits.
        let low = i64::from(rate) * i64::from(low);
        let low = (low >> 32) as i32 + (low as u32 >> 31) as i32;
        i64::from(rate) * i64::from(high) + i64::from(low)
    }

    /// Computes the factor h/12 of the cross product A × E in the formulas of the module `rate`, for a step h of at most
    /// [`super::rate::LONGEST_CURVE`]: a twelfth of twice the half angle. The factor has 32 fraction bits, and converts a cross
    /// product in units of 2^5 LSB² to a rate in units of 2^−12 LSB.
    pub fn coning(self) -> u32 {
        const TWELFTH: u64 = (1 << 32) / 12;
        // `self.0 >> 17` is below 2^36 for such a step.
        (((self.0 >> 17) * TWELFTH) >> 32) as u32
    }
}
