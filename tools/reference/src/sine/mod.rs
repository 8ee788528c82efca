//! Sine and cosine: error tables over every input, for Glint's kernels and beside other libraries.
//!
//! - [`truth`]: the f64 reference, and how wrong it is itself.
//! - [`statistics`]: what is kept of the errors.
//! - [`subjects`]: the kernels, each with all its natural inputs.
//! - [`sweep`]: runs a subject over its inputs on all cores.

pub mod statistics;
pub mod subjects;
pub mod sweep;
pub mod truth;
