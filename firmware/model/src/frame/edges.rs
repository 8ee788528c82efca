//! Drawing of a mesh's edges by the model.

use super::FrameStats;
use super::constants::FrameConstants;
use super::description::{Frame, Subject};
use crate::edges::EdgeList;
use crate::error::RenderError;
use crate::frame_buffer::FrameBuffer;
use crate::line::Segment;
use crate::triangle::Projected;

impl Frame<'_> {
    /// Draws the edges of the mesh of [`Subject::Edges`] over the faces drawn by [`draw`](Self::draw), and then the rectangles. Adds the
    /// counts of both to the counts of the faces. Does nothing for other subjects. Calls `progress` at short intervals.
    ///
    /// # Errors
    /// [`RenderError`] for a buffer or memory of the wrong size.
    pub fn draw_edges(
        &self,
        constants: &FrameConstants,
        list: &mut EdgeList,
        buffer: &mut FrameBuffer,
        scratch: &mut [Projected],
        progress: &mut dyn FnMut(),
        stats: &mut FrameStats,
    ) -> Result<(), RenderError> {
        let (Subject::Edges(subject, _), Some(setup)) = (&self.subject, constants.mesh()) else {
            return Ok(());
        };
        buffer.check()?;
        let (mut covered, mut drawn) = (0, 0);
        let samples = self.drawn_samples();
        let mut draw = |segment: &Segment| {
            for line in segment.strokes(samples) {
                covered += line.covered(buffer) as u64;
                drawn += u64::from(line.draw(buffer));
            }
        };
        let (mesh, culls) = (&subject.mesh, subject.culls());
        let edges = list.segments(mesh, culls, setup, scratch, progress, &mut draw)?;
        stats.edges = Some(edges);
        if let Some(mesh) = &mut stats.mesh {
            mesh.pixels_covered += covered;
            mesh.pixels_drawn += drawn;
        }
        self.draw_rectangles(buffer, progress, stats);
        Ok(())
    }
}
