//! Pictures of PNG and JPEG files in memory, and PNG files of pictures.

use crate::error::PictureError;
use image::codecs::png::PngEncoder;
use image::error::LimitErrorKind;
use image::{
    DynamicImage, ExtendedColorType, ImageDecoder, ImageEncoder, ImageError, ImageFormat,
    ImageReader, Limits,
};
use std::io::Cursor;

/// Largest width and height of a picture in texels.
pub const MAX_SIDE: u32 = 8192;
/// Maximum size of a decoded picture in bytes.
pub const MAX_BYTES: u64 = 256 << 20;
/// Maximum number of characters of a decoder's message in an error.
const MAX_MESSAGE: usize = 200;

/// A picture in memory, with 8 bits per channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width and height, at least 1.
    pub size: [u32; 2],
    /// Red, green, blue (sRGB) and opacity of each texel, 0 to 255, row after row from the top left.
    pub texels: Vec<[u8; 4]>,
}

impl Picture {
    /// A picture whose texels `texel` computes from column and row.
    pub fn drawn(size: [u32; 2], texel: impl Fn(u32, u32) -> [u8; 4]) -> Self {
        let [width, height] = size;
        let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let texels = places.map(|[x, y]| texel(x, y)).collect();
        Self { size, texels }
    }

    /// Decodes a PNG or JPEG file; the content determines the format. An animation gives its first
    /// frame.
    ///
    /// # Errors
    /// The file is neither PNG nor JPEG, is damaged, or exceeds [`MAX_SIDE`] or [`MAX_BYTES`].
    /// Sides and size are checked before memory for the picture is allocated.
    pub fn decode(file: &[u8]) -> Result<Self, PictureError> {
        let format = match image::guess_format(file) {
            Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
            _ => return Err(PictureError::new("a PNG or JPEG file", start_of(file))),
        };
        let name = match format {
            ImageFormat::Png => "PNG",
            _ => "JPEG",
        };
        let refuse = |error: ImageError| refused(name, &error);
        let mut limits = Limits::no_limits();
        limits.max_image_width = Some(MAX_SIDE);
        limits.max_image_height = Some(MAX_SIDE);
        limits.max_alloc = Some(MAX_BYTES);
        let mut reader = ImageReader::with_format(Cursor::new(file), format);
        reader.limits(limits);
        let decoder = reader.into_decoder().map_err(refuse)?;
        let (width, height) = decoder.dimensions();
        if width == 0 || height == 0 {
            let found = format!("{width}×{height}");
            return Err(PictureError::new("a picture of at least 1×1", found));
        }
        let bytes = decoder.total_bytes();
        if bytes > MAX_BYTES {
            let expected = format!("a picture of at most {MAX_BYTES} bytes");
            let found = format!("{width}×{height}, {bytes} bytes");
            return Err(PictureError::new(expected, found));
        }
        let decoded = DynamicImage::from_decoder(decoder).map_err(refuse)?;
        let texels = decoded.into_rgba8().into_raw();
        Ok(Self {
            size: [width, height],
            texels: texels.as_chunks().0.to_vec(),
        })
    }

    /// The picture as a PNG file.
    ///
    /// # Errors
    /// The number of texels does not match the size.
    pub fn png(&self) -> Result<Vec<u8>, PictureError> {
        let [width, height] = self.size;
        let mut file = Vec::new();
        let encoder = PngEncoder::new(&mut file);
        let texels = self.texels.as_flattened();
        if texels.len() as u64 != 4 * u64::from(width) * u64::from(height) {
            let expected = format!("{width}×{height} texels");
            return Err(PictureError::new(expected, self.texels.len().to_string()));
        }
        encoder
            .write_image(texels, width, height, ExtendedColorType::Rgba8)
            .map_err(|error| refused("PNG", &error))?;
        Ok(file)
    }
}

/// The first bytes of a file, for a message.
fn start_of(file: &[u8]) -> String {
    const SHOWN: usize = 8;
    match file.get(..SHOWN) {
        None if file.is_empty() => "an empty file".into(),
        None => format!("'{}'", file.escape_ascii()),
        Some(start) => format!("'{}…'", start.escape_ascii()),
    }
}

/// Converts an error of a decoder.
fn refused(format: &str, error: &ImageError) -> PictureError {
    match error {
        ImageError::Limits(limit) if limit.kind() == LimitErrorKind::DimensionError => {
            let expected = format!("a picture of at most {MAX_SIDE}×{MAX_SIDE}");
            PictureError::new(expected, "a larger one")
        }
        ImageError::Limits(_) => {
            let expected = format!("a picture of at most {MAX_BYTES} bytes");
            PictureError::new(expected, "a larger one")
        }
        _ => {
            let message = error.to_string();
            let message = message.chars().take(MAX_MESSAGE);
            let message = message.map(|c| if c.is_control() { ' ' } else { c });
            PictureError::new(
                format!("a {format} file without damage"),
                message.collect::<String>(),
            )
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::example::repair_png;
    use image::codecs::jpeg::JpegEncoder;

    fn small() -> Picture {
        Picture {
            size: [3, 2],
            texels: (0..6).map(|i| [40 * i, 255 - 40 * i, 7, 51 * i]).collect(),
        }
    }

    fn error(file: &[u8]) -> String {
        Picture::decode(file).unwrap_err().to_string()
    }

    /// A PNG with this size in its header, and the data of a small one.
    fn with_size(size: [u32; 2]) -> Vec<u8> {
        let mut file = small().png().unwrap();
        file[16..20].copy_from_slice(&size[0].to_be_bytes());
        file[20..24].copy_from_slice(&size[1].to_be_bytes());
        repair_png(&mut file);
        file
    }

    #[test]
    fn png_and_jpeg() {
        let picture = small();
        let file = picture.png().unwrap();
        assert_eq!(Picture::decode(&file).unwrap(), picture);
        assert_eq!(with_size([3, 2]), file);
        let mut jpeg = Vec::new();
        let grey = [200_u8; 3 * 16 * 8];
        let written =
            JpegEncoder::new(&mut jpeg).write_image(&grey, 16, 8, ExtendedColorType::Rgb8);
        written.unwrap();
        let decoded = Picture::decode(&jpeg).unwrap();
        assert_eq!(decoded.size, [16, 8]);
        let mut texels = decoded.texels.iter();
        assert!(texels.all(|&[r, .., a]| r.abs_diff(200) <= 1 && a == 255));
    }

    #[test]
    fn files_of_other_types() {
        for (file, found) in [
            (&b""[..], "an empty file"),
            (b"GIF89a", "'GIF89a'"),
            (b"\0\x01 a long text", "'\\x00\\x01 a lon…'"),
        ] {
            let expected = format!("expected a PNG or JPEG file, found {found}");
            assert_eq!(error(file), expected);
        }
    }

    #[test]
    fn damaged_files() {
        let file = small().png().unwrap();
        for length in 8..file.len() - 12 {
            let message = error(&file[..length]);
            let expected = "expected a PNG file without damage, found ";
            assert!(message.starts_with(expected), "{length}: {message}");
        }
        let message = error(b"\xff\xd8\xff\xe0");
        let expected = "expected a JPEG file without damage, found ";
        assert!(message.starts_with(expected), "{message}");
    }

    #[test]
    fn bombs_of_pixels_take_no_memory() {
        for size in [[8193, 1], [1, 8193], [u32::MAX >> 1, u32::MAX >> 1]] {
            let expected = "expected a picture of at most 8192×8192, found a larger one";
            assert_eq!(error(&with_size(size)), expected, "{size:?}");
        }
        // With 16 bits per channel the picture has 512 MiB.
        let mut file = with_size([8192, 8192]);
        file[24] = 16;
        repair_png(&mut file);
        let expected =
            "expected a picture of at most 268435456 bytes, found 8192×8192, 536870912 bytes";
        assert_eq!(error(&file), expected);
        for size in [[0, 0], [0, 1], [1, 0]] {
            let message = error(&with_size(size));
            assert!(message.starts_with("expected a P"), "{message}");
        }
    }

    #[test]
    fn a_picture_with_missing_texels_is_no_file() {
        let mut picture = small();
        picture.texels.pop();
        let error = picture.png().unwrap_err().to_string();
        assert_eq!(error, "expected 3×2 texels, found 5");
    }
}
