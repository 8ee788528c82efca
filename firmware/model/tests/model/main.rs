//! Tests of the model against f64, a plain rasterizer and stated pictures.
//!
//! All tests are in one program, to avoid linking one program per file.

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
