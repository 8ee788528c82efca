//! Trials of marching rays with different parameters. Each trial draws the four views of the sponge at 320 × 180.

use std::cell::RefCell;

use glint_model::raymarch::{FieldOptions, Palette};
use glint_testbench::Raymarcher;
use indicatif::ProgressBar;
use serde::{Deserialize, Serialize};

use super::requirements::MARCHING;
use crate::camera::{Ray, Size};
use crate::raymarch::Field;
use crate::raymarch::metrics::{Expected, RayOutcome};
use crate::raymarch::raymarched::{self, Measured, RenderedRay, Subject, marching};
use crate::raymarch::variant::{Method, entry};

/// Errors and cost of one configuration of the parameters: a line of a study's CSV file.
#[derive(Serialize, Deserialize)]
pub struct Trial {
    /// Name of the line of related configurations in the diagram.
    pub family: String,
    /// Value of the varied parameter.
    pub config: String,
    /// Whether the configuration is that of the marching rays in the comparison with exits.
    pub shipped: bool,
    /// Intersection over union of two sets: the pixels that hit in the pictures, and the pixels that hit in the reference.
    pub iou: f64,
    /// Number of rays that reach the step limit.
    pub undecided: usize,
    /// Median error of the depth, in world units.
    pub depth_median: Option<f64>,
    /// 99th percentile of the errors of the depth, in world units.
    pub depth_p99: Option<f64>,
    /// Largest error of the depth, in world units.
    pub depth_max: Option<f64>,
    /// Fraction of pixels with the wrong face among the pixels that hit in both picture and reference.
    pub wrong_faces: f64,
    /// Mean number of evaluations of the field's distance per ray.
    pub evaluations: f64,
    /// Mean clocks of the verilated raymarcher per picture; `None` for configurations that exist only in software.
    pub cycles: Option<f64>,
    /// Names of the requirements that the trial does not meet.
    pub failed: String,
}

/// The views of every trial with their reference pictures, and the raymarcher.
pub struct Views<'a> {
    subjects: &'a [Subject],
    expected: Vec<Expected>,
    raymarcher: RefCell<Raymarcher>,
    bar: ProgressBar,
}

impl<'a> Views<'a> {
    /// Collects the data for all trials. `subjects` are the views, and `bar` displays the running trial.
    pub fn new(subjects: &'a [Subject], bar: ProgressBar) -> Self {
        let expected = subjects.iter().flat_map(|subject| &subject.expected);
        Self {
            subjects,
            expected: expected.copied().collect(),
            raymarcher: RefCell::new(Raymarcher::new("raymarcher", 1)),
            bar,
        }
    }

    /// Draws all views with `draw` and compares the pictures with the reference. Adds `added` evaluations per hit to the number of
    /// evaluations that `draw` returns.
    pub fn trial(
        &self,
        family: &str,
        config: String,
        added: u32,
        draw: impl Fn(&Subject) -> Vec<RenderedRay>,
    ) -> Trial {
        self.bar.set_message(format!("{family}, {config}"));
        let found: Vec<RenderedRay> = self.subjects.iter().flat_map(draw).collect();
        let measured = Measured::new(&self.expected, &found);
        let accuracy = measured.accuracy;
        let hit = |ray: &&RenderedRay| matches!(ray.outcome, RayOutcome::Hit { .. });
        let hits = found.iter().filter(hit).count();
        Trial {
            family: family.to_owned(),
            config,
            shipped: false,
            iou: accuracy.iou,
            undecided: accuracy.undecided,
            depth_median: accuracy.depth.map(|depth| depth.median),
            depth_p99: accuracy.depth.map(|depth| depth.p99),
            depth_max: accuracy.depth.map(|depth| depth.max),
            wrong_faces: accuracy.wrong_faces,
            evaluations: measured.cost() + (hits as f64 * f64::from(added)) / found.len() as f64,
            cycles: None,
            failed: MARCHING.missed(&accuracy, 0).join(" "),
        }
    }

    /// Draws the views with the model, which provides the errors, and with the verilated raymarcher, which provides the clocks.
    pub fn model(&self, family: &str, config: String, options: &FieldOptions) -> Trial {
        let mut trial = self.trial(family, config, 0, |subject| subject.picture(options));
        trial.shipped = *options == marching();
        let mut raymarcher = self.raymarcher.borrow_mut();
        let palette = Palette::default();
        let pictures = self.subjects.iter();
        let clocks: u64 = pictures
            .map(|subject| {
                raymarcher
                    .draw(None, &subject.setup(options), &palette)
                    .clocks
            })
            .sum();
        trial.cycles = Some(clocks as f64 / self.subjects.len() as f64);
        trial
    }

    /// Draws the views with a method in f64. A ray starts at the start of the model's ray of the same pixel or, with
    /// `exact_entry`, exactly at the cube around the sponge.
    pub fn variant(
        &self,
        family: &str,
        config: String,
        method: &Method,
        exact_entry: bool,
    ) -> Trial {
        self.trial(family, config, 0, |subject| {
            let Field::Menger { depth } = subject.field else {
                unreachable!("trials draw the sponge");
            };
            let setup = subject.setup(&marching());
            let marching = setup.marching().expect("marching rays");
            pixels(subject)
                .map(|(x, y, ray)| {
                    let begin = if exact_entry {
                        entry(&ray).max(subject.camera.near)
                    } else {
                        let ray = marching.ray(0, x, y);
                        raymarched::depth(&setup, marching.depth_of(&ray, ray.start))
                    };
                    method.march(depth, &ray, begin)
                })
                .collect()
        })
    }
}

/// Returns the column, row and ray of each pixel of a subject, row by row.
pub fn pixels(subject: &Subject) -> impl Iterator<Item = (u32, u32, Ray)> {
    let (width, height) = subject.size;
    let size = Size { width, height };
    let camera = subject.camera;
    (0..width * height).map(move |i| {
        let (x, y) = (i % width, i / width);
        (x, y, camera.ray([x, y].map(f64::from), size))
    })
}
