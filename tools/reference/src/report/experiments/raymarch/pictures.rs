//! Experiment: errors of the model's pictures, compared with exact hits of the rays, and numbers of distance evaluations.

use glint_model::raymarch::FieldOptions;
use serde::{Deserialize, Serialize};

use super::requirements::{LARGE, LARGE_COST, SMALL, SMALL_COST, missed};
use crate::raymarch::Field;
use crate::raymarch::raymarched::{self, Measured, Subject};

/// Errors of a picture and its number of evaluations of the field's distance: a line of `raymarch.csv`. Depths are in world
/// units along the camera's n.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Text form of the field.
    pub scene: String,
    /// Name of the view.
    pub view: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Intersection over union of two sets: the pixels that hit in the picture, and the pixels that hit in the reference.
    pub iou: f64,
    /// Number of pixels where the picture hits and the reference misses.
    pub false_hits: usize,
    /// Number of pixels where the picture misses and the reference hits.
    pub false_misses: usize,
    /// Number of rays that reach the step limit.
    pub undecided: usize,
    /// Median error of depths from the rays' parameters t.
    pub depth_median: Option<f64>,
    /// 99th percentile of the errors of depths from the rays' parameters t.
    pub depth_p99: Option<f64>,
    /// Largest error of depths from the rays' parameters t.
    pub depth_max: Option<f64>,
    /// Median error of depths from depth codes.
    pub code_median: Option<f64>,
    /// 99th percentile of the errors of depths from depth codes.
    pub code_p99: Option<f64>,
    /// Largest error of depths from depth codes.
    pub code_max: Option<f64>,
    /// Fraction of pixels with the wrong face among the pixels that hit in both picture and reference.
    pub wrong_faces: f64,
    /// 99th percentile of the angle between the normals of picture and reference on round surfaces, in degrees.
    pub normal_p99: Option<f64>,
    /// Fraction of unstable pixels. A pixel is unstable if a tiny change of its ray changes the result, because the pixel is close to an
    /// edge.
    pub unstable: f64,
    /// Mean number of evaluations per ray.
    pub evaluations: f64,
    /// Largest number of evaluations by a single ray.
    pub evaluations_max: u32,
    /// Names of the requirements that the picture does not meet.
    pub missed: String,
    /// Names of the goals that the picture does not reach.
    pub not_reached: String,
}

impl Row {
    fn new(subject: &Subject, measured: &Measured) -> Self {
        let &Measured {
            accuracy, coded, ..
        } = measured;
        let (width, height) = subject.size;
        let cost = if width == SMALL.0 {
            SMALL_COST
        } else {
            LARGE_COST
        };
        // Returns the names of the missed requirements (`level` 0) or goals (`level` 1). Round fields have requirements but no
        // goals; flat fields other than the sponge have neither.
        let list = |level: usize| {
            let sponge = matches!(subject.field, Field::Menger { .. });
            let mut missed = if sponge || subject.parsed.is_round() && level == 0 {
                missed(&accuracy, level)
            } else {
                vec![]
            };
            if sponge && measured.cost() > cost[level] {
                missed.push("evaluations");
            }
            missed.join(" ")
        };
        Self {
            scene: subject.scene.clone(),
            view: subject.name.clone(),
            width,
            height,
            iou: accuracy.iou,
            false_hits: accuracy.false_hit,
            false_misses: accuracy.false_miss,
            undecided: accuracy.undecided,
            depth_median: accuracy.depth.map(|depth| depth.median),
            depth_p99: accuracy.depth.map(|depth| depth.p99),
            depth_max: accuracy.depth.map(|depth| depth.max),
            code_median: coded.map(|depth| depth.median),
            code_p99: coded.map(|depth| depth.p99),
            code_max: coded.map(|depth| depth.max),
            wrong_faces: accuracy.wrong_faces,
            normal_p99: accuracy.normal.map(|normal| normal.p99),
            unstable: accuracy.unstable,
            evaluations: measured.cost(),
            evaluations_max: measured.most,
            missed: list(0),
            not_reached: list(1),
        }
    }
}

/// Measures all pictures. `quick` skips pictures of 1280 × 720.
pub fn measure(quick: bool) -> Vec<Row> {
    let small: Vec<Subject> = [
        raymarched::sponges(SMALL),
        raymarched::others(SMALL),
        raymarched::rounds(SMALL),
    ]
    .into_iter()
    .flatten()
    .collect();
    let large = if quick {
        vec![]
    } else {
        raymarched::sponges(LARGE)
    };
    let subjects = small.iter().chain(&large);
    let rows = subjects.map(|subject| {
        let picture = subject.picture(&FieldOptions::of(&subject.parsed));
        Row::new(subject, &Measured::new(&subject.expected, &picture))
    });
    rows.collect()
}
