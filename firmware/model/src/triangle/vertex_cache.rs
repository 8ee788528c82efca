//! The engine's cache of processed vertices, which determines how often the engine fetches the vertices of a mesh.

use glint_core::mesh::Mesh;

/// Number of vertices in the cache.
pub const SLOTS: usize = 512;

/// The tags of the cache. The cache is direct-mapped: the slot of a vertex is its index modulo [`SLOTS`], and a new vertex replaces the
/// vertex in its slot.
#[derive(Clone, Debug)]
pub struct VertexCache {
    slots: [Option<u16>; SLOTS],
}

impl VertexCache {
    /// The empty cache, as at the start of a chunk.
    pub const fn empty() -> Self {
        Self {
            slots: [None; SLOTS],
        }
    }

    /// Looks up a vertex by its index in the chunk, and adds the vertex to the cache. Returns whether the engine must fetch the vertex.
    pub fn misses(&mut self, index: u16) -> bool {
        let slot = self.slots.get_mut(usize::from(index) % SLOTS);
        slot.is_none_or(|slot| slot.replace(index) != Some(index))
    }
}

/// Counts the vertices that the engine fetches for a mesh: at least one fetch for each vertex that a triangle uses, at most one for
/// each corner of a triangle.
pub fn fetches(mesh: &Mesh) -> u32 {
    let mut count = 0;
    for chunk in mesh.chunks() {
        let mut cache = VertexCache::empty();
        for triangle in chunk.triangles() {
            for index in triangle.indices {
                count += u32::from(cache.misses(index));
            }
        }
    }
    count
}
