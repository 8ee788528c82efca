//! Experiment: errors of smooth shading in different forms (methods and word lengths).

use serde::{Deserialize, Serialize};

use crate::errors::Errors;
use crate::triangle::smooth::forms::{Form, Inverse, Light};
use crate::triangle::smooth::{Interpolated, RANGES, Scene, scenes};

/// Errors of a form in a scene: a line of `gouraud-forms.csv`. Errors are in steps of a colour channel of RGB565.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Name of the family of forms.
    pub family: String,
    /// Name of the form in its family.
    pub form: String,
    /// Whether Glint itself uses the form.
    pub shipped: bool,
    /// Description of the scene.
    pub scene: String,
    /// Whether depth or light change strongly between neighbouring pixels.
    pub stiff: bool,
    /// Number of covered pixels, summed over the triangles.
    pub pixels: u64,
    /// Largest error before the last rounding.
    pub max_err: f64,
    /// RMS of the errors before the last rounding.
    pub rms: f64,
    /// Largest difference from the rounded exact colour, in whole steps.
    pub steps: u32,
    /// Fraction of the channel values that differ from the rounded exact colour.
    pub differing: f64,
}

/// Families and names of all forms.
pub const FORMS: [(&str, &str, Form); 9] = [
    ("affine", AFFINE, Form::Affine),
    (ENDS, "first and last lane", Form::GroupEnds),
    (ENDS, "first and last covered pixel", Form::CoveredEnds),
    (PIXELS, "16 entries of 11 bits", table(4)),
    (PIXELS, "64 entries of 13 bits", table(6)),
    (PIXELS, "256 entries of 15 bits", table(8)),
    (PIXELS, SHIPPED, Form::Pixels(Inverse::GLINT)),
    (PIXELS, "4096 entries of 19 bits", table(12)),
    (PIXELS, "64 entries and a Newton step", NEWTON),
];

const ENDS: &str = "ends of a group";
const PIXELS: &str = "each pixel";
/// Name of the form without division.
pub const AFFINE: &str = "linear on the screen";
/// Name of the form that Glint uses.
pub const SHIPPED: &str = "1024 entries of 17 bits";
const NEWTON: Form = Form::Pixels(Inverse {
    index: 6,
    newton: true,
});

const fn table(index: u32) -> Form {
    Form::Pixels(Inverse {
        index,
        newton: false,
    })
}

/// Measures all forms in all scenes.
pub fn measure() -> Vec<Row> {
    let scenes = scenes();
    let rows = scenes.iter().flat_map(|scene| {
        eprintln!("{} …", scene.name);
        measure_scene(scene)
    });
    rows.collect()
}

/// Accumulated errors of a form in a scene.
#[derive(Clone, Copy, Default)]
struct Measured {
    errors: Errors,
    steps: u32,
    differing: u64,
}

/// Measures all forms in a scene.
///
/// # Panics
/// When the light of Glint's form differs from the light that the model computes.
pub fn measure_scene(scene: &Scene) -> Vec<Row> {
    let mut measured = [Measured::default(); FORMS.len()];
    let mut pixels = 0;
    for triangle in scene.triangles() {
        let Some(setup) = triangle.setup() else {
            continue;
        };
        let light = Light {
            setup: &setup,
            exact: Interpolated::new(&triangle.oriented.vertices, &triangle.lit),
        };
        let drawn = triangle.pixels(&setup);
        pixels += drawn.len() as u64;
        for group in drawn.chunk_by(|a, b| (a.row, a.column / 8) == (b.row, b.column / 8)) {
            let exact: Vec<_> = group
                .iter()
                .map(|pixel| light.exact.perspective(pixel.centre()))
                .collect();
            for ((_, _, form), measured) in FORMS.iter().zip(&mut measured) {
                let found = light.group(*form, group);
                if *form == Form::Pixels(Inverse::GLINT) {
                    for (pixel, found) in group.iter().zip(&found) {
                        assert_eq!(
                            rounded(found),
                            pixel.colour.channels().map(u32::from),
                            "{pixel:?}"
                        );
                    }
                }
                for (found, exact) in found.iter().zip(&exact) {
                    measured.add(found, exact);
                }
            }
        }
    }
    let rows = FORMS
        .iter()
        .zip(measured)
        .map(|((family, name, form), measured)| Row {
            family: (*family).to_owned(),
            form: (*name).to_owned(),
            shipped: *form == Form::Pixels(Inverse::GLINT),
            scene: scene.name.to_owned(),
            stiff: scene.stiff,
            pixels,
            max_err: measured.errors.max,
            rms: measured.errors.rms(),
            steps: measured.steps,
            differing: measured.differing as f64 / (3 * pixels) as f64,
        });
    rows.collect()
}

impl Measured {
    /// Adds the light of a pixel.
    fn add(&mut self, found: &[f64; 3], exact: &[f64; 3]) {
        let (whole, expected) = (rounded(found), rounded(exact));
        for channel in 0..3 {
            self.errors.add(found[channel] - exact[channel]);
            let difference = whole[channel].abs_diff(expected[channel]);
            self.steps = self.steps.max(difference);
            self.differing += u64::from(difference != 0);
        }
    }
}

/// Rounds the light of each channel to whole steps, and clamps it to the channel's range.
fn rounded(light: &[f64; 3]) -> [u32; 3] {
    [0, 1, 2].map(|i: usize| (light[i] + 0.5).floor().clamp(0.0, RANGES[i] - 1.0) as u32)
}
