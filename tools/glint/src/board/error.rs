//! Errors of opening or starting a board.

use glint_board_api::built::NotBuilt;

/// An error of opening or starting a board.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// An error of the virtual board.
    #[error(transparent)]
    Virtual(#[from] virtual_board::Error),
    /// An error of the emulated board.
    #[error(transparent)]
    Emulated(#[from] emulated_board::Error),
    /// The address for a debugger cannot be used.
    #[error("{address}: expected a free address of this host for a debugger, found: {source}")]
    Debugger {
        /// The address that was requested.
        address: std::net::SocketAddr,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The name is not that of a simulated board, and a serial port of this name cannot be opened.
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
    /// `serial` was requested, but no serial port, or more than one, has the USB bridge of a board.
    #[error(
        "serial: expected one port with the USB bridge of a board, found {found}; --board PORT selects one"
    )]
    Guess {
        /// The ports of this host.
        found: String,
    },
    /// The BIOS or the firmware of a simulated board has not been built.
    #[error(transparent)]
    NotBuilt(#[from] NotBuilt),
    /// The BIOS or the firmware of a simulated board cannot be read.
    #[error("{path}: cannot be read: {source}")]
    Read {
        /// Path of the file.
        path: String,
        /// Error of the operating system.
        source: std::io::Error,
    },
}
