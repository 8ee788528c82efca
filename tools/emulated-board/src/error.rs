//! Errors of the emulated board.

use litex_pac::memories::MAIN_RAM;

/// An error of an emulated board.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// An access of the host is not within main memory.
    #[error(
        "memory access of {length} bytes at {address:#010x}: expected a range within {:#010x}..{:#010x}",
        MAIN_RAM.base, MAIN_RAM.base + MAIN_RAM.size
    )]
    Address {
        /// Address of the first byte, as the CPU sees it.
        address: u32,
        /// Number of bytes of the access.
        length: usize,
    },
    /// The frame on the monitor has an unexpected width.
    #[error("frame on the monitor: expected {expected} pixels in a line, found {found}")]
    FrameWidth {
        /// Expected number of pixels in a line.
        expected: usize,
        /// Number of pixels in a line of the frame.
        found: usize,
    },
}
