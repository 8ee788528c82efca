//! A virtual image sensor: an OV7670 or OV5640 with its parallel port (DVP).
//!
//! | part | purpose |
//! |---|---|
//! | [`Chip`] | registers: identity, reset, format and polarity |
//! | [`Source`] | pictures: files ([`Images`]), or a synthetic moving hand whose centre of mass and area are known ([`Scene`]) |
//! | [`ImageSensor`] | the chip on its SCCB wires, and the levels of its port, period by period of PCLK, with faults |
//!
//! The caller passes the current time. Equal calls with an equal seed give equal levels.
//!
//! # Limits
//! The source determines the size of a frame, [`Timing`] the frame rate; the chip's
//! registers for size, scaling, clock, exposure and colour only store the written values.

#![forbid(unsafe_code)]

mod chip;
mod frame;
mod scene;
mod sensor;

pub use chip::{Chip, ChipFault, Format, Model, Polarity};
pub use frame::{Error, Frame, Images, Source, rgb565};
pub use scene::{Hand, Scene};
pub use sensor::{Fault, ImageSensor, Levels, Timing};
