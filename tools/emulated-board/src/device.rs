//! The interface between the bus and a block of the SoC.

use crate::MainMemory;

/// A block of the SoC with its register window.
///
/// `now` is the number of clock cycles since the start; it never decreases. The module `offset` of a block in `litex_pac`
/// contains the offsets of its registers, and its types describe the registers' fields. A read at an offset without a register returns 0,
/// and a write there has no effect.
pub trait Device {
    /// Reads the register at `offset` bytes from the block's first register.
    fn read(&mut self, offset: u32, now: u64) -> u32;

    /// Writes the register at `offset`. An engine reads and writes main memory `ram`.
    fn write(&mut self, offset: u32, value: u32, now: u64, ram: &mut MainMemory);

    /// Processes all events up to the cycle `now`. Returns the cycle of the next event, or `u64::MAX` if there is none.
    ///
    /// The bus calls this method before and after each access to the block, and at the cycle that the last call returned.
    fn advance(&mut self, _now: u64, _ram: &mut MainMemory) -> u64 {
        u64::MAX
    }

    /// Whether an enabled event is pending: the level of the block's interrupt line.
    fn interrupt(&self) -> bool {
        false
    }
}
