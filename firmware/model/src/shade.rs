//! Flat shading with the light at the camera.

use glint_core::colour::Rgb565;

use crate::nearest;
use crate::setup::Facing;

/// clamp(−N·n, 0, 1) of a face normal N (s2.14) and the forward direction n (s2.23), u1.8; a back face negates N.
pub fn intensity(normal: [i16; 3], n: &[i32; 3], facing: Facing) -> u32 {
    // Below 2^41.
    let product: i64 = core::iter::zip(normal, n)
        .map(|(a, &b)| i64::from(a) * i64::from(b))
        .sum();
    let towards = match facing {
        Facing::Front => -product,
        Facing::Back => product,
    };
    nearest(towards, 37 - 8).clamp(0, 1 << 8) as u32
}

/// Each channel times the intensity (u1.8, at most 1), to nearest.
pub fn lit(colour: Rgb565, intensity: u32) -> Rgb565 {
    let [r, g, b] = colour
        .channels()
        .map(|c| ((u32::from(c) * intensity + (1 << 7)) >> 8) as u16);
    Rgb565(r << 11 | g << 5 | b)
}
