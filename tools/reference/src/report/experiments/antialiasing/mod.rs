//! Experiment: compares pictures of the built-in scenes with one and with four samples a pixel with the mean of 64 samples in f64.
//!
//! - [`errors`]: errors of the pictures and, in f64, of patterns of samples.
//! - [`dither`]: matrices of ordered dithering for averages of four samples.
//! - [`light`]: averages in linear light.
//! - [`cycles`]: cycles of the pictures on the whole SoC.
//!
//! All pictures are of 1280×720 pixels, in the exact quality. A function that draws states the samples and the rounding, so the defaults of
//! scenes do not matter.

pub mod cycles;
pub mod dither;
pub mod errors;
pub mod light;

use anyhow::Result;
use glint::scene::{self, Changes};
use glint_core::colour::{Rgb565, Rounding};
use glint_core::picture::Samples;
use glint_core::quality::Quality;
use glint_model::Frame;
use glint_scene_file::SceneFile;

use self::dither::DitherRow;
use self::errors::{PatternRow, Row};
use self::light::LightRow;
use crate::camera::Vector;
use crate::errors::Errors;
use crate::picture::SHOWN;
use crate::picture::averaged::{Averaged, grid};
use crate::picture::exact::Exact;
use crate::report::experiments::quality::scenes;
use crate::report::progress;

/// Tables of errors.
#[derive(Default)]
pub struct Tables {
    /// `antialiasing.csv`
    pub errors: Vec<Row>,
    /// `antialiasing-patterns.csv`
    pub patterns: Vec<PatternRow>,
    /// `antialiasing-dither.csv`
    pub dither: Vec<DitherRow>,
    /// `antialiasing-light.csv`
    pub light: Vec<LightRow>,
}

/// Measures the errors of the scenes whose names contain `only`, and those of the ramp.
///
/// # Errors
/// A scene cannot be drawn.
pub fn measure(only: &str) -> Result<Tables> {
    let scenes: Vec<SceneFile> = scenes(only).collect();
    let bar = progress::bar(scenes.len() as u64)?;
    let mut tables = Tables::default();
    let mut dithered = dither::Sums::default();
    for scene in &scenes {
        let name = scene.name();
        bar.set_message(name.to_owned());
        draw(scene, |frame| {
            let exact = errors::reference(frame)?;
            tables
                .errors
                .extend(errors::of_engine(name, frame, &exact)?);
            tables
                .patterns
                .extend(errors::of_patterns(name, frame, &exact)?);
            let samples = four_samples(frame)?;
            dithered.add(&samples);
            tables
                .light
                .push(light::measure(name, &samples, &exact.edges));
            Ok(())
        })?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    tables.dither = dithered.rows("scenes");
    tables.dither.extend(dither::of_ramp());
    Ok(tables)
}

/// A frame as it is measured: 1280×720, with all options that this page compares.
fn measured<'a>(frame: &Frame<'a>, samples: Samples, rounding: Rounding) -> Frame<'a> {
    Frame {
        size: SHOWN,
        samples,
        rounding,
        ..*frame
    }
}

/// Calls `draw` with the frame of a scene in the exact quality.
fn draw<T>(scene: &SceneFile, draw: impl FnOnce(&Frame) -> Result<T>) -> Result<T> {
    let changes = Changes {
        quality: Some(Quality::Exact),
        size: Some(SHOWN),
        ..Changes::default()
    };
    scene::draw(scene, &changes, draw)?
}

/// Errors of all pixels, and of the pixels along edges.
#[derive(Default)]
struct Compared {
    all: Errors,
    edges: Errors,
}

impl Compared {
    /// Compares colours with a reference.
    fn new(found: impl IntoIterator<Item = Vector>, exact: &Averaged) -> Self {
        let mut errors = Self::default();
        let expected = exact.colours.iter().zip(&exact.edges);
        for (found, (expected, &is_edge)) in found.into_iter().zip(expected) {
            for (found, expected) in found.into_iter().zip(expected) {
                errors.all.add(found - expected);
                if is_edge {
                    errors.edges.add(found - expected);
                }
            }
        }
        errors
    }
}

/// The colour on the monitor.
fn displayed(pixel: Rgb565) -> Vector {
    pixel.to_rgb888().map(f64::from)
}

/// The pictures of the four samples of a pixel, row by row.
type FourSamples = [Vec<Vector>; 4];

fn four_samples(frame: &Frame) -> Result<FourSamples> {
    let mut pictures = FourSamples::default();
    for (picture, offset) in pictures.iter_mut().zip(grid(2)) {
        *picture = Exact::at(frame, offset)?.colours;
    }
    Ok(pictures)
}

/// The mean of the colours of four samples.
fn mean(samples: &FourSamples, pixel: usize) -> Vector {
    [0, 1, 2].map(|i: usize| samples.iter().map(|sample| sample[pixel][i]).sum::<f64>() / 4.0)
}
