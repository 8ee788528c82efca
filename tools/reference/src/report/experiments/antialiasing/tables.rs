//! All errors of all scenes.

use anyhow::Result;
use glint_scene_file::SceneFile;

use super::compared::{draw, four_samples};
use super::dither::{self, DitherRow};
use super::errors::{self, PatternRow, Row};
use super::light::{self, LightRow};
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

/// Measures the errors of the scenes whose names contain `only`, and the errors of the ramp.
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
