//! Starts boards that are simulated in this process.

use super::debugger::DebuggedBoard;
use super::error::OpenError;
use super::name::BoardName;
use crate::formats::read_at_most;
use emulated_board::EmulatedBoard;
use glint_board_api::{AnyBoard, built};
use std::env;
use std::net::SocketAddr;
use std::path::Path;
use virtual_board::{Start, VirtualBoard};

/// A simulated board with a serial line and direct access to its memory, by default the virtual
/// board.
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

/// Builds an emulated board that starts with `firmware` in its memory, for a debugger at `address`; port 0 selects a free port.
///
/// # Errors
/// The firmware exceeds main memory, or the address cannot be used.
pub fn debugged(
    firmware: &[u8],
    address: SocketAddr,
) -> Result<SimulatedBoard<DebuggedBoard>, OpenError> {
    let board = DebuggedBoard::new(EmulatedBoard::fast(firmware)?, address);
    let board = board.map_err(|source| OpenError::Debugger { address, source })?;
    Ok(SimulatedBoard::new(board))
}

/// Builds an emulated board that starts with the BIOS of the virtual board.
///
/// # Errors
/// The gateware is not built.
pub fn emulated_bios() -> Result<SimulatedBoard<EmulatedBoard>, OpenError> {
    let bios = "software/bios/bios.bin";
    let path = match env::var_os("GLINT_VIRTUAL_BOARD") {
        Some(folder) => Path::new(&folder).join(bios),
        None => built::find(&format!("gateware/virtual/{bios}"), "cargo xtask gateware")?,
    };
    let bios = read(&path)?;
    Ok(SimulatedBoard::new(EmulatedBoard::full(&bios)))
}

/// Builds the simulated board `name` that starts with `firmware` in its memory, or with its BIOS if `firmware` is `None`. Returns
/// `None` for a board on a serial port.
///
/// # Errors
/// As for the function that builds the board.
pub fn simulated(name: &BoardName, firmware: Option<&[u8]>) -> Result<Option<AnyBoard>, OpenError> {
    Ok(Some(match (name, firmware) {
        (BoardName::Emulated, Some(firmware)) => emulated(firmware)?.into(),
        (BoardName::Emulated, None) => emulated_bios()?.into(),
        (BoardName::Virtual, Some(firmware)) => verilated(firmware)?.into(),
        (BoardName::Virtual, None) => verilated_bios()?.into(),
        (BoardName::Serial(_), _) => return Ok(None),
    }))
}

/// Reads the firmware file at `path`, or without a path the firmware that `cargo xtask firmware` has built and [`built::find`]
/// finds.
///
/// # Errors
/// The firmware is not built, or the file cannot be read.
pub fn built_firmware(path: Option<&Path>) -> Result<Vec<u8>, OpenError> {
    match path {
        Some(path) => read(path),
        None => read(&built::find("firmware/glint.bin", "cargo xtask firmware")?),
    }
}

/// Maximum size of a firmware file in bytes. No supported board has a larger main memory.
const MAX_FIRMWARE: u64 = 1 << 30;

fn read(path: &Path) -> Result<Vec<u8>, OpenError> {
    read_at_most(path, MAX_FIRMWARE).map_err(|source| OpenError::Read {
        path: path.display().to_string(),
        source,
    })
}
