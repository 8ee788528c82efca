//! Smooth shading: the division of light by depth that gives the colour of each pixel (docs/formats/triangle.md, "Smooth
//! shading").

use glint_core::colour::Rgb565;

/// `INVERSE[i]` is 2^17/(1 + (i + 1/2)/1024), rounded to nearest, u0.17.
pub const INVERSE: [u32; 1024] = inverses();

const fn inverses() -> [u32; 1024] {
    let mut table = [0; 1024];
    let mut i = 0;
    while i < table.len() {
        // The exact entry is 2^28/d.
        let d = 2049 + 2 * i as u32;
        table[i] = ((1 << 29) + d) / (2 * d);
        i += 1;
    }
    table
}

/// Bits per channel: red, green and blue.
pub const CHANNEL_BITS: [u32; 3] = [5, 6, 5];

/// The colour of a pixel, from the light accumulators of its channels, and from `depth`, its depth accumulator plus
/// half a code.
///
/// The depth of a covered pixel is at least 2^7 codes; smaller depths give a meaningless colour.
pub fn colour(light: [u32; 3], depth: u32) -> Rgb565 {
    let shift = depth.leading_zeros().min(11);
    let inverse = INVERSE[((depth << shift) >> 21 & 0x3FF) as usize];
    let mut colour = 0;
    for (value, bits) in core::iter::zip(light, CHANNEL_BITS) {
        // Light is at most 63/64 of the depth, so an accumulator whose highest six bits are ones is a light of 0 that was
        // rounded to slightly below 0.
        let product = if value >> 26 == 0x3F {
            0
        } else {
            u64::from(value >> 8) * u64::from(inverse)
        };
        let cut = 40 - bits - shift;
        let channel = (product + (1 << (cut - 1))) >> cut;
        colour = colour << bits | channel as u16 & ((1 << bits) - 1);
    }
    Rgb565(colour)
}
