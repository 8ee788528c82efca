//! The triangle engine's modules against the model: each alone, all together, and the control of the engine's passes.

mod control;
mod engine;
mod lists;
mod raster;
mod setup;
mod vertex;
mod vertex_cache;
