//! Descriptors and band lists, the input of the raster pass (docs/formats/triangle.md).

mod contents;

use core::ops::RangeInclusive;

use glint_core::bits::Bits;
use glint_core::colour::Rgb565;
use glint_core::constants::{self, LIST_GAP_WORDS, LIST_TABLE_WORDS};
use glint_core::picture::Size;
use glint_core::records::{
    PIECE_MARK, descriptor, piece as piece_fields, planes, stored_piece, texture_planes,
};

use crate::line::Piece;
use crate::triangle::setup::{Edge, Plane, Setup};
use crate::triangle::textured::{Axis, OfTexture};

pub use contents::Contents;

/// Number of columns of a group, which is also the number of pixels that the raster pass draws in one clock.
pub const GROUP: i32 = constants::GROUP as i32;

/// A triangle after its setup, or a piece of a line, packed into 32-bit words: first the words of a flat triangle without a texture, then
/// the texture, then the planes of light. A build of the gateware reads only the parts in its [`Layout`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Descriptor {
    words: [u32; WORDS],
}

/// Number of 32-bit words of a flat triangle without a texture.
const FLAT_WORDS: usize = descriptor::BITS / 32;
/// Number of 32-bit words of a texture, rounded up to a multiple of 16 bytes.
const TEXTURE_WORDS: usize = texture_planes::BITS.div_ceil(128) * 4;
/// Number of 32-bit words of the planes of light, rounded up to a multiple of 16 bytes.
const LIGHT_WORDS: usize = planes::BITS.div_ceil(128) * 4;
const WORDS: usize = FLAT_WORDS + TEXTURE_WORDS + LIGHT_WORDS;

/// The optional parts of a descriptor that a build of the gateware reads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Whether the gateware reads the texture.
    pub is_textured: bool,
    /// Whether the gateware reads the planes of light, for smooth shading.
    pub is_smooth: bool,
}

impl Layout {
    /// The layout without optional parts.
    pub const FLAT: Self = Self::new(false, false);
    /// The layout with the planes of light.
    pub const SMOOTH: Self = Self::new(false, true);
    /// The layout with the texture.
    pub const TEXTURED: Self = Self::new(true, false);
    /// The layout with all parts.
    pub const WHOLE: Self = Self::new(true, true);
    /// All layouts.
    pub const ALL: [Self; 4] = [Self::FLAT, Self::SMOOTH, Self::TEXTURED, Self::WHOLE];

    const fn new(is_textured: bool, is_smooth: bool) -> Self {
        Self {
            is_textured,
            is_smooth,
        }
    }

    /// Number of 32-bit words in a descriptor, a multiple of four.
    pub const fn words(self) -> usize {
        let texture = if self.is_textured { TEXTURE_WORDS } else { 0 };
        let light = if self.is_smooth { LIGHT_WORDS } else { 0 };
        FLAT_WORDS + texture + light
    }

    /// The range of each part's words in a [`Descriptor`]; empty for a part that the gateware does not read.
    fn parts(self) -> [core::ops::Range<usize>; 3] {
        let texture = FLAT_WORDS..FLAT_WORDS + TEXTURE_WORDS;
        let light = texture.end..WORDS;
        let empty = 0..0;
        [
            0..FLAT_WORDS,
            if self.is_textured {
                texture
            } else {
                empty.clone()
            },
            if self.is_smooth { light } else { empty },
        ]
    }
}

/// The fields of a plane: its start value, and its steps per pixel to the right and down.
type PlaneFields = [Bits; 3];
const DEPTH: PlaneFields = [
    descriptor::DEPTH_START,
    descriptor::DEPTH_STEP_X,
    descriptor::DEPTH_STEP_Y,
];
const fn light(channel: usize) -> PlaneFields {
    [
        in_planes(planes::LIGHT_START).element(channel),
        in_planes(planes::LIGHT_STEP_X).element(channel),
        in_planes(planes::LIGHT_STEP_Y).element(channel),
    ]
}
const SMOOTH: Bits = in_planes(planes::SMOOTH);

/// The position of a field of the light planes, which follow the texture.
const fn in_planes(field: Bits) -> Bits {
    field.from(32 * (FLAT_WORDS + TEXTURE_WORDS))
}

/// The position of a field of the texture, which follows the words of a flat triangle.
const fn in_texture(field: Bits) -> Bits {
    field.from(descriptor::BITS)
}
const fn coordinate(axis: usize) -> PlaneFields {
    [
        in_texture(texture_planes::PLANES_START).element(axis),
        in_texture(texture_planes::PLANES_STEP_X).element(axis),
        in_texture(texture_planes::PLANES_STEP_Y).element(axis),
    ]
}

/// Number of leading words of a piece that are stored at [`stored_piece::LOW`]; the remaining words are stored at [`stored_piece::HIGH`].
const LOW_WORDS: usize = 4;
/// Half a depth code, 14 fraction bits, which is added to the depth of a piece so that truncation rounds to nearest.
const HALF_A_CODE: i64 = 1 << 13;

impl Descriptor {
    /// Packs a triangle; `colour` is the triangle's colour under flat shading without a texture.
    pub fn new(setup: &Setup, colour: Rgb565, texture: Option<&OfTexture>) -> Self {
        let bounds = setup.bounds;
        // The bounds are in the picture, so they are not negative and the divisions round down.
        let group_start = setup.start_column / GROUP;
        let back = setup.start_column - GROUP * group_start;
        let mut words = [0; WORDS];
        let [first, second, third] = &setup.edges;
        put_edge(&mut words, 0, first, back);
        put_edge(&mut words, 1, second, back);
        put_edge(&mut words, 2, third, back);
        put_plane(&mut words, DEPTH, &setup.depth, back);
        let mut put = |field: Bits, value: i32| field.put(&mut words, value.into());
        put(descriptor::TOP, bounds.top);
        put(descriptor::BOTTOM, bounds.bottom);
        put(descriptor::GROUP_LEFT, bounds.left / GROUP);
        put(descriptor::GROUP_RIGHT, (bounds.right - 1) / GROUP);
        put(descriptor::GROUP_START, group_start);
        put(descriptor::COLOUR, colour.0.into());
        if let Some([red, green, blue]) = &setup.light {
            put_plane(&mut words, light(0), red, back);
            put_plane(&mut words, light(1), green, back);
            put_plane(&mut words, light(2), blue, back);
            SMOOTH.put(&mut words, 1);
        }
        if let Some(texture) = texture {
            put_texture(&mut words, texture, back);
        }
        Self { words }
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
        let mut fields = [0; piece_fields::BITS.div_ceil(32)];
        for (field, value) in [
            (piece_fields::X_MAJOR, line.x_major.into()),
            (piece_fields::LEFT, left.into()),
            (piece_fields::UP, up.into()),
            (piece_fields::COLUMN, column.into()),
            (piece_fields::ROW, row.into()),
            (piece_fields::COUNT, line.count.into()),
            (piece_fields::ERROR, (line.error + minor).into()),
            (piece_fields::MINOR, minor.into()),
            (piece_fields::FALL, (minor - major).into()),
            (piece_fields::DEPTH, line.depth + HALF_A_CODE),
            (piece_fields::DEPTH_STEP, line.depth_step),
        ] {
            field.put(&mut fields, value);
        }
        let mut words = [0; WORDS];
        for (at, count) in [
            (stored_piece::REPEATS, LOW_WORDS),
            (stored_piece::LOW, LOW_WORDS),
            (stored_piece::REPEATS_LOW, LOW_WORDS / 2),
        ] {
            let stored = words.iter_mut().skip(at.word()).zip(fields);
            stored.take(count).for_each(|(to, word)| *to = word);
        }
        let high = words.iter_mut().skip(stored_piece::HIGH.word());
        for (to, word) in high.zip(fields.into_iter().skip(LOW_WORDS)) {
            *to = word;
        }
        stored_piece::MARK.put(&mut words, PIECE_MARK as i64);
        stored_piece::COLOUR.put(&mut words, piece.colour.0.into());
        Self { words }
    }

    /// The words that a gateware with this layout reads, by part, lowest word first.
    pub fn words(&self, layout: Layout) -> [&[u32]; 3] {
        layout
            .parts()
            .map(|part| self.words.get(part).unwrap_or_default())
    }
}

/// Writes the texture of a triangle.
///
/// Not inlined, because few triangles have one.
#[inline(never)]
fn put_texture(words: &mut [u32; WORDS], texture: &OfTexture, back: i32) {
    let [across, down] = &texture.axes;
    put_axis(words, 0, across, back);
    put_axis(words, 1, down, back);
    let [red, green, blue] = texture.light;
    let light = in_texture(texture_planes::LIGHT);
    light.element(0).put(words, red.into());
    light.element(1).put(words, green.into());
    light.element(2).put(words, blue.into());
    in_texture(texture_planes::TEXTURE).put(words, texture.number.into());
    in_texture(texture_planes::LINEAR).put(words, texture.weight.is_some().into());
}

// The functions below are inlined, so that the positions of all fields are constants, and the code has no loop over fields and no shift by
// a variable.

/// Writes the coordinate of a texture along the axis with the index `number`.
#[inline(always)]
fn put_axis(words: &mut [u32; WORDS], number: usize, axis: &Axis, back: i32) {
    put_plane(words, coordinate(number), &axis.plane, back);
    let range = in_texture(texture_planes::RANGE).element(number);
    range.put(words, axis.range_log2.into());
    let periods = in_texture(texture_planes::PERIODS).element(number);
    periods.put(words, axis.periods.into());
}

/// Writes the edge with the index `number`, with the start column moved to the left by `back`.
#[inline(always)]
fn put_edge(words: &mut [u32; WORDS], number: usize, edge: &Edge, back: i32) {
    let start = edge.start - i64::from(back) * i64::from(edge.step_x);
    descriptor::START.element(number).put(words, start);
    (descriptor::STEPS_X.element(number)).put(words, edge.step_x.into());
    (descriptor::STEPS_Y.element(number)).put(words, edge.step_y.into());
}

/// Writes a plane, with the start column moved to the left by `back`.
#[inline(always)]
fn put_plane(words: &mut [u32; WORDS], fields: PlaneFields, plane: &Plane, back: i32) {
    let start = plane
        .start
        .wrapping_sub(plane.step_x.wrapping_mul(back as u32));
    let [at_start, at_step_x, at_step_y] = fields;
    at_start.put(words, start.into());
    at_step_x.put(words, plane.step_x.into());
    at_step_y.put(words, plane.step_y.into());
}

/// Start of a band's list, in 16-byte words from the start of the set of lists. A list holds up to 4 << `shift` entries. The gap between
/// two lists has the length of a row of a memory bank, so that the lists of neighbouring bands are in different banks.
pub const fn list_word(band: u32, shift: u32) -> u32 {
    LIST_TABLE_WORDS + (band << shift) + LIST_GAP_WORDS * band
}

/// Number of rows of a band in a picture of this width, one of the widths of [`SIZES`](crate::SIZES).
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

/// Number of 32-bit words of the table of list lengths at the start of a set of lists.
pub const LENGTHS: usize = 4 * LIST_TABLE_WORDS as usize;

/// The `shift` of [`list_word`] for a picture of this width: the largest value for which the table of list lengths and the lists of all
/// bands fit `words` 32-bit words. At least 2^15 words are required.
pub const fn list_shift(width: u32, words: usize) -> u32 {
    let room = (words / 4) as u32 - LIST_TABLE_WORDS;
    (room / size(width).bands() - LIST_GAP_WORDS).ilog2()
}

/// Lengths of the band lists, and number of the descriptors, that a [`ListWriter`] has written.
#[derive(Clone, Debug)]
pub struct ListCounts {
    lengths: [u32; LENGTHS],
    descriptors: u32,
    is_full: bool,
}

impl ListCounts {
    /// The counts of empty lists.
    pub const EMPTY: Self = Self {
        lengths: [0; LENGTHS],
        descriptors: 0,
        is_full: false,
    };

    /// Length of each band's list, in entries.
    pub const fn lengths(&self) -> &[u32; LENGTHS] {
        &self.lengths
    }

    /// Number of descriptors written.
    pub const fn descriptors(&self) -> u32 {
        self.descriptors
    }

    /// Whether the memory for descriptors or for a list was too small.
    pub const fn is_full(&self) -> bool {
        self.is_full
    }

    /// The counts of a set of `lists` and of `descriptors` descriptors that a geometry pass has written.
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
    layout: Layout,
}

/// Error: the memory for descriptors or for a list is full.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Full;

impl<'a> ListWriter<'a> {
    /// A writer that appends to a set of descriptors and band lists in two regions of memory, for a picture of this width and gateware with
    /// this layout. `counts` has the numbers of descriptors and entries written so far. A list holds up to 4 << `list_shift` entries.
    pub const fn new(
        descriptors: &'a mut [u32],
        lists: &'a mut [u32],
        counts: &'a mut ListCounts,
        width: u32,
        list_shift: u32,
        layout: Layout,
    ) -> Self {
        Self {
            descriptors,
            lists,
            counts,
            band_rows: band_rows(width),
            list_shift,
            layout,
        }
    }

    /// Appends a triangle to the lists of all bands that its bounds touch; `colour` and `texture` as for [`Descriptor::new`].
    pub fn put(&mut self, setup: &Setup, colour: Rgb565, texture: Option<&OfTexture>) {
        // The bounds are in the picture and not empty.
        let (top, bottom) = (setup.bounds.top as u32, setup.bounds.bottom as u32);
        let bands = top / self.band_rows..=(bottom - 1) / self.band_rows;
        self.append(&Descriptor::new(setup, colour, texture), bands);
    }

    /// Appends a piece of a line to the list of its band.
    pub fn put_piece(&mut self, piece: &Piece) {
        // The first pixel is in the picture.
        let band = piece.first()[1] as u32 / self.band_rows;
        self.append(&Descriptor::of_piece(piece), band..=band);
    }

    #[inline(always)]
    fn append(&mut self, descriptor: &Descriptor, bands: RangeInclusive<u32>) {
        let words = self.layout.words();
        let counts = &mut *self.counts;
        let at = counts.descriptors as usize * words;
        let Some(mut to) = self.descriptors.get_mut(at..at + words) else {
            counts.is_full = true;
            return;
        };
        for part in descriptor.words(self.layout) {
            // The lengths of all parts add up to the length of the descriptor.
            let Some((first, rest)) = to.split_at_mut_checked(part.len()) else {
                break;
            };
            first.copy_from_slice(part);
            to = rest;
        }
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

    /// Writes the table of list lengths, and returns the number of descriptors in the set.
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
