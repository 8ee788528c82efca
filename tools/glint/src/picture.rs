//! Rendered frames in memory and in files.

use glint_core::picture::Size;
use glint_model::DepthScale;
use std::io::{self, Write};
use virtual_board::Picture;

/// Speed of the colour quantisation of a GIF, from 1 (best quality) to 30 (fastest).
const QUANTISER_SPEED: i32 = 10;

/// Colours and depth codes of a rendered frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// RGB565, row by row from the top left.
    pub colour: Vec<u16>,
    /// Depth codes in the order of the colours; empty unless requested.
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

    /// The colours with 8 bits per channel.
    pub fn picture(&self) -> Picture {
        Picture::from_rgb565(self.width as usize, self.height as usize, &self.colour)
    }

    /// Writes the distance along the camera's axis n in world units, one little-endian f32 per pixel. The distance of a pixel
    /// without a surface, whose depth code is 0, is +inf.
    ///
    /// # Errors
    /// The distances cannot be written.
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

impl Image {
    /// The distances along the camera's axis n as greys: white at the nearest surface, dark at the farthest, linear between them, and black
    /// where there is no surface.
    #[must_use]
    pub fn depth_picture(&self, scale: &DepthScale) -> Picture {
        /// Grey of the farthest surface.
        const FARTHEST: f64 = 40.0;
        let distance = |&code: &u32| Some(scale.distance(code)?.to_num::<f64>());
        let distances: Vec<Option<f64>> = self.depth.iter().map(distance).collect();
        let seen = || distances.iter().flatten().copied();
        let nearest = seen().fold(f64::INFINITY, f64::min);
        let range = (seen().fold(nearest, f64::max) - nearest).max(f64::MIN_POSITIVE);
        let grey = |z: f64| (255.0 - (255.0 - FARTHEST) * (z - nearest) / range).round() as u8;
        let colours = distances.iter().flat_map(|z| [z.map_or(0, grey); 3]);
        Picture::new(self.width as usize, self.height as usize, colours.collect())
    }
}

/// An animation that repeats endlessly. Its images have one size, and are written one by one.
pub enum Animation<W: Write> {
    /// An animated PNG.
    Png(png::Writer<W>),
    /// A GIF. Each image has its own palette of up to 256 colours.
    Gif {
        /// Encoder of the images.
        encoder: gif::Encoder<W>,
        /// Duration of an image in 1/100 s.
        delay: u16,
    },
}

impl<W: Write> Animation<W> {
    /// Begins an animated PNG of `count` images with the given width and height.
    ///
    /// # Errors
    /// The file cannot be written, or `count` is 0.
    pub fn png(
        out: W,
        [width, height]: [u32; 2],
        count: u32,
        images_per_second: u16,
    ) -> io::Result<Self> {
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_animated(count, 0)?;
        encoder.set_frame_delay(1, images_per_second)?;
        Ok(Self::Png(encoder.write_header()?))
    }

    /// Begins a GIF with the given width and height. The duration of an image is rounded up to a multiple of 1/100 s.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn gif(out: W, size: [u32; 2], images_per_second: u16) -> io::Result<Self> {
        let [width, height] = size.map(|side| side as u16);
        let encoder = gif::Encoder::new(out, width, height, &[]);
        let mut encoder = encoder.map_err(io::Error::other)?;
        let forever = encoder.set_repeat(gif::Repeat::Infinite);
        forever.map_err(io::Error::other)?;
        let delay = 100_u16.div_ceil(images_per_second.max(1));
        Ok(Self::Gif { encoder, delay })
    }

    /// Writes the next image.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, picture: &Picture) -> io::Result<()> {
        let (rgb, [width, height]) = (picture.rgb(), [picture.width(), picture.height()]);
        match self {
            Self::Png(writer) => Ok(writer.write_image_data(rgb)?),
            Self::Gif { encoder, delay } => {
                let (width, height) = (width as u16, height as u16);
                let mut frame = gif::Frame::from_rgb_speed(width, height, rgb, QUANTISER_SPEED);
                frame.delay = *delay;
                encoder.write_frame(&frame).map_err(io::Error::other)
            }
        }
    }

    /// Ends the animation.
    ///
    /// # Errors
    /// The file cannot be written, or has fewer images than `count`.
    pub fn finish(self) -> io::Result<()> {
        match self {
            Self::Png(writer) => Ok(writer.finish()?),
            Self::Gif { encoder, .. } => encoder.into_inner().map_err(io::Error::other)?.flush(),
        }
    }
}

/// Writes images of one size as an animated PNG.
///
/// # Errors
/// The file cannot be written, or there are no images.
pub fn write_animation(
    out: impl Write,
    images: &[Image],
    images_per_second: u16,
) -> io::Result<()> {
    let size = images
        .first()
        .map_or([0; 2], |first| [first.width, first.height]);
    let mut animation = Animation::png(out, size, images.len() as u32, images_per_second)?;
    let mut pictures = images.iter().map(Image::picture);
    pictures.try_for_each(|picture| animation.add(&picture))?;
    animation.finish()
}
