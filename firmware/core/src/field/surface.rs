//! Distances of points from solids, in field units with 12 fraction bits as in the gateware, and the nearest surfaces.

use crate::fixed::Q32_32;

/// Number of fraction bits of coordinates and distances in field units.
pub const FRACTION: u32 = 12;

/// The surface of a solid that is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// A face perpendicular to an axis.
    Face {
        /// Axis of the normal: 0, 1, 2 for x, y, z.
        axis: u8,
        /// Whether the normal points in the positive direction of the axis.
        positive: bool,
    },
    /// A face perpendicular to a diagonal.
    Octant {
        /// Bit i is set if component i of the normal is positive.
        signs: u8,
    },
    /// The surface of a sphere.
    Round {
        /// The sphere's number, from 0.
        number: u8,
    },
    /// A surface of a union with a fillet: a face, a sphere, or the fillet between them.
    Blended {
        /// Axis of the face.
        axis: u8,
        /// Whether the face's normal points in the positive direction of the axis.
        positive: bool,
        /// Number of the sphere.
        number: u8,
        /// Weight of the sphere, u0.8: 0 means the face alone.
        share: u8,
    },
}

impl Surface {
    /// The base of a cone.
    pub const BASE: Self = Self::Face {
        axis: 2,
        positive: false,
    };

    /// Returns the face in the gateware's encoding. A face perpendicular to an axis is encoded as twice the axis, plus 1 if the
    /// normal is positive; a face perpendicular to a diagonal is encoded as its `signs`. `None` for a sphere.
    pub const fn face(self) -> Option<u8> {
        match self {
            Self::Face { axis, positive } | Self::Blended { axis, positive, .. } => {
                Some(2 * axis + positive as u8)
            }
            Self::Octant { signs } => Some(signs),
            Self::Round { .. } => None,
        }
    }

    /// Number of the sphere; `None` for a face.
    pub const fn number(self) -> Option<u8> {
        match self {
            Self::Face { .. } | Self::Octant { .. } => None,
            Self::Round { number } | Self::Blended { number, .. } => Some(number),
        }
    }

    /// Weight of the sphere in the surface: 0 for a face alone, 255 for a sphere alone.
    pub const fn share(self) -> u8 {
        match self {
            Self::Face { .. } | Self::Octant { .. } => 0,
            Self::Round { .. } => 255,
            Self::Blended { share, .. } => share,
        }
    }
}

/// The distance of a point from a solid, and the surface nearest to the point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldSample {
    /// Distance, s10.12. The distance from a flat solid is in the maximum norm: a cube about the point contains no surface if half its
    /// side is this distance. The distance from spheres is in the Euclidean norm.
    pub distance: i32,
    /// The surface nearest to the point.
    pub surface: Surface,
}

/// Returns the lowest `bits` bits of a number, sign-extended.
pub const fn cropped(x: i32, bits: u32) -> i32 {
    let beyond = 32 - bits;
    x << beyond >> beyond
}

/// Returns the ones' complement magnitude of a number, which needs no carry: |x| for x ≥ 0, |x| − 1 for x < 0.
pub const fn magnitude(x: i32) -> u32 {
    (x ^ (x >> 31)) as u32
}

/// Converts a length from world units to field units, rounded to nearest. |x| is at most 64, the scale at most 256.
pub fn units(x: Q32_32, scale: Q32_32) -> i64 {
    // The length is used with 24 fraction bits, the scale with 20 fraction bits.
    let product = (x.to_bits() >> 8) * (scale.to_bits() >> 12);
    (product + (1 << (43 - FRACTION))) >> (44 - FRACTION)
}
