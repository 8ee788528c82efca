//! Textures in memory (docs/formats/texture.md): a header, a palette, and mip levels in blocks.
//!
//! [`Texture::new_checked`] checks the bytes of a texture once, and returns a view whose accessors do not fail.

mod blend;
mod draw;
#[cfg(feature = "alloc")]
mod encode;

use core::ops::{Range, RangeInclusive};

use crate::colour::Rgb565;
use crate::deviation::Expected::{AtMost, Exactly, Magic, OneOr, Within};
use crate::deviation::{self, Deviation, Expected};
pub use crate::records::TextureHeader;
use crate::records::WORD;
use crate::wire::crc_32_without;
pub use blend::{Blend, Eighths};
pub use draw::{Picture, draw};
#[cfg(feature = "alloc")]
pub use encode::{Source, encode};

/// The first four bytes of a texture.
pub const MAGIC: [u8; 4] = *b"GLT1";
/// Base-2 logarithms of the sides that a texture may have.
pub const SIDES_LOG2: RangeInclusive<u8> = 3..=10;
/// Number of bytes of a block, the unit of texel caches.
pub const BLOCK_BYTES: usize = 2 * WORD;

/// The representation of a texel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// A colour in RGB565.
    #[default]
    Rgb565,
    /// An index into a palette of 256 colours.
    Palette256,
    /// An index into a palette of 16 colours.
    Palette16,
}

impl Format {
    /// All formats, by their numbers in the header.
    pub const ALL: [Self; 3] = [Self::Rgb565, Self::Palette256, Self::Palette16];

    /// Number of bits of a texel.
    pub const fn bits(self) -> usize {
        match self {
            Self::Rgb565 => 16,
            Self::Palette256 => 8,
            Self::Palette16 => 4,
        }
    }

    /// Number of colours of the palette; 0 for a format without a palette.
    pub const fn colours(self) -> usize {
        match self {
            Self::Rgb565 => 0,
            Self::Palette256 => 256,
            Self::Palette16 => 16,
        }
    }

    /// Base-2 logarithms of the width and height of a block in texels.
    pub const fn block_log2(self) -> [u32; 2] {
        match self {
            Self::Rgb565 => [2, 2],
            Self::Palette256 => [3, 2],
            Self::Palette16 => [3, 3],
        }
    }
}

/// Rule for texture coordinates beyond the sides of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// Repeats the texture.
    #[default]
    Repeat,
    /// Repeats the texture, mirrored every other time.
    Mirror,
    /// Clamps to the texels at the side.
    Clamp,
}

impl Wrap {
    /// All rules, by their numbers in the header.
    pub const ALL: [Self; 3] = [Self::Repeat, Self::Mirror, Self::Clamp];

    /// Maps a column or row, which may be outside of a level of 2^`side_log2` texels, to a position inside.
    pub fn place(self, place: i32, side_log2: u32) -> u32 {
        let side = 1 << side_log2;
        let inside = place & (side - 1);
        let place = match self {
            Self::Repeat => inside,
            Self::Mirror if place & side != 0 => side - 1 - inside,
            Self::Mirror => inside,
            Self::Clamp => place.clamp(0, side - 1),
        };
        place as u32
    }
}

/// Rule for the colour between texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// The colour of the nearest texel.
    #[default]
    Nearest,
    /// The average of the four nearest texels, weighted by their distances.
    Bilinear,
}

impl Filter {
    /// All filters, by their numbers in the header.
    pub const ALL: [Self; 2] = [Self::Nearest, Self::Bilinear];
}

/// The rules by which a texture is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sampler {
    /// The rule beyond the left and right sides, and the rule beyond the upper and lower sides.
    pub wrap: [Wrap; 2],
    /// The rule for the colour between texels.
    pub filter: Filter,
}

/// A checked texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texture<'a> {
    bytes: &'a [u8],
    format: Format,
    size_log2: [u32; 2],
    levels: u32,
    sampler: Sampler,
    key: Option<u16>,
    blend: Blend,
}

impl<'a> Texture<'a> {
    /// Checks the header, the lengths of palette and levels, and the reserved bytes of a texture, which may be followed by other
    /// bytes. This does not check the checksum, which protects files; [`checksum`] computes it.
    ///
    /// # Errors
    /// The first deviation from the format, with its position.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, Deviation> {
        let found = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        let short = |expected: usize| {
            deviation::Format::Texture.deviation(0, Exactly("bytes", expected as u32), found)
        };
        let record = bytes.first_chunk().ok_or(short(TextureHeader::BYTES))?;
        let header = TextureHeader::from_bytes(record);
        let magic = u32::from_le_bytes(header.magic);
        expect(TextureHeader::MAGIC, Magic(MAGIC), magic)?;
        let [least, most] = [SIDES_LOG2.start(), SIDES_LOG2.end()].map(|side| u32::from(*side));
        let side = Within("the logarithm of a side", least, most);
        let size_log2 = [header.width_log2, header.height_log2].map(u32::from);
        expect(TextureHeader::WIDTH_LOG2, side, size_log2[0])?;
        expect(TextureHeader::HEIGHT_LOG2, side, size_log2[1])?;
        let levels = u32::from(header.levels);
        let all = OneOr("mip levels", 1 + size_log2[0].max(size_log2[1]));
        expect(TextureHeader::LEVELS, all, levels)?;
        let format = one_of(
            TextureHeader::FORMAT,
            "(format)",
            header.format,
            &Format::ALL,
        )?;
        let wrap = TextureHeader::WRAP.start;
        let sampler = Sampler {
            wrap: [
                one_of(wrap..wrap + 1, "(wrap)", header.wrap[0], &Wrap::ALL)?,
                one_of(wrap + 1..wrap + 2, "(wrap)", header.wrap[1], &Wrap::ALL)?,
            ],
            filter: one_of(
                TextureHeader::FILTER,
                "(filter)",
                header.filter,
                &Filter::ALL,
            )?,
        };
        let cut_out = one_of(
            TextureHeader::CUT_OUT,
            "(cut-out)",
            header.cut_out,
            &[false, true],
        )?;
        let largest = if cut_out { (1 << format.bits()) - 1 } else { 0 };
        expect(
            TextureHeader::KEY,
            AtMost("(key)", largest),
            header.key.into(),
        )?;
        let blend = one_of(TextureHeader::BLEND, "(blend)", header.blend, &Blend::ALL)?;
        let reserved = record.get(TextureHeader::RESERVED).unwrap_or_default();
        let reserved = reserved.iter().copied().find(|&byte| byte != 0);
        let reserved = u32::from(reserved.unwrap_or(0));
        expect(TextureHeader::RESERVED, Exactly("(reserved)", 0), reserved)?;
        let texture = Self {
            bytes,
            format,
            size_log2,
            levels,
            sampler,
            key: cut_out.then_some(header.key),
            blend,
        };
        let length = texture.level_start(levels);
        expect(
            TextureHeader::LENGTH,
            Exactly("bytes", length as u32),
            header.length,
        )?;
        let bytes = bytes.get(..length).ok_or(short(length))?;
        Ok(Self { bytes, ..texture })
    }

    /// Checks a texture as [`new_checked`](Self::new_checked) does, and that no other bytes follow.
    ///
    /// # Errors
    /// The first deviation from the format, with its position.
    pub fn new_alone(bytes: &'a [u8]) -> Result<Self, Deviation> {
        let texture = Self::new_checked(bytes)?;
        let length = Exactly("bytes in all", texture.bytes.len() as u32);
        let found = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        deviation::Format::Texture.expect(0, length, found)?;
        Ok(texture)
    }

    /// All bytes of the texture, including its header.
    pub const fn bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// The format of the texels.
    pub const fn format(&self) -> Format {
        self.format
    }

    /// The rules by which the texture is sampled.
    pub const fn sampler(&self) -> Sampler {
        self.sampler
    }

    /// How the texture is blended with the picture behind it.
    pub const fn blend(&self) -> Blend {
        self.blend
    }

    /// Base-2 logarithms of width and height.
    pub const fn size_log2(&self) -> [u32; 2] {
        self.size_log2
    }

    /// Number of mip levels, at least 1.
    pub const fn levels(&self) -> u32 {
        self.levels
    }

    /// Base-2 logarithms of the width and height of a level: each is one less than in the level before, and at least 0.
    pub fn level_log2(&self, level: u32) -> [u32; 2] {
        self.size_log2.map(|side| side.saturating_sub(level))
    }

    /// Offset in bytes of a level; for the number of levels, the length of the texture.
    fn level_start(&self, level: u32) -> usize {
        let blocks: usize = (0..level).map(|level| self.blocks(level)).sum();
        TextureHeader::BYTES + 2 * self.format.colours() + BLOCK_BYTES * blocks
    }

    /// Number of blocks of a level.
    fn blocks(&self, level: u32) -> usize {
        let [across, down] = self.blocks_log2(level);
        1 << (across + down)
    }

    /// Base-2 logarithms of the numbers of blocks across and down of a level. A level that is smaller than a block takes one block.
    fn blocks_log2(&self, level: u32) -> [u32; 2] {
        let (sides, block) = (self.level_log2(level), self.format.block_log2());
        [0, 1].map(|axis: usize| sides[axis].saturating_sub(block[axis]))
    }

    /// The value of a texel of a level, a colour or an index; 0 outside of the level.
    pub fn value(&self, level: u32, [x, y]: [u32; 2]) -> u16 {
        let [width, height] = self.format.block_log2();
        let [across, _] = self.blocks_log2(level);
        let block = ((y >> height) << across) + (x >> width);
        let at = self.level_start(level) + BLOCK_BYTES * block as usize;
        let bit = texel_bit(self.format, [x, y]);
        let Some(bytes) = self.bytes.get(at + bit / 8..).and_then(<[u8]>::first_chunk) else {
            // A texel of fewer than 16 bits may be in the last byte.
            let byte = self.bytes.get(at + bit / 8).copied().unwrap_or(0);
            return texel(self.format, byte.into(), bit);
        };
        texel(self.format, u16::from_le_bytes(*bytes), bit)
    }

    /// The colour of a texel of a level; `None` if it is transparent.
    pub fn colour(&self, level: u32, place: [u32; 2]) -> Option<Rgb565> {
        let value = self.value(level, place);
        if self.key == Some(value) {
            return None;
        }
        Some(match self.format {
            Format::Rgb565 => Rgb565(value),
            Format::Palette256 | Format::Palette16 => self.palette(value),
        })
    }

    /// The colour in the palette with the number `index`.
    fn palette(&self, index: u16) -> Rgb565 {
        let at = TextureHeader::BYTES + 2 * usize::from(index);
        let colour = self.bytes.get(at..).and_then(<[u8]>::first_chunk);
        Rgb565(colour.map_or(0, |bytes| u16::from_le_bytes(*bytes)))
    }
}

/// The position of a texel's lowest bit in its block. The first 32 bits of each word have the texels of
/// even columns and even rows, the next 32 bits those of odd columns and even rows, the last 64 bits
/// those of odd rows. Therefore four neighbours are in different quarters of their words.
fn texel_bit(format: Format, [x, y]: [u32; 2]) -> usize {
    let [width, height] = format.block_log2();
    let [x, y] = [x & ((1 << width) - 1), y & ((1 << height) - 1)];
    let class = (y & 1) << 1 | x & 1;
    let number = (y >> 1) << (width - 1) | x >> 1;
    let in_class = number as usize * format.bits();
    (in_class / 32) * 128 + class as usize * 32 + in_class % 32
}

/// Extracts the texel whose lowest bit is number `bit` in memory. The lowest byte of `bits` contains
/// this bit.
const fn texel(format: Format, bits: u16, bit: usize) -> u16 {
    let value = bits >> (bit % 8);
    match format {
        Format::Rgb565 => value,
        Format::Palette256 => value & 0xFF,
        Format::Palette16 => value & 0xF,
    }
}

/// The checksum of a texture: the CRC-32 of all bytes except the checksum's own bytes.
pub fn checksum(texture: &[u8]) -> u32 {
    crc_32_without(texture, TextureHeader::CHECKSUM)
}

fn expect(field: Range<usize>, expected: Expected, found: u32) -> Result<(), Deviation> {
    deviation::Format::Texture.expect(field.start as u32, expected, found)
}

/// The value that a number in the header represents.
fn one_of<T: Copy>(
    field: Range<usize>,
    name: &'static str,
    number: u8,
    values: &[T],
) -> Result<T, Deviation> {
    let most = AtMost(name, values.len() as u32 - 1);
    let value = values.get(usize::from(number)).copied();
    let offset = field.start as u32;
    value.ok_or(deviation::Format::Texture.deviation(offset, most, number.into()))
}
