//! Experiments on the geometry before rasterization.

pub mod drift;
pub mod precision;
pub mod turns;
