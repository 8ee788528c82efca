//! Descriptors and band lists, the input of the raster pass (docs/formats/triangle.md).

mod contents;

use core::ops::RangeInclusive;

use glint_core::colour::{Rgb565, Shading};
use glint_core::machine::{self, LIST_GAP_WORDS, LIST_TABLE_WORDS};
use glint_core::picture::Size;

use crate::line::Piece;
use crate::triangle::setup::{Plane, Setup};

pub use contents::Contents;

/// Number of columns of a group, which is also the number of pixels that the raster pass draws in one clock.
pub const GROUP: i32 = machine::GROUP as i32;

/// A triangle after its setup, or a piece of a line, packed into words of 32 bits. The words for smooth shading, with the planes
/// of light, come last: gateware without smooth shading reads only the words before them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Descriptor {
    words: [u32; SMOOTH_WORDS],
}

/// Number of 32-bit words of a descriptor for gateware without smooth shading.
const FLAT_WORDS: usize = machine::FLAT_DESCRIPTOR_BYTES as usize / 4;
/// Number of 32-bit words of a descriptor for gateware with smooth shading.
const SMOOTH_WORDS: usize = machine::SMOOTH_DESCRIPTOR_BYTES as usize / 4;

/// Number of 32-bit words of a descriptor, a multiple of four, for gateware whose best shading is `capability`.
pub const fn words(capability: Shading) -> usize {
    match capability {
        Shading::Flat => FLAT_WORDS,
        Shading::Smooth => SMOOTH_WORDS,
    }
}

/// The bits of a descriptor that mark a piece of a line.
const PIECE: i64 = 3;
/// Half a depth code, 14 fraction bits, which the depth of a piece includes.
const HALF_A_CODE: i64 = 1 << 13;

impl Descriptor {
    /// Packs a triangle; `colour` is its colour under flat shading.
    pub fn new(setup: &Setup, colour: Rgb565) -> Self {
        let bounds = setup.bounds;
        // The bounds are in the picture and not negative, so unsigned divisions suffice.
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

    /// Packs a piece of a line, whose first pixel is in the picture.
    pub fn of_piece(piece: &Piece) -> Self {
        let line = &piece.line;
        let [major, minor] = line.span;
        let [left, up] = if line.x_major {
            line.backward
        } else {
            [line.backward[1], line.backward[0]]
        };
        let [column, row] = piece.first();
        let mut bits = Packer {
            used: 128,
            ..Packer::default()
        };
        bits.put(line.x_major.into(), 1);
        bits.put(left.into(), 1);
        bits.put(up.into(), 1);
        bits.put(column.into(), 11);
        bits.put(row.into(), 10);
        bits.put(line.count.into(), 12);
        bits.put((line.error + minor).into(), 21);
        bits.put(minor.into(), 20);
        bits.put((minor - major).into(), 21);
        // The depth has its lowest 30 bits here, and the others behind the repeated words.
        let depth = line.depth + HALF_A_CODE;
        bits.put(depth, 30);
        bits.used = 320;
        bits.put(depth >> 30, 4);
        bits.put(line.depth_step, 34);
        bits.used = 366;
        bits.put(PIECE, 2);
        bits.put(piece.colour.0.into(), 16);
        let mut words = bits.words;
        words.copy_within(4..8, 0);
        words.copy_within(4..6, 8);
        Self { words }
    }

    /// The words that gateware reads whose best shading is `capability`, the word with the lowest bits first.
    pub fn words(&self, capability: Shading) -> &[u32] {
        self.words.get(..words(capability)).unwrap_or_default()
    }
}

/// Packs consecutive bit fields.
#[derive(Default)]
struct Packer {
    words: [u32; SMOOTH_WORDS],
    used: usize,
}

impl Packer {
    /// Appends the lowest `width` bits of `value`, which must fit this width.
    fn put(&mut self, value: i64, width: usize) {
        let (mut value, mut left) = (value, width);
        while left > 0 {
            let shift = self.used % 32;
            let count = left.min(32 - shift);
            // The bits of this field in a word: `count` ones from `shift` on.
            let mask = u32::MAX >> (32 - count) << shift;
            if let Some(word) = self.words.get_mut(self.used / 32) {
                *word |= (value as u32) << shift & mask;
            }
            value >>= count;
            left -= count;
            self.used += count;
        }
    }

    /// Appends a plane whose start is moved `back` columns to the left.
    fn put_plane(&mut self, plane: &Plane, back: i32) {
        let start = plane
            .start
            .wrapping_sub(plane.step_x.wrapping_mul(back as u32));
        for value in [start, plane.step_x, plane.step_y] {
            self.put(value.into(), 32);
        }
    }
}

/// Start of a band's list, in words of 16 bytes from the start of the set of lists. A list has room for 4 << `shift`
/// entries. The gap between two lists is as long as a row of a memory bank, so that the lists of neighbouring bands are
/// in different banks.
pub const fn list_word(band: u32, shift: u32) -> u32 {
    LIST_TABLE_WORDS + (band << shift) + LIST_GAP_WORDS * band
}

/// Number of lines of a band in a picture of this width, which is one of [`SIZES`](crate::SIZES).
pub const fn band_rows(width: u32) -> u32 {
    size(width).band_lines()
}

const fn size(width: u32) -> Size {
    let [small, medium, large] = Size::ALL;
    if width == small.width() {
        small
    } else if width == medium.width() {
        medium
    } else {
        large
    }
}

/// Number of 32-bit words of the table of list lengths, which is at the start of a set of lists.
pub const LENGTHS: usize = 4 * LIST_TABLE_WORDS as usize;

/// The `shift` of [`list_word`] for a picture of this width: the largest value for which the lists of all bands fit `words` 32-bit
/// words, with the table of their lengths. At least 2^15 words are required.
pub const fn list_shift(width: u32, words: usize) -> u32 {
    let room = (words / 4) as u32 - LIST_TABLE_WORDS;
    (room / size(width).bands() - LIST_GAP_WORDS).ilog2()
}

/// Lengths of band lists and number of descriptors that a [`ListWriter`] has written.
#[derive(Clone, Debug)]
pub struct ListCounts {
    lengths: [u32; LENGTHS],
    descriptors: u32,
    is_full: bool,
}

impl ListCounts {
    /// Empty lists.
    pub const EMPTY: Self = Self {
        lengths: [0; LENGTHS],
        descriptors: 0,
        is_full: false,
    };

    /// Length of each list.
    pub const fn lengths(&self) -> &[u32; LENGTHS] {
        &self.lengths
    }

    /// Number of descriptors.
    pub const fn descriptors(&self) -> u32 {
        self.descriptors
    }

    /// Whether a descriptor or an entry of a list had no room.
    pub const fn is_full(&self) -> bool {
        self.is_full
    }

    /// The counts of a set of `descriptors` descriptors and its lists, which a geometry pass has written.
    pub fn of(lists: &[u32], descriptors: u32) -> Self {
        Self {
            lengths: lists.first_chunk().copied().unwrap_or([0; LENGTHS]),
            descriptors,
            is_full: lists.len() < LENGTHS,
        }
    }
}

/// Writes descriptors and band lists in the format of the geometry pass.
pub struct ListWriter<'a> {
    descriptors: &'a mut [u32],
    lists: &'a mut [u32],
    counts: &'a mut ListCounts,
    band_rows: u32,
    list_shift: u32,
    capability: Shading,
}

/// Error: no room for a descriptor or a list entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Full;

impl<'a> ListWriter<'a> {
    /// Continues a set of descriptors and band lists in two regions of memory, of which `counts` are written, for a picture of this
    /// width and gateware whose best shading is `capability`. A list has room for 4 << `list_shift` entries.
    pub const fn new(
        descriptors: &'a mut [u32],
        lists: &'a mut [u32],
        counts: &'a mut ListCounts,
        width: u32,
        list_shift: u32,
        capability: Shading,
    ) -> Self {
        Self {
            descriptors,
            lists,
            counts,
            band_rows: band_rows(width),
            list_shift,
            capability,
        }
    }

    /// Appends a triangle to the lists of all bands within its bounds; `colour` is its colour under flat shading.
    pub fn put(&mut self, setup: &Setup, colour: Rgb565) {
        // The bounds are in the picture and not empty.
        let (top, bottom) = (setup.bounds.top as u32, setup.bounds.bottom as u32);
        let bands = top / self.band_rows..=(bottom - 1) / self.band_rows;
        self.append(&Descriptor::new(setup, colour), bands);
    }

    /// Appends a piece of a line to the list of its band.
    pub fn put_piece(&mut self, piece: &Piece) {
        // The first pixel is in the picture.
        let band = piece.first()[1] as u32 / self.band_rows;
        self.append(&Descriptor::of_piece(piece), band..=band);
    }

    #[inline(always)]
    fn append(&mut self, descriptor: &Descriptor, bands: RangeInclusive<u32>) {
        let words = descriptor.words(self.capability);
        let counts = &mut *self.counts;
        let at = counts.descriptors as usize * words.len();
        let Some(to) = self.descriptors.get_mut(at..at + words.len()) else {
            counts.is_full = true;
            return;
        };
        to.copy_from_slice(words);
        let shift = self.list_shift;
        for band in bands {
            let Some(length) = counts.lengths.get_mut(band as usize) else {
                continue;
            };
            let at = 4 * list_word(band, shift) as usize + *length as usize;
            match self.lists.get_mut(at) {
                Some(entry) if *length < 4 << shift => {
                    *entry = counts.descriptors;
                    *length += 1;
                }
                _ => counts.is_full = true,
            }
        }
        counts.descriptors += 1;
    }

    /// Writes the table of lengths and returns the number of descriptors in the set.
    ///
    /// # Errors
    /// [`Full`] if a region of memory was too small.
    pub fn finish(self) -> Result<u32, Full> {
        match self.lists.first_chunk_mut() {
            Some(table) if !self.counts.is_full => {
                *table = self.counts.lengths;
                Ok(self.counts.descriptors)
            }
            _ => Err(Full),
        }
    }
}

#[cfg(test)]
mod tests {
    use glint_core::picture::Size;

    use super::{list_shift, list_word};

    #[test]
    fn the_lists_of_all_bands_fit_a_set() {
        for (size, words, shift) in [
            (Size::W320, 1 << 20, 15),
            (Size::W640, 1 << 20, 14),
            (Size::W1280, 1 << 20, 12),
            (Size::W320, 1 << 18, 13),
            (Size::W640, 1 << 18, 12),
            (Size::W1280, 1 << 15, 3),
        ] {
            assert_eq!(list_shift(size.width(), words), shift, "{size}, {words}");
            assert!(4 * list_word(size.bands(), shift) as usize <= words);
            assert!(4 * list_word(size.bands(), shift + 1) as usize > words);
        }
    }
}
