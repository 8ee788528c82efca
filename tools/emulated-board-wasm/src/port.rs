//! A board on a serial port of the browser.

use glint_board_api::{Board, BoardError};
use glint_live_page::Live;

/// Maximum number of bytes of a read.
const ROOM: usize = 4096;

// SAFETY: `web/port.js` implements these functions. They use the bytes of the module's memory until they return to this module, also if the
// worker suspends the module in between.
unsafe extern "C" {
    /// Writes the `length` bytes from address `start` on to the port, and returns when the port has accepted them.
    fn write_port(start: *const u8, length: usize);

    /// Reads at most `room` bytes from the port to address `start`, and returns their number. If no byte has arrived, the call waits for one,
    /// at most `wait_ms` milliseconds.
    fn read_port(start: *mut u8, room: usize, wait_ms: f64) -> usize;
}

/// The port that the worker has opened. If it fails, the page ends the worker, so no call here returns an error.
pub struct SerialPort;

impl Board for SerialPort {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        // SAFETY: the bytes are borrowed until the call returns.
        unsafe { write_port(bytes.as_ptr(), bytes.len()) };
        Ok(())
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        let mut buffer = [0; ROOM];
        // SAFETY: the buffer has `ROOM` bytes, and is borrowed until the call returns.
        let length = unsafe { read_port(buffer.as_mut_ptr(), ROOM, wait_ms as f64) };
        bytes.extend_from_slice(buffer.get(..length).unwrap_or_default());
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        crate::now() as u64
    }
}

impl Live for SerialPort {}
