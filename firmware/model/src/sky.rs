//! The sky and the gradient behind meshes: a colour for each group of eight pixels in a line (docs/formats/triangle.md, "Sky").

use glint_core::camera::{Projection, View};
use glint_core::colour::Rgb565;
use glint_core::field::magnitude;
use glint_core::fixed::U8_28;
use glint_core::light::Gradient;
use glint_core::picture::{Samples, Window};

use crate::error::RenderError;
use crate::frame_buffer::FrameBuffer;
use crate::raymarch::mixed;

/// Number of pixels in a group. All pixels of a group have one colour.
const GROUP: usize = 8;

/// Number of fraction bits of a height.
const FRACTION: u32 = 23;

/// The heights and colours of the sky in a frame.
///
/// The height of a position in the picture is the z component of the ray direction at this position, scaled so that its component along the
/// camera's forward axis n is 1. For a fixed gradient, the height is 1 at the top and −1 at the bottom of the picture. The height is linear
/// in the picture: for the group in column x (of groups) and line y it is `above` + x·`across` + (y + 1)·`down`, each s8.23.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sky {
    /// Height of the first group in the line above the picture.
    pub above: i32,
    /// Change of the height from a group to the next one in its line.
    pub across: i32,
    /// Change of the height from a line to the next one.
    pub down: i32,
    /// Colour at the zenith, from the height 1 up.
    pub zenith: [u8; 3],
    /// Colour at the horizon, the height 0.
    pub horizon: [u8; 3],
    /// Colour at the nadir, from the height −1 down.
    pub nadir: [u8; 3],
}

impl Sky {
    /// The sky for a camera, in a picture of one of the supported sizes.
    pub fn new(view: &View, size: [u32; 2], gradient: Gradient) -> Self {
        let [width, height] = size;
        let [middle, across, down] = if gradient.is_fixed {
            [
                0,
                0,
                -(((2 << FRACTION) + height as i32 / 2) / height as i32),
            ]
        } else {
            Self::heights(view, size)
        };
        // The middle of the picture is half a group to the left of a group's middle, and half a line above a line's middle.
        let [columns, lines] = [width / 16, height / 2].map(|x| x as i32);
        let first = middle + ((across + down) >> 1) - columns * across - lines * down;
        let [zenith, horizon, nadir] = gradient.colours;
        Self {
            above: first - down,
            across,
            down,
            zenith,
            horizon,
            nadir,
        }
    }

    /// The height in the middle of the picture, and its changes from a group to the next one and from a line to the next one, s8.23.
    fn heights(view: &View, size: [u32; 2]) -> [i32; 3] {
        let [u, v, n] = [view.u(), view.v(), view.n()].map(|[_, _, z]| i64::from(z.to_bits()));
        // All rays of an orthographic camera have the same direction.
        if view.projection() == Projection::Orthographic {
            return [n as i32, 0, 0];
        }
        let lens = view.lens();
        // Half a picture has 5·2^k pixels across and 45·2^k down. The step is therefore a fifth or a 45th of half the window's length, with
        // 30 fraction bits, divided by a power of two. A product has at most 61 bits. A step across is a group of eight pixels.
        let step = |row: i64, (pixels, length): (u32, U8_28), grouped: u32| {
            let k = pixels.trailing_zeros();
            let part = (length.to_bits() << 2) as i64 / i64::from(pixels >> k);
            let shift = 30 + k - grouped;
            ((row * part + (1 << (shift - 1))) >> shift) as i32
        };
        let [of_width, of_height] = lens.scales(size);
        let (across, down) = (step(u, of_width, 3), step(v, of_height, 0));
        let aside = core::iter::zip(lens.middle(), [u, v]);
        let aside = aside.map(|(middle, row)| (i64::from(middle.to_bits()) * row) >> 28);
        [(n + aside.sum::<i64>()) as i32, across, down]
    }

    /// The sky for a window of a picture with this number of samples per pixel: the group in column 0 and line 0 is the window's first.
    #[must_use]
    pub fn in_window(self, window: Window, samples: Samples) -> Self {
        let [column, line] = window.origin().map(|place| place / samples.across());
        let above = self.height(column / GROUP as u32, line);
        Self {
            above: above.wrapping_sub(self.down),
            ..self
        }
    }

    /// Height of the group in a column and a line, s8.23. It wraps modulo 2^32 as in the gateware, which occurs only for invalid constants.
    pub fn height(&self, column: u32, line: u32) -> i32 {
        let right = (column as i32).wrapping_mul(self.across);
        let down = (line as i32 + 1).wrapping_mul(self.down);
        self.above.wrapping_add(right).wrapping_add(down)
    }

    /// The colour of the group in a column and a line, eight bits per channel.
    pub fn colour(&self, column: u32, line: u32) -> [u8; 3] {
        let height = self.height(column, line);
        let share = (magnitude(height) >> (FRACTION - 8)).min(255) as u8;
        let end = if height < 0 { self.nadir } else { self.zenith };
        mixed(end, self.horizon, 255 - share)
    }

    /// Fills a picture with this number of samples per pixel with the sky, and its depth codes with 0. All samples of a group of pixels
    /// have the group's colour before dithering. Calls `progress` after each line.
    ///
    /// # Errors
    /// [`RenderError`] for a frame buffer of the wrong size.
    pub fn fill(
        &self,
        samples: Samples,
        target: &mut FrameBuffer,
        progress: &mut dyn FnMut(),
    ) -> Result<(), RenderError> {
        target.check()?;
        let rounding = target.rounding;
        let lines = target.colour.chunks_exact_mut(target.width as usize);
        let across = samples.across();
        for (y, line) in (0..).zip(lines) {
            for (x, group) in (0..).zip(line.as_chunks_mut::<GROUP>().0) {
                let colour = Rgb565::with_fractions(self.colour(x / across, y / across));
                for (lane, pixel) in (0..).zip(group) {
                    *pixel = Rgb565::rounded(colour, rounding, [lane, y]).0;
                }
            }
            progress();
        }
        target.depth.fill(0);
        Ok(())
    }
}
