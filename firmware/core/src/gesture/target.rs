//! Maps the hand's position and width in a camera frame to a position of the camera on a sphere about the origin.

use super::blob::Blob;
use crate::fixed::{Q4_28, U0_16};

/// Smallest angle between the camera and a pole of its sphere, in turns: 5.625°. At a pole the azimuth has no effect.
pub const POLE: Q4_28 = Q4_28::lit("0.015625");
/// Widths of the hand, as parts of the frame, at which the camera has its largest and its smallest distance.
pub const WIDTHS: [U0_16; 2] = [U0_16::lit("0.0625"), U0_16::lit("0.4375")];
/// The smallest and the largest distance of the camera from the origin, in world units: the limits of [`crate::camera::RADIUS`].
pub(super) const DISTANCES: [Q4_28; 2] = [Q4_28::lit("2"), Q4_28::lit("5")];
/// Smallest and largest polar angle, in turns.
pub(super) const POLARS: [Q4_28; 2] = [POLE, Q4_28::from_bits((1 << 27) - POLE.to_bits())];

/// Computes the camera's position for a hand: azimuth in turns, in [−1/2, 1/2), polar angle in turns, and distance in world
/// units. `size` is the number of columns and rows of the frame.
///
/// The azimuth is 0 at the frame's middle, and its resolution is 2^−21 turns (0.0002°). The distance decreases linearly with the
/// hand's width: a hand that approaches looks wider and moves the camera nearer, and noise of the width has the same effect at
/// every distance.
pub fn target(blob: &Blob, size: [u16; 2]) -> [Q4_28; 3] {
    let [x, y] = [0, 1].map(|axis| part(blob.centre[axis].to_bits(), size[axis]));
    let theta = Q4_28::from_bits(x - (1 << 27));
    let phi = Q4_28::from_bits(y >> 1).clamp(POLARS[0], POLARS[1]);
    let width = blob.width.clamp(WIDTHS[0], WIDTHS[1]);
    // A change of the width by 3/8 of the frame moves the camera by 3 world units, so the factor is 8; the format changes from 16
    // to 28 fraction bits.
    let nearer = i32::from(width.to_bits() - WIDTHS[0].to_bits()) << (3 + 12);
    [theta, phi, DISTANCES[1] - Q4_28::from_bits(nearer)]
}

/// Returns a coordinate in units of 2^−12 pixels as part of the frame's `length` in pixels, with 28 fraction bits. The centre of
/// pixel 0 is half a pixel from the border.
#[inline(never)]
fn part(coordinate: u32, length: u16) -> i32 {
    let length = u32::from(length.max(1));
    let place = coordinate.saturating_add(1 << 11).min((length << 12) - 1);
    // Every supported frame has a length below 2^11, so the coordinate is below 2^23; the quotient has 21 fraction bits.
    let shift = if length < 1 << 11 { 9 } else { 4 };
    (((place << shift) / length) << (16 - shift)) as i32
}
