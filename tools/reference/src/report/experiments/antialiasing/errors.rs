//! Errors of pictures and of patterns of samples against the mean of 64 samples.

use anyhow::Result;
use glint::render;
use glint_core::colour::{Rgb565, Rounding};
use glint_core::picture::Samples;
use glint_model::Frame;
use serde::{Deserialize, Serialize};

use super::compared::{Compared, displayed, measured};
use crate::picture::averaged::{Averaged, Pattern, grid};
use crate::picture::dither::Matrix;

/// Errors of a picture against the mean of 64 samples: a line of `antialiasing.csv`. Errors are RMS of a channel in steps of 1/255.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// Name of the scene.
    pub scene: String,
    /// Number of samples of a pixel: of the model's picture, or 64 for the reference itself after its rounding to RGB565.
    pub samples: u32,
    /// Whether colours are dithered.
    pub dithered: bool,
    /// Error over all pixels.
    pub colour: f64,
    /// Error over the pixels whose 64 samples show more than one surface.
    pub edges: f64,
    /// Share of these pixels.
    pub share: f64,
}

/// Errors of a pattern of samples in f64 against the mean of 64 samples: a line of `antialiasing-patterns.csv`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PatternRow {
    /// Name of the scene.
    pub scene: String,
    /// Name of the pattern.
    pub pattern: String,
    /// Number of samples of a pixel.
    pub samples: u32,
    /// Error over all pixels.
    pub colour: f64,
    /// Error over the pixels whose 64 samples show more than one surface.
    pub edges: f64,
    /// Whether the engine uses this pattern.
    pub shipped: bool,
}

/// The mean of a grid of 64 samples.
///
/// # Errors
/// The frame cannot be drawn in f64.
pub fn reference(frame: &Frame) -> Result<Averaged> {
    Averaged::new(frame, &grid(8))
}

/// The patterns, with their names. The pattern of eight samples is the standard pattern of Direct3D: no two samples are in the same column
/// or line.
fn patterns() -> Vec<(&'static str, Pattern)> {
    let sixteenths = |places: &[[i8; 2]]| {
        let place = |place: &[i8; 2]| place.map(|part| f64::from(part) / 16.0);
        places.iter().map(place).collect()
    };
    let rotated = [[-2, -6], [6, -2], [-6, 2], [2, 6]];
    #[rustfmt::skip]
    let rooks = [[1, -3], [-1, 3], [5, 1], [-3, -5], [-5, 5], [-7, -1], [3, 7], [7, -7]];
    vec![
        ("centre", grid(1)),
        ("diagonal", sixteenths(&[[-4, -4], [4, 4]])),
        ("grid", grid(2)),
        ("rotated grid", sixteenths(&rotated)),
        ("rooks", sixteenths(&rooks)),
        ("grid", grid(4)),
    ]
}

/// Errors of the model's pictures, and of the reference rounded to RGB565.
///
/// # Errors
/// The model cannot draw the frame.
pub fn of_engine(scene: &str, frame: &Frame, exact: &Averaged) -> Result<Vec<Row>> {
    let edges = exact.edges.iter().filter(|&&is_edge| is_edge).count();
    let mut rows = Vec::new();
    for (samples, number) in [
        (Some(Samples::One), 1),
        (Some(Samples::Four), 4),
        (None, 64),
    ] {
        for rounding in [Rounding::Dithered, Rounding::Nearest] {
            let pixels: Vec<Rgb565> = match samples {
                Some(samples) => {
                    let drawn = render::on_model(&measured(frame, samples, rounding))?;
                    drawn.image.colour.into_iter().map(Rgb565).collect()
                }
                None => Matrix::of(rounding).picture(&exact.colours),
            };
            let compared = Compared::new(pixels.into_iter().map(displayed), exact);
            rows.push(Row {
                scene: scene.to_owned(),
                samples: number,
                dithered: rounding == Rounding::Dithered,
                colour: compared.all.rms(),
                edges: compared.edges.rms(),
                share: edges as f64 / exact.edges.len() as f64,
            });
        }
    }
    Ok(rows)
}

/// Errors of the patterns.
///
/// # Errors
/// The frame cannot be drawn in f64.
pub fn of_patterns(scene: &str, frame: &Frame, exact: &Averaged) -> Result<Vec<PatternRow>> {
    let row = |(name, pattern): (&str, Pattern)| {
        let averaged = Averaged::new(frame, &pattern)?;
        let compared = Compared::new(averaged.colours, exact);
        Ok(PatternRow {
            scene: scene.to_owned(),
            pattern: name.to_owned(),
            samples: pattern.len() as u32,
            colour: compared.all.rms(),
            edges: compared.edges.rms(),
            shipped: pattern == grid(2),
        })
    };
    patterns().into_iter().map(row).collect()
}
