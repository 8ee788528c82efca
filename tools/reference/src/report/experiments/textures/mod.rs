//! Experiments on textures: positions of pixels, and the cache for texels.

pub mod cache;
pub mod runs;
