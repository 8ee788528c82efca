//! Experiment: errors of positions in a texture that are exact at some pixels and interpolated between them.

use serde::{Deserialize, Serialize};

use crate::errors::Errors;
use crate::triangle::textured::{Drawn, Pixel, Scene, blank, scenes};

/// Errors of a form in a scene: a line of `textures-runs.csv`. Errors are in texels of the mip level that is read.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Name of the form.
    pub form: String,
    /// Whether Glint uses the form.
    pub shipped: bool,
    /// Number of divisions for a group of eight pixels.
    pub divisions: f64,
    /// Description of the scene.
    pub scene: String,
    /// Number of pixels.
    pub pixels: u64,
    /// Largest error.
    pub max_err: f64,
    /// RMS of the errors.
    pub rms: f64,
}

/// A method of computing the positions of a row's pixels.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    /// A division at each pixel, as the model does.
    Each,
    /// Divisions at the first pixels of runs of this length, and linear interpolation between them.
    Linear(i32),
    /// Divisions at three pixels of a group of eight, and a parabola through them.
    Parabola,
}

const FORMS: [(&str, Form, f64); 6] = [
    ("each pixel", Form::Each, 8.0),
    ("each second pixel, linear", Form::Linear(2), 4.0),
    ("each fourth pixel, linear", Form::Linear(4), 2.0),
    ("each eighth pixel, linear", Form::Linear(8), 1.0),
    ("each sixteenth pixel, linear", Form::Linear(16), 0.5),
    ("each fourth pixel, a parabola", Form::Parabola, 2.0),
];

/// Measures all forms in all scenes.
#[must_use]
pub fn measure() -> Vec<Row> {
    scenes(&blank(true))
        .iter()
        .flat_map(measure_scene)
        .collect()
}

/// Measures all forms in a scene.
#[must_use]
pub fn measure_scene(scene: &Scene) -> Vec<Row> {
    let mut errors = [Errors::default(); FORMS.len()];
    let mut pixels = 0;
    scene.rows(&mut |drawn, _, row| {
        pixels += row.len() as u64;
        for (i, (pixel, level)) in row.iter().zip(drawn.levels(row)).enumerate() {
            let exact = drawn.exact(pixel);
            for ((_, form, _), errors) in FORMS.iter().zip(&mut errors) {
                let found = form.position(drawn, row, i);
                for axis in 0..2 {
                    errors.add((found[axis] - exact[axis]) / f64::from(1 << level));
                }
            }
        }
    });
    let rows = FORMS
        .iter()
        .zip(errors)
        .map(|((name, form, divisions), errors)| Row {
            form: (*name).to_owned(),
            shipped: *form == Form::Each,
            divisions: *divisions,
            scene: scene.name.to_owned(),
            pixels,
            max_err: errors.max,
            rms: errors.rms(),
        });
    rows.collect()
}

impl Form {
    /// The position of pixel `i` of a row, in texels of level 0. If an end of a run is not covered, the outermost covered pixel replaces
    /// it.
    fn position(self, drawn: &Drawn, row: &[Pixel], i: usize) -> [f64; 2] {
        let first = row[0].column;
        let exact = |column: i32| {
            let place = (column - first).clamp(0, row.len() as i32 - 1) as usize;
            (row[place].column, drawn.exact(&row[place]))
        };
        let column = row[i].column;
        match self {
            Self::Each => {
                // The model's positions have 8 fraction bits, rounded down.
                let place = drawn.textured.places(row[i].depth, row[i].values);
                let exact = drawn.exact(&row[i]);
                [0, 1].map(|axis: usize| {
                    let place = (place[axis] as f64 + 0.5) / 256.0;
                    // Positions are modulo 2^24.
                    place
                        + ((exact[axis] - place) / f64::from(1 << 24)).round() * f64::from(1 << 24)
                })
            }
            Self::Linear(length) => {
                let start = column.div_euclid(length) * length;
                let (from, to) = (exact(start), exact(start + length));
                between(column, &[from, to])
            }
            Self::Parabola => {
                let start = column.div_euclid(8) * 8;
                let ends = [exact(start), exact(start + 4), exact(start + 8)];
                between(column, &ends)
            }
        }
    }
}

/// Evaluates the polynomial through the points at `column`. Of several points in one column, only the first is used.
fn between(column: i32, points: &[(i32, [f64; 2])]) -> [f64; 2] {
    let mut used: Vec<(i32, [f64; 2])> = Vec::new();
    for point in points {
        if used.iter().all(|(other, _)| *other != point.0) {
            used.push(*point);
        }
    }
    [0, 1].map(|axis: usize| {
        let terms = used.iter().map(|&(at, value)| {
            let factors = used.iter().filter(|(other, _)| *other != at);
            factors
                .map(|&(other, _)| f64::from(column - other) / f64::from(at - other))
                .product::<f64>()
                * value[axis]
        });
        terms.sum()
    })
}
