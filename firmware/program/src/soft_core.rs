//! Drawing of frames by the model, on the soft core in place of the gateware, or on a host.

use glint_core::feature::EDGES;
use glint_core::picture::Samples;
use glint_model::edges::EdgeList;
use glint_model::{Frame, FrameBuffer, FrameStats, Projected, RenderError, Subject};

/// The memory in which the CPU draws frames.
pub struct SoftCore<'m> {
    /// Samples of a picture with four samples per pixel, for the largest part that is drawn at once.
    pub samples: &'m mut [u16],
    /// Depth codes of the samples in this part, or of the pixels in a picture.
    pub depth: &'m mut [u32],
    /// Projected vertices: [`Frame::scratch_vertices`] of them.
    pub scratch: &'m mut [Projected],
    /// Memory for the edges of a mesh.
    pub edges: &'m mut EdgeList<'static>,
}

impl SoftCore<'_> {
    /// Draws a frame into a picture of its size. Calls `progress` at short intervals.
    ///
    /// # Errors
    /// [`RenderError`] for a frame out of range, or for too little memory.
    pub fn draw(
        &mut self,
        frame: &Frame,
        picture: &mut [u16],
        progress: &mut dyn FnMut(),
    ) -> Result<FrameStats, RenderError> {
        if frame.drawn_samples() == Samples::One {
            return self.draw_samples(frame, picture, progress);
        }
        let samples = core::mem::take(&mut self.samples);
        let mut sum: Option<FrameStats> = None;
        for part in frame.parts() {
            let count = part.window().size.pixel_count();
            let samples = samples.get_mut(..count).unwrap_or_default();
            let stats = self.draw_samples(&part, samples, progress)?;
            part.average(samples, picture, progress);
            sum = Some(sum.map_or(stats, |sum| sum + stats));
        }
        self.samples = samples;
        Ok(sum.unwrap_or_default())
    }

    /// Draws the samples of a frame's window.
    fn draw_samples(
        &mut self,
        frame: &Frame,
        colour: &mut [u16],
        progress: &mut dyn FnMut(),
    ) -> Result<FrameStats, RenderError> {
        let size = frame.window().size;
        let depth = self.depth.get_mut(..size.pixel_count());
        let buffer = &mut FrameBuffer {
            width: size.width(),
            height: size.height(),
            colour,
            depth: depth.unwrap_or_default(),
            rounding: frame.rounding,
        };
        let constants = frame.constants()?;
        if EDGES.is_built
            && let Subject::Edges(subject, _) = &frame.subject
        {
            // The list is made first, because a mesh with too many edges is an error, and nothing may then be drawn.
            self.edges.make(&subject.mesh, progress)?;
        }
        let mut stats = frame.draw(&constants, buffer, self.scratch, progress)?;
        if EDGES.is_built {
            let (edges, scratch) = (&mut *self.edges, &mut *self.scratch);
            frame.draw_edges(&constants, edges, buffer, scratch, progress, &mut stats)?;
        }
        Ok(stats)
    }
}
