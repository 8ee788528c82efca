//! References for Glint's computations, written from the specification and not from the model, and the measurements of the report.
//!
//! - [`emulated`]: the emulated board, which runs the built firmware.
//! - [`errors`]: RMS and maximum of errors.
//! - [`basis`]: the deviation of a camera's basis from an orthonormal basis.
//! - [`camera`]: projection, rays, clipping and depth scale of a camera, in f64.
//! - [`raymarch`]: hits of rays on distance fields, and the errors of the raymarcher's pictures.
//! - [`gesture`]: camera frames with a hand, and the errors of the camera's control by the hand.
//! - [`imu`]: attitudes from a gyroscope and an accelerometer, for motions with known true attitudes.
//! - [`line`](mod@line): exact pixels of a segment, by the diamond-exit rule.
//! - [`object`]: drift of objects that turn by many small steps.
//! - [`picture`]: whole pictures in f64, and the errors of the model's pictures as displayed on a monitor.
//! - [`report`]: the measurements and pages of docs/report.
//! - [`sine`]: errors of sine and cosine over all inputs, for Glint's kernels and for other libraries.
//! - [`stiff`]: the catalogue of stiff and extreme cases.
//! - [`triangle`]: an exact rasterizer, the visible surface of each pixel, and the errors of smooth shading.
//! - [`wireframe`]: drift of the wireframe simulator's motions over many steps.

#![forbid(unsafe_code)]

pub mod basis;
pub mod emulated;
pub mod errors;
pub mod gesture;
pub mod imu;
pub mod line;
pub mod object;
pub mod picture;
pub mod raymarch;
pub mod report;
pub mod sine;
pub mod stiff;
pub mod triangle;
pub mod wireframe;

pub use glint_vectors::camera;
