//! Code shared by firmware and host: cameras, sines, attitudes and their sensor, fields and lights, mesh and wire formats, and the
//! console's grammar.
//!
//! Everything here is integer arithmetic without allocation, and no input makes it panic.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(test)]
extern crate std;

pub mod appearance;
pub mod calibration;
pub mod camera;
pub mod choice;
pub mod colour;
pub mod console;
pub mod field;
pub mod fixed;
pub mod follow;
pub mod i2c;
pub mod imu;
pub mod light;
#[rustfmt::skip]
pub mod machine;
pub mod mesh;
pub mod mpu6050;
pub mod orientation;
pub mod picture;
pub mod polar;
pub mod stereo;
pub mod trig;
pub mod wire;
