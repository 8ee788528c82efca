//! Kernels of the geometry with other word lengths than those in use.
//!
//! The report measures their errors on the host and their cycles on the soft core (`cargo xtask report geometry`), from this one
//! source. Nothing else uses them.
#![no_std]
#![forbid(unsafe_code)]

pub mod matrix;
pub mod normal;
pub mod reciprocal;
