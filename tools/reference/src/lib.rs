//! References for Glint's errors, written from the specification and independent of the model, and the report.
//!
//! - [`errors`]: RMS and maximum of errors.
//! - [`camera`]: the camera in f64.
//! - [`raymarch`]: hits of rays on distance fields, and the errors of pictures of fields.
//! - [`imu`]: attitudes from a gyroscope and an accelerometer, for motions of known truth.
//! - [`report`]: the measurements and pages of docs/report.
//! - [`sine`]: exhaustive error tables of sine and cosine, beside other libraries.
//! - [`triangle`]: the exact rasterizer, the visible surface of each pixel, errors of smooth shading.

#![forbid(unsafe_code)]

pub mod camera;
pub mod errors;
pub mod imu;
pub mod raymarch;
pub mod report;
pub mod sine;
pub mod triangle;
