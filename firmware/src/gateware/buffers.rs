//! Memory that the geometry pass of a frame writes and the raster pass reads.

use core::mem;

use glint_core::colour::Shading;
use glint_hal::triangle::{Lists, Set};
use glint_model::Stats;
use glint_model::triangle::descriptor;

/// Largest number of exceptions (triangles that need clipping) of a frame, and of descriptors without smooth shading in a set.
/// The CPU draws frames that need more.
const DESCRIPTORS: usize = 1 << 16;
/// Number of 32-bit words for the descriptors of a set. A descriptor with smooth shading is twice as long as one without,
/// so there is room for half as many of them.
const DESCRIPTOR_WORDS: usize = DESCRIPTORS * descriptor::words(Shading::Flat);

/// Memory of one frame: two sets of descriptors and band lists, and the list of exceptions.
pub struct Buffers {
    descriptors: &'static mut [u32],
    lists: &'static mut [u32],
    /// Numbers of the exceptions: triangles that the geometry pass leaves to the clipper.
    pub exceptions: &'static mut [u32],
    /// Descriptors of clipped triangles.
    pub clipped_descriptors: &'static mut [u32],
    /// Band lists of clipped triangles.
    pub clipped_lists: &'static mut [u32],
    /// The sets of lists written by the geometry pass and by the clipper.
    pub sets: [Option<Set>; 2],
    /// Counts of triangles of the geometry pass and the clipper.
    pub stats: Stats,
}

impl Buffers {
    /// Splits the memory of a frame off `memory`; `None` if `memory` is too small.
    pub fn split_off(memory: &mut &'static mut [u32]) -> Option<Self> {
        let mut piece = |length| {
            let (piece, rest) = mem::take(memory).split_at_mut_checked(length)?;
            *memory = rest;
            Some(piece)
        };
        Some(Self {
            descriptors: piece(DESCRIPTOR_WORDS)?,
            lists: piece(descriptor::LIST_SET_WORDS)?,
            exceptions: piece(DESCRIPTORS)?,
            clipped_descriptors: piece(DESCRIPTOR_WORDS)?,
            clipped_lists: piece(descriptor::LIST_SET_WORDS)?,
            sets: [None; 2],
            stats: Stats::default(),
        })
    }

    /// The memory for the output of a geometry pass, on gateware whose best shading is `capability`.
    pub fn lists(&self, capability: Shading) -> Lists {
        Lists {
            descriptors: address(self.descriptors),
            descriptor_limit: (DESCRIPTOR_WORDS / descriptor::words(capability)) as u32,
            lists: address(self.lists),
        }
    }

    /// The set of lists that a geometry pass has written, with `count` descriptors.
    pub fn set(&self, count: u32) -> Set {
        Set {
            descriptors: address(self.descriptors),
            count,
            lists: address(self.lists),
        }
    }

    /// The set of lists of clipped triangles, with `count` descriptors.
    pub fn clipped_set(&self, count: u32) -> Set {
        Set {
            descriptors: address(self.clipped_descriptors),
            count,
            lists: address(self.clipped_lists),
        }
    }
}

/// The address by which the engine accesses a region of memory.
pub fn address<T>(memory: &[T]) -> u32 {
    memory.as_ptr().addr() as u32
}
