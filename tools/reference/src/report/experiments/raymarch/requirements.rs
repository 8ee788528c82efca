//! Requirements for raymarched pictures, and stricter goals. Each pair of numbers is a requirement and its goal.

use crate::raymarch::metrics::Accuracy;

/// Size in pixels of the pictures in most measurements.
pub const SMALL: (u32, u32) = (320, 180);
/// Size in pixels of full-screen pictures.
pub const LARGE: (u32, u32) = (1280, 720);

/// Lower bounds of the intersection over union of the pixels that hit in the picture and the pixels that hit in the reference.
pub const IOU: [f64; 2] = [0.999, 0.9999];
/// Upper bounds of the median error of the depth, in world units.
pub const MEDIAN: [f64; 2] = [3e-4, 2e-4];
/// Upper bounds of the 99th percentile of the errors of the depth, in world units.
pub const P99: [f64; 2] = [3e-3, 5e-4];
/// Upper bounds of the fraction of wrong faces, among the pixels with a hit in both picture and reference.
pub const FACES: [f64; 2] = [0.01, 0.003];
/// Upper bound of the 99th percentile of the angle between normals on round surfaces, in degrees; there is no goal.
pub const NORMALS: f64 = 0.3;
/// Upper bounds of the distance evaluations per ray at 320 × 180. The requirement allows 60 frames per second for two eyes with
/// two lanes at 81.25 MHz.
pub const SMALL_COST: [f64; 2] = [23.5, 11.7];
/// Upper bounds of the distance evaluations per ray at 1280 × 720.
pub const LARGE_COST: [f64; 2] = [14.4, 11.5];

/// Returns the names of a picture's missed requirements (`level` 0) or goals (`level` 1). The number of evaluations is not
/// checked here.
pub fn missed(accuracy: &Accuracy, level: usize) -> Vec<&'static str> {
    let depth = accuracy.depth;
    let checks = [
        (accuracy.iou >= IOU[level], "IoU"),
        (depth.is_none_or(|d| d.median <= MEDIAN[level]), "median"),
        (depth.is_none_or(|d| d.p99 <= P99[level]), "p99"),
        (accuracy.wrong_faces <= FACES[level], "faces"),
        (accuracy.undecided == 0, "undecided"),
        (accuracy.normal.is_none_or(|d| d.p99 <= NORMALS), "normals"),
    ];
    let failed = checks.into_iter().filter(|(met, _)| !met);
    failed.map(|(_, name)| name).collect()
}
