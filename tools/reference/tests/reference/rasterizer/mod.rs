//! Compares the model of the triangle engine with an exact rasterizer and with computations in f64.
//!
//! All scenes are random with fixed seeds; a failure names the case and the triangle. `--nocapture` shows the measured figures.

mod cameras;
mod coverage;
mod quarters;
mod scenes;
mod shade;
mod smooth;
mod special;
mod visible;
