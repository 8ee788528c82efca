//! Tests of the model against f64, a plain rasterizer and stated pictures.
//!
//! One program has them all, because each program is linked on its own.

mod clipping;
mod depth;
mod descriptor;
mod frame;
mod light;
mod line;
mod mesh_in_field;
mod objects;
mod orthographic;
mod palette;
mod projection;
mod reciprocal;
mod render;
mod selftest;
mod smooth;
mod stereo;
mod volume;
mod walker;
mod winding;
mod wireframe;
