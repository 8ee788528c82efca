//! Compares the modules of the line engine with glint-model: the set-up by its pieces, the raster by its pixels.

mod raster;
mod segments;
mod setup;
