//! Errors of sine and cosine over all inputs, for Glint's kernels and for other libraries.
//!
//! - [`truth`]: the exact values in f64, and their own error.
//! - [`statistics`]: maximum, RMS and percentiles of the errors.
//! - [`kernels`]: the measured kernels, each with all inputs of its format.
//! - [`sweep`]: runs a kernel over its inputs on all cores.

pub mod kernels;
pub mod statistics;
pub mod sweep;
pub mod truth;
