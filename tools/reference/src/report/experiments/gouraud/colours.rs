//! Experiment: errors of smooth shading by the format of the vertices' colours.

use glint_core::colour::Rgb565;
use glint_model::triangle::setup::Oriented;
use glint_model::triangle::shade::Lit;
use glint_model::{SIZES, ScreenVertex};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};

use crate::errors::Errors;
use crate::triangle::smooth::forms::{Form, Inverse, Light};
use crate::triangle::smooth::{Interpolated, RANGES, Triangle};

/// Errors of a format: a line of `gouraud-colours.csv`. Errors are in 255ths, the unit of the colours in a file, before the last rounding.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Name of the format.
    pub format: String,
    /// Whether Glint itself uses the format.
    pub shipped: bool,
    /// Largest difference of a channel between two vertices of a triangle, of 255.
    pub reach: u8,
    /// Number of covered pixels, summed over the triangles.
    pub pixels: u64,
    /// Largest error of a channel.
    pub max_err: f64,
    /// RMS of the errors of the channels.
    pub rms: f64,
}

/// Makes full light of a colour.
type Method = fn([u8; 3]) -> Lit;

/// Formats of the colours, from the cheapest to the most exact.
const FORMATS: [(&str, bool, Method); 3] = [
    ("RGB565, to nearest", false, |colour| {
        Lit::new(Rgb565::from_rgb888(colour).fractions(), [256; 3])
    }),
    ("8 bits a channel", true, |colour| {
        Lit::new(Rgb565::with_fractions(colour), [256; 3])
    }),
    ("16 bits a channel, to nearest", false, |colour| {
        let steps = in_steps(colour);
        Lit([0, 1, 2].map(|i: usize| (steps[i] / RANGES[i] * 65536.0).round() as u16))
    }),
];

/// Largest differences between the colours of a triangle's vertices.
const REACHES: [u8; 3] = [8, 64, 255];
/// Number of triangles for each reach.
const TRIANGLES: usize = 200;
/// Steps of RGB565 up to a full channel.
const STEPS: [f64; 3] = [31.0, 63.0, 31.0];

/// A colour of 8 bits per channel in steps of RGB565, exactly.
fn in_steps(colour: [u8; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i: usize| f64::from(colour[i]) * STEPS[i] / 255.0)
}

/// Measures all formats with random triangles, in full light.
///
/// # Panics
/// Never: the light of all setups is set.
pub fn measure() -> Vec<Row> {
    let mut random = Pcg64Mcg::new(1);
    let mut rows = Vec::new();
    for reach in REACHES {
        let mut measured = FORMATS.map(|_| (0, Errors::default()));
        for _ in 0..TRIANGLES {
            let (vertices, colours) = triangle(&mut random, reach);
            let Some(oriented) = Oriented::new(vertices) else {
                continue;
            };
            let exact = Interpolated::of(&oriented.vertices, colours.map(in_steps));
            for ((_, _, method), (pixels, errors)) in FORMATS.iter().zip(&mut measured) {
                let triangle = Triangle {
                    oriented,
                    lit: colours.map(method),
                    clipped: false,
                    size: SIZES[0],
                };
                let Some(setup) = triangle.setup() else {
                    continue;
                };
                let light = Light {
                    setup: &setup,
                    exact,
                };
                let drawn = triangle.pixels(&setup);
                *pixels += drawn.len() as u64;
                let found = light.group(Form::Pixels(Inverse::GLINT), &drawn);
                for (pixel, found) in drawn.iter().zip(found) {
                    let exact = exact.perspective(pixel.centre());
                    for i in 0..3 {
                        errors.add((found[i] - exact[i]) * 255.0 / STEPS[i]);
                    }
                }
            }
        }
        rows.extend(FORMATS.iter().zip(measured).map(
            |((format, shipped, _), (pixels, errors))| Row {
                format: (*format).to_owned(),
                shipped: *shipped,
                reach,
                pixels,
                max_err: errors.max,
                rms: errors.rms(),
            },
        ));
    }
    rows
}

/// Makes a random triangle in the picture, on the nearer half of the depths, and colours of its vertices.
fn triangle(random: &mut Pcg64Mcg, reach: u8) -> ([ScreenVertex; 3], [[u8; 3]; 3]) {
    let vertices = [(); 3].map(|()| ScreenVertex {
        x: random.random_range(0..320 << 8),
        y: random.random_range(0..180 << 8),
        w: random.random_range(1 << 23..(1 << 24) - 256),
    });
    let lowest = [(); 3].map(|()| random.random_range(0..=u8::MAX - reach));
    let colours = [(); 3].map(|()| lowest.map(|lowest| lowest + random.random_range(0..=reach)));
    (vertices, colours)
}
