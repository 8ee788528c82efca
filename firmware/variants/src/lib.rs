//! Kernels that Glint uses, and kernels of other word lengths, other methods and other libraries for comparison.
//!
//! The report measures their errors on the host and their cycles on the soft core (`cargo xtask report`), from this single source. No
//! other code uses this crate.
#![no_std]
#![forbid(unsafe_code)]

pub mod colour;
pub mod division;
pub mod filter;
pub mod inverse_root;
pub mod kernel;
pub mod length;
pub mod matrix;
pub mod normal;
pub mod reciprocal;
pub mod root;
pub mod unit;
