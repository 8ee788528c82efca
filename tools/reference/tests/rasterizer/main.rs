//! Compares the model's triangle pipeline with the exact rasterizer and with the scene in f64.
//!
//! All scenes come from fixed seeds, and a failure names the case and the triangle. `--nocapture` shows the measured figures.

mod cameras;
mod coverage;
mod fans;
mod llvmpipe;
mod renderer;
mod scenes;
mod shade;
mod smooth;
mod special;
mod vertices;
mod visible;
