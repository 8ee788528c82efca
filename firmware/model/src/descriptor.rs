//! Descriptors and band lists: what the raster unit draws from (docs/formats.md).

use glint_core::colour::{Rgb565, Shading};

use crate::setup::{Plane, Setup};

/// Columns of a group: what the raster unit draws in one clock.
pub const GROUP: i32 = 8;

/// A triangle after its setup: what gateware without smooth shading knows, and then the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Descriptor {
    words: [u32; SMOOTH_WORDS],
}

/// Words of 32 bits that gateware without smooth shading has for a descriptor: 48 bytes.
const FLAT_WORDS: usize = 12;
/// Words of 32 bits that gateware with smooth shading has for a descriptor: 96 bytes.
const SMOOTH_WORDS: usize = 24;

/// Words of 32 bits of a descriptor, a multiple of four, for gateware that can shade as far as this.
pub const fn words(ability: Shading) -> usize {
    match ability {
        Shading::Flat => FLAT_WORDS,
        Shading::Smooth => SMOOTH_WORDS,
    }
}

impl Descriptor {
    /// Of a triangle; the colour is that of one that has no light of its own.
    pub fn new(setup: &Setup, colour: Rgb565) -> Self {
        let bounds = setup.bounds;
        // Bounds are in the picture, so divisions need not look at signs.
        let group_start = setup.start_column / GROUP;
        let back = setup.start_column - GROUP * group_start;
        let mut bits = Packer::default();
        for edge in &setup.edges {
            bits.put(edge.start - i64::from(back) * i64::from(edge.step_x), 34);
        }
        bits.put_plane(&setup.depth, back);
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
        if let Some(light) = &setup.light {
            light.iter().for_each(|plane| bits.put_plane(plane, back));
            bits.put(1, 1);
        }
        Self { words: bits.words }
    }

    /// The bits for gateware that can shade as far as this, the lowest in the lowest of the first word.
    pub fn words(&self, ability: Shading) -> &[u32] {
        self.words.get(..words(ability)).unwrap_or_default()
    }
}

/// Puts fields behind each other.
#[derive(Default)]
struct Packer {
    words: [u32; SMOOTH_WORDS],
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

    /// A plane, with its start moved to the left.
    fn put_plane(&mut self, plane: &Plane, back: i32) {
        let start = plane
            .start
            .wrapping_sub(plane.step_x.wrapping_mul(back as u32));
        for value in [start, plane.step_x, plane.step_y] {
            self.put(value.into(), 32);
        }
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
