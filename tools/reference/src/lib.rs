//! References for Glint's errors, written from the specification and independent of the model, and the report.
//!
//! - [`exact`]: coverage and depth of a snapped triangle in integers.
//! - [`errors`]: RMS and maximum of errors.
//! - [`camera`]: the camera in f64.
//! - [`surface`]: the visible surface of each pixel of the unsnapped scene, and the pixels that depend on snapping.
//! - [`field`]: hits of rays on distance fields, and the errors of pictures of fields.
//! - [`imu`]: attitudes from a gyroscope and an accelerometer, for motions of known truth.
//! - [`report`]: the measurements and pages of docs/report.
//! - [`sine`]: exhaustive error tables of sine and cosine, beside other libraries.
//! - [`smooth`]: errors of light interpolated between vertices, in named scenes.

#![forbid(unsafe_code)]

pub mod camera;
pub mod errors;
pub mod exact;
pub mod field;
pub mod imu;
pub mod report;
pub mod sine;
pub mod smooth;
pub mod surface;
