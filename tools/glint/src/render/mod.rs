//! Rendering of frames by the model in this process, or by a board.
//!
//! [`Frame`] and the types of its subjects come from the model. [`on_model`] draws frames in this process, and [`BoardRenderer`] on a
//! board.

mod board;
mod commands;
mod model;
mod remarks;
mod rendered;
mod stats;

pub use crate::board::Route;
pub use board::BoardRenderer;
pub use commands::{commands, samples_command, size_command, view_command};
pub use glint_model::{FieldSubject, Frame, MeshSubject, Subject, WireframeSubject};
pub use model::on_model;
pub use remarks::remarks;
pub use rendered::{Error, Parts, Rendered};
pub use stats::{EdgeCounts, RayCounts, Stats, TriangleCounts, WireframeCounts};
