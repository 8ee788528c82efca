//! Copies of meshes with other normals, for objects whose normals a matrix turns.

use super::{HEADER, Mesh, RECORD};

/// Offset of the normal in a vertex and in a triangle (docs/formats/mesh.md, "Mesh in memory").
const OF_VERTEX: usize = 6;
const OF_TRIANGLE: usize = 8;

impl Mesh<'_> {
    /// Copies the mesh to the start of `memory`, with the normals that `turn` returns for those of this mesh. `None` if `memory` is
    /// shorter than the mesh.
    pub fn copy_with_normals<'m>(
        &self,
        memory: &'m mut [u8],
        turn: &mut dyn FnMut([i16; 3]) -> [i16; 3],
    ) -> Option<Mesh<'m>> {
        let memory = memory.get_mut(..self.bytes.len())?;
        memory.copy_from_slice(self.bytes);
        let mut records = memory.get_mut(HEADER..)?.as_chunks_mut().0.iter_mut();
        for chunk in self.chunks() {
            // The chunk's header.
            records.next();
            for record in records.by_ref().take(chunk.vertex_count()) {
                replace(record, OF_VERTEX, turn);
            }
            for record in records.by_ref().take(chunk.triangle_count()) {
                replace(record, OF_TRIANGLE, turn);
            }
        }
        let bytes: &[u8] = memory;
        let records = bytes.get(HEADER..)?.as_chunks().0;
        Some(Mesh {
            bytes,
            records,
            vertices: self.vertices,
            triangles: self.triangles,
            radius: self.radius,
        })
    }
}

/// Replaces the normal at `offset` of a record.
fn replace(record: &mut [u8; RECORD], offset: usize, turn: &mut dyn FnMut([i16; 3]) -> [i16; 3]) {
    let halves = record.get_mut(offset..).unwrap_or_default();
    let Some([x, y, z]) = halves.as_chunks_mut().0.first_chunk_mut() else {
        return;
    };
    [*x, *y, *z] = turn([*x, *y, *z].map(i16::from_le_bytes)).map(i16::to_le_bytes);
}
