//! Distances in the engine's arithmetic: field units with 12 fraction bits, and the nearest surface.

use crate::fixed::Q32_32;

/// Fraction bits of field units.
pub const FRACTION: u32 = 12;

/// The nearest surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// A face perpendicular to an axis.
    Face {
        /// Axis of the normal: 0, 1, 2 for x, y, z.
        axis: u8,
        /// Whether the normal points along the axis, not against it.
        positive: bool,
    },
    /// A face perpendicular to a diagonal.
    Octant {
        /// Bit i is set if the normal points along axis i.
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
        /// Whether the face's normal points along the axis.
        positive: bool,
        /// Number of the sphere.
        number: u8,
        /// Weight of the sphere, u0.8: 0 is the face alone.
        share: u8,
    },
}

impl Surface {
    /// The face in the gateware's encoding: twice its axis, plus 1 if the normal is positive; or the signs of an octant.
    pub const fn face(self) -> Option<u8> {
        match self {
            Self::Face { axis, positive } | Self::Blended { axis, positive, .. } => {
                Some(2 * axis + positive as u8)
            }
            Self::Octant { signs } => Some(signs),
            Self::Round { .. } => None,
        }
    }

    /// Number of the sphere, if any.
    pub const fn number(self) -> Option<u8> {
        match self {
            Self::Face { .. } | Self::Octant { .. } => None,
            Self::Round { number } | Self::Blended { number, .. } => Some(number),
        }
    }

    /// Weight of the sphere; 255 for a sphere alone.
    pub const fn share(self) -> u8 {
        match self {
            Self::Face { .. } | Self::Octant { .. } => 0,
            Self::Round { .. } => 255,
            Self::Blended { share, .. } => share,
        }
    }
}

/// A distance and the nearest surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// Distance, s10.12: in the maximum norm for flat fields (the cube of this half side about the point holds no surface), in the
    /// Euclidean norm for round fields.
    pub distance: i32,
    /// The nearest surface.
    pub surface: Surface,
}

/// The lowest bits of a number, sign-extended.
pub const fn cropped(x: i32, bits: u32) -> i32 {
    let beyond = 32 - bits;
    x << beyond >> beyond
}

/// |x| for x ≥ 0, |x| − 1 for a negative x.
pub const fn magnitude(x: i32) -> u32 {
    (x ^ (x >> 31)) as u32
}

/// Converts a length from world units to field units, to nearest. |x| is at most 64, the scale at most 256.
pub fn units(x: Q32_32, scale: Q32_32) -> i64 {
    // The factors have 24 and 20 fraction bits.
    let product = (x.to_bits() >> 8) * (scale.to_bits() >> 12);
    (product + (1 << (43 - FRACTION))) >> (44 - FRACTION)
}
