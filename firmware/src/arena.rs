//! Memory for uploads, or for copies of meshes, side by side. The largest gap between uploads is the staging memory.

use core::ptr;
use core::slice;

use glint_core::regions::{Region, Regions};

/// Largest number of uploads: the meshes, a program, and one that replaces another.
const UPLOADS: usize = 18;

/// Memory that is divided into regions.
pub struct Arena {
    memory: *mut [u8],
    regions: Regions<UPLOADS>,
}

impl Arena {
    /// An arena without regions in `memory`, aligned to 16 bytes.
    pub const fn new(memory: &'static mut [u8]) -> Self {
        Self {
            regions: Regions::new(memory.len()),
            memory: ptr::from_mut(memory),
        }
    }

    /// Number of bytes without a region.
    pub fn free(&self) -> usize {
        self.regions.free()
    }

    /// The largest gap, which is separate from all regions.
    pub fn staging(&mut self) -> &mut [u8] {
        let gap = self.regions.gap();
        // SAFETY: the gap is in the memory, which `new` took for good, and apart from all regions. The result borrows the arena, so
        // that meanwhile no region is made of the gap and nothing else is lent for writing.
        unsafe { slice::from_raw_parts_mut(self.memory.cast::<u8>().add(gap.start), gap.len()) }
    }

    /// Makes a region of the first `length` bytes of [`staging`](Self::staging). `None` if there are fewer bytes, or if there are too
    /// many regions.
    pub fn keep(&mut self, length: usize) -> Option<Region> {
        self.regions.keep(length)
    }

    /// The first `length` bytes of a region; nothing if it is shorter.
    pub fn bytes(&self, region: Region, length: usize) -> &[u8] {
        let range = self.regions.range(region);
        let length = if length > range.len() { 0 } else { length };
        // SAFETY: the region is in the memory, and is written by `close_gaps` only, which borrows the arena for writing.
        unsafe { slice::from_raw_parts(self.memory.cast::<u8>().add(range.start), length) }
    }

    /// Makes a region part of the gaps.
    pub fn release(&mut self, region: Region) {
        self.regions.release(region);
    }

    /// Moves all regions together, so that one gap remains.
    pub fn close_gaps(&mut self) {
        let memory = self.memory.cast::<u8>();
        self.regions.close_gaps(|from, to| {
            // SAFETY: both ranges are in the memory, and the second one reaches no region but the moved one. This method borrows
            // the arena for writing, so nothing is lent.
            unsafe { ptr::copy(memory.add(from.start), memory.add(to), from.len()) };
        });
    }
}
