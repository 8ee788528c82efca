//! Boards: what the tools talk to, be it simulated or on a desk.

mod serial;
mod simulated;

pub use serial::SerialBoard;
pub use simulated::{SimulatedBoard, built_firmware};

/// A board behind its serial line.
pub trait Board {
    /// Sends bytes. They may wait on the way, but none is lost here.
    ///
    /// # Errors
    /// The line is gone.
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError>;

    /// Appends what the board has sent. If that is nothing yet, waits for something, but no longer than `wait_ms`
    /// milliseconds of the board's time.
    ///
    /// # Errors
    /// The line is gone.
    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError>;

    /// The board's time in milliseconds: all waits are counted in it, so that a simulation may be slow.
    fn now_ms(&self) -> u64;

    /// The way past the line into the board's main memory, where there is one.
    fn memory(&mut self) -> Option<&mut dyn Memory> {
        None
    }
}

/// A board's main memory, by the addresses of its processor.
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

/// Why a board cannot be talked to.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// The virtual board says so.
    #[error(transparent)]
    Virtual(#[from] virtual_board::Error),
    /// The serial port cannot be opened.
    #[error("{port}: expected a serial port, found: {source}")]
    Open {
        /// Its name.
        port: String,
        /// What the system says.
        source: serialport::Error,
    },
    /// The line broke.
    #[error("the serial line broke: {0}")]
    Line(#[from] std::io::Error),
    /// There is no program for the virtual board.
    #[error("the firmware {path} cannot be read ({source}); run `cargo xtask firmware`")]
    Firmware {
        /// Where it was looked for.
        path: String,
        /// What the system says.
        source: std::io::Error,
    },
}
