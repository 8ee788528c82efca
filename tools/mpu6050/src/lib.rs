//! An MPU-6050 that is not there: what the chip does as a master on its I2C bus can see it.
//!
//! | part | what it is |
//! |---|---|
//! | [`Chip`] | registers, sample clock, and what the sensor measures of its motion |
//! | [`Wires`] | the chip on SCL and SDA, edge by edge; notes where a master is faster than the data sheet lets it be |
//! | [`Bus`] | the chip behind `embedded-hal`, byte by byte, with a clock of its own |
//!
//! Everything follows from the calls and a seed; time is what the caller says it is, in ns.
//!
//! # Limits
//! The low-pass filter delays, and sets the noise, but leaves the amplitude as it is. There is no FIFO, no auxiliary bus, no
//! self-test, no cycle mode and no interrupt pin; these registers keep what is written to them. After waking the data are good at once.

#![forbid(unsafe_code)]

mod bus;
mod chip;
mod wires;

pub use bus::{Bus, Error};
pub use chip::{ADDRESS, Chip, Counts, Fault, Imperfections, RESET_TIME, Source, State};
pub use wires::Wires;
