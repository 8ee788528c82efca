//! References that Glint is measured against, written from the rules and not from the model.
//!
//! - [`exact`]: coverage and depth of a snapped triangle in integers.
//! - [`camera`]: the camera in f64.
//! - [`surface`]: what each pixel of the unsnapped scene shows, and where that depends on snapping.
//! - [`field`]: what a ray hits of a solid that is given by its distance field, and the errors of pictures of it.
//! - [`imu`]: attitudes from a gyroscope and an accelerometer, of motions whose truth is known.
//! - [`sine`]: exhaustive error tables of sine and cosine, beside other libraries.
//! - [`smooth`]: what interpolation of light between vertices makes of named scenes, and the errors of it.

#![forbid(unsafe_code)]

pub mod camera;
pub mod exact;
pub mod field;
pub mod imu;
pub mod report;
pub mod sine;
pub mod smooth;
pub mod surface;
