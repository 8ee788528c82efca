//! The virtual board, simulated in this process. A read from its serial line advances the simulation.

use super::error::BoardError;
use super::line::{Board, Memory};
use std::path::{Path, PathBuf};
use virtual_board::{Start, VirtualBoard};

/// Clock cycles to simulate between two checks for bytes from the board.
const SLICE: u64 = 1000;

/// A virtual board, simulated in this process.
pub struct SimulatedBoard {
    board: VirtualBoard,
}

impl SimulatedBoard {
    /// Wraps a virtual board that the caller has built.
    pub fn new(board: VirtualBoard) -> Self {
        Self { board }
    }

    /// Builds a virtual board that starts with `firmware` in its memory, without the BIOS.
    ///
    /// # Errors
    /// The gateware is not built.
    pub fn fast(firmware: &[u8]) -> Result<Self, BoardError> {
        Ok(Self::new(
            VirtualBoard::builder()
                .start(Start::Fast { firmware })
                .build()?,
        ))
    }

    /// Builds a virtual board that starts with its BIOS.
    ///
    /// # Errors
    /// The gateware is not built.
    pub fn full() -> Result<Self, BoardError> {
        Ok(Self::new(
            VirtualBoard::builder().start(Start::Full).build()?,
        ))
    }

    /// The underlying virtual board, for access to its pins, its monitor and its cycle counter.
    pub fn inner(&mut self) -> &mut VirtualBoard {
        &mut self.board
    }
}

/// Reads the firmware file at `path`, or without a path the file that `cargo xtask firmware` has built in this checkout.
///
/// # Errors
/// [`BoardError::Firmware`] for a file that cannot be read.
pub fn built_firmware(path: Option<&Path>) -> Result<Vec<u8>, BoardError> {
    let built = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/firmware/glint.bin");
    let path: PathBuf = path.map_or_else(built, Path::to_owned);
    std::fs::read(&path).map_err(|source| BoardError::Firmware {
        path: path.display().to_string(),
        source,
    })
}

impl Board for SimulatedBoard {
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
            self.board.run(SLICE);
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

impl Memory for SimulatedBoard {
    fn read_memory(&mut self, address: u32, bytes: &mut [u8]) -> Result<(), BoardError> {
        Ok(self.board.ddr_read(address, bytes)?)
    }

    fn write_memory(&mut self, address: u32, bytes: &[u8]) -> Result<(), BoardError> {
        Ok(self.board.ddr_write(address, bytes)?)
    }
}
