//! Tests of the allocation of memory regions.

use glint_core::allocator::{ALIGNMENT, Allocator, Region};
use proptest::prelude::*;

const LENGTH: usize = 4096;

/// Regions with known content, in a memory of bytes.
struct Memory {
    regions: Allocator<6>,
    bytes: Vec<u8>,
    kept: Vec<(Region, Vec<u8>)>,
}

impl Memory {
    fn allocate(&mut self, content: Vec<u8>) {
        let gap = self.regions.gap();
        let fits = content.len().next_multiple_of(ALIGNMENT) <= gap.len() && self.kept.len() < 6;
        let region = self.regions.allocate(content.len());
        assert_eq!(region.is_some(), fits);
        let Some(region) = region else { return };
        let range = self.regions.range(region);
        assert_eq!((range.start, range.start % ALIGNMENT), (gap.start, 0));
        self.bytes[range][..content.len()].copy_from_slice(&content);
        self.kept.push((region, content));
    }

    /// Checks that all regions have their content, and that regions and the largest gap do not overlap.
    fn check(&self) {
        let mut ranges = vec![self.regions.gap()];
        for (region, content) in &self.kept {
            let range = self.regions.range(*region);
            assert_eq!(&self.bytes[range.clone()][..content.len()], content);
            ranges.push(range);
        }
        ranges.sort_by_key(|range| (range.start, range.end));
        assert!(ranges.is_sorted_by(|a, b| a.end <= b.start), "{ranges:?}");
        assert!(ranges.iter().all(|range| range.end <= LENGTH));
        let used: usize = ranges.iter().map(|range| range.len()).sum();
        assert_eq!(
            self.regions.free() - self.regions.gap().len(),
            LENGTH - used
        );
    }
}

proptest! {
    #[test]
    fn regions_keep_their_content(steps in proptest::collection::vec((0..4_u8, 1..1500_usize, any::<u8>()), 1..60)) {
        let mut memory = Memory {
            regions: Allocator::new(LENGTH),
            bytes: vec![0; LENGTH],
            kept: Vec::new(),
        };
        for (step, length, byte) in steps {
            match step {
                0 | 1 => memory.allocate((0..length).map(|i| byte.wrapping_add(i as u8)).collect()),
                2 if !memory.kept.is_empty() => {
                    let (region, _) = memory.kept.remove(length % memory.kept.len());
                    memory.regions.release(region);
                }
                _ => {
                    let Memory { regions, bytes, .. } = &mut memory;
                    regions.compact(|from, to| bytes.copy_within(from, to));
                    prop_assert_eq!(regions.gap().len(), regions.free());
                }
            }
            memory.check();
        }
    }
}
