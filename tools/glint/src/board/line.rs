//! The serial line of a board, and direct access to its memory.

use super::error::BoardError;

/// A board behind its serial line.
pub trait Board {
    /// Sends bytes, and blocks until all are taken.
    ///
    /// # Errors
    /// The line is broken.
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError>;

    /// Appends received bytes. Without any it waits for the first, at most `wait_ms` milliseconds of the board's time.
    ///
    /// # Errors
    /// The line is broken.
    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError>;

    /// The board's time in milliseconds, the unit of all waits: a simulation may be slow.
    fn now_ms(&self) -> u64;

    /// Direct access to the board's main memory, where the board has it.
    fn memory(&mut self) -> Option<&mut dyn Memory> {
        None
    }
}

/// A board's main memory, by addresses of its CPU.
pub trait Memory {
    /// Reads bytes.
    ///
    /// # Errors
    /// The range is not in main memory.
    fn read_memory(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), BoardError>;

    /// Writes bytes.
    ///
    /// # Errors
    /// The range is not in main memory.
    fn write_memory(&mut self, address: u32, bytes: &[u8]) -> Result<(), BoardError>;
}
