//! Pictures on the monitor.

use std::io::Write;

use glint_core::mesh::Rgb565;

/// Reason why a picture is not an enlarged RGB565 frame.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PictureError {
    /// The sides of the picture are not multiples of the scale.
    #[error("picture of {width}x{height}: expected multiples of the scale {scale}")]
    Scale {
        /// Number of pixels of a line.
        width: usize,
        /// Number of lines.
        height: usize,
        /// The requested scale.
        scale: usize,
    },
    /// The pixels of a block, which represent one pixel of the frame, differ.
    #[error(
        "pixel {x}, {y}: expected {expected:?} as in the rest of its {scale}x{scale} block, found {found:?}"
    )]
    Block {
        /// Column of the pixel.
        x: usize,
        /// Line of the pixel.
        y: usize,
        /// Width and height of a block in pixels.
        scale: usize,
        /// Red, green and blue of the first pixel of the block.
        expected: [u8; 3],
        /// Red, green and blue of the pixel.
        found: [u8; 3],
    },
    /// A colour that is not an RGB565 colour widened by bit replication.
    #[error("pixel {x}, {y}: expected the RGB565 colour {expected:?}, found {found:?}")]
    Colour {
        /// Column of the pixel.
        x: usize,
        /// Line of the pixel.
        y: usize,
        /// The nearest RGB565 colour, widened.
        expected: [u8; 3],
        /// Red, green and blue of the pixel.
        found: [u8; 3],
    },
}

/// A picture with 8 bits per channel; the pixels are stored line by line from the top left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
}

impl Picture {
    /// Creates a picture from red, green and blue bytes of every pixel.
    ///
    /// # Panics
    /// When the number of bytes does not match the size.
    #[must_use]
    pub fn new(width: usize, height: usize, rgb: Vec<u8>) -> Self {
        assert_eq!(rgb.len(), 3 * width * height, "three bytes per pixel");
        Self { width, height, rgb }
    }

    /// Creates a picture from the RGB565 colours of every pixel, by bit replication like the gateware's video output.
    ///
    /// # Panics
    /// When the number of colours does not match the size.
    #[must_use]
    pub fn from_rgb565(width: usize, height: usize, colours: &[u16]) -> Self {
        let mut rgb = Vec::with_capacity(3 * colours.len());
        for &colour in colours {
            rgb.extend(Rgb565(colour).to_rgb888());
        }
        Self::new(width, height, rgb)
    }

    /// Number of pixels of a line.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of lines.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Red, green and blue of every pixel.
    #[must_use]
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    /// Red, green and blue at column `x` of line `y`.
    ///
    /// # Panics
    /// When the pixel is outside of the picture.
    #[must_use]
    pub fn pixel(&self, x: usize, y: usize) -> [u8; 3] {
        assert!(
            x < self.width && y < self.height,
            "pixel {x}, {y} of {}x{}",
            self.width,
            self.height
        );
        let at = 3 * (y * self.width + x);
        [self.rgb[at], self.rgb[at + 1], self.rgb[at + 2]]
    }

    /// Returns the RGB565 frame, line by line, that scan-out enlarged by `scale` to this picture.
    ///
    /// # Errors
    /// When the sides are not multiples of `scale`, a block of `scale` × `scale` pixels has several colours, or a colour
    /// is not an RGB565 colour widened by bit replication.
    pub fn scaled_back(&self, scale: usize) -> Result<Vec<u16>, PictureError> {
        let Self { width, height, .. } = *self;
        if scale == 0 || !width.is_multiple_of(scale) || !height.is_multiple_of(scale) {
            return Err(PictureError::Scale {
                width,
                height,
                scale,
            });
        }
        let mut frame = Vec::with_capacity(width * height / (scale * scale));
        for y in 0..height {
            for x in 0..width {
                let found = self.pixel(x, y);
                let (left, top) = (x - x % scale, y - y % scale);
                let expected = self.pixel(left, top);
                if found != expected {
                    return Err(PictureError::Block {
                        x,
                        y,
                        scale,
                        expected,
                        found,
                    });
                }
                if (x, y) == (left, top) {
                    let colour = Rgb565::from_rgb888(found);
                    let expected = colour.to_rgb888();
                    if found != expected {
                        return Err(PictureError::Colour {
                            x,
                            y,
                            expected,
                            found,
                        });
                    }
                    frame.push(colour.0);
                }
            }
        }
        Ok(frame)
    }

    /// Writes the picture as a PNG file.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_png(&self, out: impl Write) -> std::io::Result<()> {
        let mut encoder = png::Encoder::new(out, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgb)?;
        writer.finish()?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes a frame that uses every colour bit, and the picture of the frame enlarged by `scale`.
    fn enlarged(width: usize, height: usize, scale: usize) -> (Vec<u16>, Picture) {
        let frame: Vec<u16> = (0..width * height)
            .map(|i| (i as u16).wrapping_mul(0x9e37))
            .collect();
        let (wide, high) = (width * scale, height * scale);
        let colours: Vec<u16> = (0..wide * high)
            .map(|i| frame[i / wide / scale * width + i % wide / scale])
            .collect();
        let picture = Picture::from_rgb565(wide, high, &colours);
        (frame, picture)
    }

    #[test]
    fn an_enlarged_frame_comes_back() {
        for scale in [1, 2, 4] {
            let (frame, picture) = enlarged(20, 12, scale);
            assert_eq!(picture.scaled_back(scale), Ok(frame));
        }
    }

    #[test]
    fn a_pixel_that_leaves_its_block_is_found() {
        let (_, mut picture) = enlarged(20, 12, 4);
        let expected = picture.pixel(4, 8);
        picture.rgb[3 * (11 * 80 + 7) + 1] ^= 0x80;
        let found = picture.pixel(7, 11);
        assert_eq!(
            picture.scaled_back(4),
            Err(PictureError::Block {
                x: 7,
                y: 11,
                scale: 4,
                expected,
                found
            })
        );
    }

    #[test]
    fn a_colour_outside_rgb565_is_found() {
        let picture = Picture::new(2, 1, vec![0, 0, 0, 0xf8, 0, 0]);
        assert_eq!(
            picture.scaled_back(1),
            Err(PictureError::Colour {
                x: 1,
                y: 0,
                expected: [0xf7, 0, 0],
                found: [0xf8, 0, 0]
            })
        );
    }

    #[test]
    fn a_scale_that_does_not_divide_the_picture_is_refused() {
        let (_, picture) = enlarged(20, 12, 1);
        for scale in [0, 3, 5] {
            assert_eq!(
                picture.scaled_back(scale),
                Err(PictureError::Scale {
                    width: 20,
                    height: 12,
                    scale
                })
            );
        }
    }
}
