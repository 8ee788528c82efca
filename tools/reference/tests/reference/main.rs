//! Tests of the references, and of the report that compares Glint with the references.
//!
//! All tests are in one program, because linking further programs takes time.

mod cone;
mod exits;
mod field;
mod gesture;
mod imu;
mod lines;
mod rasterizer;
mod raymarched;
mod report;
mod round;
mod stiff;
mod wireframe;
mod workflow;
