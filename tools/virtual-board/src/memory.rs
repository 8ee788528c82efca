//! The address range of main RAM.

use std::ops::Range;

use litex_pac::memories::MAIN_RAM;

use crate::Error;

/// Checks that `length` bytes at `address` are within main RAM, and returns their offset there.
pub(crate) fn main_ram_offset(address: u32, length: usize) -> Result<u32, Error> {
    let ram: Range<u32> = MAIN_RAM.base..MAIN_RAM.base + MAIN_RAM.size;
    let fits = ram.contains(&address) && length as u64 <= u64::from(ram.end - address);
    if fits || (length == 0 && address == ram.end) {
        Ok(address - ram.start)
    } else {
        Err(Error::Address {
            address,
            length,
            ram,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn main_ram_is_checked_to_the_last_byte() {
        let end = MAIN_RAM.base + MAIN_RAM.size;
        assert_eq!(
            main_ram_offset(MAIN_RAM.base, MAIN_RAM.size as usize).unwrap(),
            0
        );
        assert_eq!(main_ram_offset(end - 1, 1).unwrap(), MAIN_RAM.size - 1);
        assert!(main_ram_offset(end - 1, 2).is_err());
        assert!(main_ram_offset(MAIN_RAM.base - 1, 1).is_err());
        assert!(main_ram_offset(end, 1).is_err());
        assert!(main_ram_offset(u32::MAX, usize::MAX).is_err());
    }
}
