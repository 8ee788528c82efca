//! Experiment: thresholds of marching rays, the form of rays of fields with fillets.

use glint_core::quality::{Quality, Threshold};
use glint_model::raymarch::{FieldOptions, Tuning};
use serde::{Deserialize, Serialize};

use super::requirements::{MARCHING, SMALL};
use crate::raymarch::metrics::Expected;
use crate::raymarch::raymarched::{self, Measured, RenderedRay, Subject};

/// Errors and cost of a threshold over the pictures of all fields with fillets: a line of `raymarch-fillet.csv`.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Exponent of the part of the threshold that grows with the depth z, z·2^−`footprint`.
    pub footprint: u32,
    /// Constant part of the threshold, in field units with 12 fraction bits.
    pub threshold: u32,
    /// Name of the quality with this threshold.
    pub quality: Option<String>,
    /// Intersection over union of two sets: the pixels that hit in the pictures, and the pixels that hit in the reference.
    pub iou: f64,
    /// Number of rays that reach the step limit.
    pub undecided: usize,
    /// Median error of the depth, in world units.
    pub depth_median: Option<f64>,
    /// 99th percentile of the errors of the depth, in world units.
    pub depth_p99: Option<f64>,
    /// 99th percentile of the angle between the normals of picture and reference on round surfaces, in degrees.
    pub normal_p99: Option<f64>,
    /// Mean number of evaluations per ray.
    pub evaluations: f64,
    /// Largest number of evaluations by a single ray.
    pub evaluations_max: u32,
    /// Names of the requirements that the pictures do not meet.
    pub missed: String,
}

/// Draws the fields with fillets at 320 × 180 with all thresholds.
pub fn measure() -> Vec<Row> {
    let mut subjects = raymarched::rounds(SMALL);
    subjects.retain(|subject| !subject.is_drawn_by_exits());
    let expected = subjects.iter().flat_map(|subject| &subject.expected);
    let expected: Vec<Expected> = expected.copied().collect();
    let thresholds = [13, 14, 15]
        .into_iter()
        .flat_map(|footprint| [1, 2, 4, 8, 16, 28, 64].map(|base| Threshold { base, footprint }));
    thresholds
        .map(|threshold| row(&subjects, &expected, threshold))
        .collect()
}

fn row(subjects: &[Subject], expected: &[Expected], threshold: Threshold) -> Row {
    let picture = |subject: &Subject| -> Vec<RenderedRay> {
        let options = FieldOptions::of(&subject.parsed);
        subject.picture(&FieldOptions {
            tuning: Tuning {
                threshold: threshold.base,
                footprint: threshold.footprint,
                ..options.tuning
            },
            ..options
        })
    };
    let rays: Vec<RenderedRay> = subjects.iter().flat_map(picture).collect();
    let measured = Measured::new(expected, &rays);
    let accuracy = measured.accuracy;
    let mut qualities = Quality::ALL.into_iter();
    let quality = qualities.find(|quality| quality.preset().threshold == threshold);
    Row {
        footprint: threshold.footprint,
        threshold: threshold.base,
        quality: quality.map(|quality| quality.name().to_owned()),
        iou: accuracy.iou,
        undecided: accuracy.undecided,
        depth_median: accuracy.depth.map(|depth| depth.median),
        depth_p99: accuracy.depth.map(|depth| depth.p99),
        normal_p99: accuracy.normal.map(|normal| normal.p99),
        evaluations: measured.cost(),
        evaluations_max: measured.most,
        missed: MARCHING.missed(&accuracy).join(" "),
    }
}
