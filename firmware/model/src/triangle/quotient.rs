//! Smooth shading: the division of light by depth that gives the colour of each pixel (docs/formats/triangle.md, "Smooth
//! shading").

use glint_core::colour::{Rgb565, Rounding};

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

/// The largest channels with fraction bits: 31, 63 and 31 steps.
pub const LARGEST: [u8; 3] = Rgb565::WHITE.fractions();

/// The channels of a pixel, red u5.3, green u6.2 and blue u5.3. `values` are the light accumulators of the channels, and `depth` is the
/// depth accumulator plus half a code.
///
/// The depth of a covered pixel is at least 2^7 codes; smaller depths give a meaningless colour.
pub fn colour(light: [u32; 3], depth: u32, rounding: Rounding) -> [u8; 3] {
    let shift = depth.leading_zeros().min(11);
    let inverse = INVERSE[((depth << shift) >> 21 & 0x3FF) as usize];
    // A channel has 8 bits. A product has 40 − `shift` fraction bits.
    let cut = 32 - shift;
    [0, 1, 2].map(|i: usize| {
        let value = light[i];
        // Light is at most 63/64 of the depth, so an accumulator whose highest six bits are ones is a light of 0 that was
        // rounded to slightly below 0.
        if value >> 26 == 0x3F {
            return 0;
        }
        let product = u64::from(value >> 8) * u64::from(inverse);
        let channel = ((product + u64::from(rounding.before_fractions(cut))) >> cut) as u8;
        // Full light may be rounded to slightly above the largest step.
        channel.min(LARGEST[i])
    })
}
