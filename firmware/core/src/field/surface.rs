//! Distances in the engine's arithmetic: field units with 12 fraction bits, and the surface that is nearest.

use crate::fixed::Q32_32;

/// Fraction bits of field units.
pub const FRACTION: u32 = 12;

/// The nearest surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// A face that is perpendicular to an axis.
    Face {
        /// 0, 1, 2: x, y, z.
        axis: u8,
        /// Whether its normal points along the axis, and not against it.
        positive: bool,
    },
    /// A face that is perpendicular to a diagonal.
    Octant {
        /// Bit i is set where its normal points along axis i, and not against it.
        signs: u8,
    },
    /// A sphere's.
    Round {
        /// The sphere's number, from 0.
        number: u8,
    },
    /// Of a union with a fillet: a face's, a sphere's, or the fillet's between them.
    Blended {
        /// The face's axis.
        axis: u8,
        /// Whether its normal points along the axis.
        positive: bool,
        /// The sphere.
        number: u8,
        /// The part of the sphere in it, u0.8: 0 is the face.
        share: u8,
    },
}

impl Surface {
    /// The face as the gateware has it: twice its axis, and 1 if it is positive; or the signs of an octant.
    pub const fn face(self) -> Option<u8> {
        match self {
            Self::Face { axis, positive } | Self::Blended { axis, positive, .. } => {
                Some(2 * axis + positive as u8)
            }
            Self::Octant { signs } => Some(signs),
            Self::Round { .. } => None,
        }
    }

    /// The sphere's number.
    pub const fn number(self) -> Option<u8> {
        match self {
            Self::Face { .. } | Self::Octant { .. } => None,
            Self::Round { number } | Self::Blended { number, .. } => Some(number),
        }
    }

    /// The part of the sphere in it, 255 of a sphere alone.
    pub const fn share(self) -> u8 {
        match self {
            Self::Face { .. } | Self::Octant { .. } => 0,
            Self::Round { .. } => 255,
            Self::Blended { share, .. } => share,
        }
    }
}

/// A distance and the surface at which it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// Flat fields, in the maximum norm: the cube of this half side about the point holds no surface. Round fields, in the
    /// Euclidean norm. s10.12.
    pub distance: i32,
    /// The surface.
    pub surface: Surface,
}

/// The lowest bits of a number, the highest of them its sign.
pub const fn cropped(x: i32, bits: u32) -> i32 {
    let beyond = 32 - bits;
    x << beyond >> beyond
}

/// |x|, or one less: |x| − 1 of a negative x.
pub const fn magnitude(x: i32) -> u32 {
    (x ^ (x >> 31)) as u32
}

/// A length in world units in field units, nearest. |x| is at most 64 and the scale 256.
pub fn units(x: Q32_32, scale: Q32_32) -> i64 {
    // 24 and 20 fraction bits.
    let product = (x.to_bits() >> 8) * (scale.to_bits() >> 12);
    (product + (1 << (43 - FRACTION))) >> (44 - FRACTION)
}
