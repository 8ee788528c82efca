//! Drawn frames in memory and in files.

use glint_core::mesh::Rgb565;
use glint_core::picture::Size;
use glint_model::DepthScale;
use std::io::{self, Write};
use virtual_board::Picture;

/// Speed of the search for the colours of a GIF, 1 (best) to 30.
const QUANTISER_SPEED: i32 = 10;

/// Colours and depth codes of a drawn frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// RGB565, row by row from the top left.
    pub colour: Vec<u16>,
    /// Depth codes in the same order as the colours; empty unless requested.
    pub depth: Vec<u32>,
}

impl Image {
    /// Creates an image of the given size with empty lists of colours and depth codes.
    pub const fn empty(size: Size) -> Self {
        Self {
            width: size.width(),
            height: size.height(),
            colour: Vec::new(),
            depth: Vec::new(),
        }
    }

    /// Converts the colours to 8 bits a channel by bit replication, like the gateware's video output.
    pub fn picture(&self) -> Picture {
        let rgb = self
            .colour
            .iter()
            .flat_map(|&colour| Rgb565(colour).to_rgb888())
            .collect();
        Picture::new(self.width as usize, self.height as usize, rgb)
    }

    /// Writes the distance along the camera's axis n in world units, as one little-endian f32 a pixel. A pixel without a surface,
    /// whose depth code is 0, gets +inf.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn write_depth(&self, mut out: impl Write, scale: &DepthScale) -> io::Result<()> {
        for &code in &self.depth {
            let distance = scale
                .distance(code)
                .map_or(f32::INFINITY, |z| z.to_num::<f32>());
            out.write_all(&distance.to_le_bytes())?;
        }
        Ok(())
    }
}

/// Writes images of one size as an animated PNG that repeats forever.
///
/// # Errors
/// It cannot be written, or there is no image.
pub fn write_animation(
    out: impl Write,
    images: &[Image],
    frames_per_second: u16,
) -> io::Result<()> {
    let first = first(images)?;
    let mut encoder = png::Encoder::new(out, first.width, first.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_animated(images.len() as u32, 0)?;
    encoder.set_frame_delay(1, frames_per_second)?;
    let mut writer = encoder.write_header()?;
    for image in images {
        writer.write_image_data(image.picture().rgb())?;
    }
    writer.finish()?;
    Ok(())
}

/// Writes images of one size as a GIF that repeats forever. Each has up to 256 colours of its own. The time of a frame is a
/// multiple of 1/100 s.
///
/// # Errors
/// It cannot be written, or there is no image.
pub fn write_gif(out: impl Write, images: &[Image], frames_per_second: u16) -> io::Result<()> {
    let first = first(images)?;
    let [width, height] = [first.width, first.height].map(|side| side as u16);
    let mut encoder = gif::Encoder::new(out, width, height, &[]).map_err(io::Error::other)?;
    encoder
        .set_repeat(gif::Repeat::Infinite)
        .map_err(io::Error::other)?;
    for image in images {
        let mut frame =
            gif::Frame::from_rgb_speed(width, height, image.picture().rgb(), QUANTISER_SPEED);
        frame.delay = 100_u16.div_ceil(frames_per_second.max(1));
        encoder.write_frame(&frame).map_err(io::Error::other)?;
    }
    Ok(())
}

fn first(images: &[Image]) -> io::Result<&Image> {
    images.first().ok_or_else(|| {
        io::Error::new(
            io::ErrorKind::InvalidInput,
            "expected at least one frame, found none",
        )
    })
}
