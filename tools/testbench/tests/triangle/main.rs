//! Compares the triangle engine's modules, each alone and all together, with the model, and tests the control of the passes.

mod control;
mod engine;
mod lists;
mod raster;
mod reciprocal;
mod setup;
mod vertex;
mod vertex_cache;
