//! Scenes: everything that a picture depends on.
//!
//! A [`Scene`] is a value. Options of the console change it ([`Scene::apply`]), a frame of the model or of the gateware shows it
//! ([`Scene::frame`]), and console commands make it again ([`Scene::write_lines`]). A picture is out of date if its scene differs
//! from the present one. Firmware and host share this crate, so that a scene means the same on both.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod error;
mod lines;
mod scene;
mod text;

pub use error::{ObjectError, SettingError};
pub use lines::{Line, LineError, Reason, lines};
pub use scene::{AnyBoard, Board, CUBE, Content, Kind, Name, PlacedMesh, Scene, Shown, Sphere};
