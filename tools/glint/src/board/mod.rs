//! Opens boards: the emulated or the virtual board in this process, or a board on a serial port.

mod debugger;
mod error;
mod name;
mod ports;
mod route;
mod serial;
mod simulated;

pub use debugger::DebuggedBoard;
pub use emulated_board::EmulatedBoard;
pub use error::OpenError;
pub use glint_board_api::{
    AnyBoard, Board, BoardError, Frame as MonitorFrame, Memory, Meter, Simulation, Uart,
};
pub use name::{BoardName, ModelOrBoard};
pub use ports::{Port, ports};
pub use route::Route;
pub use serial::SerialBoard;
pub use simulated::{
    SimulatedBoard, built_firmware, debugged, emulated, emulated_bios, simulated, verilated,
    verilated_bios,
};
