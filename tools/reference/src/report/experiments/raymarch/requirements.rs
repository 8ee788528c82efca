//! Requirements on pictures of fields, and goals beyond them. The first number of each pair is the requirement, the second the
//! goal.

use crate::raymarch::metrics::Accuracy;

/// Pictures of most measurements.
pub const SMALL: (u32, u32) = (320, 180);
/// Pictures of the monitor's size.
pub const LARGE: (u32, u32) = (1280, 720);

/// Smallest intersection over union of the masks.
pub const IOU: [f64; 2] = [0.999, 0.9999];
/// Largest median error of the depth, in world units.
pub const MEDIAN: [f64; 2] = [3e-4, 2e-4];
/// Largest 99th percentile of the depth's error, in world units.
pub const P99: [f64; 2] = [3e-3, 5e-4];
/// Largest fraction of wrong faces among common hits.
pub const FACES: [f64; 2] = [0.01, 0.003];
/// Largest 99th percentile of the angle between normals of round surfaces, in degrees.
pub const NORMALS: f64 = 0.3;
/// Most evaluations a ray at 320 × 180: 60 frames a second for two eyes, from two lanes at 81.25 MHz.
pub const SMALL_COST: [f64; 2] = [23.5, 11.7];
/// Most evaluations a ray at 1280 × 720.
pub const LARGE_COST: [f64; 2] = [14.4, 11.5];

/// Names of the requirements (level 0) or goals (level 1) that a picture misses, without its cost.
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
