//! Experiments on textures: positions of pixels, the cache for texels, filters and formats, and the speed of the engine.

pub mod cache;
pub mod engine;
pub mod filters;
pub mod runs;
