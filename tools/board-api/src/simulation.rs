//! Boards that are simulated in this process. A read from the serial line advances the simulation.

use crate::line::{Board, BoardError, Memory};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use virtual_flash::Flash;
use virtual_image_sensor::ImageSensor;
use virtual_mpu6050::Wires;

/// Number of clock cycles to simulate between two polls of the board.
const SLICE: u64 = 1000;

/// A simulated board with a UART.
pub trait Uart {
    /// Runs `cycles` cycles of the system clock.
    fn run(&mut self, cycles: u64);

    /// Cycles of the system clock since the start.
    fn cycles(&self) -> u64;

    /// System clock frequency in Hz.
    fn clock_hz(&self) -> u32;

    /// Sends bytes to the UART. The bytes wait in a queue until the program reads them.
    fn uart_write(&mut self, bytes: &[u8]);

    /// Number of sent bytes that the UART has not received yet.
    fn uart_queued(&self) -> usize;

    /// The serial output that has not been read.
    fn uart_output(&mut self) -> &mut Vec<u8>;

    /// Appends the unread serial output to `output`.
    fn uart_read(&mut self, output: &mut Vec<u8>) {
        output.append(self.uart_output());
    }

    /// Runs until `done` returns true, but at most about `limit` cycles; calls `done` every 1000 cycles. Returns whether `done`
    /// returned true.
    fn run_until(&mut self, limit: u64, mut done: impl FnMut(&mut Self) -> bool) -> bool
    where
        Self: Sized,
    {
        let end = self.cycles().saturating_add(limit);
        loop {
            if done(self) {
                return true;
            }
            let left = end.saturating_sub(self.cycles());
            if left == 0 {
                return false;
            }
            self.run(left.min(SLICE));
        }
    }

    /// Runs until the board has sent `expected`, and returns the unread output up to and including `expected`. Later output stays
    /// unread.
    ///
    /// # Errors
    /// [`Timeout`], with the output so far, if `expected` does not arrive within `limit` cycles.
    fn read_until(&mut self, expected: &str, limit: u64) -> Result<String, Timeout>
    where
        Self: Sized,
    {
        let wanted = expected.as_bytes();
        let mut searched = 0;
        let mut end = None;
        self.run_until(limit, |board| {
            let sent = board.uart_output();
            end = sent[searched..]
                .windows(wanted.len().max(1))
                .position(|window| window == wanted)
                .map(|at| searched + at + wanted.len());
            searched = sent.len().saturating_sub(wanted.len()).max(searched);
            end.is_some()
        });
        let sent = self.uart_output();
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        match end {
            Some(end) => Ok(text(sent.drain(..end).collect())),
            None => Err(Timeout {
                expected: format!("{expected:?}"),
                cycles: limit,
                got: text(std::mem::take(sent)),
            }),
        }
    }
}

/// The expected output or video of a simulated board did not arrive in time.
#[derive(Debug, thiserror::Error)]
#[error("expected {expected} within {cycles} cycles, found {got:?}")]
pub struct Timeout {
    /// The expected output or picture.
    pub expected: String,
    /// Time-out in cycles.
    pub cycles: u64,
    /// Output of the board during the wait.
    pub got: String,
}

/// A frame on a board's monitor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Number of pixels in a line.
    pub width: usize,
    /// Number of lines.
    pub height: usize,
    /// RGB565 colours, line by line from the top left.
    pub pixels: Vec<u16>,
}

/// The functions of every simulated board.
pub trait Simulation: Uart {
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

    /// Replaces the program by the memory image `program`, and resets the board, which then starts it. Connected devices stay.
    ///
    /// # Errors
    /// The image exceeds main memory, or the files of the virtual board's gateware have changed and are not valid.
    fn boot(&mut self, program: &[u8]) -> Result<(), BoardError>;

    /// Connects a motion sensor to the I2C bus; replaces the connected sensor, if any.
    fn plug(&mut self, sensor: Wires);

    /// Connects an SPI flash; replaces the connected flash, if any.
    fn plug_flash(&mut self, flash: Flash);

    /// Connects an image sensor; replaces the connected sensor, if any.
    fn plug_image_sensor(&mut self, sensor: ImageSensor);

    /// Lit segments of the eight digits from left to right: bits 0 to 6 for the segments a to g, bit 7 for the point.
    fn digits(&self) -> [u8; 8];

    /// Sets which of the buttons 0 to 3 are pressed, one bit each.
    fn set_buttons(&mut self, pressed: u8);

    /// Sets the 16 switches, one bit each.
    fn set_switches(&mut self, on: u16);

    /// The 16 LEDs, one bit each.
    fn leds(&self) -> u16;

    /// The last complete frame on the monitor and its number, which counts vertical blankings.
    /// Returns `None` if the monitor has shown no frame since the frame with the number `last` of
    /// an earlier call. The first call passes 0.
    ///
    /// # Errors
    /// The picture on the monitor is not a frame.
    fn new_frame(&mut self, last: u64) -> Result<Option<(u64, Frame)>, BoardError>;

    /// Captures the next complete frame on the monitor, and returns its RGB565 colours. A frame has 1280 / `scale` pixels in a
    /// line.
    ///
    /// # Errors
    /// The monitor has no signal, or the frame has another size.
    fn monitor_frame(&mut self, scale: usize) -> Result<Vec<u16>, BoardError>;
}

/// Lets another thread read the cycle count of a simulated board.
#[derive(Clone, Debug)]
pub struct Meter {
    cycles: Arc<AtomicU64>,
    clock_hz: u32,
}

impl Meter {
    /// Cycles of the system clock since the start.
    pub fn cycles(&self) -> u64 {
        self.cycles.load(Ordering::Relaxed)
    }

    /// System clock frequency in Hz.
    pub const fn clock_hz(&self) -> u32 {
        self.clock_hz
    }
}

/// A simulated board with a serial line and direct access to its memory.
pub struct SimulatedBoard<S: ?Sized> {
    board: Box<S>,
    meter: Meter,
}

/// A simulated board of any kind.
pub type AnyBoard = SimulatedBoard<dyn Simulation + Send>;

impl<S: Uart> SimulatedBoard<S> {
    /// Wraps a board that the caller has built.
    pub fn new(board: S) -> Self {
        let meter = Meter {
            cycles: Arc::default(),
            clock_hz: board.clock_hz(),
        };
        let board = Box::new(board);
        Self { board, meter }
    }
}

impl<S: Simulation + Send + 'static> From<SimulatedBoard<S>> for AnyBoard {
    fn from(SimulatedBoard { board, meter }: SimulatedBoard<S>) -> Self {
        Self { board, meter }
    }
}

impl<S: Uart + ?Sized> SimulatedBoard<S> {
    /// The cycle count of the board, for another thread.
    pub fn meter(&self) -> Meter {
        self.meter.clone()
    }

    /// Runs the board, and publishes its cycle count to other threads.
    fn advance(&mut self, cycles: u64) {
        self.board.run(cycles);
        let cycles = self.board.cycles();
        self.meter.cycles.store(cycles, Ordering::Relaxed);
    }

    /// The underlying board, for access to its pins, its monitor and its cycle counter.
    pub fn inner(&mut self) -> &mut S {
        &mut self.board
    }
}

impl<S: Uart + ?Sized> Uart for SimulatedBoard<S> {
    fn run(&mut self, cycles: u64) {
        self.advance(cycles);
    }

    fn cycles(&self) -> u64 {
        self.board.cycles()
    }

    fn clock_hz(&self) -> u32 {
        self.board.clock_hz()
    }

    fn uart_queued(&self) -> usize {
        self.board.uart_queued()
    }

    fn uart_write(&mut self, bytes: &[u8]) {
        self.board.uart_write(bytes);
    }

    fn uart_output(&mut self) -> &mut Vec<u8> {
        self.board.uart_output()
    }
}

impl<S: Simulation + ?Sized> Board for SimulatedBoard<S> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.board.uart_write(bytes);
        Ok(())
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        let before = bytes.len();
        let limit = wait_ms.saturating_mul(u64::from(self.board.clock_hz()) / 1000);
        let end = self.board.cycles().saturating_add(limit);
        self.board.uart_read(bytes);
        while bytes.len() == before && self.board.cycles() < end {
            self.advance(SLICE);
            self.board.uart_read(bytes);
        }
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.board.cycles() / (u64::from(self.board.clock_hz()) / 1000).max(1)
    }

    fn memory(&mut self) -> Option<&mut dyn Memory> {
        Some(self)
    }
}

impl<S: Simulation + ?Sized> Memory for SimulatedBoard<S> {
    fn read_memory(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), BoardError> {
        self.board.read_memory(address, bytes)
    }

    fn write_memory(&mut self, address: u32, bytes: &[u8]) -> Result<(), BoardError> {
        self.board.write_memory(address, bytes)
    }
}
