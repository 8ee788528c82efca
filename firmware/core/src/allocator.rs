//! Allocation of regions of any length in a memory, with gaps between the regions.

use core::ops::Range;

/// Alignment of the start of regions, in bytes: the width of a memory word.
pub const ALIGNMENT: usize = 16;

/// The number of a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region(usize);

impl Region {
    /// A region without memory.
    pub const NONE: Self = Self(usize::MAX);
}

/// A memory of a certain length, with at most `N` regions.
#[derive(Clone, Debug)]
pub struct Allocator<const N: usize> {
    length: usize,
    /// The range of each region; an entry with an empty range is free.
    ranges: [Range<usize>; N],
}

impl<const N: usize> Allocator<N> {
    /// A memory without regions.
    pub const fn new(length: usize) -> Self {
        Self {
            length,
            ranges: [const { 0..0 }; N],
        }
    }

    /// Number of bytes in all gaps.
    pub fn free(&self) -> usize {
        let used: usize = self.used().map(Range::len).sum();
        self.length - used
    }

    /// The largest gap; of equal gaps the first.
    pub fn gap(&self) -> Range<usize> {
        let next = |start: usize| {
            let later = self.used().filter(|range| range.start >= start);
            let starts = later.map(|range| range.start);
            starts.min().unwrap_or(self.length)
        };
        let starts = self.used().map(|range| range.end).chain([0]);
        starts
            .map(|start| start..next(start))
            .max_by_key(|gap| (gap.len(), self.length - gap.start))
            .unwrap_or(0..0)
    }

    /// Allocates a region of `length` bytes, rounded up to [`ALIGNMENT`], at the start of the largest gap. `None` if the gap is
    /// shorter, or if `N` regions exist.
    pub fn allocate(&mut self, length: usize) -> Option<Region> {
        let gap = self.gap();
        let length = length.max(1).checked_next_multiple_of(ALIGNMENT)?;
        let number = self.ranges.iter().position(Range::is_empty)?;
        let range = self.ranges.get_mut(number)?;
        (length <= gap.len()).then(|| {
            *range = gap.start..gap.start + length;
            Region(number)
        })
    }

    /// The range of a region.
    pub fn range(&self, Region(number): Region) -> Range<usize> {
        self.ranges.get(number).cloned().unwrap_or_default()
    }

    /// Frees a region.
    pub fn release(&mut self, Region(number): Region) {
        if let Some(range) = self.ranges.get_mut(number) {
            *range = 0..0;
        }
    }

    /// Moves all regions to the start of the memory in their order, so that one gap remains. Calls `copy(range, to)` for each
    /// region that moves, in the order of their addresses; `to` is the new position of the region's first byte. `to` is below
    /// `range.start` and not below the end of any region already moved.
    pub fn compact(&mut self, mut copy: impl FnMut(Range<usize>, usize)) {
        let mut end = 0;
        let later = |range: &&mut Range<usize>, end| range.start < range.end && range.start >= end;
        while let Some(range) = (self.ranges.iter_mut())
            .filter(|range| later(range, end))
            .min_by_key(|range| range.start)
        {
            let length = range.len();
            if range.start > end {
                copy(range.clone(), end);
            }
            *range = end..end + length;
            end += length;
        }
    }

    fn used(&self) -> impl Iterator<Item = &Range<usize>> {
        self.ranges.iter().filter(|range| range.start < range.end)
    }
}
