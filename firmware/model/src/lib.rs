//! Bit-exact twins of Glint's accelerators.
//!
//! This is the triangle pipeline of `docs/formats.md` in integers: the renderer of the CPU backend, and the oracle
//! that the gateware's tests compare with. A vertex goes through [`vertex`], a triangle through [`setup`] and [`raster`], one
//! that leaves the guard band or crosses the near plane through [`clip`]; [`render()`] runs a whole frame.
//!
//! No floating point, no allocation, no 128-bit integers. Every sum and product fits its type for every camera that
//! [`glint_core::camera::View`] accepts and for every mesh; the comments prove it, and tests with overflow checks
//! run the extremes. Where arithmetic is meant to be modular it says `wrapping`.
#![no_std]
#![forbid(unsafe_code)]

pub mod clip;
pub mod descriptor;
pub mod frame;
pub mod mesh_in_field;
pub mod quotient;
pub mod raster;
pub mod raymarch;
pub mod reciprocal;
mod render;
pub mod setup;
pub mod shade;
pub mod vertex;

pub use frame::{DepthScale, MeshSetup};
pub use glint_core::colour::Shading;
pub use render::{
    Buffer, DrawnTriangle, Options, RenderError, SIZES, Stats, Target, clip_exceptions, render,
    trace, trace_frame,
};
pub use vertex::{Projected, ScreenVertex};

/// x·2^−shift rounded to nearest, ties up. `shift` is in 1…31, and x has room for half a unit of the result.
const fn nearest(x: i64, shift: u32) -> i64 {
    // The mask changes nothing; with it, a 32-bit processor need not care for larger shifts.
    (x + (1u32 << (shift - 1)) as i64) >> (shift & 31)
}
