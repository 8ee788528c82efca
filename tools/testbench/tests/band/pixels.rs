//! Model of the band buffer: pixel groups, bands, and the expected words of the flush of a band.

use glint_core::colour::{Rgb565, Rounding};
use glint_core::stereo::Tint;
use std::ops::Range;

pub const LANES: usize = 8;
pub const ROWS_OF_A_BANK: u64 = 2048;
/// Largest number of words in flight to memory: the depth of the band buffer's FIFO.
pub const WORDS: usize = 16;
pub const PICTURE_LINES: usize = 720;

/// Operation of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Writes the lanes that pass the depth test.
    Plain,
    /// A query: returns the lanes that pass the depth test, and writes nothing.
    Asks,
    /// Writes the colours of all lanes of the mask, and keeps their depths.
    Blended,
}

#[derive(Clone, Debug)]
pub struct Group {
    pub kind: Kind,
    pub row: usize,
    pub mask: u8,
    /// Eyes for which the group is drawn: 1 left, 2 right, 3 both.
    pub halves: u8,
    pub codes: [u32; LANES],
    pub colours: [u16; LANES],
}

#[derive(Clone, Copy, Debug)]
pub struct Band {
    pub base: u32,
    pub depth_base: u32,
    pub lines: usize,
    pub stride: usize,
    pub first_line: usize,
    pub slot: usize,
    pub whole: bool,
    pub with_depth: bool,
    pub clear: u16,
    /// Whether a sky replaces the clear colour.
    pub sky: bool,
    /// How the sky is rounded.
    pub rounding: Rounding,
    /// Composition of colours from the luminances of two eyes: 0 for none, 1 with the tint red and blue, 2 with the tint red and cyan.
    pub compose: u8,
}

impl Band {
    /// The colour of the sky in a row of the band buffer, different in each row, and the two lowest bits of the row's picture line.
    pub fn sky_of(&self, row: usize) -> ([u8; 3], u32) {
        let colour = [29, 83, 151].map(|step| (step * row + usize::from(self.clear)) as u8);
        (colour, (row / self.stride % 4) as u32)
    }

    /// The colour of a pixel that no group has drawn: the clear colour, or the sky's colour.
    fn background(&self, row: usize, lane: usize) -> u16 {
        let (colour, line) = self.sky_of(row);
        match self.sky {
            true => {
                let colour = Rgb565::with_fractions(colour);
                Rgb565::rounded(colour, self.rounding, [lane as u32, line]).0
            }
            false => self.clear,
        }
    }

    /// Lines of the picture that the band covers.
    pub fn picture_lines(&self) -> Range<usize> {
        self.first_line..self.first_line + self.lines
    }
}

pub type Word = (u32, [u32; 4]);

/// For each frame buffer and each line of the picture: the range of drawn group columns at the line's last flush; `None` if unknown.
pub type Left = [Vec<Option<Range<usize>>>; 2];

/// Depth and colour of a band's drawn pixels, by row of the band buffer.
pub struct Pixels(pub Vec<[Option<(u32, u16)>; LANES]>);

impl Pixels {
    pub fn clear() -> Self {
        Self(vec![[None; LANES]; ROWS_OF_A_BANK as usize])
    }

    /// Draws a group. Returns the lanes that pass the depth test.
    pub fn draw(&mut self, group: &Group) -> u8 {
        let mut passing = 0;
        for lane in (0..LANES).filter(|lane| group.mask >> lane & 1 == 1) {
            let pixel = &mut self.0[group.row][lane];
            let (code, colour) = (group.codes[lane], group.colours[lane]);
            let before = pixel.map_or(0, |(code, _)| code);
            passing |= u8::from(code >= before) << lane;
            let seen = pixel.map_or(0, |(_, colour)| colour);
            match (group.kind, group.halves) {
                (Kind::Asks, _) => {}
                (Kind::Blended, _) => *pixel = Some((before, colour)),
                (Kind::Plain, 1) => *pixel = Some((code, seen & 0xff00 | colour & 0x00ff)),
                (Kind::Plain, 2) => *pixel = Some((before, seen & 0x00ff | colour & 0xff00)),
                (Kind::Plain, _) if code >= before => *pixel = Some((code, colour)),
                (Kind::Plain, _) => {}
            }
        }
        passing
    }

    /// Returns the expected words of the flush of a band, in order, and updates `left`.
    pub fn words(&self, band: &Band, left: &mut Left) -> Vec<Word> {
        let mut words = Vec::new();
        for (line, picture_line) in band.picture_lines().enumerate() {
            let rows = line * band.stride..(line + 1) * band.stride;
            let drawn = |row: &usize| self.0[*row].iter().any(Option::is_some);
            let now = match (rows.clone().find(drawn), rows.clone().rfind(drawn)) {
                (Some(first), Some(last)) => first - rows.start..last + 1 - rows.start,
                _ => 0..0,
            };
            let before = left[band.slot][picture_line].replace(now.clone());
            let both = if band.whole || band.with_depth {
                0..band.stride
            } else {
                match before.expect("a line of unknown content is flushed whole") {
                    before if before.is_empty() => now,
                    before if now.is_empty() => before,
                    before => now.start.min(before.start)..now.end.max(before.end),
                }
            };
            let span = both.map(|column| rows.start + column);
            words.extend(span.clone().map(|row| self.colours(row, band)));
            if band.with_depth {
                words.extend(span.flat_map(|row| self.depths(row, band)));
            }
        }
        words
    }

    pub fn colours(&self, row: usize, band: &Band) -> Word {
        let seen = |(_, colour): (u32, u16)| {
            let [left, right] = colour.to_le_bytes();
            match band.compose {
                0 => colour,
                1 => Tint::RedBlue.compose(left, right),
                _ => Tint::RedCyan.compose(left, right),
            }
        };
        let pixels = self.0[row];
        let colour: [u32; LANES] = std::array::from_fn(|lane| {
            pixels[lane].map_or(band.background(row, lane), seen).into()
        });
        let pairs = [0, 1, 2, 3].map(|i| colour[2 * i] | colour[2 * i + 1] << 16);
        (band.base + row as u32, pairs)
    }

    pub fn depths(&self, row: usize, band: &Band) -> [Word; 2] {
        let codes = self.0[row].map(|pixel| pixel.map_or(0, |(code, _)| code));
        let (halves, base) = (codes.as_chunks::<4>().0, band.depth_base + 2 * row as u32);
        [(base, halves[0]), (base + 1, halves[1])]
    }
}
