//! Cycles of pictures with one and four samples a pixel on the whole SoC.

use anyhow::{Context, Result, ensure};
use glint::board::built_firmware;
use glint::console::Console;
use glint::render::{self, BoardRenderer, Parts, Rendered, Route, Subject};
use glint::{convert, generate};
use glint_core::colour::Rounding;
use glint_core::mesh::Mesh;
use glint_core::picture::{Backend, Samples};
use glint_model::Frame;
use glint_scene_file::{SceneFile, built_in};
use serde::{Deserialize, Serialize};

use super::compared::{draw, measured};
use crate::picture::SHOWN;
use crate::report::experiments::quality::scenes;
use crate::report::experiments::triangle::ahead;
use crate::report::progress;
use crate::report::soc::{self, BackToBack};

/// Cycles of a frame of 1280×720 on the whole SoC: a line of `antialiasing-cycles.csv`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Cycles {
    /// Name of the scene or mesh.
    pub scene: String,
    /// Number of samples of a pixel.
    pub samples: u32,
    /// Cycles of a frame drawn alone.
    pub alone: u64,
    /// Mean cycles of a frame drawn back to back, so two frames overlap; measured for some scenes.
    pub overlapped: Option<f64>,
}

/// Subject of a measured frame: a built-in scene, or a mesh of [`generate`].
struct Case {
    name: String,
    scene: Option<SceneFile>,
}

/// Half width of a picture in which the teapot at distance 2 fills most of the width.
const HALF_WIDTH: f64 = 0.4781;

/// The scenes and meshes of which frames are also drawn back to back.
const OVERLAPPED: [&str; 4] = ["menger", "objects", "room", "teapot"];

/// Number of passes of each kind in a measurement of frames drawn back to back; a frame has one geometry and one raster pass for each
/// sample of a pixel.
const PASSES: u32 = 8;

impl Case {
    /// The folder in `target/gateware` of a board that draws the frames.
    fn board(&self) -> &'static str {
        match &self.scene {
            Some(scene) if scene.needs().texture => "virtual-texture-fog",
            Some(scene) if scene.needs().smooth => "virtual-smooth",
            _ => "virtual",
        }
    }

    /// Calls `draw` with the frame.
    fn draw<T>(&self, draw_frame: impl FnOnce(&Frame) -> Result<T>) -> Result<T> {
        if let Some(scene) = &self.scene {
            return draw(scene, draw_frame);
        }
        let made = generate::named(&self.name)
            .and_then(|model| convert::convert(&model, convert::Options::default()));
        let (mesh, _) = made.map_err(|error| anyhow::anyhow!("{error}"))?;
        let subject = Subject::mesh(Mesh::new_checked(&mesh)?);
        draw_frame(&Frame::new(subject, ahead(HALF_WIDTH)?, SHOWN))
    }
}

/// Measures the cycles of frames whose names contain `only`, on two virtual boards at a time.
///
/// # Errors
/// A board is not built, or a frame differs from the model's.
pub fn measure(only: &str) -> Result<Vec<Cycles>> {
    let firmware = built_firmware(None)?;
    let scenes = scenes("").chain(built_in("room")).map(|scene| Case {
        name: scene.name().to_owned(),
        scene: Some(scene),
    });
    let teapot = Case {
        name: "teapot".to_owned(),
        scene: None,
    };
    let cases: Vec<_> = scenes
        .chain([teapot])
        .filter(|case| case.name.contains(only))
        .collect();
    let bar = progress::bar(2 * cases.len() as u64)?;
    let rows = soc::two_at_a_time(&cases, |case| {
        bar.set_message(format!("{} on the SoC", case.name));
        case.draw(|frame| {
            let mut rows = Vec::new();
            for (samples, number) in [(Samples::One, 1), (Samples::Four, 4)] {
                let frame = measured(frame, samples, Rounding::Dithered);
                let (alone, overlapped) = frame_cycles(&firmware, case, &frame, PASSES / number)
                    .with_context(|| format!("{}, {number} samples", case.name))?;
                bar.suspend(|| {
                    let name = &case.name;
                    eprintln!(
                        "{name}, {number} samples: {alone} cycles, {overlapped:?} overlapped"
                    );
                });
                bar.inc(1);
                rows.push(Cycles {
                    scene: case.name.clone(),
                    samples: number,
                    alone,
                    overlapped,
                });
            }
            Ok(rows)
        })
    })?;
    bar.finish_and_clear();
    Ok(rows.into_iter().flatten().collect())
}

/// Cycles of a frame drawn alone and, for some cases, the mean cycles of `frames` frames drawn back to back.
fn frame_cycles(
    firmware: &[u8],
    case: &Case,
    frame: &Frame,
    frames: u32,
) -> Result<(u64, Option<f64>)> {
    let mut board = soc::started(case.board(), firmware)?;
    let mut console = Console::new(&mut board);
    console.greet()?;
    let mut renderer = BoardRenderer::new(console)
        .with_backend(Backend::Gateware)
        .with_route(Route::Memory)
        .with_scene(case.scene.clone());
    let Rendered { image, stats } = renderer.render(frame, Parts::COLOUR)?;
    ensure!(
        stats.backend.as_deref() == Some("gateware"),
        "expected a frame of the gateware, found the soft core's"
    );
    let expected = render::on_model(frame)?;
    ensure!(
        image.colour == expected.image.colour,
        "the frame is not the model's"
    );
    let overlapped = if OVERLAPPED.contains(&case.name.as_str()) {
        let kernel = match frame.subject.field_part() {
            Some(_) => "field",
            None => "triangle",
        };
        Some(BackToBack::measure(&mut renderer, kernel, frames)?.frame("cycles")?)
    } else {
        None
    };
    let alone = stats.cycles.context("no cycles in the reply")?;
    Ok((alone, overlapped))
}
