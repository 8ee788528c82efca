//! Experiment: errors of the model's pictures, compared with exact hits of the rays, and numbers of evaluations.

use glint_model::raymarch::{FieldOptions, Palette};
use glint_testbench::Raymarcher;
use serde::{Deserialize, Serialize};

use super::requirements::{
    EXITS, EXITS_GOAL, LARGE, LARGE_COST, MARCHING, Requirements, SMALL, SMALL_COST,
};
use crate::raymarch::Field;
use crate::raymarch::raymarched::{self, Measured, Subject};

/// The form of a picture's rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// Rays cross each empty prism in one step (docs/raymarch-exits.md).
    Exits,
    /// Rays advance by the field's distance.
    Marching,
}

/// Errors of a picture and its number of evaluations of the field: a line of `raymarch.csv`. Depths are in world units along the
/// camera's n.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Form of the rays.
    pub form: Form,
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
    /// Clocks of the verilated raymarcher alone for the picture; `None` for marching rays, and in a quick measurement.
    pub cycles: Option<u64>,
    /// Names of the requirements that the picture does not meet.
    pub missed: String,
    /// Names of the goals that the picture does not reach.
    pub not_reached: String,
}

impl Row {
    /// Draws the picture of a subject with the model. With `raymarcher`, measures the clocks too.
    pub fn measure(subject: &Subject, raymarcher: Option<&mut Raymarcher>) -> Self {
        let setup = subject.setup(&FieldOptions::of(&subject.parsed));
        let measured = Measured::new(&subject.expected, &raymarched::picture(&setup, 0));
        let mut row = Self::new(subject, &measured);
        row.cycles =
            raymarcher.map(|raymarcher| raymarcher.draw(None, &setup, &Palette::default()).clocks);
        row
    }

    /// Whether both rows are of the same picture.
    pub fn shows_the_same_as(&self, other: &Self) -> bool {
        (&self.scene, &self.view, self.width) == (&other.scene, &other.view, other.width)
            && self.form == other.form
    }

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
        let (form, bounds, goal) = match subject.is_drawn_by_exits() {
            true => (Form::Exits, EXITS, Some(EXITS_GOAL)),
            false => (Form::Marching, MARCHING, None),
        };
        let is_sponge = matches!(subject.field, Field::Menger { .. });
        let list = |bounds: &Requirements, cost: f64| {
            let mut missed = bounds.missed(&accuracy);
            if is_sponge && measured.cost() > cost {
                missed.push("evaluations");
            }
            missed.join(" ")
        };
        Self {
            form,
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
            cycles: None,
            missed: list(&bounds, cost[0]),
            not_reached: goal.map_or_else(String::new, |goal| list(&goal, cost[1])),
        }
    }
}

/// The pictures of 320 × 180.
pub fn small() -> Vec<Subject> {
    let mut subjects = raymarched::sponges(SMALL);
    subjects.extend(raymarched::others(SMALL));
    subjects.extend(raymarched::rounds(SMALL));
    subjects
}

/// Measures all pictures. `quick` skips pictures of 1280 × 720, and clocks.
pub fn measure(quick: bool) -> Vec<Row> {
    let mut subjects = small();
    let mut raymarcher = None;
    if !quick {
        subjects.extend(raymarched::sponges(LARGE));
        raymarcher = Some(Raymarcher::new("raymarcher", 1));
    }
    let measure = |subject: &Subject| {
        let raymarcher = raymarcher.as_mut();
        Row::measure(subject, raymarcher.filter(|_| subject.is_drawn_by_exits()))
    };
    subjects.iter().map(measure).collect()
}
