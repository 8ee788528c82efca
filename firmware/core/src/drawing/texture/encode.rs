//! Encoding of textures, for hosts with a heap.

use alloc::vec::Vec;

use super::{
    BLOCK_BYTES, Blend, Format, MAGIC, SIDES_LOG2, Sampler, Texture, TextureHeader, checksum,
    texel_bit,
};
use crate::colour::Rgb565;
use crate::deviation::Deviation;

/// The contents of a texture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Source {
    /// The format of the texels.
    pub format: Format,
    /// Base-2 logarithms of width and height.
    pub size_log2: [u8; 2],
    /// The rules by which the texture is sampled.
    pub sampler: Sampler,
    /// The value of a transparent texel.
    pub key: Option<u16>,
    /// How the texture is blended with the picture behind it.
    pub blend: Blend,
    /// The colours of a palette. Missing colours are black; surplus colours are left out.
    pub palette: Vec<Rgb565>,
    /// The values of the texels of each mip level, row after row. Missing texels are 0.
    pub levels: Vec<Vec<u16>>,
}

/// Encodes a texture.
///
/// # Errors
/// A size, the key or the number of levels is out of range: [`Texture::new_checked`] rejects it.
pub fn encode(source: &Source) -> Result<Vec<u8>, Deviation> {
    let (format, [width_log2, height_log2]) = (source.format, source.size_log2);
    let Sampler { wrap, filter } = source.sampler;
    let header = TextureHeader {
        magic: MAGIC,
        width_log2,
        height_log2,
        levels: source.levels.len().try_into().unwrap_or(u8::MAX),
        format: format as u8,
        wrap: wrap.map(|wrap| wrap as u8),
        filter: filter as u8,
        cut_out: source.key.is_some().into(),
        key: source.key.unwrap_or(0),
        blend: source.blend.number(),
        ..TextureHeader::default()
    };
    let mut body = Vec::new();
    for index in 0..format.colours() {
        let Rgb565(colour) = source.palette.get(index).copied().unwrap_or_default();
        body.extend(colour.to_le_bytes());
    }
    let has_size = source
        .size_log2
        .iter()
        .all(|side| SIDES_LOG2.contains(side));
    // The check at the end rejects other sizes.
    for (level, texels) in (0_u8..).zip(&source.levels).take_while(|_| has_size) {
        let size = source.size_log2.map(|side| side.saturating_sub(level));
        blocks(format, size, texels, &mut body);
    }
    let length = TextureHeader::BYTES + body.len();
    let mut bytes = TextureHeader {
        length: length as u32,
        ..header
    }
    .to_bytes()
    .to_vec();
    bytes.extend(body);
    let sum = checksum(&bytes).to_le_bytes();
    bytes[TextureHeader::CHECKSUM].copy_from_slice(&sum);
    Texture::new_checked(&bytes)?;
    Ok(bytes)
}

/// Adds the blocks of a level.
fn blocks(format: Format, size_log2: [u8; 2], texels: &[u16], body: &mut Vec<u8>) {
    let [width, height] = size_log2.map(|side| 1_u32 << side);
    let [block_width, block_height] = format.block_log2().map(|side| 1_u32 << side);
    for top in (0..height).step_by(block_height as usize) {
        for left in (0..width).step_by(block_width as usize) {
            let mut block = [0_u8; BLOCK_BYTES];
            for y in top..height.min(top + block_height) {
                for x in left..width.min(left + block_width) {
                    let value = texels.get((y * width + x) as usize).copied().unwrap_or(0);
                    let bit = texel_bit(format, [x, y]);
                    let bits = u32::from(value) & ((1 << format.bits()) - 1);
                    let bits = bits << (bit % 8);
                    for (byte, part) in block[bit / 8..].iter_mut().zip(bits.to_le_bytes()) {
                        *byte |= part;
                    }
                }
            }
            body.extend(block);
        }
    }
}
