//! Main memory.

use litex_pac::memories::MAIN_RAM;

/// Main memory, which the CPU and the engines share. Addresses are CPU addresses; numbers are little-endian.
pub struct MainMemory {
    bytes: Vec<u8>,
}

impl Default for MainMemory {
    fn default() -> Self {
        Self::new()
    }
}

impl MainMemory {
    /// Main memory that is all 0.
    #[must_use]
    pub fn new() -> Self {
        Self {
            bytes: vec![0; MAIN_RAM.size as usize],
        }
    }

    /// The `length` bytes at `address`; `None` if they are not within main memory.
    #[must_use]
    #[inline]
    pub fn bytes(&self, address: u32, length: usize) -> Option<&[u8]> {
        let offset = address.wrapping_sub(MAIN_RAM.base) as usize;
        self.bytes.get(offset..)?.get(..length)
    }

    /// The `length` bytes at `address` for writing; `None` if they are not within main memory.
    #[must_use]
    #[inline]
    pub fn bytes_mut(&mut self, address: u32, length: usize) -> Option<&mut [u8]> {
        let offset = address.wrapping_sub(MAIN_RAM.base) as usize;
        self.bytes.get_mut(offset..)?.get_mut(..length)
    }

    /// The `N` bytes at `address`; `None` if they are not within main memory.
    #[must_use]
    #[inline]
    pub fn array<const N: usize>(&self, address: u32) -> Option<[u8; N]> {
        let offset = address.wrapping_sub(MAIN_RAM.base) as usize;
        self.bytes.get(offset..)?.first_chunk().copied()
    }

    /// Writes bytes from `address` on. If not all of these bytes are within main memory, nothing is written and the result is `None`.
    #[must_use]
    #[inline]
    pub fn set_array<const N: usize>(&mut self, address: u32, bytes: [u8; N]) -> Option<()> {
        let offset = address.wrapping_sub(MAIN_RAM.base) as usize;
        *self.bytes.get_mut(offset..)?.first_chunk_mut()? = bytes;
        Some(())
    }

    /// The byte at `address`; `None` outside main memory.
    #[must_use]
    #[inline]
    pub fn byte(&self, address: u32) -> Option<u8> {
        self.array(address).map(u8::from_le_bytes)
    }

    /// The 32-bit word at `address`; `None` outside main memory.
    #[must_use]
    #[inline]
    pub fn word(&self, address: u32) -> Option<u32> {
        self.array(address).map(u32::from_le_bytes)
    }

    /// Writes the 32-bit word at `address`; returns `None` if it is outside main memory.
    #[must_use]
    #[inline]
    pub fn set_word(&mut self, address: u32, value: u32) -> Option<()> {
        self.set_array(address, value.to_le_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accesses_are_checked_to_the_last_byte() {
        let mut ram = MainMemory::new();
        let last = MAIN_RAM.base + MAIN_RAM.size - 4;
        assert_eq!(ram.set_word(last, 0x0403_0201), Some(()));
        assert_eq!(ram.bytes(last, 4), Some(&[1, 2, 3, 4][..]));
        assert_eq!(ram.byte(last + 3), Some(4));
        assert_eq!(ram.set_word(last + 1, 0), None);
        assert_eq!(ram.word(last + 1), None);
        assert_eq!(ram.bytes(last, 5), None);
        assert_eq!(ram.bytes_mut(MAIN_RAM.base - 1, 1), None);
        assert_eq!(ram.word(last), Some(0x0403_0201));
        assert_eq!(ram.byte(u32::MAX), None);
    }
}
