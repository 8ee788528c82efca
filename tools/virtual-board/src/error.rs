//! Errors of the virtual board.

use std::path::PathBuf;

use glint_board_api::Timeout;
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
    /// The register map of the library's SoC differs from the register access crate's.
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
    /// A back-door access outside of main RAM.
    #[error(
        "DDR3 access of {length} bytes at {address:#010x}: expected a range within {:#010x}..{:#010x}",
        .ram.start, .ram.end
    )]
    Address {
        /// Address of the first byte on the CPU's bus.
        address: u32,
        /// Number of bytes.
        length: usize,
        /// Address range of main RAM.
        ram: std::ops::Range<u32>,
    },
    /// Time-out while waiting for output or video.
    #[error(transparent)]
    Timeout(#[from] Timeout),
    /// The operating system provides no pseudo-terminal.
    #[error("pseudo-terminal: {0}")]
    Pty(#[from] std::io::Error),
}
