//! Boards that are simulated in this process, at their start.

use super::error::OpenError;
use emulated_board::EmulatedBoard;
use std::path::{Path, PathBuf};
use virtual_board::{Start, VirtualBoard};

/// A simulated board with a serial line and direct access to its memory; by default the verilated one.
pub type SimulatedBoard<S = VirtualBoard> = glint_board_api::SimulatedBoard<S>;

/// Builds a virtual board that starts with `firmware` in its memory, without the BIOS.
///
/// # Errors
/// The gateware is not built.
pub fn verilated(firmware: &[u8]) -> Result<SimulatedBoard, OpenError> {
    let board = VirtualBoard::builder().start(Start::Fast { firmware });
    Ok(SimulatedBoard::new(board.build()?))
}

/// Builds a virtual board that starts with its BIOS.
///
/// # Errors
/// The gateware is not built.
pub fn verilated_bios() -> Result<SimulatedBoard, OpenError> {
    let board = VirtualBoard::builder().start(Start::Full);
    Ok(SimulatedBoard::new(board.build()?))
}

/// Builds an emulated board that starts with `firmware` in its memory, without the BIOS.
///
/// # Errors
/// The firmware exceeds main memory.
pub fn emulated(firmware: &[u8]) -> Result<SimulatedBoard<EmulatedBoard>, OpenError> {
    Ok(SimulatedBoard::new(EmulatedBoard::fast(firmware)?))
}

/// Builds an emulated board that starts with the BIOS of the virtual board.
///
/// # Errors
/// The gateware is not built.
pub fn emulated_bios() -> Result<SimulatedBoard<EmulatedBoard>, OpenError> {
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/gateware/virtual");
    let path = built.join("software/bios/bios.bin");
    let bios = std::fs::read(&path).map_err(|source| OpenError::Bios {
        path: path.display().to_string(),
        source,
    })?;
    Ok(SimulatedBoard::new(EmulatedBoard::full(&bios)))
}

/// Reads the firmware file at `path`, or without a path the file that `cargo xtask firmware` has built in this checkout.
///
/// # Errors
/// [`OpenError::Firmware`] for a file that cannot be read.
pub fn built_firmware(path: Option<&Path>) -> Result<Vec<u8>, OpenError> {
    let built = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/firmware/glint.bin");
    let path: PathBuf = path.map_or_else(built, Path::to_owned);
    std::fs::read(&path).map_err(|source| OpenError::Firmware {
        path: path.display().to_string(),
        source,
    })
}
