//! Textures that the firmware draws, without a heap.

use super::{Blend, Filter, Format, MAGIC, Texture, TextureHeader, texel_bit};
use crate::colour::Rgb565;

/// Number of texels in a block.
const BLOCK: usize = 16;

/// Value of a transparent texel: a blue that is almost black.
const KEY: u16 = 1;

/// A texture that is drawn by a function.
#[derive(Clone, Copy, Debug)]
pub struct Picture {
    /// Base-2 logarithms of width and height.
    pub size_log2: [u8; 2],
    /// Whether some texels are transparent.
    pub is_cut_out: bool,
    /// Whether rectangles show parts of the texture. If so, the texture has one level and is sampled at the nearest texel. Otherwise it has
    /// all mip levels and is sampled bilinearly.
    pub is_atlas: bool,
    /// How the texture is blended with the picture behind it.
    pub blend: Blend,
    /// Returns the colour of a texel of the largest level; `None` if it is transparent.
    pub texel: fn([u32; 2]) -> Option<Rgb565>,
}

/// Writes a texture in RGB565, which is repeated. Texels of smaller levels are averages. Returns the length in bytes; `None` if `memory` is
/// too short.
pub fn draw(memory: &mut [u8], picture: &Picture) -> Option<usize> {
    let [width_log2, height_log2] = picture.size_log2;
    let (levels, filter) = if picture.is_atlas {
        (1, Filter::Nearest)
    } else {
        (1 + u32::from(width_log2.max(height_log2)), Filter::Bilinear)
    };
    let layout = Texture {
        bytes: &[],
        format: Format::Rgb565,
        size_log2: picture.size_log2.map(u32::from),
        levels,
        sampler: Default::default(),
        key: None,
        blend: Default::default(),
    };
    let length = layout.level_start(levels);
    let memory = memory.get_mut(..length)?;
    let header = TextureHeader {
        magic: MAGIC,
        length: length as u32,
        width_log2,
        height_log2,
        levels: levels as u8,
        format: Format::Rgb565 as u8,
        filter: filter as u8,
        cut_out: picture.is_cut_out.into(),
        key: if picture.is_cut_out { KEY } else { 0 },
        blend: picture.blend.number(),
        ..TextureHeader::default()
    };
    let (head, body) = memory.split_first_chunk_mut()?;
    *head = header.to_bytes();
    body.fill(0);
    let (texels, _) = body.as_chunks_mut::<2>();
    let key = picture.is_cut_out.then_some(KEY);
    let mut start = 0;
    let mut larger = None;
    for level in 0..levels {
        let [across, _] = layout.blocks_log2(level);
        let here = Level { start, across };
        let [width, height] = layout.level_log2(level).map(|side| 1 << side);
        for y in 0..height {
            for x in 0..width {
                let colour = match larger {
                    None => (picture.texel)([x, y]).map_or(KEY, |Rgb565(colour)| colour),
                    Some(larger) => average(texels, larger, [x, y], key),
                };
                *texels.get_mut(here.index([x, y]))? = colour.to_le_bytes();
            }
        }
        start += BLOCK * layout.blocks(level);
        larger = Some((here, [width, height]));
    }
    Some(length)
}

/// The position of a level in memory.
#[derive(Clone, Copy)]
struct Level {
    /// Number of texels before the level.
    start: usize,
    /// Base-2 logarithm of the number of blocks across.
    across: u32,
}

impl Level {
    /// Index of a texel in memory.
    fn index(self, [x, y]: [u32; 2]) -> usize {
        let block = ((y >> 2) << self.across) + (x >> 2);
        self.start + BLOCK * block as usize + texel_bit(Format::Rgb565, [x, y]) / 16
    }
}

/// The average of the opaque texels among the four texels of a level that a texel of the next level covers. Transparent texels have the
/// value `key`; the result is transparent if at least three texels are. In a level of one row or column, each of two texels counts twice.
fn average(
    texels: &[[u8; 2]],
    (level, size): (Level, [u32; 2]),
    [x, y]: [u32; 2],
    key: Option<u16>,
) -> u16 {
    let (mut sums, mut count) = ([0; 3], 0);
    for corner in 0..4 {
        let place = [2 * x + (corner & 1), 2 * y + (corner >> 1)];
        let place = [0, 1].map(|axis: usize| place[axis].min(size[axis] - 1));
        let texel = texels.get(level.index(place)).copied();
        let colour = u16::from_le_bytes(texel.unwrap_or_default());
        if Some(colour) == key {
            continue;
        }
        let [r, g, b] = [colour >> 11, colour >> 5 & 63, colour & 31];
        sums = [sums[0] + r, sums[1] + g, sums[2] + b];
        count += 1;
    }
    if count < 2 {
        return KEY;
    }
    let [r, g, b] = sums.map(|sum| (sum + count / 2) / count);
    r << 11 | g << 5 | b
}
