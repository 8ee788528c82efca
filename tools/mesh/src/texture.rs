//! Texture files: pictures, and textures in a board's memory layout.

use crate::convert::TextureOptions;
use crate::error::{FormatError, InputError};
use crate::formats::read_file;
use glint_core::texture::{Filter, MAGIC, Sampler, Texture, TextureHeader, Wrap, checksum};
use glint_texture::convert::{Report, again, convert};
use glint_texture::error::PictureError;
use glint_texture::options::Options;
use glint_texture::picture::Picture;
use std::path::Path;

/// Extensions of texture files.
const EXTENSIONS: [&str; 4] = ["glt", "png", "jpg", "jpeg"];
/// Opacity below which the texels of a picture are transparent, if no other is requested.
pub const CUTOFF: f32 = 0.5;

/// Whether a file's name has the extension of a texture file.
pub fn is_texture(name: &str) -> bool {
    let extension = Path::new(name).extension();
    extension.is_some_and(|extension| {
        EXTENSIONS
            .iter()
            .any(|one| extension.eq_ignore_ascii_case(one))
    })
}

/// Reads a texture file, and converts it to a texture in a board's memory layout.
///
/// # Errors
/// The file cannot be read, or [`of_bytes`] rejects it.
pub fn load(path: &Path, options: &TextureOptions) -> Result<(Vec<u8>, Report), InputError> {
    let file = read_file(path)?;
    of_bytes(&file, options, None, CUTOFF).map_err(|error| error.in_path(path))
}

/// Converts a PNG or JPEG file, or a texture in a board's memory layout, by its contents. A texture remains unchanged unless the options
/// change it. Without `wrap` a texture keeps its wrap modes, and a picture repeats. Texels of a picture with an opacity below `cutoff` are
/// transparent.
///
/// # Errors
/// The file violates its format.
pub fn of_bytes(
    file: &[u8],
    options: &TextureOptions,
    wrap: Option<[Wrap; 2]>,
    cutoff: f32,
) -> Result<(Vec<u8>, Report), FormatError> {
    let sampler = |of_file: Sampler| Sampler {
        wrap: wrap.unwrap_or(of_file.wrap),
        filter: options.filter.unwrap_or(of_file.filter),
    };
    let side = options.largest_side;
    if file.starts_with(&MAGIC) {
        let texture = checked(file)?;
        let sampler = sampler(texture.sampler());
        return again(&texture, options.format, side, sampler, options.blend).map_err(of_picture);
    }
    let picture = Picture::decode(file).map_err(of_picture)?;
    let options = Options {
        format: options.format.unwrap_or_default(),
        largest_side: side,
        sampler: sampler(Sampler {
            filter: Filter::Bilinear,
            ..Sampler::default()
        }),
        cutoff: Some(cutoff),
        blend: options.blend.unwrap_or_default(),
    };
    convert(&picture, &options).map_err(of_picture)
}

/// Checks a texture in a board's memory layout, with its checksum.
///
/// # Errors
/// The bytes are not a texture, or its checksum is wrong.
pub fn checked(file: &[u8]) -> Result<Texture<'_>, FormatError> {
    let texture = Texture::new_alone(file)
        .map_err(|error| FormatError::whole("a valid texture", error.to_string()))?;
    let stated = file.get(TextureHeader::CHECKSUM);
    let stated = stated.and_then(|bytes| bytes.try_into().ok());
    let (stated, needed) = (stated.map_or(0, u32::from_le_bytes), checksum(file));
    if stated != needed {
        let expected = format!("the CRC-32 {needed:08x} of the other bytes");
        let found = format!("{stated:08x}: the file is damaged");
        return Err(FormatError::whole(expected, found));
    }
    Ok(texture)
}

/// The error of an image file as an error in an input.
pub fn of_picture(error: PictureError) -> FormatError {
    FormatError::whole(error.expected, error.found)
}
