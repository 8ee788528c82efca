//! Code shared by firmware and host: cameras, including those that show whole meshes, trigonometry, the motion sensor and its
//! attitude, hand gestures and the image sensor, distance fields and lights, the formats of meshes and flash images, wireframe
//! programs, transfers over a serial line, the console's grammar, scenes, the demo of a board without a host, and cooperative
//! tasks.
//!
//! All code is integer arithmetic, and no input makes it panic. Only the feature `alloc` allocates memory.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(test)]
extern crate std;

pub mod allocator;
pub mod appearance;
pub mod bits;
pub mod block;
pub mod calibration;
pub mod camera;
pub mod choice;
pub mod colour;
pub mod console;
#[rustfmt::skip]
pub mod constants;
pub mod cordic;
pub mod demo;
pub mod digits;
pub mod feature;
pub mod field;
pub mod fixed;
pub mod flash;
pub mod framing;
pub mod gesture;
pub mod image_sensor;
pub mod imu;
pub mod light;
pub mod matrix;
pub mod mesh;
pub mod mpu6050;
pub mod object;
pub mod orientation;
pub mod picture;
pub mod quality;
#[rustfmt::skip]
pub mod records;
pub mod root;
pub mod shape;
pub mod steering;
pub mod stereo;
pub mod tasks;
pub mod trig;
pub mod vector;
pub mod wire;
pub mod wireframe;
pub mod words;
