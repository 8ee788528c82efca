//! Experiments on textures: positions of pixels, the cache for texels, filters and formats.

pub mod cache;
pub mod filters;
pub mod runs;
