//! Stereo pictures with meshes: the gateware draws the frames of both eyes, one after the other, and the soft core composes them.
//!
//! ```text
//! frame of the right eye ─▶ memory of its own ──┐
//! frame of the left eye, with its depth ─▶ back ─▶ compose ─▶ back
//! ```

use glint_model::Eyes;
use litex_pac::cpu;

use super::fallback::Fallback;
use super::geometry::Cpu;
use super::rendered::Rendered;
use super::renderer::{GatewareRenderer, Output};

/// The picture of the right eye, and the state of drawing a stereo picture.
pub struct RightEye {
    /// Colours of the right eye's picture in RGB565.
    pub colour: &'static mut [u16],
    /// Cost of the right eye's frame, stored while the frame of the left eye is drawn.
    rendered: Option<Rendered>,
}

impl RightEye {
    /// Creates the picture of the right eye in this memory.
    pub const fn new(colour: &'static mut [u16]) -> Self {
        Self {
            colour,
            rendered: None,
        }
    }

    /// Starts or continues the drawing of a stereo picture to `output`, as [`GatewareRenderer::advance`] does for a frame.
    ///
    /// # Errors
    /// As [`GatewareRenderer::advance`].
    pub fn advance(
        &mut self,
        gateware: &mut GatewareRenderer,
        eyes: &Eyes,
        output: &mut Output,
        cpu: &mut Cpu,
    ) -> Option<Result<Rendered, Fallback>> {
        if self.rendered.is_none() {
            match self.draw(gateware, eyes, cpu)? {
                Ok(rendered) => self.rendered = Some(rendered),
                Err(fallback) => return Some(Err(fallback)),
            }
        }
        let left = gateware.advance(&eyes.left, output, cpu)?;
        let right = self.rendered.take()?;
        Some(left.map(|left| left.plus(right, self.compose(gateware, eyes, output, cpu))))
    }

    /// Draws a stereo picture `count` times. The console does not answer during this call.
    ///
    /// # Errors
    /// As [`GatewareRenderer::advance`].
    pub fn repeat(
        &mut self,
        gateware: &mut GatewareRenderer,
        eyes: &Eyes,
        output: &mut Output,
        cpu: &mut Cpu,
        count: u32,
    ) -> Result<Rendered, Fallback> {
        let mut once = || loop {
            if let Some(drawn) = self.advance(gateware, eyes, output, cpu) {
                break drawn;
            }
        };
        let mut sum = once()?;
        for _ in 1..count {
            sum = sum.plus(once()?, 0);
        }
        Ok(sum)
    }

    /// Starts or continues the frame of the right eye.
    fn draw(
        &mut self,
        gateware: &mut GatewareRenderer,
        eyes: &Eyes,
        cpu: &mut Cpu,
    ) -> Option<Result<Rendered, Fallback>> {
        let mut output = Output {
            colour: &mut *self.colour,
            depth: None,
        };
        // The renderer tracks the contents of the two frame buffers only, and this memory is not a frame buffer.
        if !gateware.is_busy() {
            gateware.invalidate(output.colour);
        }
        let drawn = gateware.advance(&eyes.right, &mut output, cpu)?;
        gateware.invalidate(output.colour);
        Some(drawn)
    }

    /// Replaces `left`, the picture of the left eye, by the picture of both eyes.
    pub fn join(&self, eyes: &Eyes, left: &mut [u16], progress: &mut dyn FnMut()) {
        let pixels = eyes.left.size.pixel_count();
        let left = left.get_mut(..pixels).unwrap_or_default();
        // Both pictures are aligned to words.
        let left = bytemuck::try_cast_slice_mut(left).unwrap_or_default();
        let right = bytemuck::try_cast_slice(self.colour).unwrap_or_default();
        eyes.compose(left, right, progress);
    }

    /// Composes the picture of both eyes in `output`, which holds the left eye's picture. Returns the clock cycles used.
    fn compose(
        &self,
        gateware: &mut GatewareRenderer,
        eyes: &Eyes,
        output: &mut Output,
        cpu: &mut Cpu,
    ) -> u64 {
        let start = cpu::cycles();
        // The engine writes to memory and not to the CPU's data cache, which may hold older data.
        cpu::flush_data_cache();
        self.join(eyes, output.colour, cpu.progress);
        gateware.invalidate(output.colour);
        cpu::cycles() - start
    }
}
