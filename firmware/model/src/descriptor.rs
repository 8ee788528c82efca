//! Descriptors and band lists: what the raster unit draws from (docs/formats.md).

use glint_core::colour::Rgb565;

use crate::setup::Setup;

/// Columns of a group: what the raster unit draws in one clock.
pub const GROUP: i32 = 8;

/// A triangle after its setup, 48 bytes in memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Descriptor {
    /// The bits, the lowest in the lowest of the first word.
    pub words: [u32; 12],
}

impl Descriptor {
    /// Of a triangle in one colour.
    pub fn new(setup: &Setup, colour: Rgb565) -> Self {
        let bounds = setup.bounds;
        // Bounds are in the picture, so divisions need not look at signs.
        let group_start = setup.start_column / GROUP;
        let back = setup.start_column - GROUP * group_start;
        let mut bits = Packer::default();
        for edge in &setup.edges {
            bits.put(edge.start - i64::from(back) * i64::from(edge.step_x), 34);
        }
        let depth = setup.depth;
        let depth_start = depth
            .start
            .wrapping_sub(depth.step_x.wrapping_mul(back as u32));
        for value in [depth_start, depth.step_x, depth.step_y] {
            bits.put(value.into(), 32);
        }
        for edge in &setup.edges {
            bits.put(edge.step_x.into(), 21);
            bits.put(edge.step_y.into(), 21);
        }
        bits.put(bounds.top.into(), 10);
        bits.put(bounds.bottom.into(), 10);
        bits.put((bounds.left / GROUP).into(), 8);
        bits.put(((bounds.right - 1) / GROUP).into(), 8);
        bits.put(group_start.into(), 8);
        bits.put(colour.0.into(), 16);
        Self { words: bits.words }
    }

    /// As it lies in memory.
    pub fn to_bytes(&self) -> [u8; 48] {
        let mut bytes = [0; 48];
        for (to, word) in bytes.as_chunks_mut().0.iter_mut().zip(self.words) {
            *to = word.to_le_bytes();
        }
        bytes
    }
}

/// Puts fields behind each other.
#[derive(Default)]
struct Packer {
    words: [u32; 12],
    used: usize,
}

impl Packer {
    /// The lowest `width` bits of a value, which is in its range.
    fn put(&mut self, value: i64, width: usize) {
        for i in 0..width {
            let at = self.used + i;
            if let Some(word) = self.words.get_mut(at / 32) {
                *word |= ((value >> i & 1) as u32) << (at % 32);
            }
        }
        self.used += width;
    }
}

/// Words of 16 bytes before the first list of a set: the lengths of 64 lists.
pub const TABLE_WORDS: u32 = 16;

/// Where the list of a band begins, in words of 16 bytes from the beginning of its set. Lists have room for 4 << `shift`
/// entries, and a row of a memory's bank lies between them, so that neighbours are in different banks.
pub const fn list_word(band: u32, shift: u32) -> u32 {
    TABLE_WORDS + (band << shift) + 128 * band
}

/// Rows of a band of a picture of this width, one of [`SIZES`](crate::SIZES): at most 15,360 pixels.
pub const fn band_rows(width: u32) -> u32 {
    match width {
        320 => 45,
        640 => 24,
        _ => 12,
    }
}
