//! The scale between depths and depth codes.

use glint_core::fixed::Q32_32;

/// K = `mantissa`·2^`exponent`: a depth code is K/z, and z is K/code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthScale {
    /// Mantissa km, u17 in [2^16, 2^17).
    pub mantissa: u32,
    /// Exponent ke, −5 to 5.
    pub exponent: i32,
}

impl DepthScale {
    /// (2^18 − 4) times the smallest possible depth of the mesh: the depth of the near plane, or of the mesh's bounding sphere about
    /// the origin if the sphere begins beyond the near plane. `n` may be 10^−4 longer than 1, so the radius is enlarged by 2^−13.
    pub(crate) fn new(origin: i64, near: i64, radius: u32) -> Self {
        let radius = i64::from(radius);
        let reach = (radius << 23) + (radius << 10);
        Self::from_nearest(near.max(origin - reach))
    }

    /// The scale (2^18 − 4)·z for a nearest depth z in (0, 64], 37 fraction bits.
    pub(crate) fn from_nearest(nearest: i64) -> Self {
        // The product is below 2^61.
        let scale = nearest as u64 * ((1 << 18) - 4);
        Self::cut(scale, -37)
    }

    /// The product with a number above 0 and with 2^`shift`, truncated to 17 bits.
    pub(crate) fn times(&self, scale: Q32_32, shift: u32) -> Self {
        // Product of 17 by 40 bits.
        let product = u64::from(self.mantissa) * (scale.to_bits() as u64 >> 8);
        Self::cut(product, self.exponent - 24 + shift as i32)
    }

    /// value·2^exponent, truncated to 17 bits.
    fn cut(value: u64, exponent: i32) -> Self {
        let lead = value.ilog2();
        Self {
            mantissa: (value >> (lead - 16)) as u32,
            exponent: lead as i32 - 16 + exponent,
        }
    }

    /// The distance along n of a depth code, to nearest; `None` for the clear code 0.
    pub fn distance(&self, code: u32) -> Option<Q32_32> {
        let code = u64::from(code);
        // The dividend is below 2^(17 + 37).
        let scale = u64::from(self.mantissa) << (32 + self.exponent);
        let bits = (scale + code / 2).checked_div(code)?;
        Some(Q32_32::from_bits(bits as i64))
    }
}
