//! Copies of meshes with transformed normals, for objects whose matrix changes normals.

use super::{Mesh, MeshHeader, Triangle, Vertex};

impl Mesh<'_> {
    /// Copies the mesh to the start of `memory`, and replaces each normal by the result of `turn`. `None` if `memory` is
    /// shorter than the mesh.
    pub fn copy_with_normals<'m>(
        &self,
        memory: &'m mut [u8],
        turn: &mut dyn FnMut([i16; 3]) -> [i16; 3],
    ) -> Option<Mesh<'m>> {
        let memory = memory.get_mut(..self.bytes.len())?;
        memory.copy_from_slice(self.bytes);
        let records = memory.get_mut(MeshHeader::BYTES..)?.as_chunks_mut().0;
        let mut records = records.iter_mut();
        for chunk in self.chunks() {
            // The chunk's header.
            records.next();
            for record in records.by_ref().take(chunk.vertex_count()) {
                let mut vertex = Vertex::from_bytes(record);
                vertex.normal = turn(vertex.normal);
                *record = vertex.to_bytes();
            }
            for record in records.by_ref().take(chunk.triangle_count()) {
                let mut triangle = Triangle::from_bytes(record);
                triangle.normal = turn(triangle.normal);
                *record = triangle.to_bytes();
            }
        }
        let bytes: &[u8] = memory;
        let words = bytes.get(MeshHeader::BYTES..)?.as_chunks().0;
        let (records, rest) = words.split_at_checked(self.records.len())?;
        let (arrays, textures) = rest.split_at_checked(self.arrays.len())?;
        Some(Mesh {
            bytes,
            records,
            arrays,
            textures,
            ..*self
        })
    }
}
