//! A board on a serial port.

use super::error::OpenError;
use super::ports;
use glint_board_api::console::PATIENCE_MS;
use glint_board_api::{Board, BoardError};
use serialport::SerialPort;
use std::io::{self, Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// Name on the command line for the port that is probably connected to a board.
const GUESS: &str = "serial";
/// Minimum time-out of a read from the port, so that a loop of reads does not use a whole CPU core.
const SHORTEST: Duration = Duration::from_millis(1);

/// Time after which a write fails if the port accepts no byte. It equals the time-out of a reply.
const MAX_BLOCKED: Duration = Duration::from_millis(PATIENCE_MS);

/// A board on a serial port with 8 data bits, no parity, 1 stop bit and no flow control.
pub struct SerialBoard {
    port: Box<dyn SerialPort>,
    opened: Instant,
}

impl SerialBoard {
    /// Opens a port; `serial` selects the port that is probably connected to a board.
    ///
    /// # Errors
    /// [`OpenError::Open`] for a port that does not exist, [`OpenError::Busy`] for a port in use,
    /// [`OpenError::Guess`] if no port or several ports could be connected to a board.
    pub fn open(name: &str, baud: u32) -> Result<Self, OpenError> {
        if name == GUESS {
            return Self::open(&ports::guess()?, baud);
        }
        let port = serialport::new(name, baud)
            .timeout(SHORTEST)
            .open()
            .map_err(|source| open_error(name, source))?;
        Ok(Self {
            port,
            opened: Instant::now(),
        })
    }
}

/// The error for a port that cannot be opened.
fn open_error(name: &str, source: serialport::Error) -> OpenError {
    let port = name.to_owned();
    // The crate `serialport` reports a missing port and a locked port as the same kind of error.
    if source.kind() == serialport::ErrorKind::NoDevice && Path::new(name).exists() {
        return OpenError::Busy { port };
    }
    let ports = ports::ports();
    let ports = ports.map_or_else(|error| error.to_string(), |ports| ports::summary(&ports));
    OpenError::Open {
        port,
        ports,
        source,
    }
}

impl Board for SerialBoard {
    fn write(&mut self, mut bytes: &[u8]) -> Result<(), BoardError> {
        let mut last = Instant::now();
        while !bytes.is_empty() {
            match self.port.write(bytes) {
                Ok(written) if written > 0 => {
                    bytes = &bytes[written..];
                    last = Instant::now();
                }
                // The port's buffer is full. It empties at the speed of the line, so the loop
                // writes again.
                Ok(_) => {}
                Err(error) if is_transient(&error) => {}
                Err(error) => return Err(error.into()),
            }
            if last.elapsed() > MAX_BLOCKED {
                let text = format!(
                    "the port has accepted no byte for {} s",
                    MAX_BLOCKED.as_secs()
                );
                return Err(io::Error::new(io::ErrorKind::TimedOut, text).into());
            }
        }
        Ok(())
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        let wait = Duration::from_millis(wait_ms).max(SHORTEST);
        self.port.set_timeout(wait).map_err(io::Error::from)?;
        let mut buffer = [0; 4096];
        match self.port.read(&mut buffer) {
            Ok(0) => Err(io::Error::from(io::ErrorKind::UnexpectedEof).into()),
            Ok(length) => {
                bytes.extend_from_slice(&buffer[..length]);
                Ok(())
            }
            Err(error) if is_transient(&error) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    fn now_ms(&self) -> u64 {
        self.opened.elapsed().as_millis() as u64
    }
}

fn is_transient(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted
    )
}
