//! Experiment: measures with the SoC's counters how the cycles of a frame are divided between soft core and engines, for each built-in
//! scene.

use anyhow::{Context, Result};
use glint::board::built_firmware;
use glint::render::Stats;
use glint::scene::Changes;
use glint_scene_file::SceneFile;
use serde::{Deserialize, Serialize};

use super::quality::scenes;
use crate::report::progress;
use crate::report::soc;

/// Number of lanes of the virtual board's raymarcher.
pub const LANES: u64 = 2;

/// Cycles and counts of a frame: a line of `timeline.csv`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// Name of the scene.
    pub scene: String,
    /// Width of the frame in pixels.
    pub width: u32,
    /// Number of cycles of the frame, if no other frame is drawn at the same time.
    pub cycles: u64,
    /// Number of cycles outside of the engines' passes.
    pub soft_core: u64,
    /// Number of cycles of geometry passes.
    pub geometry: u64,
    /// Number of cycles of raster passes.
    pub raster: u64,
    /// Number of cycles in which memory did not accept a command of an engine. Not every such cycle stalls the engine.
    pub refused: u64,
    /// Number of words of 16 bytes read and written by the engines.
    pub words: u64,
    /// Number of evaluations of the field; `None` without a field.
    pub evaluations: Option<u64>,
}

/// Measures a frame of each scene whose name contains `only`, on two virtual boards at a time.
///
/// # Errors
/// A board is not built, or a frame differs from the model's.
pub fn measure(only: &str) -> Result<Vec<Row>> {
    let firmware = built_firmware(None)?;
    let scenes: Vec<SceneFile> = scenes(only).collect();
    let bar = progress::bar(scenes.len() as u64)?;
    let rows = soc::two_at_a_time(&scenes, |scene| {
        let name = scene.name();
        bar.set_message(format!("{name} on the SoC"));
        let stats = soc::frame(&firmware, scene, &Changes::default());
        let row = stats.and_then(|stats| row(scene, &stats));
        bar.inc(1);
        row.with_context(|| name.to_owned())
    })?;
    bar.finish_and_clear();
    Ok(rows)
}

fn row(scene: &SceneFile, stats: &Stats) -> Result<Row> {
    let counter = |name: &str| stats.engine.get(name);
    Ok(Row {
        scene: scene.name().to_owned(),
        width: scene.size().width(),
        cycles: stats.cycles.context("no cycles in the reply")?,
        soft_core: counter("cycles_soft_core")?,
        geometry: counter("cycles_geometry")?,
        raster: counter("cycles_raster")?,
        refused: counter("cycles_stalled")?,
        words: counter("words_read")? + counter("words_written")?,
        evaluations: stats.rays.as_ref().map(|rays| rays.evaluations),
    })
}
