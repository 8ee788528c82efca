//! Errors of sine and cosine over all inputs, for Glint's kernels and for other libraries.
//!
//! - [`truth`]: the reference values in f64, and their error.
//! - [`statistics`]: maximum, RMS and percentiles of the errors.
//! - [`kernels`]: the measured kernels and their inputs.
//! - [`sweep`]: measurement of a kernel over its inputs on all cores of the computer.

pub mod kernels;
pub mod statistics;
pub mod sweep;
pub mod truth;
