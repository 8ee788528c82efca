//! Bit-exact software models of Glint's accelerators: the triangle engine, the line engine, the raymarcher and the gesture engine.
//!
//! The crate computes the triangle pipeline, the lines and the raymarcher of `docs/formats` in integer arithmetic. It is the renderer of
//! the CPU backend, and the oracle of the gateware's tests. A [`Frame`] describes a picture, and [`Frame::draw`] draws it: the mesh of the
//! picture by [`triangle`], the rays of its distance field by [`raymarch`]; [`line`](mod@line) draws segments, [`edges`] makes the segments
//! of a mesh's edges, and [`wireframe`] runs the programs of the wireframe simulator. [`gesture`] counts the pixels of a hand in the frames
//! of an image sensor.
//!
//! The crate uses no floating point and no allocation, and 128-bit integers only for the tables of fog and for the translation of an
//! orthographic frame. No sum or product overflows its type, for every camera that [`glint_core::camera::View`] accepts and every mesh:
//! comments at the functions prove this, and tests with overflow checks run the extreme cases. Intended modular arithmetic uses the
//! `wrapping` methods.
#![no_std]
#![forbid(unsafe_code)]

mod depth;
pub mod edges;
mod error;
mod fog;
mod frame;
mod frame_buffer;
pub mod gesture;
pub mod line;
pub mod mesh_in_field;
mod options;
pub mod raymarch;
pub mod selftest;
mod sky;
mod stereo;
pub mod triangle;
pub mod wireframe;

pub use depth::DepthScale;
pub use error::{Buffer, MAX_EYE, RenderError, SIZES};
pub use fog::Fog;
pub use frame::{
    FieldConstants, FieldSubject, Frame, FrameConstants, FrameStats, MeshSubject, Object, Subject,
    average_lines,
};
pub use frame_buffer::FrameBuffer;
pub use glint_core::colour::Shading;
pub use options::MeshOptions;
pub use sky::Sky;
pub use stereo::Eyes;
pub use triangle::{
    Clip, DrawnTriangle, MeshLight, MeshSetup, Options, Placement, Projected, ScreenVertex, Stats,
    clip_exceptions, render, trace, trace_frame,
};
pub use wireframe::{WireframeStats, WireframeSubject};
