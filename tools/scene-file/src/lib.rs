//! Scene files: descriptions of pictures, and the gateware and firmware that they require.
//!
//! A scene file is TOML. Most of its keys are console commands, and the values are the commands' arguments: `size = "640 360"` is
//! `size 640 360`. So a scene is a list of console commands ([`SceneFile::lines`]), which the firmware stores and the host sends,
//! and the console's parser checks every value. docs/scenes.md describes the keys.

#![forbid(unsafe_code)]

mod built_in;
mod error;
mod file;
mod keys;
mod needs;
mod read;
mod scene;

pub use built_in::{NAMES, TEXTS};
pub use error::{SceneError, Violation};
pub use keys::{BUDGET, names as keys};
pub use needs::{Fields, Needs};
pub use read::{MAX_BYTES, built_in, read};
pub use scene::{Budget, SceneFile, Steer, upright};
