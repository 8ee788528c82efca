//! Memory regions of a pass: checks them before the pass, and reads 16-byte words from them.

use glint_core::picture::Size;
use glint_model::triangle::descriptor::list_word;
use litex_pac::memories::MAIN_RAM;
use litex_pac::triangle::{Error, Size as SizeCode};

use crate::MainMemory;

/// Width in bits of the counters of descriptors and entries.
pub const COUNT_BITS: u32 = 20;

/// Largest valid `list_shift`: longer lists exceed the counter of entries.
const LAST_SHIFT: u32 = COUNT_BITS - 3;

/// Size of a memory word in bytes.
pub const WORD: u32 = 16;

/// The picture size for a register code; `None` for an invalid code.
pub fn picture_size(code: Option<SizeCode>) -> Option<Size> {
    Some(match code? {
        SizeCode::W320 => Size::W320,
        SizeCode::W640 => Size::W640,
        SizeCode::W1280 => Size::W1280,
    })
}

/// The result of the checks of a pass's regions.
#[derive(Default)]
pub struct Regions {
    is_misplaced: bool,
}

impl Regions {
    /// Checks that a region of `words` words from `address` on is aligned to a word and within main memory.
    pub fn check(&mut self, address: u32, words: u64) {
        let place = address.wrapping_sub(MAIN_RAM.base);
        let left = MAIN_RAM.size.saturating_sub(place) / WORD;
        self.is_misplaced |= !address.is_multiple_of(WORD) || left == 0 || words > u64::from(left);
    }

    /// # Errors
    /// [`Error::Address`] if a region was not aligned, or not within main memory.
    pub const fn result(&self) -> Result<(), Error> {
        if self.is_misplaced {
            Err(Error::Address)
        } else {
            Ok(())
        }
    }
}

/// Number of words of the table of lengths and all lists of a set; for an invalid `list_shift`, a number that exceeds every memory.
pub fn list_words(size: Size, list_shift: u32) -> u64 {
    if list_shift > LAST_SHIFT {
        u64::MAX
    } else {
        list_word(size.bands(), list_shift).into()
    }
}

/// The memory word with the index `number`, its address divided by 16. Bits of the index that exceed main memory are ignored.
pub fn record(ram: &MainMemory, number: u32) -> [u8; WORD as usize] {
    const _: () = assert!(MAIN_RAM.size.is_power_of_two());
    let place = number.wrapping_mul(WORD) & (MAIN_RAM.size - 1);
    ram.array(MAIN_RAM.base + place).unwrap_or_default()
}

/// The 32-bit entry `number` of a list that begins at the memory word `first`.
pub fn entry(ram: &MainMemory, first: u32, number: u32) -> u32 {
    let record = record(ram, first.wrapping_add(number / 4));
    let place = number as usize % 4;
    record
        .as_chunks()
        .0
        .get(place)
        .map_or(0, |bytes| u32::from_le_bytes(*bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_in_main_memory() {
        let end = MAIN_RAM.base + MAIN_RAM.size;
        for (address, words, expected) in [
            (MAIN_RAM.base, u64::from(MAIN_RAM.size / WORD), Ok(())),
            (
                MAIN_RAM.base,
                u64::from(MAIN_RAM.size / WORD) + 1,
                Err(Error::Address),
            ),
            (end - WORD, 1, Ok(())),
            (end - WORD, 2, Err(Error::Address)),
            (end - WORD, u64::MAX, Err(Error::Address)),
            (end, 0, Err(Error::Address)),
            (MAIN_RAM.base - WORD, 1, Err(Error::Address)),
            (MAIN_RAM.base + 4, 1, Err(Error::Address)),
            (0, 0, Err(Error::Address)),
        ] {
            let mut regions = Regions::default();
            regions.check(address, words);
            assert_eq!(regions.result(), expected, "{address:#x}, {words}");
        }
    }

    #[test]
    fn numbers_of_words_wrap() {
        let mut ram = MainMemory::new();
        ram.set_word(MAIN_RAM.base + 24, 7).unwrap();
        assert_eq!(entry(&ram, MAIN_RAM.base / WORD, 6), 7);
        assert_eq!(entry(&ram, 0, 6), 7);
        assert_eq!(entry(&ram, u32::MAX, 10), 7);
    }
}
