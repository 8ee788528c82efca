//! Errors of the virtual board.

use std::path::PathBuf;

use glint_board_api::built::NotBuilt;
use glint_testbench::LoadError;

/// An error of a virtual board.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The library has not been built.
    #[error(transparent)]
    NotBuilt(#[from] NotBuilt),
    /// The library does not exist.
    #[error("the virtual board's library {} is missing; run `{command}`", .path.display())]
    LibraryMissing {
        /// Path of the library.
        path: PathBuf,
        /// The command that builds the library.
        command: &'static str,
    },
    /// The library cannot be used.
    #[error("the virtual board's library {0}; run `cargo xtask gateware`")]
    Library(#[from] LoadError),
    /// The library's SoC has another register map.
    #[error(
        "the virtual board's build id is {found:#010x}: expected {expected:#010x}; \
         run `cargo xtask gateware` and `cargo xtask pac`"
    )]
    BuildId {
        /// Build id of the register access crate, `litex_pac`.
        expected: u32,
        /// Build id of the library.
        found: u32,
    },
    /// Waveforms cannot be written.
    #[error("waveforms to {}: cannot be written; expected an existing folder and a library of `cargo xtask gateware --waveforms`", .path.display())]
    Trace {
        /// Path of the file for the waveforms.
        path: PathBuf,
    },
    /// An access of the back door outside main RAM.
    #[error(
        "DDR3 access of {length} bytes at {address:#010x}: expected a range within {:#010x}..{:#010x}",
        .ram.start, .ram.end
    )]
    Address {
        /// Address of the first byte, as the CPU sees it.
        address: u32,
        /// Number of bytes.
        length: usize,
        /// Address range of main RAM.
        ram: std::ops::Range<u32>,
    },
    /// The expected output or video did not come in time.
    #[error("expected {expected} within {cycles} cycles, found {got:?}")]
    Timeout {
        /// Expected input.
        expected: String,
        /// Time-out in cycles.
        cycles: u64,
        /// Output of the SoC during the wait.
        got: String,
    },
    /// The operating system provides no pseudo-terminal.
    #[error("pseudo-terminal: {0}")]
    Pty(#[from] std::io::Error),
}
