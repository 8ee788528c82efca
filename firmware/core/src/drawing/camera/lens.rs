//! The lens of a camera: the part of the world that its picture shows.

use core::fmt;

use super::error::ViewError;
use super::limits::{DEFAULT_HALF_WIDTH, DEFAULT_NEAR, HALF_HEIGHT, HALF_WIDTH, MIDDLE, NEAR};
use super::projection::Projection;
use crate::division::quotient_with_fraction;
use crate::fixed::{Q4_28, Q32_32, U4_28, U8_28};

/// Projection, window and near plane of a camera.
///
/// The window is the rectangle that the picture shows: at distance 1 from the eye in perspective, at every distance in orthographic
/// projection. Its sides are parallel to the camera's axes u and v. By default its middle is on the axis n, and its shape is that of the
/// picture, 16:9, so that pixels are square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lens {
    projection: Projection,
    half_width: U8_28,
    /// Half the height of the window; `None` for square pixels.
    half_height: Option<U8_28>,
    /// Middle of the window, along u and v.
    middle: [Q4_28; 2],
    near: U4_28,
}

impl Lens {
    /// The lens of cameras that are defined by angles.
    pub(super) const DEFAULT: Self = Self {
        projection: Projection::Perspective,
        half_width: DEFAULT_HALF_WIDTH,
        half_height: None,
        middle: [Q4_28::ZERO; 2],
        near: DEFAULT_NEAR,
    };

    /// Makes a lens with square pixels, whose picture is centred on the direction of view, from half the width of the window and the
    /// distance of the near plane, in world units.
    ///
    /// # Errors
    /// `half_width` is not from 0.0087 to 115, or `near` not from 0.01 to 2.
    pub fn new(projection: Projection, half_width: U8_28, near: U4_28) -> Result<Self, ViewError> {
        let lens = Self {
            projection,
            ..Self::DEFAULT
        };
        lens.with_half_width(half_width)?.with_near(near)
    }

    /// Makes a lens from half the width and height of its window, the window's middle along u and v, and the distance of the near plane, in
    /// world units. The middle is rounded to nearest. A half height that fits square pixels within the rounding of both halves gives
    /// exactly the lens of [`new`](Self::new).
    ///
    /// # Errors
    /// The half width is not from 0.0087 to 115, the half height not from 0.0049 to 115, a coordinate of the middle not within 6, or
    /// `near` not from 0.01 to 2.
    #[inline(never)]
    pub fn window(
        projection: Projection,
        [half_width, half_height]: [U8_28; 2],
        middle: [Q32_32; 2],
        near: U4_28,
    ) -> Result<Self, ViewError> {
        let lens = Self::new(projection, half_width, near)?;
        if !(HALF_HEIGHT[0]..=HALF_HEIGHT[1]).contains(&half_height) {
            return Err(ViewError::HalfHeight(half_height));
        }
        if let Some(far) = middle.into_iter().find(|x| x.unsigned_abs() > MIDDLE) {
            return Err(ViewError::Middle(far));
        }
        // The errors of both halves are at most half a unit.
        let misfit = (16 * half_height.to_bits()).abs_diff(9 * half_width.to_bits());
        let is_square = misfit <= (16 + 9) / 2 + 1;
        Ok(Self {
            half_height: Some(half_height).filter(|_| !is_square),
            middle: middle.map(|x| Q4_28::from_bits(((x.to_bits() + (1 << 3)) >> 4) as i32)),
            ..lens
        })
    }

    /// The lens with another half width, and square pixels.
    pub(super) fn with_half_width(self, half_width: U8_28) -> Result<Self, ViewError> {
        if !(HALF_WIDTH[0]..=HALF_WIDTH[1]).contains(&half_width) {
            return Err(ViewError::HalfWidth(half_width));
        }
        Ok(Self {
            half_width,
            half_height: None,
            ..self
        })
    }

    /// The lens with half width and half height divided by `factor`, rounded down; for a factor of 0 both become 256. Quotients saturate
    /// at 2^31.
    pub(super) fn zoomed(self, factor: U8_28) -> Result<Self, ViewError> {
        let part = |half: U8_28| {
            if factor == 0 {
                return U8_28::lit("256");
            }
            let part = quotient_with_fraction(half.to_bits(), factor.to_bits(), 28);
            U8_28::from_bits(part)
        };
        let half_height = self.half_height.map(part);
        let lens = self.with_half_width(part(self.half_width))?;
        match half_height {
            Some(half) if !(HALF_HEIGHT[0]..=HALF_HEIGHT[1]).contains(&half) => {
                Err(ViewError::HalfHeight(half))
            }
            _ => Ok(Self {
                half_height,
                ..lens
            }),
        }
    }

    /// The lens with another near plane.
    pub(super) fn with_near(self, near: U4_28) -> Result<Self, ViewError> {
        if !(NEAR[0]..=NEAR[1]).contains(&near) {
            return Err(ViewError::Near(near));
        }
        Ok(Self { near, ..self })
    }

    /// The lens with another projection.
    pub(super) const fn with_projection(self, projection: Projection) -> Self {
        Self { projection, ..self }
    }

    /// The lens with its window moved by `shift`, at most 1 in magnitude, along u.
    pub(super) fn shifted(self, shift: Q4_28) -> Self {
        let [across, down] = self.middle;
        Self {
            middle: [across + shift, down],
            ..self
        }
    }

    /// The projection: perspective or orthographic.
    pub const fn projection(&self) -> Projection {
        self.projection
    }

    /// Half the width of the window in world units, from 0.0087 to 115.
    pub const fn half_width(&self) -> U8_28 {
        self.half_width
    }

    /// Half the height of the window in world units, from 0.0049 to 115; with square pixels 9/16 of the half width, rounded to nearest.
    pub fn half_height(&self) -> U8_28 {
        let square = || U8_28::from_bits((9 * self.half_width.to_bits() + 8) >> 4);
        self.half_height.unwrap_or_else(square)
    }

    /// The middle of the window along u and v, in world units. Each coordinate is within ±6, or ±7 for an eye of a stereo pair.
    pub const fn middle(&self) -> [Q4_28; 2] {
        self.middle
    }

    /// The distance of the near plane from the eye, in world units, from 0.01 to 2.
    pub const fn near(&self) -> U4_28 {
        self.near
    }

    /// For each direction, across and down: a length on the screen in pixels, and the same length in the window. The lengths are half of
    /// the width and half of the height of a picture. With square pixels, both directions have the lengths across, so that their scales
    /// are equal, bit for bit.
    #[inline(always)]
    pub fn scales(&self, [width, height]: [u32; 2]) -> [(u32, U8_28); 2] {
        let across = (width / 2, self.half_width);
        let down = self.half_height.map(|half| (height / 2, half));
        [across, down.unwrap_or(across)]
    }
}

/// Writes half width and near plane. The projection follows, unless it is perspective and the window is centred with square pixels. For any
/// other window, the half height and the middle along u and v follow.
impl fmt::Display for Lens {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self {
            projection,
            half_width,
            middle: [across, down],
            near,
            ..
        } = self;
        write!(f, "{half_width} {near}")?;
        if self.half_height.is_some() || self.middle != [Q4_28::ZERO; 2] {
            write!(f, " {projection} {} {across} {down}", self.half_height())
        } else if *projection == Projection::Orthographic {
            write!(f, " {projection}")
        } else {
            Ok(())
        }
    }
}
