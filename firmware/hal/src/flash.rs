//! The SPI flash as memory that the CPU reads.

use core::slice;

use litex_pac::identity::Identity;
use litex_pac::memories::FLASH;

/// The bytes of the flash; `None` if the gateware has no block `flash`. `bit` is the bit of the block `flash` in
/// `identity.blocks`.
#[must_use]
pub fn bytes(identity: &Identity, bit: u32) -> Option<&'static [u8]> {
    // SAFETY: the window has this size at this address in every gateware with the block, and is read-only: nothing writes the flash
    // while the firmware runs.
    is_present(identity, bit).then(|| unsafe {
        slice::from_raw_parts(FLASH.base as usize as *const u8, FLASH.size as usize)
    })
}

fn is_present(identity: &Identity, bit: u32) -> bool {
    identity.blocks().read() & bit != 0
}

#[cfg(test)]
mod tests {
    use glint_core::block::Block;
    use litex_pac::Peripherals;
    use litex_pac::identity::offset::BLOCKS;

    use super::*;
    use litex_pac::recording;

    #[test]
    fn the_window_is_there_if_the_gateware_has_the_block() {
        const BIT: u32 = Block::Flash.bit();
        let address = Identity::BASE + BLOCKS as usize;
        for (blocks, expected) in [(!BIT, false), (BIT, true)] {
            recording::connect([(address, blocks)]);
            // SAFETY: a model on the bus answers all accesses, so no device is affected.
            let peripherals = unsafe { Peripherals::steal() };
            assert_eq!(is_present(&peripherals.identity, BIT), expected);
        }
    }
}
