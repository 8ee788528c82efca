//! The walk over the chunks of a mesh in memory, whose content may be anything.

use std::ops::Range;

use glint_core::mesh::ChunkHeader;

use super::region::record;
use crate::MainMemory;

/// Most vertices and triangles of a chunk.
const MOST: u32 = (1 << 24) - 1;

/// A walk over chunks.
pub struct Walk {
    /// Number of the word of the next chunk's header.
    header: u64,
    /// Number of the first word after the mesh.
    past: u64,
    has_begun: bool,
    /// Whether the walk has met a chunk without vertices or beyond the mesh's end, and has ended there.
    pub is_damaged: bool,
    /// Number of words read.
    pub words: u32,
}

/// A chunk, by the numbers of its words of memory.
pub struct Chunk {
    /// The first vertex.
    pub vertices: u32,
    /// The triangles.
    pub triangles: Range<u32>,
}

impl Walk {
    /// A walk from the word `first` to the word before `past`.
    pub fn new(first: u32, past: u64) -> Self {
        Self {
            header: first.into(),
            past,
            has_begun: false,
            is_damaged: false,
            words: 0,
        }
    }

    /// The next chunk; `None` after the last one. A mesh has at least one.
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
        Some(Chunk {
            vertices: first as u32,
            // The end is in main memory, whose addresses have 32 bits.
            triangles: base as u32..end as u32,
        })
    }
}
