//! The units of a sensor's samples.

use crate::fixed::Q32_32;
use crate::mpu6050::GYRO_LSB_PER_DPS;

/// Scales of a sensor's raw counts: LSB per °/s and LSB per g.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Units {
    /// LSB of the gyroscope per °/s.
    pub per_dps: Q32_32,
    /// LSB of the accelerometer per g.
    pub per_g: u32,
}

impl Units {
    /// Scales of an MPU-6050 with the ranges ±2000 °/s and ±8 g.
    pub const MPU_6050: Self = Self {
        per_dps: GYRO_LSB_PER_DPS,
        per_g: 4_096,
    };

    /// Converts a rate of `dps` degrees per second to LSB, rounded up. The result is at least 1.
    pub(crate) fn rate(self, dps: u32) -> u32 {
        // The scale is limited to 2^−4…2^12 LSB per °/s; 2^12 is the largest scale of a sensor with 16-bit counts.
        let lsb = self.per_dps.to_bits().clamp(1 << 28, 1 << 44);
        ((i128::from(lsb) * i128::from(dps) + (1 << 32) - 1) >> 32) as u32
    }

    /// Converts a rate in units of 2^−16 LSB to °/h, rounded down.
    pub(crate) fn per_hour(self, rate: u32) -> Q32_32 {
        let lsb = i128::from(self.per_dps.to_bits().max(1 << 28));
        Q32_32::saturating_from_num(fixed_i128(((i128::from(rate) * 3_600) << 48) / lsb))
    }
}

/// Converts raw bits to a fixed-point number with 32 fraction bits.
fn fixed_i128(bits: i128) -> fixed::FixedI128<fixed::types::extra::U32> {
    fixed::FixedI128::from_bits(bits)
}
