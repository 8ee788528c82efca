//! Drawing of a frame's rectangles by the model.

use super::FrameStats;
use super::description::Frame;
use crate::frame_buffer::FrameBuffer;
use crate::triangle::raster::draw_textured;
use crate::triangle::rectangle::set_up;

impl Frame<'_> {
    /// Draws the rectangles over the picture in `buffer`. Adds their pixels to the counts of the mesh or wireframe, if the frame has one.
    /// Calls `progress` before each rectangle.
    pub(super) fn draw_rectangles(
        &self,
        buffer: &mut FrameBuffer,
        progress: &mut dyn FnMut(),
        stats: &mut FrameStats,
    ) {
        for rectangle in self.drawn_rectangles() {
            progress();
            let visible = set_up(rectangle, self.window(), self.drawn_samples());
            let Some((setup, textured)) = visible else {
                continue;
            };
            let coverage = draw_textured(&setup, &textured, buffer);
            if let Some(mesh) = &mut stats.mesh {
                mesh.add_pixels(&coverage);
            }
            if let Some(wireframe) = &mut stats.wireframe {
                wireframe.pixels += u64::from(coverage.drawn);
            }
        }
    }
}
