//! Reasons why numbers do not describe a camera.

use core::fmt;

use super::limits::{FIELD_OF_VIEW, HALF_HEIGHT, HALF_WIDTH, MAX_EYE, MIDDLE, NEAR, RADIUS, WIDTH};
use super::projection::Projection;
use crate::fixed::{Decimal, Q2_23, Q32_32, Turns, U4_28, U8_28};

/// One of the three vectors of a camera's basis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BasisVector {
    /// The vector u, which points to the right of the screen.
    U,
    /// The vector v, which points down the screen.
    V,
    /// The vector n, which points into the scene.
    N,
}

impl fmt::Display for BasisVector {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::U => "u",
            Self::V => "v",
            Self::N => "n",
        })
    }
}

/// The left or the lower side of a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The left side, opposite to the right side.
    Left,
    /// The lower side, opposite to the upper side.
    Bottom,
}

/// Reason why numbers do not describe a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewError {
    /// The eye is too far from the origin.
    Eye([Q32_32; 3]),
    /// The length of a vector of the basis differs from 1 by more than 1e-4.
    Length {
        /// Name of the vector.
        axis: BasisVector,
        /// Components of the vector.
        row: [Q2_23; 3],
    },
    /// The scalar product of two vectors of the basis exceeds 1e-4 in magnitude.
    NotPerpendicular {
        /// The first vector.
        a: BasisVector,
        /// The second vector.
        b: BasisVector,
        /// Their scalar product.
        product: Q2_23,
    },
    /// The basis is orthonormal but u × v = −n.
    Mirrored,
    /// The half width is out of range.
    HalfWidth(U8_28),
    /// The half height is out of range.
    HalfHeight(U8_28),
    /// A coordinate of the middle of the picture is out of range.
    Middle(Q32_32),
    /// The right side of the window is not beyond the left side, or the upper side not beyond the lower side.
    Sides {
        /// The left or the lower side.
        low: Side,
        /// Its coordinate.
        least: Q32_32,
        /// Coordinate of the opposite side.
        most: Q32_32,
    },
    /// An entry that makes a matrix neither a perspective nor an orthographic projection.
    Matrix {
        /// The projection that the entry in row 4, column 3 selects: orthographic if this entry is 0, otherwise perspective.
        projection: Projection,
        /// Number of the entry, row by row, from 0.
        place: u8,
        /// Value of the entry.
        found: Q32_32,
        /// Description of the value that this entry has in a projection.
        expected: &'static str,
    },
    /// The near plane is out of range.
    Near(U4_28),
    /// The far plane is not beyond the near plane.
    Far {
        /// Distance of the near plane.
        near: U4_28,
        /// Distance of the far plane.
        far: U8_28,
    },
    /// The direction of the gaze is 0.
    Gaze,
    /// The direction that points up on the screen is 0.
    Up,
    /// The width of the picture of an orthographic camera is out of range.
    Width(U8_28),
    /// The field of view is out of range.
    FieldOfView(Turns),
    /// The radius of a spherical camera is out of range.
    Radius(Q32_32),
    /// The polar angle of a spherical camera is out of range.
    Polar(Turns),
}

impl fmt::Display for ViewError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Self::Eye(eye) => {
                let [x, y, z] = eye.map(Decimal);
                write!(
                    f,
                    "eye ({x}, {y}, {z}): expected within {MAX_EYE} of the origin"
                )
            }
            Self::Length { axis, row } => {
                let [x, y, z] = row.map(Decimal);
                write!(f, "{axis} = ({x}, {y}, {z}): expected length 1 within 1e-4")
            }
            Self::NotPerpendicular { a, b, product } => {
                write!(f, "{a}·{b} = {}: expected 0 within 1e-4", Decimal(product))
            }
            Self::Mirrored => {
                f.write_str("u × v = −n: expected u × v = n (u right, v down, n forward)")
            }
            Self::HalfWidth(x) => out_of_range(f, "half_width", x, &HALF_WIDTH),
            Self::HalfHeight(x) => out_of_range(f, "half_height", x, &HALF_HEIGHT),
            Self::Middle(x) => write!(
                f,
                "middle of the picture {} from the camera's axis: expected within {}",
                Decimal(x),
                Decimal(MIDDLE)
            ),
            Self::Sides { low, least, most } => {
                let (low, high) = match low {
                    Side::Left => ("left", "right"),
                    Side::Bottom => ("bottom", "top"),
                };
                let [least, most] = [least, most].map(Decimal);
                write!(
                    f,
                    "{low} {least}, {high} {most}: expected {low} below {high}"
                )
            }
            Self::Matrix {
                projection,
                place,
                found,
                expected,
            } => {
                let [row, column] = [place / 4, place % 4].map(|from_0| u32::from(from_0) + 1);
                let found = Decimal(found);
                write!(
                    f,
                    "row {row}, column {column} is {found}: expected {expected} in {projection} projection"
                )
            }
            Self::Far { near, far } => {
                let (near, far) = (Decimal(near), Decimal(far));
                write!(f, "far {far}: expected beyond the near plane, {near}")
            }
            Self::Width(x) => out_of_range(f, "width", x, &WIDTH),
            Self::Near(x) => out_of_range(f, "near", x, &NEAR),
            Self::Radius(x) => out_of_range(f, "radius", x, &RADIUS),
            Self::Gaze => f.write_str("gaze (0, 0, 0): expected a non-zero direction"),
            Self::Up => f.write_str("up (0, 0, 0): expected a non-zero direction"),
            Self::FieldOfView(angle) => {
                let [least, most] =
                    FIELD_OF_VIEW.map(|angle| angle.to_degrees().round().to_num::<u32>());
                let angle = Decimal(angle.to_degrees());
                write!(
                    f,
                    "field of view {angle} degrees: expected {least} to {most}"
                )
            }
            Self::Polar(phi) => {
                let phi = Decimal(phi.to_degrees());
                write!(f, "phi {phi} degrees: expected 0 to 180")
            }
        }
    }
}

/// Writes that a number is not within its range.
fn out_of_range<T: Copy>(
    f: &mut fmt::Formatter,
    name: &str,
    found: T,
    &[least, most]: &[T; 2],
) -> fmt::Result
where
    Decimal<T>: fmt::Display,
{
    let [found, least, most] = [found, least, most].map(Decimal);
    write!(f, "{name} {found}: expected {least} to {most}")
}

impl core::error::Error for ViewError {}
