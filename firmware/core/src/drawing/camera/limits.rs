//! Ranges and default values of the parameters of a camera.

use crate::fixed::{Q4_28, Q32_32, Turns, U4_28, U8_28};

/// Half width of the image plane at distance 1, in world units, for cameras that are defined by angles.
pub const DEFAULT_HALF_WIDTH: U8_28 = U8_28::lit("0.9");
/// Distance of the near plane from the eye, in world units, for cameras that are defined by angles.
pub const DEFAULT_NEAR: U4_28 = U4_28::lit("0.1");

/// Largest accepted distance of an eye from the origin, in world units.
pub const MAX_EYE: u32 = 32;
/// Smallest and largest accepted half width of the image plane, at distance 1 in perspective, in world units.
pub const HALF_WIDTH: [U8_28; 2] = [U8_28::lit("0.0087"), U8_28::lit("115")];
/// Smallest and largest accepted half height of the image plane, at distance 1 in perspective, in world units.
pub const HALF_HEIGHT: [U8_28; 2] = [U8_28::lit("0.0049"), U8_28::lit("115")];
/// Largest accepted distance of the picture's middle from the camera's axis, across and down, at distance 1 in perspective, in world units.
pub const MIDDLE: Q4_28 = Q4_28::lit("6");
/// Smallest and largest accepted width of the picture of an orthographic camera, in world units: twice the [`HALF_WIDTH`].
pub const WIDTH: [U8_28; 2] = [U8_28::lit("0.0174"), U8_28::lit("230")];
/// Smallest and largest accepted horizontal field of view, 1° and 179°.
pub const FIELD_OF_VIEW: [Turns; 2] = [
    Turns::from_degrees(Q32_32::lit("1")),
    Turns::from_degrees(Q32_32::lit("179")),
];
/// Smallest and largest accepted distance of the near plane from the eye, in world units.
pub const NEAR: [U4_28; 2] = [U4_28::lit("0.01"), U4_28::lit("2")];
/// Smallest and largest accepted distance of a camera of `View::spherical` from the origin, in world units.
pub const RADIUS: [Q32_32; 2] = [Q32_32::lit("2"), Q32_32::lit("5")];
