//! Boards as programs see them.
//!
//! | module | purpose |
//! |---|---|
//! | [`mod@line`] | the serial line of a board, and direct access to its memory |
//! | [`console`], [`transfer`] | protocols of the firmware on the line: commands, uploads, downloads |
//! | [`simulation`] | what simulated boards have in common, and the line to one |
//! | [`pace`] | holds a simulated board back to real time |
//! | [`built`] | finds the files that `cargo xtask` builds |
//!
//! The boards themselves are in other crates.
#![forbid(unsafe_code)]

pub mod built;
pub mod console;
pub mod line;
pub mod pace;
pub mod simulation;
pub mod transfer;

pub use line::{Board, BoardError, Memory, read_in_steps};
pub use simulation::{Frame, Meter, SimulatedBoard, Simulation, Uart};
pub use {virtual_flash, virtual_image_sensor, virtual_mpu6050};
