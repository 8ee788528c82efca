//! Experiment: compares pictures of the built-in scenes with one and with four samples a pixel with the mean of 64 samples in f64.
//!
//! - [`compared`]: frames, and their differences from a reference.
//! - [`errors`]: errors of the pictures and, in f64, of patterns of samples.
//! - [`dither`]: matrices of ordered dithering for averages of four samples.
//! - [`light`]: averages in linear light.
//! - [`tables`]: all errors of all scenes.
//! - [`cycles`]: cycles of the pictures on the whole SoC.
//!
//! All pictures are of 1280×720 pixels, in the exact quality. A function that draws states the samples and the rounding, so the defaults of
//! scenes do not matter.

pub mod compared;
pub mod cycles;
pub mod dither;
pub mod errors;
pub mod light;
pub mod tables;
