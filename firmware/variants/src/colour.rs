//! Packing of colours with eight bits per channel to pixels of a frame buffer.

use glint_core::colour::Rgb565;

use crate::kernel::Format::Fixed;
use crate::kernel::{Kernel, other, shipped};

/// A pixel format: a kernel that packs a colour 0xRRGGBB, and the inverse.
pub struct Pixel {
    /// The kernel that packs a colour.
    pub pack: Kernel<u32, u64>,
    /// Number of bits of a pixel.
    pub bits: u32,
    /// The displayed red, green and blue of a pixel.
    pub shown: fn(u64) -> [u8; 3],
}

/// All pixel formats, from fast to exact.
pub const PIXELS: &[Pixel] = &[
    truncated::<3, 3, 2>("colour_332", "RGB332, truncated"),
    truncated::<4, 4, 4>("colour_444", "RGB444, truncated"),
    truncated::<5, 6, 5>("colour_565_cut", "RGB565, truncated"),
    Pixel {
        pack: shipped("colour_565", "RGB565, to nearest", Fixed(0), |rgb| {
            let [_, r, g, b] = rgb.to_be_bytes();
            Rgb565::from_rgb888([r, g, b]).0.into()
        }),
        bits: 16,
        shown: |pixel| Rgb565(pixel as u16).to_rgb888(),
    },
    Pixel {
        pack: other("colour_888", "RGB888", Fixed(0), |rgb| rgb.into()),
        bits: 24,
        shown: |pixel| [16, 8, 0].map(|shift| (pixel >> shift) as u8),
    },
];

/// Maps a phase, a number that a benchmark spreads over its range, to an input.
pub const fn input(phase: u32) -> u32 {
    phase >> 8
}

/// The pixel format that keeps the highest `R` bits of red, `G` bits of green and `B` bits of blue.
const fn truncated<const R: u32, const G: u32, const B: u32>(
    name: &'static str,
    config: &'static str,
) -> Pixel {
    Pixel {
        pack: other(name, config, Fixed(0), |rgb| cut(rgb, [R, G, B])),
        bits: R + G + B,
        shown: |pixel| widened(pixel, [R, G, B]),
    }
}

/// Keeps the highest bits of each channel.
fn cut(rgb: u32, bits: [u32; 3]) -> u64 {
    let mut pixel = 0;
    for (bits, channel) in core::iter::zip(bits, [rgb >> 16, rgb >> 8, rgb]) {
        pixel = pixel << bits | (channel & 0xFF) >> (8 - bits);
    }
    pixel.into()
}

/// Widens each channel to eight bits by repeating its bits.
fn widened(pixel: u64, bits: [u32; 3]) -> [u8; 3] {
    let [r, g, b] = bits;
    let mut shift = r + g + b;
    [r, g, b].map(|bits| {
        shift -= bits;
        let channel = (pixel >> shift) as u32 & ((1 << bits) - 1);
        let top = channel << (8 - bits);
        (top | top >> bits | top >> (2 * bits).min(8) | top >> (3 * bits).min(8)) as u8
    })
}
