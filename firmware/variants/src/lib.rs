//! Kernels of the geometry with other word lengths than those in use, and other filters for the camera's control by a hand.
//!
//! The report measures their errors on the host and their cycles on the soft core (`cargo xtask report`), from this one
//! source. Nothing else uses them.
#![no_std]
#![forbid(unsafe_code)]

pub mod filter;
pub mod matrix;
pub mod normal;
pub mod reciprocal;
