//! Requirements for pictures of fields, and stricter goals.

use crate::raymarch::metrics::Accuracy;

/// Size in pixels of the pictures in most measurements.
pub const SMALL: (u32, u32) = (320, 180);
/// Size in pixels of full-screen pictures.
pub const LARGE: (u32, u32) = (1280, 720);

/// Bounds of a picture's errors.
pub struct Requirements {
    /// Lower bound of the intersection over union of the pixels that hit in the picture and the pixels that hit in the reference.
    pub iou: f64,
    /// Upper bound of the median error of the depth, in world units.
    pub median: f64,
    /// Upper bound of the 99th percentile of the errors of the depth, in world units.
    pub p99: f64,
    /// Upper bound of the fraction of wrong faces, among the pixels with a hit in both picture and reference.
    pub faces: f64,
    /// Upper bound of the 99th percentile of the angle between normals on round surfaces, in degrees.
    pub normals: f64,
}

/// Bounds of fields that are drawn by exits.
pub const EXITS: Requirements = Requirements {
    iou: 0.99998,
    median: f64::INFINITY,
    p99: 2e-5,
    faces: 2e-4,
    normals: 0.1,
};

/// Goals of fields that are drawn by exits.
pub const EXITS_GOAL: Requirements = Requirements {
    iou: 0.999_999,
    p99: 5e-6,
    faces: 0.0,
    ..EXITS
};

/// Bounds of fields that are drawn by marching rays. These fields have no goals.
pub const MARCHING: Requirements = Requirements {
    iou: 0.999,
    median: 3e-4,
    p99: 3e-3,
    faces: 0.01,
    normals: 0.3,
};

/// Upper bounds of the evaluations per ray of the sponge at 320 × 180: requirement and goal. They allow 300 and 400 frames per second for
/// two eyes with two lanes at 81.25 MHz.
pub const SMALL_COST: [f64; 2] = [4.7, 3.5];
/// Upper bounds of the evaluations per ray of the sponge at 1280 × 720: requirement and goal. They allow 60 and 70 frames per second with
/// two lanes at 81.25 MHz.
pub const LARGE_COST: [f64; 2] = [2.9, 2.5];

impl Requirements {
    /// Returns the names of the bounds that a picture exceeds. The number of evaluations is not checked here.
    pub fn missed(&self, accuracy: &Accuracy) -> Vec<&'static str> {
        let depth = accuracy.depth;
        let normal = accuracy.normal;
        let checks = [
            (accuracy.iou >= self.iou, "IoU"),
            (depth.is_none_or(|d| d.median <= self.median), "median"),
            (depth.is_none_or(|d| d.p99 <= self.p99), "p99"),
            (accuracy.wrong_faces <= self.faces, "faces"),
            (accuracy.undecided == 0, "undecided"),
            (normal.is_none_or(|d| d.p99 <= self.normals), "normals"),
        ];
        let failed = checks.into_iter().filter(|(met, _)| !met);
        failed.map(|(_, name)| name).collect()
    }
}
