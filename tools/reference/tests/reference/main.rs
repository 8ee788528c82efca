//! Tests of the references, and of the report that compares Glint with them.
//!
//! One program has them all, because each program is linked on its own.

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
