//! A virtual MPU-6050 for an I2C master.
//!
//! | part | purpose |
//! |---|---|
//! | [`Chip`] | registers, sample clock, and measurement of a motion |
//! | [`Wires`] | the chip on the wires SCL and SDA, simulated edge by edge; records violations of the data sheet's timing |
//! | [`Bus`] | the chip on a bus with the traits of `embedded-hal`, simulated byte by byte, with a simulated time |
//!
//! The caller passes the current time in ns to the chip. Equal calls with an equal seed give equal results.
//!
//! # Limits
//! The low-pass filter delays the motion and limits the noise, but does not attenuate fast motion. There is no FIFO, no
//! auxiliary bus, no self-test, no cycle mode and no interrupt pin; the registers of these functions only store the
//! written values. Data are valid right after wake-up.

#![forbid(unsafe_code)]

mod bus;
mod chip;

pub use bus::{Bus, Error};
pub use chip::{ADDRESS, Chip, Counts, Fault, Imperfections, RESET_TIME, Source, State};

/// The chip on the wires SCL and SDA.
pub type Wires = virtual_i2c_device::Wires<Chip>;
