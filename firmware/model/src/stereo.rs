//! Stereo: the frames of two eyes, and the composition of their pictures into an anaglyph (docs/formats/camera.md, "Stereo").
//!
//! For a field without a mesh and rectangles, one frame casts the rays of both eyes. Other frames are drawn as two frames of one eye each.

use core::iter;
use core::ops::Add;

use glint_core::camera::Projection;
use glint_core::colour::{HALF_LUMINANCE, Rgb565, fine_luminance};
use glint_core::feature::{MESH, STEREO};
use glint_core::stereo::Tint;

use crate::error::RenderError;
use crate::frame::{Frame, FrameStats, Subject};

/// Number of 32-bit words in a line of the soft core's data cache. A word holds two pixels.
const LINE: usize = 8;
/// Number of cache lines that are composed between two calls of `progress` in [`Eyes::compose`].
const LINES_PER_CALL: usize = 128;

/// The frames of two eyes, whose pictures are composed into one.
#[derive(Clone, Copy, Debug)]
pub struct Eyes<'a> {
    /// The frame of the left eye, whose depth codes become those of the composed picture.
    pub left: Frame<'a>,
    /// The frame of the right eye, whose depth codes are not used.
    pub right: Frame<'a>,
    /// Colours of the anaglyph glasses.
    pub tint: Tint,
}

impl<'a> Frame<'a> {
    /// Whether each eye has a frame of its own.
    #[inline(always)]
    pub(crate) const fn is_pair(&self) -> bool {
        self.stereo.is_some()
            && (!matches!(self.subject, Subject::Field(_)) || !self.drawn_rectangles().is_empty())
    }

    /// The frames of both eyes; `None` for a frame that is drawn as one frame.
    ///
    /// # Errors
    /// [`RenderError::Stereo`] for a wireframe, and [`RenderError::Orthographic`].
    pub fn eyes(&self) -> Result<Option<Eyes<'a>>, RenderError> {
        if !(STEREO.is_built && MESH.is_built) {
            return Ok(None);
        }
        let Some(stereo) = self.stereo.filter(|_| self.is_pair()) else {
            return Ok(None);
        };
        if let Subject::Wireframe(_) = self.subject {
            return Err(RenderError::Stereo);
        }
        if self.view.projection() == Projection::Orthographic {
            return Err(RenderError::Orthographic);
        }
        let [left, right] = stereo.eyes(&self.view).map(|view| Self {
            view,
            stereo: None,
            ..*self
        });
        Ok(Some(Eyes {
            left,
            right,
            tint: stereo.tint,
        }))
    }

    /// The frames to draw for this frame: one for the left and one for the right eye, or only this frame. The picture has the depth codes
    /// of the first frame.
    ///
    /// # Errors
    /// As [`eyes`](Self::eyes).
    pub fn drawn(&self) -> Result<impl Iterator<Item = Self>, RenderError> {
        let (first, second) = match self.eyes()? {
            Some(eyes) => (eyes.left, Some(eyes.right)),
            None => (*self, None),
        };
        Ok(iter::once(first).chain(second))
    }
}

impl Eyes<'_> {
    /// Replaces the picture of the left eye by the anaglyph of both eyes. A word holds two pixels, the left pixel in its lower half. Calls
    /// `progress` at short intervals.
    pub fn compose(&self, left: &mut [u32], right: &[u32], progress: &mut dyn FnMut()) {
        let (left, left_rest) = left.as_chunks_mut::<LINE>();
        let (right, right_rest) = right.as_chunks::<LINE>();
        let mut last = ([0; 2], self.composed([0; 2]));
        for (number, (left, right)) in left.iter_mut().zip(right).enumerate() {
            // Copies a whole cache line of each picture: the data cache of the soft core is direct-mapped, so alternating reads of the two
            // pictures would evict each other's lines.
            let (of_right, of_left) = (*right, *left);
            let (a, b) = (of_left[0], of_right[0]);
            if of_left.iter().all(|&x| x == a) && of_right.iter().all(|&x| x == b) {
                // In most lines each eye has a single colour, the same as in the previous line.
                *left = [self.remembered(&mut last, [a, b]); LINE];
            } else {
                for (left, (a, b)) in left.iter_mut().zip(of_left.into_iter().zip(of_right)) {
                    *left = self.remembered(&mut last, [a, b]);
                }
            }
            if number.is_multiple_of(LINES_PER_CALL) {
                progress();
            }
        }
        for (left, &right) in left_rest.iter_mut().zip(right_rest) {
            *left = self.composed([*left, right]);
        }
    }

    /// As [`composed`](Self::composed); `last` caches the previous words and their result.
    #[inline(always)]
    fn remembered(&self, last: &mut ([u32; 2], u32), words: [u32; 2]) -> u32 {
        if last.0 != words {
            *last = (words, self.composed(words));
        }
        last.1
    }

    /// Composes two pixels of each eye to two pixels of the anaglyph.
    fn composed(&self, [left, right]: [u32; 2]) -> u32 {
        let [a, b] = pixels(left).map(luminance);
        let [c, d] = pixels(right).map(luminance);
        let [first, second] = [(a, c), (b, d)].map(|(left, right)| self.tint.compose(left, right));
        u32::from(first) | u32::from(second) << 16
    }
}

/// The two pixels in a word, the left one first.
const fn pixels(word: u32) -> [u16; 2] {
    [word as u16, (word >> 16) as u16]
}

/// The luminance of a pixel in RGB565, whose channels are widened to 8 bits.
fn luminance(pixel: u16) -> u8 {
    let [low, high] = pixel.to_le_bytes();
    ((LOW[usize::from(low)] + HIGH[usize::from(high)]) >> 8) as u8
}

/// Contribution of the lower byte of a pixel to its luminance, in units of 2^−8, plus the rounding constant. The luminance is the
/// sum of the entries of `LOW` and `HIGH`, because the bits that widen green are all in the higher byte.
static LOW: [u16; 256] = shares(0, HALF_LUMINANCE);
/// Contribution of the higher byte of a pixel to its luminance, in units of 2^−8.
static HIGH: [u16; 256] = shares(8, 0);

const fn shares(shift: u32, rounding: u16) -> [u16; 256] {
    let mut shares = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        shares[byte] = fine_luminance(Rgb565((byte as u16) << shift).to_rgb888()) + rounding;
        byte += 1;
    }
    shares
}

/// Adds the counts of both eyes, or of the quarters of a frame.
impl Add for FrameStats {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        if let (Some(mesh), Some(other)) = (&mut self.mesh, &other.mesh) {
            mesh.add(other);
        }
        if let (Some(field), Some(other)) = (&mut self.field, &other.field) {
            field.add(other);
        }
        if let (Some(wireframe), Some(other)) = (&mut self.wireframe, &other.wireframe) {
            wireframe.add(other);
        }
        if let (Some(edges), Some(other)) = (&mut self.edges, &other.edges) {
            edges.add(other);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::luminance;
    use glint_core::colour::{self, Rgb565};

    #[test]
    fn the_luminance_of_every_pixel() {
        for pixel in 0..=u16::MAX {
            let rgb = Rgb565(pixel).to_rgb888();
            assert_eq!(luminance(pixel), colour::luminance(rgb), "{pixel:#06x}");
        }
    }
}
