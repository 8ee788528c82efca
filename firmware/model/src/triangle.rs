//! Bit-exact model of the triangle engine, which draws the pixels of a mesh.
//!
//! Vertices are processed by [`vertex`], and triangles by [`setup`] and [`raster`]. Triangles that cross the guard band or the near plane
//! are first cut by [`clip`]. [`render()`] draws a mesh. [`descriptor`] has the records of triangles that the engine writes to memory.
//! [`vertex_cache`] models the cache that determines which vertices the engine fetches.

mod classify;
pub mod clip;
pub mod descriptor;
mod exceptions;
mod facing;
mod mesh_light;
pub(crate) mod mesh_setup;
mod object;
mod primitive;
pub mod quotient;
pub mod raster;
pub mod reciprocal;
pub mod rectangle;
mod render;
pub(crate) mod rounding;
pub mod setup;
pub mod shade;
pub mod textured;
pub mod vertex;
pub mod vertex_cache;
pub mod volume;

pub use classify::Path;
pub use exceptions::clip_exceptions;
pub use mesh_light::MeshLight;
pub use mesh_setup::MeshSetup;
pub use object::Placement;
pub use primitive::{Options, Placed, light_of, texture_on};
pub use render::{
    DrawnTriangle, Emit, PreparedMesh, Stats, draw_parts, project_chunk, render, set_up_parts,
    trace, trace_frame,
};
pub use vertex::{Projected, ScreenVertex};
pub use volume::Clip;
