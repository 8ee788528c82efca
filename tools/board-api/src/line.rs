//! The serial line of a board, and direct access to its memory.

use std::io;

/// An error of an access to a board.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// Reading from or writing to the serial line failed.
    #[error("serial line: {0}")]
    Line(#[from] io::Error),
    /// The user has ended the wait for the board, or the transfer.
    #[error("stopped")]
    Cancelled,
    /// An error of a simulated board.
    #[error(transparent)]
    Simulation(Box<dyn std::error::Error + Send + Sync>),
}

impl BoardError {
    /// An error of a simulated board.
    pub fn simulation(error: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> Self {
        Self::Simulation(error.into())
    }
}

/// A board that the host reaches over its serial line.
pub trait Board {
    /// Sends `bytes` to the board, and returns when the line has accepted all bytes.
    ///
    /// # Errors
    /// The line has failed.
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError>;

    /// Reads the bytes that the board has sent, and appends them to the buffer `bytes`. If no byte has arrived, the call waits
    /// for one, at most `wait_ms` milliseconds of the board's time.
    ///
    /// # Errors
    /// The line has failed.
    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError>;

    /// The board's time in milliseconds. All time-outs use it, because a simulated board may run slower than real time.
    fn now_ms(&self) -> u64;

    /// Direct access to the board's main memory; `None` for a board that has a serial line only.
    fn memory(&mut self) -> Option<&mut dyn Memory> {
        None
    }
}

/// Implements [`Board::read`] with calls of `step`. Each call reads for at most the given number of milliseconds, and may return
/// without bytes.
///
/// # Errors
/// Those of `step`.
pub fn read_in_steps<B: Board>(
    board: &mut B,
    bytes: &mut Vec<u8>,
    wait_ms: u64,
    mut step: impl FnMut(&mut B, &mut Vec<u8>, u64) -> Result<(), BoardError>,
) -> Result<(), BoardError> {
    let before = bytes.len();
    let end = board.now_ms() + wait_ms;
    loop {
        let left = end.saturating_sub(board.now_ms());
        step(board, bytes, left)?;
        if bytes.len() > before || left == 0 {
            return Ok(());
        }
    }
}

/// Direct access to a board's main memory; addresses are those of the board's CPU.
pub trait Memory {
    /// Reads main memory from `address` on into `bytes`.
    ///
    /// # Errors
    /// The range is not in main memory.
    fn read_memory(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), BoardError>;

    /// Writes `bytes` to main memory from `address` on.
    ///
    /// # Errors
    /// The range is not in main memory.
    fn write_memory(&mut self, address: u32, bytes: &[u8]) -> Result<(), BoardError>;
}
