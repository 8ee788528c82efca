//! View volumes: lenses with a far plane, from the six sides of the volume or from a projection matrix.

use super::error::{Side, ViewError};
use super::lens::Lens;
use super::projection::Projection;
use crate::division::quotient_with_fraction;
use crate::fixed::{Q32_32, U4_28, U8_28};

/// The sides of a window, in world units: to the right and up on the screen from the camera's axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sides {
    /// Coordinate of the left side.
    pub left: Q32_32,
    /// Coordinate of the right side, above `left`.
    pub right: Q32_32,
    /// Coordinate of the lower side.
    pub bottom: Q32_32,
    /// Coordinate of the upper side, above `bottom`.
    pub top: Q32_32,
}

/// The part of the world that a picture shows: a lens and a far plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ViewVolume {
    /// Projection, window and near plane.
    pub lens: Lens,
    /// Distance of the far plane from the eye, in world units; `None` without a far plane.
    pub far: Option<U8_28>,
}

impl ViewVolume {
    /// Makes a volume from its six sides: the window in the near plane, as `glFrustum` and `glOrtho` define it, and the distances of near and
    /// far plane from the eye. Half width, half height and middle of the window are rounded to nearest, with 28 fraction bits.
    ///
    /// # Errors
    /// A side is not beyond its opposite, or out of the range of [`Lens::window`]; or the far plane is not beyond the near plane.
    pub fn of_sides(
        projection: Projection,
        sides: Sides,
        near: U4_28,
        far: Option<U8_28>,
    ) -> Result<Self, ViewError> {
        // A side beyond this limit is out of range, and its sums do not overflow.
        const LIMIT: i64 = 1 << 42;
        let bits = |side: Q32_32| side.to_bits().clamp(-LIMIT, LIMIT);
        // Twice the distance at which the sides are given, with 32 fraction bits.
        let twice = match projection {
            Projection::Perspective => i64::from(near.to_bits()) << 5,
            Projection::Orthographic => 2 << 32,
        };
        let pairs = [
            (Side::Left, sides.left, sides.right),
            (Side::Bottom, sides.bottom, sides.top),
        ];
        let (mut half, mut middle) = ([0; 2], [0; 2]);
        for (axis, (low, least, most)) in pairs.into_iter().enumerate() {
            if least >= most {
                return Err(ViewError::Sides { low, least, most });
            }
            half[axis] = ratio(bits(most) - bits(least), twice);
            middle[axis] = ratio(bits(most) + bits(least), twice);
        }
        Self::new(projection, half, middle, near, far)
    }

    /// Makes a volume from a projection matrix M of OpenGL's convention: the column (x, y, z, 1) of a point in the camera's coordinates (x to
    /// the right, y up, z backwards) becomes M·(x, y, z, 1), whose first three components divided by the fourth are in −1…1 inside the
    /// volume, with z = −1 in the near plane. Any positive multiple of a matrix defines the same
    /// projection. A far plane at 256 world units or
    /// beyond, or at infinity, clips nothing, and is left out.
    ///
    /// Half width, half height and middle of the window, near and far plane are quotients of the matrix's entries and their sums, rounded to
    /// nearest, with 28 fraction bits.
    ///
    /// # Errors
    /// The matrix is no perspective or orthographic projection whose window has sides parallel to x and y, or its volume is out of the
    /// ranges of [`of_sides`](Self::of_sides).
    pub fn of_matrix(matrix: &[[Q32_32; 4]; 4]) -> Result<Self, ViewError> {
        let (projection, signs) = match matrix[3][2].to_bits() {
            0 => (Projection::Orthographic, b"+00*0+0*00-*000+"),
            _ => (Projection::Perspective, b"+0*00+*000-*00-0"),
        };
        for ((place, entry), sign) in (0..).zip(matrix.as_flattened()).zip(signs) {
            let (is_right, expected) = match sign {
                b'+' => (*entry > 0, "above 0"),
                b'-' => (*entry < 0, "below 0"),
                b'0' => (*entry == 0, "0"),
                _ => (true, ""),
            };
            if !is_right {
                return Err(ViewError::Matrix {
                    projection,
                    place,
                    found: *entry,
                    expected,
                });
            }
        }
        let at = |row: usize, column: usize| matrix[row][column].to_bits();
        let (a, b) = (at(2, 2), at(2, 3));
        // The dividend w of the window's half sizes, the column with its middle, and the planes at which z becomes −1 and 1.
        let (w, column, [near, far]) = match projection {
            // At the depth d, −a·d + b = ∓w·d.
            Projection::Perspective => {
                let w = at(3, 2).saturating_neg();
                let plane = |sum: i64| if sum == 0 { i64::MAX } else { ratio(b, sum) };
                let planes = [a.saturating_sub(w), a.saturating_add(w)];
                (w, 2, planes.map(plane))
            }
            // −a·d + b = ∓w.
            Projection::Orthographic => {
                let w = at(3, 3);
                let planes = [b.saturating_add(w), b.saturating_sub(w)];
                (w, 3, planes.map(|sum| ratio(sum, a)))
            }
        };
        let half = [0, 1].map(|axis: usize| ratio(w, at(axis, axis)));
        let middle = [0, 1].map(|axis: usize| {
            let middle = ratio(at(axis, column), at(axis, axis));
            if column == 2 { middle } else { -middle }
        });
        const LIMIT: i64 = 256 << 28;
        let near = U4_28::from_bits(near.clamp(0, u32::MAX.into()) as u32);
        let far = Some(far).filter(|far| *far < LIMIT);
        let far = far.map(|far| U8_28::from_bits(far.max(0).unsigned_abs()));
        Self::new(projection, half, middle, near, far)
    }

    /// Makes a volume from half the width and height of the window and its middle, to the right and up, with 28 fraction bits.
    #[inline(never)]
    fn new(
        projection: Projection,
        half: [i64; 2],
        [across, up]: [i64; 2],
        near: U4_28,
        far: Option<U8_28>,
    ) -> Result<Self, ViewError> {
        let half = half.map(|half| U8_28::from_bits(half.max(0).unsigned_abs()));
        // Quotients are within 2^62.
        let middle = [across, -up].map(|middle| Q32_32::from_bits(middle.saturating_mul(16)));
        let lens = Lens::window(projection, half, middle, near)?;
        match far {
            Some(far) if far <= near => Err(ViewError::Far { near, far }),
            _ => Ok(Self { lens, far }),
        }
    }
}

/// The quotient of two numbers, rounded to nearest with ties away from 0, with 28 fraction bits. A quotient beyond ±2^34 saturates.
#[inline(never)]
fn ratio(number: i64, divisor: i64) -> i64 {
    // The quotient has one fraction bit more than the result.
    let twice = quotient_with_fraction(number.unsigned_abs(), divisor.unsigned_abs(), 29);
    let nearest = ((twice + 1) >> 1) as i64;
    if (number < 0) == (divisor < 0) {
        nearest
    } else {
        -nearest
    }
}
