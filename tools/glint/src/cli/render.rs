//! `glint render`.

use super::camera::CameraSubject;
use super::common::{DrawingArguments, Opened, bad_value};
use super::heading;
use super::messages::{print_json, say, warn};
use super::output::{DEPTH, Output, PICTURE, STATISTICS};
use super::progress::{advance, bar, spinner};
use super::subject::SubjectArguments;
use super::texture::print_textures;
use anyhow::Context;
use clap::{Args, ValueEnum};
use glint::board::{Board, BoardName, ModelOrBoard};
use glint::convert::TextureReport;
use glint::object::Description;
use glint::render::{Frame, Parts, RayCounts, Rendered, Stats, on_model, remarks};
use glint_core::picture::{Quarter, Samples};
use glint_scene_file::SceneFile;
use serde::Serialize;
use std::path::PathBuf;

/// Render a model, a distance field, or a model in a distance field to a picture.
#[derive(Args)]
pub struct RenderArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// An additional model and its position in the world; repeatable. `MODEL` is followed by
    /// operations, which are applied in the order given: `scale S` or `scale X,Y,Z`, `rotate AXIS
    /// DEGREES`, `move X,Y,Z`, `matrix NUMBERS` (three rows, and the translation), `colour RRGGBB`.
    #[arg(long, value_name = "MODEL PLACE", conflicts_with_all = ["field", "scene"], help_heading = heading::SUBJECT)]
    object: Vec<String>,
    #[command(flatten, next_help_heading = heading::RENDERER)]
    drawing: DrawingArguments,
    /// Picture file to write; `-` is standard output.
    #[arg(long, value_name = "PICTURE.png", help_heading = heading::PICTURE)]
    out: PathBuf,
    /// Write the distances along the camera's forward axis n in world units: one little-endian f32
    /// for each pixel, +inf for a pixel without a surface; or, with the extension .png, a picture of greys, white at the nearest surface,
    /// dark at the farthest, and black without a surface. Requires a picture with one sample a pixel.
    #[arg(long, value_name = "DEPTH.f32|DEPTH.png", help_heading = heading::PICTURE)]
    depth: Option<PathBuf>,
    /// Write clock cycles, the clock frequency in Hz, and counts of triangles, pixels and rays as JSON.
    #[arg(long, value_name = "STATS.json", help_heading = heading::PICTURE)]
    stats: Option<PathBuf>,
    /// Keep the model's coordinates; coordinates outside [-2, 2) are an error.
    #[arg(long, requires = "model", help_heading = heading::SUBJECT)]
    keep_scale: bool,
    /// Source of a board's picture: its memory, or the monitor of the emulated or the virtual board.
    #[arg(long, value_enum, default_value_t = Capture::Frame, help_heading = heading::RENDERER)]
    capture: Capture,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Capture {
    /// The frame buffer in the board's memory.
    Frame,
    /// The monitor's picture, scaled down to the frame's size.
    Monitor,
}

/// Output of `--json`.
#[derive(Serialize)]
struct Outcome<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    field: Option<&'a str>,
    board: String,
    size: [u32; 2],
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    textures: &'a [TextureReport],
    #[serde(flatten)]
    stats: &'a Totals<'a>,
}

/// Statistics of a frame, and values derived from them.
#[derive(Serialize)]
struct Totals<'a> {
    #[serde(flatten)]
    stats: &'a Stats,
    #[serde(skip_serializing_if = "Option::is_none")]
    evaluations_per_ray: Option<f64>,
}

impl RenderArguments {
    pub fn run(self) -> anyhow::Result<()> {
        self.drawing.check()?;
        let objects = self.objects()?;
        let instead = "--field, --object or --scene";
        let mut defaults = self.drawing.defaults();
        if self.depth.is_some() {
            defaults.scene.samples = Samples::One;
        }
        self.subject
            .with_frame(&objects, self.keep_scale, instead, defaults, |shown| {
                let view = self.subject.view(shown)?;
                let frame = &Frame {
                    view,
                    ..*shown.frame
                };
                self.write(&CameraSubject { frame, ..*shown })
            })
    }

    /// Renders a frame, and writes its pictures and statistics.
    fn write(&self, shown: &CameraSubject) -> anyhow::Result<()> {
        let CameraSubject { frame, scene, .. } = *shown;
        let mut inputs = self.subject.inputs(scene);
        let objects = self.objects()?.into_iter();
        inputs.extend(objects.map(|object| object.model.into()));
        let open = |path, extensions| Output::open(path, extensions, &inputs);
        let out = open(&self.out, PICTURE)?;
        let depth = self.depth.as_deref().map(|path| open(path, DEPTH));
        let depth = depth.transpose()?;
        let statistics = self.stats.as_deref().map(|path| open(path, STATISTICS));
        let statistics = statistics.transpose()?;
        if depth.is_some() && frame.samples != Samples::One {
            let found = format!("--aa {}", frame.samples);
            return Err(bad_value("--depth", "a picture with --aa 1", found).into());
        }
        let Rendered { image, stats } = self.render(frame, scene)?;
        remarks(frame, &stats)?.iter().for_each(warn);
        out.write(|out| image.picture().write_png(out))?;
        if let Some(out) = depth {
            let first = frame.drawn()?.next();
            let scale = first.map(|frame| frame.constants()).transpose()?;
            let scale = scale.and_then(|constants| constants.depth_scale());
            let scale = scale.context("expected a frame with a subject")?;
            let is_picture = out
                .path()
                .extension()
                .is_some_and(|end| end.eq_ignore_ascii_case("png"));
            out.write(|out| match is_picture {
                true => image.depth_picture(&scale).write_png(out),
                false => image.write_depth(out, &scale),
            })?;
        }
        let totals = Totals {
            stats: &stats,
            evaluations_per_ray: stats.rays.as_ref().map(RayCounts::evaluations_per_ray),
        };
        if let Some(out) = statistics {
            out.write_json(&totals)?;
        }
        if self.drawing.transfer.json {
            let outcome = Outcome {
                model: self.subject.model.as_deref(),
                field: self.subject.field.name(),
                board: self.drawing.board.to_string(),
                size: frame.size.pixels(),
                textures: shown.textures,
                stats: &totals,
            };
            return print_json(&outcome);
        }
        print_textures(shown.textures)?;
        print_stats(&stats, frame.is_divided())
    }

    fn objects(&self) -> anyhow::Result<Vec<Description>> {
        let objects = self
            .object
            .iter()
            .map(|text| Description::parse(text).map_err(|error| error.in_file("--object").into()));
        objects.collect()
    }

    fn render(&self, frame: &Frame, scene: Option<&SceneFile>) -> anyhow::Result<Rendered> {
        anyhow::ensure!(
            self.drawing.board.is_simulated() || self.capture == Capture::Frame,
            "--capture monitor: expected the emulated or the virtual board, found --board {}",
            self.drawing.board
        );
        match &self.drawing.board {
            ModelOrBoard::Model => {
                let spinner = spinner("rendering");
                let rendered = on_model(frame)?;
                spinner.finish();
                Ok(rendered)
            }
            ModelOrBoard::Board(name) => match self.drawing.transfer.line.open_any(name)? {
                Opened::Serial(mut board) => self.render_on(&mut board, name, frame, scene),
                Opened::Simulated(mut board) => {
                    let mut rendered = self.render_on(&mut board, name, frame, scene)?;
                    if self.capture == Capture::Monitor {
                        let _capturing = spinner("capturing a frame of the monitor");
                        let scale = virtual_board::WIDTH / frame.size.width() as usize;
                        rendered.image.colour = board.inner().monitor_frame(scale)?;
                    }
                    Ok(rendered)
                }
            },
        }
    }

    fn render_on(
        &self,
        board: &mut dyn Board,
        name: &BoardName,
        frame: &Frame,
        scene: Option<&SceneFile>,
    ) -> anyhow::Result<Rendered> {
        let bar = bar("mesh and frames");
        let mut renderer = self
            .drawing
            .renderer(board, name)
            .with_scene(scene.cloned())
            .with_progress(advance(&bar));
        let parts = Parts {
            colour: self.capture == Capture::Frame,
            depth: self.depth.is_some(),
        };
        Ok(renderer.render(frame, parts)?)
    }
}

/// Prints the statistics of a frame as text. If `is_divided`, the frame was drawn in quarters, and the counts of triangles, segments and
/// edges contain the whole subject once per quarter.
pub fn print_stats(stats: &Stats, is_divided: bool) -> anyhow::Result<()> {
    let passes = if is_divided {
        Quarter::ALL.len() as u32
    } else {
        1
    };
    let given = |count: u32| match is_divided {
        true => format!("{passes} x {}", count / passes),
        false => count.to_string(),
    };
    if let Some(counts) = &stats.mesh {
        say(format_args!(
            "triangles  {} in, {} culled, {} clipped, {} drawn",
            given(counts.triangles_in),
            counts.triangles_culled,
            counts.triangles_clipped,
            counts.triangles_drawn
        ))?;
        let tested = counts.pixels_tested.map(|tested| (tested, "tested"));
        let drawn = counts.pixels_drawn.map(|drawn| (drawn, "drawn"));
        let pixels = [tested, Some((counts.pixels_covered, "covered")), drawn];
        let pixels = pixels.iter().flatten();
        let pixels: Vec<_> = pixels
            .map(|(count, what)| format!("{count} {what}"))
            .collect();
        say(format_args!("pixels     {}", pixels.join(", ")))?;
    }
    if let Some(counts) = &stats.rays {
        say(format_args!(
            "rays       {} cast, {} hit, {} missed, {} undecided",
            counts.rays, counts.hits, counts.misses, counts.undecided
        ))?;
        say(format_args!(
            "field      {} evaluations, {:.2} a ray",
            counts.evaluations,
            counts.evaluations_per_ray()
        ))?;
    }
    if let Some(counts) = &stats.wireframe {
        say(format_args!(
            "segments   {} in, {} drawn as lines, {} pixels",
            given(counts.segments),
            counts.lines,
            counts.line_pixels
        ))?;
    }
    if let Some(counts) = &stats.edges {
        say(format_args!(
            "edges      {} in, {} drawn as lines",
            given(counts.edges_in),
            counts.edges_drawn
        ))?;
    }
    if let (Some(cycles), Some(clock)) = (stats.cycles, stats.clock) {
        let (rate, megahertz) = (clock as f64 / cycles as f64, clock as f64 / 1e6);
        say(format_args!(
            "cycles     {cycles} by the {}, {rate:.2} frames a second at {megahertz} MHz",
            stats.backend.as_deref().unwrap_or("board")
        ))?;
    }
    Ok(())
}
