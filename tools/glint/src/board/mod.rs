//! Access to boards over their serial line: the emulated or the virtual board in this process, or a board on a serial port.

mod error;
mod line;
mod name;
mod ports;
mod serial;
mod simulated;

pub use emulated_board::{EmulatedBoard, Frame as MonitorFrame};
pub use error::BoardError;
pub use line::{Board, Memory, read_in_steps};
pub use name::{BoardName, ModelOrBoard};
pub use ports::{Port, ports};
pub use serial::SerialBoard;
pub use simulated::{Meter, SimulatedBoard, Simulation, built_firmware};
