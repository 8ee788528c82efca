//! The model's triangle pipeline against the exact rasterizer and the f64 scene.
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
