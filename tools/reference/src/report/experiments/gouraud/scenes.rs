//! Experiment: errors of the model's smooth shading.

use serde::{Deserialize, Serialize};

use crate::triangle::smooth::{Measured, scenes};

/// Errors of a scene: a line of `gouraud.csv`. Errors are in steps of a colour channel of RGB565.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Description of the scene.
    pub scene: String,
    /// Number of drawn triangles: unclipped triangles, and triangles that the clipper has produced.
    pub triangles: u64,
    /// Number of drawn triangles that the clipper has produced.
    pub clipped: u64,
    /// Number of drawn triangles with a visible back face.
    pub back_faces: u64,
    /// Number of covered pixels, summed over the triangles.
    pub pixels: u64,
    /// Smallest depth code of a covered pixel.
    pub smallest_depth_code: u32,
    /// Upper bound of the model's error (docs/formats/triangle.md, "Smooth shading", plus half a step for the last rounding).
    pub bound: f64,
    /// Largest error of the model's colours.
    pub max_err: f64,
    /// RMS of the errors of the model's colours.
    pub rms: f64,
    /// Largest error of the exact colours after rounding to whole steps.
    pub rounded_max_err: f64,
    /// RMS of the errors of the exact colours after rounding to whole steps.
    pub rounded_rms: f64,
    /// Largest error of colours interpolated linearly on the screen, without the division by depth.
    pub affine_max_err: f64,
    /// RMS of the errors of colours interpolated linearly on the screen.
    pub affine_rms: f64,
}

impl Row {
    fn new(name: &str, bound: f64, measured: &Measured) -> Self {
        Self {
            scene: name.to_owned(),
            triangles: measured.triangles,
            clipped: measured.clipped,
            back_faces: measured.back,
            pixels: measured.pixels,
            smallest_depth_code: measured.farthest,
            bound,
            max_err: measured.model.max,
            rms: measured.model.rms(),
            rounded_max_err: measured.rounded.max,
            rounded_rms: measured.rounded.rms(),
            affine_max_err: measured.affine.max,
            affine_rms: measured.affine.rms(),
        }
    }
}

/// Measures the errors of all scenes.
pub fn measure() -> Vec<Row> {
    scenes()
        .iter()
        .map(|scene| Row::new(scene.name, scene.bound, &scene.measure()))
        .collect()
}
