//! Compares the triangle engine's modules, each module alone and all modules together, with the
//! model, and tests the control of the passes.

mod control;
mod engine;
mod fog;
mod lists;
mod raster;
mod reciprocal;
mod setup;
mod vertex;
mod vertex_cache;
