//! Iterator over the chunks of a mesh in memory. The iterator checks the chunks, because memory may contain arbitrary data.

use std::ops::Range;

use glint_core::mesh::ChunkHeader;

use super::region::record;
use crate::MainMemory;

/// Maximum number of vertices, and of triangles, of a chunk.
const MOST: u32 = (1 << 24) - 1;

/// An iterator over chunks.
pub struct Walk {
    /// Index of the word with the next chunk's header.
    header: u64,
    /// Index of the first word after the mesh.
    past: u64,
    has_begun: bool,
    /// Number of vertices of the previous chunks.
    vertices: u32,
    /// Whether the iterator has stopped at a chunk that has no vertices, has more than [`MOST`] vertices or triangles, or extends
    /// beyond the mesh's end.
    pub is_damaged: bool,
    /// Number of words read.
    pub words: u32,
}

/// A chunk, by the indices of its memory words.
pub struct Chunk {
    /// Number in the mesh of the first vertex.
    pub first: u32,
    /// Index of the memory word with the first vertex.
    pub vertices: u32,
    /// Indices of the memory words with the triangles.
    pub triangles: Range<u32>,
}

impl Walk {
    /// An iterator from the word `first` to the word before `past`.
    pub fn new(first: u32, past: u64) -> Self {
        Self {
            header: first.into(),
            past,
            has_begun: false,
            vertices: 0,
            is_damaged: false,
            words: 0,
        }
    }

    /// The next chunk; `None` after the last chunk and at a damaged chunk. A mesh has at least one chunk.
    pub fn chunk(&mut self, ram: &MainMemory) -> Option<Chunk> {
        if self.is_damaged || self.has_begun && self.header >= self.past {
            return None;
        }
        self.has_begun = true;
        let ChunkHeader {
            vertices,
            triangles,
        } = ChunkHeader::from_bytes(&record(ram, self.header as u32));
        let first = self.header + 1;
        let base = first + u64::from(vertices);
        let end = base + u64::from(triangles);
        self.words += 1;
        self.is_damaged = vertices == 0 || vertices > MOST || triangles > MOST || end > self.past;
        if self.is_damaged {
            return None;
        }
        self.header = end;
        self.words = self.words.wrapping_add(triangles);
        let before = self.vertices;
        self.vertices = before.wrapping_add(vertices);
        Some(Chunk {
            first: before,
            vertices: first as u32,
            // The end is within main memory, so it fits 32 bits.
            triangles: base as u32..end as u32,
        })
    }
}
