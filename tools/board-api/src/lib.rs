//! The interface between programs and boards.
//!
//! | module | purpose |
//! |---|---|
//! | [`mod@line`] | the serial line of a board, and direct access to its memory |
//! | [`console`], [`transfer`] | protocols of the firmware on the line: commands, uploads, downloads |
//! | [`mod@flash`] | protocol of the BIOS on the line: serial boot |
//! | [`simulation`] | common parts of simulated boards, and their serial line |
//! | [`pace`] | limits the speed of a simulated board to real time |
//! | [`built`] | finds the files that `cargo xtask` builds |
//!
//! Other crates implement the boards.
#![forbid(unsafe_code)]

pub mod built;
pub mod console;
pub mod flash;
pub mod line;
pub mod pace;
pub mod simulation;
pub mod transfer;

pub use line::{Board, BoardError, Memory, read_in_steps};
pub use simulation::{AnyBoard, Frame, Meter, SimulatedBoard, Simulation, Timeout, Uart};
pub use {virtual_flash, virtual_image_sensor, virtual_mpu6050};
