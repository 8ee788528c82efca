//! Scenes: everything that a picture depends on.
//!
//! A [`Scene`] is a plain value. Console options change the scene ([`Scene::apply`]), [`Scene::frame`] converts it to a frame of
//! the model or the gateware, and [`Scene::write_lines`] writes it as console commands. A picture is outdated if its scene
//! differs from the current scene. Firmware and host share this crate, so that a scene has the same meaning on both.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod animator;
mod error;
mod lines;
mod scene;
mod text;

pub use animator::Animator;
pub use error::{ObjectError, SettingError};
pub use lines::{Line, LineError, Reason, lines};
pub use scene::{
    AnyBoard, Assets, Board, CUBE, Defaults, Kind, Name, PlacedMesh, Scene, SceneSubject, Sphere,
};
