//! Clipping of exceptions: triangles that the gateware does not clip itself, but reports to the firmware.

use glint_core::mesh::Mesh;

use crate::triangle::mesh_setup::MeshSetup;
use crate::triangle::primitive::Options;
use crate::triangle::render::{Emit, Renderer};

/// Clips the gateware's exceptions, which have the indices `numbers` in the mesh. Calls `emit` with every part inside the volume, and
/// returns the number of exceptions with such a part.
///
/// Ascending indices, the gateware's order, are the fastest. Indices beyond the mesh are ignored.
pub fn clip_exceptions(
    mesh: &Mesh,
    frame: &MeshSetup,
    options: &Options,
    numbers: &mut dyn Iterator<Item = u32>,
    emit: &mut Emit,
) -> u32 {
    let mut renderer = Renderer::new(mesh, frame, options, emit);
    let mut chunks = mesh.chunks();
    // Indices of the first triangle and of the first vertex of the chunk, in the mesh.
    let (mut chunk, mut first, mut vertex) = (chunks.next(), 0, 0);
    let mut drawn = 0;
    for number in numbers {
        if number < first {
            chunks = mesh.chunks();
            (chunk, first, vertex) = (chunks.next(), 0, 0);
        }
        while let Some(passed) = &chunk
            && number - first >= passed.triangle_count() as u32
        {
            first += passed.triangle_count() as u32;
            vertex += passed.vertex_count();
            chunk = chunks.next();
        }
        let Some(chunk) = &chunk else { continue };
        let Some(triangle) = chunk.triangle((number - first) as usize) else {
            continue;
        };
        drawn += u32::from(renderer.clip(number, &triangle, chunk, vertex));
    }
    drawn
}
