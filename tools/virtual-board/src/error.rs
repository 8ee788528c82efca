//! Errors of a board.

use std::path::PathBuf;

use glint_testbench::LoadError;

/// Error of a board.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The library does not exist.
    #[error("the virtual board's library {} is missing; run `cargo xtask gateware{option}`", .path.display())]
    LibraryMissing {
        /// Its path.
        path: PathBuf,
        /// Option of the command that builds it.
        option: &'static str,
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
        /// Build id of the register access crate.
        expected: u32,
        /// Build id of the library.
        found: u32,
    },
    /// Waveforms cannot be written.
    #[error("waveforms to {}: cannot be written; expected an existing folder and a library of `cargo xtask gateware --waveforms`", .path.display())]
    Trace {
        /// Path of the waveforms.
        path: PathBuf,
    },
    /// An access of the back door outside main RAM.
    #[error(
        "DDR3 access of {length} bytes at {address:#010x}: expected a range within {:#010x}..{:#010x}",
        .ram.start, .ram.end
    )]
    Address {
        /// First byte, an address of the CPU.
        address: u32,
        /// Number of bytes.
        length: usize,
        /// Main RAM.
        ram: std::ops::Range<u32>,
    },
    /// A wait that timed out.
    #[error("expected {expected} within {cycles} cycles, found {got:?}")]
    Timeout {
        /// Expected event.
        expected: String,
        /// Time-out in cycles.
        cycles: u64,
        /// Output meanwhile.
        got: String,
    },
    /// The operating system provides no pseudo-terminal.
    #[error("pseudo-terminal: {0}")]
    Pty(#[from] std::io::Error),
}
