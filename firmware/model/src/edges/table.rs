//! A hash table of edges in the caller's memory.

/// Number of words of an edge's key.
pub const KEY_WORDS: usize = 3;

/// Content of an empty slot.
const EMPTY: u32 = u32::MAX;

/// A set of edges, which are numbered in the order of their insertion.
pub struct Table<'m> {
    /// Hash slots with edge numbers, with linear probing: an edge is in the first free slot from the index of its hash on. The number of
    /// slots is a power of two.
    slots: &'m mut [u32],
    /// The keys of the edges, by edge number.
    keys: &'m mut [[u32; KEY_WORDS]],
    /// Number of edges in the table.
    count: usize,
}

impl<'m> Table<'m> {
    /// Number of slots for up to `most` edges: at most three quarters of the slots are in use, so that searches are short.
    const fn slots(most: usize) -> usize {
        (most + most / 3 + 1).next_power_of_two()
    }

    /// Number of words of memory for up to `most` edges.
    pub const fn words(most: usize) -> usize {
        4 * Self::slots(most)
    }

    /// An empty table in `memory` for up to `most` edges, or for fewer if `memory` is too small for `most`; `None` if no edge fits.
    pub fn new(memory: &'m mut [u32], most: usize) -> Option<Self> {
        let room = 1 << (memory.len() / 4).checked_ilog2()?;
        let (slots, keys) = memory.split_at_mut_checked(Self::slots(most).min(room))?;
        slots.fill(EMPTY);
        Some(Self {
            slots,
            keys: keys.as_chunks_mut().0,
            count: 0,
        })
    }

    /// Returns the number of edges in the table.
    pub const fn len(&self) -> usize {
        self.count
    }

    /// Finds an edge, or inserts it. Returns its number, and whether it was inserted; `None` if the table is full.
    pub fn insert(&mut self, key: [u32; KEY_WORDS]) -> Option<(u32, bool)> {
        // The hash of FxHasher: the multiplier is 2^32 divided by the golden ratio. The upper bits of the hash are mixed best.
        let hash = key.iter().fold(0u32, |hash, &word| {
            (hash.rotate_left(5) ^ word).wrapping_mul(0x9E37_79B9)
        });
        let mask = self.slots.len() - 1;
        let mut at = hash.rotate_left(16) as usize & mask;
        loop {
            let slot = self.slots.get_mut(at)?;
            if *slot == EMPTY {
                // One slot always remains empty, so that every search ends.
                let place = self.keys.get_mut(self.count);
                *place.filter(|_| self.count < mask)? = key;
                let number = self.count as u32;
                *slot = number;
                self.count += 1;
                return Some((number, true));
            }
            if self.keys.get(*slot as usize) == Some(&key) {
                return Some((*slot, false));
            }
            at = (at + 1) & mask;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Table;

    #[test]
    fn a_table_has_each_edge_once_until_it_is_full() {
        let mut memory = [7; 64];
        let mut table = Table::new(&mut memory, 1000).unwrap();
        // 16 slots, one of which remains empty, and memory for 16 edges.
        for number in 0..15 {
            let key = [number & 3, number >> 2, 5];
            assert_eq!(table.insert(key), Some((number, true)));
            assert_eq!(table.insert(key), Some((number, false)));
        }
        assert_eq!(table.insert([9, 9, 9]), None);
        assert_eq!(table.insert([2, 1, 5]), Some((6, false)));
        assert_eq!(table.len(), 15);
        assert!(Table::new(&mut [0; 3], 1).is_none());
    }
}
