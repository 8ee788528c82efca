//! What can go wrong with a board.

use std::path::PathBuf;

/// Why a board could not be made or did not do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// There is no library to load.
    #[error("the virtual board's library {} is missing; run `cargo xtask gateware{option}`", .path.display())]
    LibraryMissing {
        /// Where it was expected.
        path: PathBuf,
        /// What the command needs beyond its name.
        option: &'static str,
    },
    /// The library exists and cannot be loaded.
    #[error("the virtual board's library {} cannot be loaded; run `cargo xtask gateware`", .path.display())]
    Library {
        /// The library.
        path: PathBuf,
        /// What the loader said.
        source: libloading::Error,
    },
    /// The library speaks another version of the interface.
    #[error(
        "the virtual board's library {} has interface {found}, this program needs {expected}; \
         run `cargo xtask gateware`", .path.display()
    )]
    Interface {
        /// The library.
        path: PathBuf,
        /// What this crate was written for.
        expected: u32,
        /// What the library has.
        found: u32,
    },
    /// The library's SoC has other registers than this program.
    #[error(
        "the virtual board's register map is {found:#010x}, this program was built for {expected:#010x}; \
         run `cargo xtask gateware` and `cargo xtask pac`"
    )]
    BuildId {
        /// Of the register access crate this program was built with.
        expected: u32,
        /// Of the library.
        found: u32,
    },
    /// The library was built without waveforms.
    #[error("cannot write waveforms to {}: is its folder there, and is the library one with waveforms?", .path.display())]
    Trace {
        /// The file that was asked for.
        path: PathBuf,
    },
    /// An access through the back door that is not wholly in main RAM.
    #[error(
        "DDR3 access of {length} bytes at {address:#010x}: expected it within {:#010x}..{:#010x}",
        .ram.start, .ram.end
    )]
    Address {
        /// First byte, as the CPU addresses it.
        address: u32,
        /// Bytes asked for.
        length: usize,
        /// Main RAM.
        ram: std::ops::Range<u32>,
    },
    /// What was waited for did not come.
    #[error("waited {cycles} cycles for {expected}; got {got:?}")]
    Timeout {
        /// What was waited for.
        expected: String,
        /// How long.
        cycles: u64,
        /// What came instead.
        got: String,
    },
    /// The operating system refused a pseudo-terminal.
    #[error("pseudo-terminal: {0}")]
    Pty(#[from] std::io::Error),
}
