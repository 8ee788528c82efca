//! Bit-exact twins of Glint's accelerators.
//!
//! The triangle pipeline and the raymarcher of `docs/formats.md` in integers: the renderer of the CPU backend, and the oracle
//! of the gateware's tests. A [`Frame`] describes a picture, and [`Frame::draw`] draws it. Its vertices go through [`vertex`], its
//! triangles through [`setup`] and [`raster`], those beyond the guard band or the near plane through [`clip`], its rays through
//! [`raymarch`].
//!
//! No floating point, no allocation, no 128-bit integers. Every sum and product fits its type for every camera that
//! [`glint_core::camera::View`] accepts and for every mesh; the comments prove it, and tests with overflow checks
//! run the extremes. Modular arithmetic is written as `wrapping`.
#![no_std]
#![forbid(unsafe_code)]

pub mod clip;
mod depth;
pub mod descriptor;
mod error;
mod exceptions;
mod facing;
mod frame;
mod frame_buffer;
pub mod mesh_in_field;
mod mesh_setup;
pub mod quotient;
pub mod raster;
pub mod raymarch;
pub mod reciprocal;
mod render;
mod rounding;
pub mod setup;
pub mod shade;
mod triangle;
pub mod vertex;

pub use depth::DepthScale;
pub use error::{Buffer, MAX_EYE, RenderError, SIZES};
pub use exceptions::clip_exceptions;
pub use frame::{
    FieldConstants, FieldSubject, Frame, FrameConstants, FrameStats, MeshSubject, Subject,
};
pub use frame_buffer::FrameBuffer;
pub use glint_core::colour::Shading;
pub use mesh_setup::MeshSetup;
pub use render::{DrawnTriangle, Stats, render, trace, trace_frame};
pub use triangle::Options;
pub use vertex::{Projected, ScreenVertex};
