//! Code shared by firmware and host: cameras, lights, placements of objects, trigonometry, the motion sensor and its attitude, hand
//! gestures and the image sensor, distance fields, built-in meshes, the formats of meshes and flash images, wireframe programs, transfers
//! over a serial line, the console's grammar, the demo of a board without a host, and cooperative tasks.
//!
//! All code is integer arithmetic, and no input makes it panic. Only the feature `alloc` allocates memory.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(test)]
extern crate std;

mod board;
mod drawing;
mod gateware;
mod math;
mod motion;
mod text;

pub mod allocator;
pub mod console;
pub mod deviation;
pub mod feature;
pub mod field;
pub mod flash;
pub mod gesture;
pub mod image_sensor;
pub mod mesh;
pub mod shape;
pub mod wire;
pub mod wireframe;

pub use board::*;
pub use drawing::*;
pub use gateware::*;
pub use math::*;
pub use motion::*;
pub use text::*;
