//! Compares the triangle engine's modules with the model, each alone and all together, and tests the control of its passes.

mod control;
mod engine;
mod lists;
mod raster;
mod reciprocal;
mod setup;
mod vertex;
mod vertex_cache;
