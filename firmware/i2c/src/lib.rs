//! What drivers of buses and of devices share beyond `embedded-hal`: [`PeriodicI2c`], a bus that repeats a read, and [`TwoWires`], a
//! bus of two wires that software moves.
#![no_std]
#![forbid(unsafe_code)]

mod periodic;
mod wires;

pub use periodic::{PeriodicI2c, PeriodicRead};
pub use wires::{NoAcknowledge, TwoWires, Wires};
