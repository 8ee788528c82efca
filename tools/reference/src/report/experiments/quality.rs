//! Experiment: compares pictures of the built-in scenes, as displayed on a monitor, with the same frames in f64, and measures the cycles of
//! these frames on the whole SoC. Size and precision of the rays vary.

use anyhow::{Context, Result};
use glint::board::built_firmware;
use glint::scene::{self, Changes};
use glint_core::block::Block;
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_model::Frame;
use glint_scene_file::{NAMES, SceneFile, built_in};
use serde::{Deserialize, Serialize};

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
    /// Name of the quality that sets the rays' thresholds; `None` without a field.
    pub rays: Option<String>,
    /// Name of the quality with this size and these thresholds, if any.
    pub quality: Option<String>,
    /// Fraction of wrong pixels ([`Measured::wrong`]).
    pub wrong: f64,
    /// RMS of the errors of a channel ([`Measured::colour`]).
    pub colour: f64,
}

/// Cycles of a frame: a line of `quality-cycles.csv`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Cycles {
    /// Name of the scene.
    pub scene: String,
    /// Width of the frame in pixels.
    pub width: u32,
    /// Name of the quality that sets the rays' thresholds; `None` without a field.
    pub rays: Option<String>,
    /// Number of cycles of the frame on the whole SoC, if no other frame is drawn at the same time.
    pub cycles: u64,
}

/// A frame to measure: a size, and the quality that sets the rays' thresholds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// Size of the picture.
    pub size: Size,
    /// The quality that sets the rays' thresholds; `None` without a field.
    pub rays: Option<Quality>,
}

impl Variant {
    /// The frames of a scene: all sizes, and for fields all precisions of the rays.
    fn all(scene: &SceneFile) -> Vec<Self> {
        let has_field = scene.needs().blocks.contains(&Block::Raymarch);
        let rays: Vec<Option<Quality>> = match has_field {
            true => Quality::ALL.map(Some).into(),
            false => vec![None],
        };
        let of_size = |size| rays.iter().map(move |&rays| Self { size, rays });
        Size::ALL.into_iter().flat_map(of_size).collect()
    }

    /// The quality with this size and this precision of the rays.
    #[must_use]
    pub fn quality(self) -> Option<Quality> {
        let mut qualities = Quality::ALL.into_iter();
        qualities.find(|quality| {
            quality.size() == self.size && self.rays.is_none_or(|rays| rays == *quality)
        })
    }

    fn changes(self) -> Changes {
        Changes {
            quality: self.rays,
            size: Some(self.size),
            ..Changes::default()
        }
    }

    fn rays_name(self) -> Option<String> {
        self.rays.map(|rays| rays.name().to_owned())
    }
}

/// The built-in scenes that have their own picture (not the lists of scenes), restricted to names that contain `only`.
pub fn scenes(only: &str) -> impl Iterator<Item = SceneFile> {
    let scenes = NAMES.into_iter().filter_map(built_in);
    scenes.filter(move |scene| scene.scenes().is_empty() && scene.name().contains(only))
}

/// Measures the errors of the scenes whose names contain `only`, in the frames that are `wanted`.
///
/// # Errors
/// A scene cannot be drawn.
pub fn errors(only: &str, wanted: impl Fn(Variant) -> bool) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for scene in scenes(only) {
        let exact = scene::draw(&scene, &Changes::default(), Exact::new)??;
        for variant in Variant::all(&scene).into_iter().filter(|&one| wanted(one)) {
            let measure = |frame: &Frame| picture::measure(frame, &exact);
            let Measured { wrong, colour } = scene::draw(&scene, &variant.changes(), measure)??;
            rows.push(Row {
                scene: scene.name().to_owned(),
                width: variant.size.width(),
                rays: variant.rays_name(),
                quality: variant.quality().map(|quality| quality.name().to_owned()),
                wrong,
                colour,
            });
        }
    }
    Ok(rows)
}

/// Measures the cycles of the frames of the scenes whose names contain `only`, on two virtual boards at a time.
///
/// # Errors
/// A board is not built, or a frame differs from the model's.
pub fn cycles(only: &str) -> Result<Vec<Cycles>> {
    let firmware = built_firmware(None)?;
    let scenes: Vec<SceneFile> = scenes(only).collect();
    let frames = scenes.iter().map(|scene| Variant::all(scene).len() as u64);
    let bar = progress::bar(frames.sum())?;
    let rows = soc::two_at_a_time(&scenes, |scene| {
        bar.set_message(format!("{} on the SoC", scene.name()));
        let mut rows = Vec::new();
        let mut variants = Variant::all(scene);
        // The frames of the qualities are measured first, because other large frames take minutes on a virtual board.
        variants.sort_by_key(|variant| variant.quality().is_none());
        for variant in variants {
            let stats = soc::frame(&firmware, scene, &variant.changes());
            let cycles = stats.and_then(|stats| stats.cycles.context("no cycles in the reply"));
            let cycles = cycles.with_context(|| format!("{}, {variant:?}", scene.name()))?;
            bar.suspend(|| eprintln!("{}, {variant:?}: {cycles} cycles", scene.name()));
            bar.inc(1);
            rows.push(Cycles {
                scene: scene.name().to_owned(),
                width: variant.size.width(),
                rays: variant.rays_name(),
                cycles,
            });
        }
        Ok(rows)
    })?;
    bar.finish_and_clear();
    Ok(rows.into_iter().flatten().collect())
}
