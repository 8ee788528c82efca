//! The triangle engine's modules against the model: alone, together, and behind their registers.

mod control;
mod engine;
mod lists;
mod raster;
mod setup;
mod vertex;
mod vertex_cache;
