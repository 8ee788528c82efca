//! Sine and cosine: errors over all inputs, of Glint's kernels and of other libraries.
//!
//! - [`truth`]: the f64 reference, and its own error.
//! - [`statistics`]: statistics of the errors.
//! - [`kernels`]: the kernels, each with all inputs of its format.
//! - [`sweep`]: runs a kernel over its inputs on all cores.

pub mod kernels;
pub mod statistics;
pub mod sweep;
pub mod truth;
