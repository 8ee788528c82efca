//! Arenas: memory divided into regions for uploads, or for copies of meshes. The largest gap between the regions of uploads is the staging
//! memory.

use core::ops::Range;
use core::ptr;
use core::slice;

use glint_core::allocator::{Allocator, Region};
use glint_core::object::MAX_OBJECTS;

/// Largest number of uploads: one mesh for each object, one replacement texture, and one wireframe program.
pub const MAX_UPLOADS: usize = MAX_OBJECTS + 2;
/// Largest number of regions: the uploads, and a new upload that will replace another upload.
const UPLOADS: usize = MAX_UPLOADS + 1;

/// Memory that a task fills or sends over several turns. No other reference to the memory exists until the task gives it back.
pub struct Loan {
    bytes: &'static mut [u8],
    /// The range of `bytes` that is used.
    part: Range<usize>,
    /// The region in the arena that lent the memory; `NONE` for memory outside of arenas.
    region: Region,
}

impl Default for Loan {
    /// A loan of no memory.
    fn default() -> Self {
        Self::new(&mut [])
    }
}

impl Loan {
    /// A loan of memory outside of arenas.
    pub const fn new(bytes: &'static mut [u8]) -> Self {
        Self {
            part: 0..bytes.len(),
            bytes,
            region: Region::NONE,
        }
    }

    /// Whether the memory belongs to an arena.
    pub fn is_of_arena(&self) -> bool {
        self.region != Region::NONE
    }

    /// Restricts the loan to this part of its bytes, or to nothing if the part is out of range.
    pub const fn narrow(&mut self, part: Range<usize>) {
        self.part = part;
    }
}

impl AsRef<[u8]> for Loan {
    fn as_ref(&self) -> &[u8] {
        self.bytes.get(self.part.clone()).unwrap_or_default()
    }
}

impl AsMut<[u8]> for Loan {
    fn as_mut(&mut self) -> &mut [u8] {
        self.bytes.get_mut(self.part.clone()).unwrap_or_default()
    }
}

/// Memory that is divided into regions.
pub struct Arena {
    memory: *mut [u8],
    allocator: Allocator<UPLOADS>,
    /// Number of regions that are lent. While it is above 0, no region is moved.
    lent: usize,
}

impl Arena {
    /// An arena without regions in `memory`, aligned to 16 bytes.
    pub const fn new(memory: &'static mut [u8]) -> Self {
        Self {
            allocator: Allocator::new(memory.len()),
            memory: ptr::from_mut(memory),
            lent: 0,
        }
    }

    /// Number of regions that are lent.
    pub const fn lent(&self) -> usize {
        self.lent
    }

    /// Number of bytes that belong to no region.
    pub fn free(&self) -> usize {
        self.allocator.free()
    }

    /// The largest gap, which is separate from all regions.
    pub fn staging(&mut self) -> &mut [u8] {
        let gap = self.allocator.gap();
        // SAFETY: the gap is in the memory, which `new` borrowed for `'static`, and overlaps no region. The result borrows the arena
        // mutably, so that no region is made of the gap and no other mutable reference to it exists.
        unsafe { slice::from_raw_parts_mut(self.memory.cast::<u8>().add(gap.start), gap.len()) }
    }

    /// Makes a region of the first `length` bytes of [`staging`](Self::staging). `None` if there are fewer bytes, or if there are too
    /// many regions.
    pub fn allocate(&mut self, length: usize) -> Option<Region> {
        self.allocator.allocate(length)
    }

    /// Lends the first `length` bytes of [`staging`](Self::staging), with their contents, until [`keep_lent`](Self::keep_lent) or
    /// [`give_back`](Self::give_back) is called. `None` in the same cases as [`allocate`](Self::allocate).
    pub fn lend(&mut self, length: usize) -> Option<Loan> {
        let region = self.allocate(length)?;
        let start = self.allocator.range(region).start;
        self.lent += 1;
        // SAFETY: the region has at least `length` bytes of the memory, which `new` borrowed for `'static`. Only the loan has the region's
        // number, so no other reference to its bytes is made before the loan ends. The region overlaps no other region, and is not moved,
        // because `compact` moves nothing while a region is lent.
        let bytes =
            unsafe { slice::from_raw_parts_mut(self.memory.cast::<u8>().add(start), length) };
        Some(Loan {
            region,
            ..Loan::new(bytes)
        })
    }

    /// Ends a loan of this arena and returns its region.
    pub fn keep_lent(&mut self, loan: Loan) -> Region {
        self.lent -= usize::from(loan.is_of_arena());
        loan.region
    }

    /// Ends a loan of this arena and frees its region. The contents are unchanged.
    pub fn give_back(&mut self, loan: Loan) {
        let region = self.keep_lent(loan);
        self.release(region);
    }

    /// The first `length` bytes of a region; empty if the region is shorter.
    pub fn bytes(&self, region: Region, length: usize) -> &[u8] {
        let range = self.allocator.range(region);
        let length = if length > range.len() { 0 } else { length };
        // SAFETY: the region is in the memory, and is only written by `compact`, which borrows the arena mutably.
        unsafe { slice::from_raw_parts(self.memory.cast::<u8>().add(range.start), length) }
    }

    /// Frees a region. Its bytes become part of a gap.
    pub fn release(&mut self, region: Region) {
        self.allocator.release(region);
    }

    /// Moves all regions so that one gap remains; does nothing while a region is lent.
    pub fn compact(&mut self) {
        if self.lent > 0 {
            return;
        }
        let memory = self.memory.cast::<u8>();
        self.allocator.compact(|from, to| {
            // SAFETY: both ranges are in the memory, and the target overlaps no region except the moved one. This method borrows the arena
            // mutably, and no region is lent.
            unsafe { ptr::copy(memory.add(from.start), memory.add(to), from.len()) };
        });
    }
}
