//! Experiment: errors and evaluations of rays by exits for several word lengths, compared with exact hits in f64.

use anyhow::Result;
use glint::scene::{self, Changes};
use glint_model::raymarch::exits::{Exits, Words};
use serde::{Deserialize, Serialize};

use super::requirements::{LARGE, SMALL};
use crate::camera::{Camera, Size};
use crate::raymarch::exited;
use crate::raymarch::metrics;
use crate::raymarch::raymarched::{self, Measured, RenderedRay, Subject};
use crate::raymarch::views;
use crate::report::experiments::quality;

/// Errors of a picture with a set of word lengths: a line of `raymarch-words.csv`. Depths are in world units along the camera's n.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Name of the varied word length, or `chosen` for the gateware's.
    pub family: String,
    /// Text form of the field.
    pub scene: String,
    /// Name of the view.
    pub view: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Fraction bits of a direction's component whose reciprocal is taken.
    pub component: u32,
    /// Fraction bits of a direction's component in T·D.
    pub direction: u32,
    /// Fraction bits of the mantissa of a reciprocal.
    pub inverse: u32,
    /// Fraction bits of the parameter T.
    pub parameter: u32,
    /// Fraction bits of the linear functions of a cone, for spheres of a list.
    pub outline: u32,
    /// Fraction bits of q·D, for spheres of a lattice.
    pub along: u32,
    /// Intersection over union of two sets: the pixels that hit in the picture, and the pixels that hit in the reference.
    pub iou: f64,
    /// Number of pixels where the picture hits and the reference misses.
    pub false_hits: usize,
    /// Number of pixels where the picture misses and the reference hits.
    pub false_misses: usize,
    /// Fraction of pixels with the wrong face among the pixels that hit in both picture and reference.
    pub wrong_faces: f64,
    /// Median error of depths.
    pub depth_median: Option<f64>,
    /// 99th percentile of the errors of depths.
    pub depth_p99: Option<f64>,
    /// Largest error of depths.
    pub depth_max: Option<f64>,
    /// 99th percentile of the angle between the normals of picture and reference on round surfaces, in degrees.
    pub normal_p99: Option<f64>,
    /// Mean number of evaluations of the flat solid or the lattice per ray.
    pub evaluations: f64,
    /// Largest number of evaluations by a single ray.
    pub evaluations_max: u32,
    /// Mean number of tested spheres of a list per ray.
    pub tests: f64,
}

/// A set of word lengths, with the name of the varied word.
pub type Family = (&'static str, Words);

/// Word lengths far longer than the gateware's.
const WIDE: Words = Words {
    component: 27,
    direction: 24,
    inverse: 24,
    parameter: 16,
    outline: 22,
    along: 20,
};

/// All sets of word lengths: the gateware's, and sets in which one word is shorter than in [`WIDE`].
fn families() -> Vec<Family> {
    let mut families = vec![("chosen", Words::CHOSEN), ("wide", WIDE)];
    let mut vary = |name, bits: &[u32], with: fn(u32) -> Words| {
        families.extend(bits.iter().map(|&bits| (name, with(bits))));
    };
    vary("component", &[24, 25, 26], |component| Words {
        component,
        ..WIDE
    });
    vary("direction", &[13, 15, 17, 19, 21, 23], |direction| Words {
        direction,
        ..WIDE
    });
    vary("inverse", &[14, 16, 17, 18, 20, 22], |inverse| Words {
        inverse,
        ..WIDE
    });
    vary("parameter", &[9, 10, 11, 12, 13, 14], |parameter| Words {
        parameter,
        ..WIDE
    });
    vary("outline", &[12, 14, 16, 17, 18, 20], |outline| Words {
        outline,
        ..WIDE
    });
    vary("along", &[8, 10, 11, 12, 14, 16], |along| Words {
        along,
        ..WIDE
    });
    families
}

/// Whether a word length has an effect on the pictures of a field.
fn concerns(family: &str, scene: &str) -> bool {
    let list = scene.contains("sphere") || scene.contains("moving");
    match family {
        "outline" => list,
        "along" => scene.starts_with("lattice"),
        "direction" => !list || scene.starts_with("union"),
        _ => true,
    }
}

/// Measures the pictures of the report and of the built-in scenes at 320 × 180 with all word lengths, and the sponge and the scenes at
/// 1280 × 720 with the gateware's word lengths.
///
/// # Errors
/// A scene cannot be drawn.
pub fn measure() -> Result<Vec<Row>> {
    let mut jobs: Vec<(Subject, Vec<Family>)> = Vec::new();
    for subject in subjects(SMALL)? {
        let of_field = |(name, _): &Family| concerns(name, &subject.scene);
        let families = families().into_iter().filter(of_field).collect();
        jobs.push((subject, families));
    }
    for subject in large()? {
        jobs.push((subject, vec![("chosen", Words::CHOSEN)]));
    }
    let pictures = jobs.iter();
    Ok(pictures
        .flat_map(|(subject, families)| families.iter().map(|family| row(subject, family)))
        .collect())
}

/// The pictures of the report, sponges of other depths, an octahedron, and the built-in scenes of fields, drawn for one eye.
pub fn subjects(size: (u32, u32)) -> Result<Vec<Subject>> {
    let mut subjects = raymarched::sponges(size);
    let aside = views::camera([1.25, -1.875, 0.40625], [0.0; 3]);
    let close = views::camera([0.5, -1.25, 0.4375], [0.375, -1.0, 0.3125]);
    subjects.extend(
        [1, 2, 3, 5, 6]
            .map(|depth| Subject::new("close", &format!("menger:{depth}"), &close, size)),
    );
    subjects.extend(raymarched::others(size));
    subjects.push(Subject::new("aside", "octahedron:1", &aside, size));
    subjects.extend(raymarched::rounds(size));
    subjects.push(Subject::new(
        "close",
        "union:menger:5+moving:0.5,1,60",
        &close,
        size,
    ));
    subjects.extend(scenes(size)?);
    subjects.retain(|subject| !subject.scene.starts_with("smooth"));
    Ok(subjects.into_iter().map(to_the_far_limit).collect())
}

/// The pictures of 1280 × 720.
fn large() -> Result<Vec<Subject>> {
    let mut subjects = raymarched::sponges(LARGE);
    subjects.extend(scenes(LARGE)?);
    Ok(subjects.into_iter().map(to_the_far_limit).collect())
}

/// The built-in scenes of fields, drawn for one eye.
fn scenes(size: (u32, u32)) -> Result<Vec<Subject>> {
    let mut subjects = Vec::new();
    for one in quality::scenes("") {
        let seen = scene::draw(&one, &Changes::default(), |frame| {
            let field = frame.subject.field_part()?.field.to_string();
            Some((field, Camera::of(&frame.view)))
        })?;
        if let Some((field, camera)) = seen {
            subjects.push(Subject::new(one.name(), &field, &camera, size));
        }
    }
    Ok(subjects)
}

/// Extends the reference picture of an endless field to the far limit of rays by exits, and to the end of a repeated solid.
fn to_the_far_limit(mut subject: Subject) -> Subject {
    if subject.parsed.is_endless() {
        let exits = exits(&subject, WIDE);
        let (width, height) = subject.size;
        let size = Size { width, height };
        let limits = (subject.camera.near, exited::depth(&exits, exits.far));
        subject.expected = metrics::expected(&subject.field, size, limits, |pixel| {
            subject.camera.ray(pixel, size)
        });
        for (pixel, i) in subject.expected.iter_mut().zip(0..) {
            let place = [i % width, i / width].map(f64::from);
            let direction = subject.camera.ray(place, size).direction;
            let reach = exited::reach(&exits, 0, direction);
            pixel.hit = pixel.hit.filter(|hit| hit.t <= reach);
        }
    }
    subject
}

/// The model's constants of a subject's picture.
pub fn exits(subject: &Subject, words: Words) -> Exits {
    let view = subject.camera.view().expect("a subject's camera");
    Exits::new(&subject.parsed, &view, subject.size, None, words).expect("a supported size")
}

/// Measures a picture with the word lengths of a family.
pub fn row(subject: &Subject, &(family, words): &Family) -> Row {
    let exits = exits(subject, words);
    let (rays, tests): (Vec<RenderedRay>, Vec<u32>) =
        exited::picture(&exits, 0).into_iter().unzip();
    let measured = Measured::new(&subject.expected, &rays);
    let Measured { accuracy, most, .. } = measured;
    let depth = |of: fn(&metrics::Quantiles) -> f64| accuracy.depth.as_ref().map(of);
    Row {
        family: family.to_owned(),
        scene: subject.scene.clone(),
        view: subject.name.clone(),
        width: subject.size.0,
        height: subject.size.1,
        component: words.component,
        direction: words.direction,
        inverse: words.inverse,
        parameter: words.parameter,
        outline: words.outline,
        along: words.along,
        iou: accuracy.iou,
        false_hits: accuracy.false_hit,
        false_misses: accuracy.false_miss,
        wrong_faces: accuracy.wrong_faces,
        depth_median: depth(|depth| depth.median),
        depth_p99: depth(|depth| depth.p99),
        depth_max: depth(|depth| depth.max),
        normal_p99: accuracy.normal.map(|normal| normal.p99),
        evaluations: measured.cost(),
        evaluations_max: most,
        tests: f64::from(tests.iter().sum::<u32>()) / tests.len().max(1) as f64,
    }
}
