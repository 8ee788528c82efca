//! Errors of boards.

/// An error in the access to a board.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// An error of the virtual board.
    #[error(transparent)]
    Virtual(#[from] virtual_board::Error),
    /// An error of the emulated board.
    #[error(transparent)]
    Emulated(#[from] emulated_board::Error),
    /// The picture on the virtual board's monitor is not that of a frame.
    #[error(transparent)]
    Picture(#[from] virtual_board::PictureError),
    /// The frame on the emulated board's monitor has another size.
    #[error("frame on the monitor: expected {expected} pixels in a line, found {found}")]
    FrameWidth {
        /// Expected number of pixels in a line.
        expected: usize,
        /// Number of pixels in a line.
        found: usize,
    },
    /// The serial port cannot be opened.
    #[error(
        "{port}: expected `emulated`, `virtual` or a serial port, found: {source}; this host has {ports}"
    )]
    Open {
        /// Name of the port.
        port: String,
        /// The ports of this host.
        ports: String,
        /// Error of the operating system.
        source: serialport::Error,
    },
    /// Another program has the serial port open.
    #[error(
        "{port}: expected a serial port that no other program uses, found one in use: end that program"
    )]
    Busy {
        /// Name of the port.
        port: String,
    },
    /// The serial ports of this host cannot be listed.
    #[error("the serial ports cannot be listed: {0}")]
    Ports(serialport::Error),
    /// No serial port, or more than one, is probably a board's.
    #[error(
        "serial: expected one port with the USB bridge of a board, found {found}; --board PORT selects one"
    )]
    Guess {
        /// The ports of this host.
        found: String,
    },
    /// Reading from or writing to the serial line failed.
    #[error("serial line: {0}")]
    Line(#[from] std::io::Error),
    /// The BIOS of the virtual board, which the emulated board starts with, cannot be read.
    #[error("the BIOS {path} cannot be read ({source}); run `cargo xtask gateware`")]
    Bios {
        /// Path of the file.
        path: String,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The firmware file of a simulated board cannot be read.
    #[error("the firmware {path} cannot be read ({source}); run `cargo xtask firmware`")]
    Firmware {
        /// Path of the file.
        path: String,
        /// Error of the operating system.
        source: std::io::Error,
    },
}
