//! Tests of the references, and of the report that compares Glint with the references.
//!
//! All tests are in one program, because each program takes time to link.

mod cones;
mod field;
mod gesture;
mod imu;
mod lines;
mod picture;
mod rasterizer;
mod raymarched;
mod report;
mod round;
mod stiff;
mod wireframe;
mod workflow;
