//! Pieces: a line is cut at the borders of the picture's bands, into one piece for each band in which the line has a pixel.

use glint_core::colour::Rgb565;
use glint_core::picture::Size;

use super::{Line, LineDepth, LinePixel, LinePixels, NEAREST, Segment};
use crate::frame_buffer::FrameBuffer;
use crate::triangle::ScreenVertex;
use crate::triangle::setup::Bounds;

/// The part of a line in one band of a picture, given by its first pixel there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Piece {
    /// The rest of the line from the first pixel in the band to the line's end, which may be outside of the band. Depths include the bias.
    pub line: Line,
    /// Colour of all pixels of the piece.
    pub colour: Rgb565,
}

impl Segment {
    /// The pieces of the segment in a picture of this size, in the order in which the segment crosses the bands.
    pub fn pieces(&self, size: Size) -> impl Iterator<Item = Piece> + use<> {
        let (ends, bias) = match self.depth {
            LineDepth::Over => {
                let w = (NEAREST << 6) as u32;
                (self.ends.map(|end| ScreenVertex { w, ..end }), 0)
            }
            LineDepth::Tested { bias } => (self.ends, bias),
        };
        let (bands, colour) = (size.bands(), self.colour);
        let is_upward = ends[1].y < ends[0].y;
        let line = Line::new(&ends).map(|line| Line {
            depth: line.depth + (i64::from(bias) << 14),
            ..line
        });
        (0..bands).filter_map(move |number| {
            let band = if is_upward {
                bands - 1 - number
            } else {
                number
            };
            let pixels = line?.pixels(&band_bounds(size, band));
            let line = *pixels.rest()?;
            Some(Piece { line, colour })
        })
    }
}

impl Piece {
    /// Column and row of the piece's first pixel.
    pub fn first(&self) -> [i32; 2] {
        let pixel = self.line.pixel();
        [pixel.column, pixel.row]
    }

    /// Draws the piece in its band, up to the last pixel in the band. Calls `visit` with each pixel, and returns the number of pixels that
    /// passed the depth test.
    pub fn draw(
        &self,
        band: &Bounds,
        target: &mut FrameBuffer,
        visit: &mut dyn FnMut(&LinePixel),
    ) -> u32 {
        let mut drawn = 0;
        let pixels = LinePixels {
            line: self.line,
            // The number of pixels is not limited here: the iterator stops at the end of the band.
            last: [i32::MAX; 2],
        };
        let is_inside = |column, row| {
            (band.left..band.right).contains(&column) && (band.top..band.bottom).contains(&row)
        };
        for pixel in pixels.take_while(|pixel| is_inside(pixel.column, pixel.row)) {
            visit(&pixel);
            let depth = LineDepth::Tested { bias: 0 };
            drawn += u32::from(target.draw_pixel(&pixel, depth, self.colour));
        }
        drawn
    }
}

/// The columns and rows of a band of a picture.
pub fn band_bounds(size: Size, band: u32) -> Bounds {
    let rows = size.band_lines() as i32;
    Bounds {
        left: 0,
        right: size.width() as i32,
        top: band as i32 * rows,
        bottom: (band as i32 + 1) * rows,
    }
}
