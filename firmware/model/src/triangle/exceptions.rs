//! Clipping of exceptions: triangles that the gateware does not clip, but reports to the firmware.

use glint_core::mesh::{Mesh, Rgb565};

use crate::triangle::mesh_setup::MeshSetup;
use crate::triangle::primitive::{Options, Placed, clip_fan, lit_corners};
use crate::triangle::setup::Setup;

/// Clips the gateware's exceptions, given by their `numbers` in the mesh. Emits setup and colour of every part inside the volume, and
/// returns the number of exceptions with such a part.
///
/// Numbers in ascending order, the gateware's order, are fastest. Numbers beyond the mesh are ignored.
pub fn clip_exceptions(
    mesh: &Mesh,
    frame: &MeshSetup,
    options: &Options,
    numbers: &mut dyn Iterator<Item = u32>,
    emit: &mut dyn FnMut(&Setup, Rgb565),
) -> u32 {
    let mut chunks = mesh.chunks();
    let (mut chunk, mut first) = (chunks.next(), 0);
    let mut drawn = 0;
    for number in numbers {
        if number < first {
            chunks = mesh.chunks();
            (chunk, first) = (chunks.next(), 0);
        }
        while let Some(passed) = &chunk
            && number - first >= passed.triangle_count() as u32
        {
            first += passed.triangle_count() as u32;
            chunk = chunks.next();
        }
        let Some(chunk) = &chunk else { continue };
        let Some(triangle) = chunk.triangle((number - first) as usize) else {
            continue;
        };
        let mut any = false;
        clip_fan(frame, options, &triangle, chunk, &mut |corners| {
            let light = lit_corners(options.shading, corners);
            let vertices = corners.map(|corner| &corner.place);
            if let Some(placed) = Placed::new(frame, options, &triangle, vertices, light.as_ref()) {
                emit(&placed.setup(), placed.colour);
                any = true;
            }
        });
        drawn += u32::from(any);
    }
    drawn
}
