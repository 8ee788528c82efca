//! Compares the modules of the line engine with glint-model: the pieces from the set-up, and the pixels from the raster.

mod raster;
mod segments;
mod setup;
