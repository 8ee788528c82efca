//! The scale that converts depths to depth codes.

use glint_core::fixed::Q32_32;

/// The scale K of depth codes, as `mantissa`·2^`exponent`: in perspective, a surface at depth z along the camera's forward axis n has the
/// code K/z (docs/formats/camera.md, "Frame constants").
///
/// In orthographic projection codes are linear: a code is 2^(`exponent` − 19) world units (docs/formats/camera.md, "Orthographic
/// projection").
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DepthScale {
    /// Mantissa km, u17 in [2^16, 2^17).
    pub mantissa: u32,
    /// Exponent ke, −5 to 5; in orthographic projection −6 to 10.
    pub exponent: i32,
    /// In orthographic projection, the depth whose code is 2^18, with 37 fraction bits.
    pub origin: Option<i64>,
}

/// Number of codes for the depth range of an orthographic frame: all but the four highest and the four lowest codes.
const LINEAR_CODES: i64 = (1 << 18) - 8;

impl DepthScale {
    /// Returns the scale for a mesh with the given `radius` (14 fraction bits). `origin` is the depth of the world's origin, and `near` is
    /// the depth of the near plane; both have 37 fraction bits.
    ///
    /// The scale is (2^18 − 4) times the smallest possible depth of the mesh: the depth of the near plane, or of the nearest point of the
    /// mesh's bounding sphere about the origin if that is farther. The length of the axis n may be 1 + 10^−4, so the radius is multiplied
    /// by 1 + 2^−13.
    pub(crate) fn new(origin: i64, near: i64, radius: u32) -> Self {
        Self::from_nearest(near.max(origin - Self::reach(radius)))
    }

    /// Returns the largest difference in depth between a point of a mesh with the given `radius` and the mesh's origin, 37 fraction bits.
    pub(crate) fn reach(radius: u32) -> i64 {
        let radius = i64::from(radius);
        (radius << 23) + (radius << 10)
    }

    /// Returns the scale of a frame whose smallest depth is `nearest`, in (0, 64], with 37 fraction bits: (2^18 − 4)·`nearest`.
    pub(crate) fn from_nearest(nearest: i64) -> Self {
        // `nearest` is at most 2^43, so the product is below 2^61.
        let scale = nearest as u64 * ((1 << 18) - 4);
        Self::cut(scale, -37)
    }

    /// Returns the scale of an orthographic frame for depths from `nearest` to `farthest`, with 37 fraction bits. The world units per code
    /// are the smallest power of two, at least 2^(`least` − 19), for which every depth has a code. `nearest` has the code 2^18 − 4.
    pub(crate) fn linear(nearest: i64, farthest: i64, least: i32) -> Self {
        // One code is 2^(18 + ke) units of a depth. Depths differ by less than 2^46, so the loop ends at an exponent of at most 10.
        let mut exponent = least;
        while LINEAR_CODES << (18 + exponent) < farthest - nearest && exponent < 10 {
            exponent += 1;
        }
        Self {
            mantissa: 1 << 16,
            exponent,
            origin: Some(nearest - (4 << (18 + exponent))),
        }
    }

    /// Returns this scale multiplied by `scale`, which is above 0, and by 2^`shift`, with the mantissa truncated to 17 bits.
    pub(crate) fn times(&self, scale: Q32_32, shift: u32) -> Self {
        // Multiplies the mantissa (17 bits) by `scale` truncated to 40 bits, of which 24 are fraction bits.
        let product = u64::from(self.mantissa) * (scale.to_bits() as u64 >> 8);
        Self::cut(product, self.exponent - 24 + shift as i32)
    }

    /// Returns the scale `value`·2^`exponent`, with the mantissa truncated to 17 bits.
    fn cut(value: u64, exponent: i32) -> Self {
        let lead = value.ilog2();
        Self {
            mantissa: (value >> (lead - 16)) as u32,
            exponent: lead as i32 - 16 + exponent,
            origin: None,
        }
    }

    /// The depth of a code in orthographic projection, 37 fraction bits.
    pub(crate) fn linear_depth(&self, code: u32) -> i64 {
        let below = (1 << 18) - i64::from(code);
        self.origin.unwrap_or_default() + (below << (18 + self.exponent))
    }

    /// Converts a depth code to the depth along the camera's forward axis n, rounded to nearest; `None` for code 0, an empty pixel.
    pub fn distance(&self, code: u32) -> Option<Q32_32> {
        if let (Some(_), 1..) = (self.origin, code) {
            return Some(Q32_32::from_bits((self.linear_depth(code) + (1 << 4)) >> 5));
        }
        let code = u64::from(code);
        // The mantissa is below 2^17 and the shift at most 37, so the dividend is below 2^(17 + 37).
        let scale = u64::from(self.mantissa) << (32 + self.exponent);
        let bits = (scale + code / 2).checked_div(code)?;
        Some(Q32_32::from_bits(bits as i64))
    }
}
