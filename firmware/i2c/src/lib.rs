//! Interfaces of bus and device drivers that `embedded-hal` lacks: [`PeriodicI2c`], a bus that repeats a read, and [`TwoWires`], a
//! bit-banged bus.
#![no_std]
#![forbid(unsafe_code)]

mod periodic;
mod wires;

pub use periodic::{PeriodicI2c, PeriodicRead};
pub use wires::{NoAcknowledge, TwoWires, Wires};
