//! `glint render`.

use super::camera::{CameraArguments, CameraSubject};
use super::common::{Opened, SizeArguments, TransferArguments, bad_value, named};
use super::convert::load;
use super::field::FieldArguments;
use super::messages::{print_json, say, warn};
use super::output::{DEPTH, Output, PICTURE, STATISTICS};
use super::progress::{advance, bar, spinner};
use anyhow::Context;
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use glint::board::{Board, BoardName, ModelOrBoard};
use glint::console::Console;
use glint::object::Description;
use glint::render::{
    BoardRenderer, Frame, Parts, RayCounts, Rendered, Route, Stats, on_model, remarks,
};
use glint::scene;
use glint_core::mesh::Mesh;
use glint_core::object::Place;
use glint_core::picture::{Backend, Size};
use glint_model::Object;
use glint_scene::{Assets, Kind, Scene};
use glint_scene_file::SceneFile;
use serde::Serialize;
use std::path::PathBuf;

/// Render a model, a distance field, or a model in a distance field to a picture.
#[derive(Args)]
pub struct RenderArguments {
    /// A mesh file, `-` for standard input, or a generator's name. With --field, the mesh is drawn in the field.
    model: Option<String>,
    /// A scene: the name of a built-in scene (`glint scene list`), a scene file (docs/scenes.md), or `-` for standard input. It
    /// sets camera, quality and size; the camera options, --quality and --size override them.
    #[arg(long, value_name = "NAME|FILE.toml", conflicts_with = "model")]
    scene: Option<String>,
    /// An additional model and its position in the world; repeatable. `MODEL` and then, in this order of application, `scale S`
    /// or `scale X,Y,Z`, `rotate AXIS DEGREES`, `move X,Y,Z`, `matrix NUMBERS` (three rows, and the translation), `colour
    /// RRGGBB`.
    #[arg(long, value_name = "MODEL PLACE", conflicts_with_all = ["field", "scene"])]
    object: Vec<String>,
    #[command(flatten)]
    field: FieldArguments,
    #[command(flatten)]
    camera: CameraArguments,
    /// The renderer: `model` (the bit-exact model, in this process), `emulated` (the firmware in an emulator), `virtual`
    /// (the verilated SoC) or a serial port.
    #[arg(long, default_value = "model")]
    board: ModelOrBoard,
    /// Renderer of a board: `cpu` (the soft core) or `gateware` (the accelerators) [default: gateware if the board has it].
    #[arg(long, value_parser = named(Backend::ALL, Backend::name))]
    backend: Option<Backend>,
    #[command(flatten)]
    size: SizeArguments,
    /// Picture file to write; `-` is standard output.
    #[arg(long, value_name = "PICTURE.png")]
    out: PathBuf,
    /// Draw the picture with 2 or 4 times the width and height, and average 2×2 or 4×4 pixels for each output pixel; the larger
    /// picture has at most 1280x720 pixels. Requires the model. The counts are those of the larger picture.
    #[arg(long, value_name = "2|4", conflicts_with = "depth", value_parser = PossibleValuesParser::new(["2", "4"]))]
    supersample: Option<String>,
    /// Write the distance along the camera's forward axis n, in world units: one little-endian f32 for each pixel, +inf for a
    /// pixel without a surface.
    #[arg(long, value_name = "DEPTH.f32")]
    depth: Option<PathBuf>,
    /// Write clock cycles, the clock frequency in Hz, and counts of triangles, pixels and rays as JSON.
    #[arg(long, value_name = "STATS.json")]
    stats: Option<PathBuf>,
    /// Keep the model's coordinates; those outside [-2, 2) are an error.
    #[arg(long, requires = "model")]
    keep_scale: bool,
    /// Source of a board's picture: its memory, or the monitor of the emulated or the virtual board.
    #[arg(long, value_enum, default_value_t = Capture::Frame)]
    capture: Capture,
    #[command(flatten)]
    transfer: TransferArguments,
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
        self.transfer.check(&self.board, self.backend)?;
        if let Some(name) = &self.scene {
            let scene = glint_scene_file::read(name)?;
            return scene::draw(&scene, &self.size.changes()?, |frame| {
                let view = self.camera.of_scene(&self.field.options, frame.view)?;
                self.write(&Frame { view, ..*frame }, Some(&scene))
            })?;
        }
        let mut scene = self.field.scene(&self.size)?;
        let model = self.model.as_deref();
        let model = model.map(|name| load(name, self.keep_scale)).transpose()?;
        let mesh = model.as_ref().map(|model| Mesh::new_checked(&model.mesh));
        let mesh = mesh.transpose()?;
        let descriptions = self.objects()?;
        let models = descriptions
            .iter()
            .map(|object| load(&object.model, self.keep_scale))
            .collect::<anyhow::Result<Vec<_>>>()?;
        let colour = self.field.mesh_colour(&scene)?;
        let place = Place {
            colour,
            ..Place::default()
        };
        let model = mesh.filter(|_| !descriptions.is_empty() || colour.is_some());
        let mut objects: Vec<_> = model
            .into_iter()
            .map(|mesh| scene.object(&place, mesh))
            .collect();
        for (Description { place, .. }, model) in descriptions.iter().zip(&models) {
            let place = Place {
                colour: place.colour.or(colour),
                ..*place
            };
            objects.push(scene.object(&place, Mesh::new_checked(&model.mesh)?));
        }
        let frame = shown(&mut scene, mesh, &objects);
        let frame = frame?.ok_or_else(|| nothing("--field, --object or --scene"))?;
        let shown = CameraSubject {
            sphere: frame.subject.sphere(),
            model: self.model.as_deref(),
            has_mesh: mesh.is_some(),
            stereo: frame.stereo,
        };
        let view = self.camera.view(&self.field.options, &shown)?;
        self.write(&Frame { view, ..frame }, None)
    }

    /// Renders a frame, and writes its pictures and statistics; `scene` is the scene of the frame, if any.
    fn write(&self, frame: &Frame, scene: Option<&SceneFile>) -> anyhow::Result<()> {
        let inputs = self.inputs(scene)?;
        let open = |path, extensions| Output::open(path, extensions, &inputs);
        let out = open(&self.out, PICTURE)?;
        let depth = self.depth.as_deref().map(|path| open(path, DEPTH));
        let depth = depth.transpose()?;
        let statistics = self.stats.as_deref().map(|path| open(path, STATISTICS));
        let statistics = statistics.transpose()?;
        let (drawn, factor) = self.supersampled(frame.size)?;
        let Rendered { image, stats } = self.render(
            &Frame {
                size: drawn,
                ..*frame
            },
            scene,
        )?;
        remarks(frame, &stats)?.iter().for_each(warn);
        out.write(|out| image.picture().reduced(factor).write_png(out))?;
        if let Some(out) = depth {
            let first = frame.drawn()?.next();
            let scale = first.map(|frame| frame.constants()).transpose()?;
            let scale = scale.and_then(|constants| constants.depth_scale());
            let scale = scale.context("expected a frame with a subject")?;
            out.write(|out| image.write_depth(out, &scale))?;
        }
        let totals = Totals {
            stats: &stats,
            evaluations_per_ray: stats.rays.as_ref().map(RayCounts::evaluations_per_ray),
        };
        if let Some(out) = statistics {
            out.write_json(&totals)?;
        }
        if self.transfer.json {
            let outcome = Outcome {
                model: self.model.as_deref(),
                field: self.field.name(),
                board: self.board.to_string(),
                size: frame.size.pixels(),
                stats: &totals,
            };
            return print_json(&outcome);
        }
        print_stats(&stats)
    }

    /// The size to draw for a picture of this size, and the number of drawn pixels per output pixel in each direction.
    fn supersampled(&self, size: Size) -> anyhow::Result<(Size, usize)> {
        let Some(text) = &self.supersample else {
            return Ok((size, 1));
        };
        if self.board != ModelOrBoard::Model {
            let found = format!("--board {}", self.board);
            return Err(bad_value("--supersample", "--board model", found).into());
        }
        let factor = if text == "2" { 2 } else { 4 };
        let mut sizes = Size::ALL.into_iter();
        let drawn = sizes.find(|drawn| drawn.width() == factor * size.width());
        let drawn = drawn.ok_or_else(|| {
            let expected = "2 for 320x180 or 640x360, or 4 for 320x180";
            bad_value("--supersample", expected, format!("{text} for {size}"))
        });
        Ok((drawn?, factor as usize))
    }

    /// Names of the files that the command reads; includes names of generators.
    fn inputs(&self, scene: Option<&SceneFile>) -> anyhow::Result<Vec<PathBuf>> {
        let mut names = self
            .objects()?
            .into_iter()
            .map(|object| object.model)
            .collect::<Vec<_>>();
        names.extend(self.model.clone());
        names.extend(self.scene.clone());
        names.extend(self.field.file().map(str::to_owned));
        names.extend(scene.into_iter().flat_map(SceneFile::meshes).cloned());
        let files = names.into_iter().map(PathBuf::from);
        Ok(files.chain(self.camera.file().map(PathBuf::from)).collect())
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
            self.board.is_simulated() || self.capture == Capture::Frame,
            "--capture monitor: expected the emulated or the virtual board, found --board {}",
            self.board
        );
        match &self.board {
            ModelOrBoard::Model => {
                let spinner = spinner("rendering");
                let rendered = on_model(frame)?;
                spinner.finish();
                Ok(rendered)
            }
            ModelOrBoard::Board(name) => match self.transfer.line.open_any(name)? {
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
        let mut renderer = BoardRenderer::new(Console::new(board))
            .with_backend(self.backend)
            .with_scene(scene.cloned())
            .with_route(self.transfer.transfer.unwrap_or(Route::of(name)))
            .with_progress(advance(&bar));
        let parts = Parts {
            colour: self.capture == Capture::Frame,
            depth: self.depth.is_some(),
        };
        Ok(renderer.render(frame, parts)?)
    }
}

/// The frame of a scene with its field, mesh or objects; `None` for a scene without any of them.
pub fn shown<'a>(
    scene: &'a mut Scene,
    mesh: Option<Mesh<'a>>,
    objects: &'a [Object<'a>],
) -> anyhow::Result<Option<Frame<'a>>> {
    if !objects.is_empty() {
        scene.kind = Kind::Objects;
    }
    scene.with_mesh = mesh.is_some();
    let is_empty = objects.is_empty() && mesh.is_none() && scene.field.is_none();
    let program = scene::program()?;
    Ok((!is_empty).then(|| {
        scene.frame(Assets {
            mesh,
            objects,
            program,
        })
    }))
}

/// The error for a command without anything to draw; `options` are the alternatives to a model.
pub fn nothing(options: &str) -> anyhow::Error {
    let expected = format!("a mesh file or a generator such as teapot, or {options} in its place");
    bad_value("MODEL", &expected, "none").into()
}

/// Prints the statistics of a frame as text.
pub fn print_stats(stats: &Stats) -> anyhow::Result<()> {
    if let Some(counts) = &stats.mesh {
        say(format_args!(
            "triangles  {} in, {} culled, {} clipped, {} drawn",
            counts.triangles_in,
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
            counts.segments, counts.lines, counts.line_pixels
        ))?;
    }
    if let Some(counts) = &stats.edges {
        say(format_args!(
            "edges      {} in, {} drawn as lines",
            counts.edges_in, counts.edges_drawn
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
