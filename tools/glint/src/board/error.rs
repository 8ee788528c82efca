//! Errors of boards.

/// An error in the access to a board.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// An error of the virtual board.
    #[error(transparent)]
    Virtual(#[from] virtual_board::Error),
    /// The serial port cannot be opened.
    #[error("{port}: expected a serial port, found: {source}")]
    Open {
        /// Name of the port.
        port: String,
        /// Error of the operating system.
        source: serialport::Error,
    },
    /// Reading from or writing to the serial line failed.
    #[error("serial line: {0}")]
    Line(#[from] std::io::Error),
    /// The firmware file of the virtual board cannot be read.
    #[error("the firmware {path} cannot be read ({source}); run `cargo xtask firmware`")]
    Firmware {
        /// Path of the file.
        path: String,
        /// Error of the operating system.
        source: std::io::Error,
    },
}
