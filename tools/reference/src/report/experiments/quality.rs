//! Experiment: compares pictures of the built-in scenes, as displayed on a monitor, with the same frames in f64, and measures the cycles of
//! these frames on the whole SoC, in all qualities.

use anyhow::{Context, Result};
use glint::board::built_firmware;
use glint::scene::{self, Changes};
use glint_core::picture::Samples;
use glint_core::quality::Quality;
use glint_model::Frame;
use glint_scene_file::{NAMES, SceneFile, built_in};
use serde::{Deserialize, Serialize};

use crate::picture::averaged::{Averaged, grid};
use crate::picture::exact::Exact;
use crate::picture::{self, Measured};
use crate::report::progress;
use crate::report::soc;

/// Errors of a frame: a line of `quality.csv`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// Name of the scene.
    pub scene: String,
    /// Width of the frame in pixels.
    pub width: u32,
    /// Name of the quality.
    pub quality: String,
    /// Fraction of wrong pixels ([`Measured::wrong`]).
    pub wrong: f64,
    /// RMS of the errors of a channel ([`Measured::colour`]).
    pub colour: f64,
}

/// Cycles of a frame: a line of `quality-cycles.csv` and `raymarch-scenes.csv`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Cycles {
    /// Name of the scene.
    pub scene: String,
    /// Width of the frame in pixels.
    pub width: u32,
    /// Number of cycles of the frame on the whole SoC, if no other frame is drawn at the same time.
    pub cycles: u64,
}

/// Number of columns and of rows of samples in a pixel of the reference for colours.
const ACROSS: u32 = 8;

/// The changes of a scene to a quality.
fn of(quality: Quality) -> Changes {
    Changes {
        quality: Some(quality),
        size: Some(quality.size()),
        ..Changes::default()
    }
}

/// The built-in scenes that have their own picture in f64 (no lists of scenes, and no scenes with textures), restricted to names that
/// contain `only`.
pub fn scenes(only: &str) -> impl Iterator<Item = SceneFile> {
    let scenes = NAMES.into_iter().filter_map(built_in);
    scenes.filter(move |scene| {
        scene.scenes().is_empty() && !scene.needs().texture && scene.name().contains(only)
    })
}

/// Measures the errors of the scenes whose names contain `only`, in the qualities for which `wanted` is true: wrong surfaces at pixel
/// centres, and colours against the mean of 64 samples.
///
/// # Errors
/// A scene cannot be drawn.
pub fn errors(only: &str, wanted: impl Fn(Quality) -> bool) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for scene in scenes(only) {
        let (exact, mean) = scene::draw(&scene, &Changes::default(), |frame| {
            anyhow::Ok((Exact::new(frame)?, Averaged::new(frame, &grid(ACROSS))?))
        })??;
        for quality in Quality::ALL.into_iter().filter(|&one| wanted(one)) {
            let measure = |frame: &Frame| picture::measure(frame, &exact, &mean);
            let Measured { wrong, colour } = scene::draw(&scene, &of(quality), measure)??;
            rows.push(Row {
                scene: scene.name().to_owned(),
                width: quality.size().width(),
                quality: quality.name().to_owned(),
                wrong,
                colour,
            });
        }
    }
    Ok(rows)
}

/// Measures the cycles of the frames of scenes in all qualities, with this number of samples a pixel, by default the quality's number, on
/// two virtual boards at a time.
///
/// # Errors
/// A board is not built, or a frame differs from the model's.
pub fn cycles(
    scenes: impl Iterator<Item = SceneFile>,
    samples: Option<Samples>,
) -> Result<Vec<Cycles>> {
    let firmware = built_firmware(None)?;
    let scenes: Vec<SceneFile> = scenes.collect();
    let bar = progress::bar((scenes.len() * Quality::ALL.len()) as u64)?;
    let rows = soc::two_at_a_time(&scenes, |scene| {
        bar.set_message(format!("{} on the SoC", scene.name()));
        let mut rows = Vec::new();
        for quality in Quality::ALL {
            let name = format!("{}, {}", scene.name(), quality.name());
            let changes = Changes {
                samples,
                ..of(quality)
            };
            let stats = soc::frame(&firmware, scene, &changes);
            let cycles = stats.and_then(|stats| stats.cycles.context("no cycles in the reply"));
            let cycles = cycles.with_context(|| name.clone())?;
            bar.suspend(|| eprintln!("{name}: {cycles} cycles"));
            bar.inc(1);
            rows.push(Cycles {
                scene: scene.name().to_owned(),
                width: quality.size().width(),
                cycles,
            });
        }
        Ok(rows)
    })?;
    bar.finish_and_clear();
    Ok(rows.into_iter().flatten().collect())
}
