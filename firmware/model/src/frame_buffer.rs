//! Frame buffers: the colours and depth codes of a picture.

use glint_core::colour::Rounding;

use crate::error::{Buffer, RenderError, SIZES};

/// The memory of one picture, stored row by row from the top, without padding.
#[derive(Debug)]
pub struct FrameBuffer<'a> {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels; width and height are one of the [`SIZES`].
    pub height: u32,
    /// Colours in RGB565, one per pixel.
    pub colour: &'a mut [u16],
    /// Depth codes, one per pixel: u18, larger is nearer, 0 for an empty pixel.
    pub depth: &'a mut [u32],
    /// How colours are rounded to RGB565.
    pub rounding: Rounding,
}

impl FrameBuffer<'_> {
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let &Self { width, height, .. } = self;
        if !SIZES.contains(&(width, height)) {
            return Err(RenderError::Size { width, height });
        }
        let expected = width as usize * height as usize;
        for (buffer, found) in [
            (Buffer::Colour, self.colour.len()),
            (Buffer::Depth, self.depth.len()),
        ] {
            if found != expected {
                return Err(RenderError::Buffer {
                    buffer,
                    expected,
                    found,
                });
            }
        }
        Ok(())
    }

    /// Fills the picture with the colour `clear` (RGB565) and the depth codes with 0.
    pub(crate) fn clear(&mut self, clear: u16) {
        // The compiler makes a `memset` of whole words of a fill with the constant 0.
        match clear {
            0 => self.colour.fill(0),
            clear => self.colour.fill(clear),
        }
        self.depth.fill(0);
    }

    /// Checks that the size of this buffer equals the size (`width`, `height`) of the frame constants.
    pub(crate) fn check_size(&self, (width, height): (u32, u32)) -> Result<(), RenderError> {
        if (self.width, self.height) == (width, height) {
            Ok(())
        } else {
            Err(RenderError::Size { width, height })
        }
    }
}
