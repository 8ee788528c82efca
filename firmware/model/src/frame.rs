//! A frame: the description of one picture, the constants computed from it, and its drawing by the model.
//!
//! The CPU backend, the gateware backend and the host share these types. [`Frame`] is the description, [`FrameConstants`] are computed once
//! per frame, and [`Frame::draw`] draws the picture in integer arithmetic, bit for bit as the gateware does.

mod constants;
mod description;
mod edges;
mod rectangles;
mod samples;

use glint_core::feature::WIREFRAME;

use crate::edges::EdgeStats;
use crate::error::RenderError;
use crate::frame_buffer::FrameBuffer;
use crate::raymarch::{FieldStats, RayEnd, render_field};
use crate::triangle::{
    DrawnTriangle, Emit, PreparedMesh, Projected, Stats, draw_parts, set_up_parts,
};
use crate::wireframe::{WireframeStats, render_wireframe};

pub use constants::{FieldConstants, FrameConstants};
pub use description::{FieldSubject, Frame, MeshSubject, Object, Subject};
pub use samples::average_lines;

/// Number of triangles that are drawn between two calls of `progress` in [`Frame::draw`].
const TRIANGLES_PER_CALL: u32 = 32;
/// Number of pixels of a field that are drawn between two calls of `progress` in [`Frame::draw`].
const PIXELS_PER_CALL: u32 = 16;

/// Counts of the triangles, rays, lines and pixels of a drawn frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// Counts of the mesh, if any.
    pub mesh: Option<Stats>,
    /// Counts of the field, if any.
    pub field: Option<FieldStats>,
    /// Counts of the wireframe, if any.
    pub wireframe: Option<WireframeStats>,
    /// Counts of the edges of a mesh, if any. The mesh's counts of covered and drawn pixels include those of its edges.
    pub edges: Option<EdgeStats>,
}

impl Frame<'_> {
    /// Computes the constants of this frame, and checks all of its objects.
    ///
    /// # Errors
    /// As [`FrameConstants::update`] and [`FrameConstants::check_meshes`].
    pub fn constants(&self) -> Result<FrameConstants, RenderError> {
        let mut constants = FrameConstants::default();
        constants.update(self)?;
        constants.check_meshes(self)?;
        Ok(constants)
    }

    /// Number of vertices that the scratch memory of [`draw`](Self::draw) must hold.
    pub fn scratch_vertices(&self) -> usize {
        let meshes = self.subject.meshes();
        let chunks = meshes.map(|subject| subject.mesh.largest_chunk());
        chunks.max().unwrap_or(0)
    }

    /// The mesh with this number, with its options and frame constants; `None` after the last mesh.
    fn part<'s>(
        &'s self,
        constants: &'s FrameConstants,
        number: usize,
    ) -> Option<PreparedMesh<'s>> {
        let (subject, options) = self.numbered_mesh(number, constants.light())?;
        Some(PreparedMesh {
            mesh: subject.mesh,
            frame: constants.numbered_mesh(self, number).ok()??,
            options,
        })
    }

    /// Makes the triangles of all meshes of the frame from the frame's `constants`, in drawing order, and calls `emit` with each triangle
    /// and its setup. `scratch` is memory for projected vertices. The pixel counts in the result are 0.
    ///
    /// # Errors
    /// [`RenderError`] for scratch memory that is too small.
    pub fn set_up_meshes(
        &self,
        constants: &FrameConstants,
        scratch: &mut [Projected],
        emit: &mut Emit,
    ) -> Result<Stats, RenderError> {
        let Some(setup) = constants.mesh() else {
            return Ok(Stats::default());
        };
        let mut part = |number| self.part(constants, number);
        let size = (setup.width, setup.height);
        set_up_parts(&mut part, size, scratch, emit)
    }

    /// Draws the samples of the frame's [window](Self::window) into `buffer` from the frame's `constants`, with `scratch` as memory for
    /// projected vertices. Sets the buffer's rounding. Does not draw the edges of [`Subject::Edges`] and the rectangles in front of them,
    /// which [`draw_edges`](Self::draw_edges) draws. Calls `progress` at short intervals.
    ///
    /// # Errors
    /// [`RenderError`] for a buffer or scratch memory of the wrong size.
    pub fn draw(
        &self,
        constants: &FrameConstants,
        buffer: &mut FrameBuffer,
        scratch: &mut [Projected],
        progress: &mut dyn FnMut(),
    ) -> Result<FrameStats, RenderError> {
        let mut stats = FrameStats::default();
        buffer.rounding = self.rounding;
        if WIREFRAME.is_built
            && let Subject::Wireframe(subject) = &self.subject
        {
            let (window, samples) = (self.window(), self.drawn_samples());
            stats.wireframe = Some(render_wireframe(
                subject, self.clear, window, samples, buffer, progress,
            )?);
        }
        // A field covers every pixel. Meshes are drawn after the field, so that their blended textures can be in front of the field.
        let field = constants.field();
        if let Some(FieldConstants { setup, palette }) = field {
            buffer.depth.fill(0);
            let mut show = |x, _, _: &RayEnd| {
                if x % PIXELS_PER_CALL == 0 {
                    progress();
                }
            };
            stats.field = Some(render_field(setup, palette, buffer, &mut show)?);
        }
        if let Some(sky) = constants.sky() {
            sky.fill(self.drawn_samples(), buffer, progress)?;
        }
        if constants.mesh().is_some() {
            let mut part = |number| self.part(constants, number);
            let mut show = |triangle: &DrawnTriangle| {
                if triangle.index.is_multiple_of(TRIANGLES_PER_CALL) {
                    progress();
                }
            };
            let is_clear = field.is_none() && constants.sky().is_none();
            let clear = is_clear.then_some(self.clear.0);
            stats.mesh = Some(draw_parts(
                &mut part,
                clear,
                constants.fog(),
                buffer,
                scratch,
                &mut show,
            )?);
        }
        if !matches!(self.subject, Subject::Edges(..)) {
            self.draw_rectangles(buffer, progress, &mut stats);
        }
        Ok(stats)
    }
}
