//! Rendering of frames by the model in this process, or by a board.
//!
//! The model defines [`Frame`] and the types of its subjects. [`ModelRenderer`] and [`BoardRenderer`] implement the trait
//! [`Renderer`].

mod board;
mod commands;
mod model;
mod remarks;
mod renderer;
mod stats;

pub use crate::board::Route;
pub use board::BoardRenderer;
pub use commands::{commands, size_command, view_command};
pub use glint_model::{FieldSubject, Frame, MeshSubject, Subject, WireframeSubject};
pub use model::{ModelRenderer, on_model};
pub use remarks::remarks;
pub use renderer::{Error, Parts, Rendered, Renderer};
pub use stats::{EdgeCounts, RayCounts, Stats, TriangleCounts, WireframeCounts};
