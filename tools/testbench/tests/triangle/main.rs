//! The triangle engine's modules against the model: each alone, together, and behind their registers.

mod control;
mod engine;
mod lists;
mod raster;
mod setup;
mod vertex;
mod vertex_cache;
