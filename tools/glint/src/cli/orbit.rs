//! `glint orbit`.

use super::camera::{CameraArguments, CameraSubject, turn};
use super::common::{SizeArguments, TransferArguments, bad_value, named};
use super::convert::load;
use super::field::FieldArguments;
use super::messages::{print_json, say, warn};
use super::output::{ANIMATION, Output};
use super::progress::count_bar;
use super::render::{nothing, shown};
use anyhow::Context;
use clap::Args;
use glint::board::{BoardName, ModelOrBoard};
use glint::console::Console;
use glint::picture::Animation;
use glint::render::{BoardRenderer, Frame, Rendered, Route, Subject, on_model, remarks};
use glint::scene;
use glint_core::camera::View;
use glint_core::mesh::Mesh;
use glint_core::object::Place;
use glint_core::picture::Backend;
use glint_scene_file::SceneFile;
use serde::Serialize;
use std::io::{self, BufWriter, Seek, Write};
use std::path::PathBuf;

/// Render an animation in which the camera goes once around a model, a distance field, a model in a field, or a scene.
///
/// A camera that shows the whole model goes around the model about the up axis. With a camera option, in a field, and in a scene,
/// it goes around the origin about the z axis, starting with the camera of `glint render`.
#[derive(Args)]
pub struct OrbitArguments {
    /// A mesh file, `-` for standard input, or a generator's name. With --field, the mesh is drawn in the field.
    model: Option<String>,
    /// A scene: the name of a built-in scene (`glint scene list`), a scene file (docs/scenes.md), or `-` for standard input. It
    /// sets camera, quality and size; the camera options, --quality and --size override them.
    #[arg(long, value_name = "NAME|FILE.toml", conflicts_with = "model")]
    scene: Option<String>,
    #[command(flatten)]
    field: FieldArguments,
    #[command(flatten)]
    camera: CameraArguments,
    /// Animation to write: an animated PNG, or a GIF, which has 256 colours per frame. `-` is standard output, for a PNG.
    #[arg(long, value_name = "ANIMATION.png|ANIMATION.gif")]
    out: PathBuf,
    /// Number of frames.
    #[arg(long, default_value_t = 36, value_parser = clap::value_parser!(u16).range(1..=360))]
    frames: u16,
    /// Frames per second of the animation. The frame time of a GIF is a multiple of 1/100 s.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u16).range(1..=50))]
    rate: u16,
    /// The renderer: `model` (the bit-exact model, in this process), `emulated` (the firmware in an emulator), `virtual`
    /// (the verilated SoC) or a serial port.
    #[arg(long, default_value = "model")]
    board: ModelOrBoard,
    /// Renderer of a board: `cpu` (the soft core) or `gateware` (the accelerators) [default: gateware if the board has it].
    #[arg(long, value_parser = named(Backend::ALL, Backend::name))]
    backend: Option<Backend>,
    #[command(flatten)]
    size: SizeArguments,
    #[command(flatten)]
    transfer: TransferArguments,
}

/// Output of `--json`.
#[derive(Serialize)]
struct Outcome<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    field: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    scene: Option<&'a str>,
    board: String,
    size: [u32; 2],
    frames: u16,
    /// Mean cycles of a frame, if the renderer counts cycles.
    #[serde(skip_serializing_if = "Option::is_none")]
    cycles: Option<u64>,
}

impl OrbitArguments {
    pub fn run(self) -> anyhow::Result<()> {
        self.transfer.check(&self.board, self.backend)?;
        match &self.scene {
            Some(name) => self.run_scene(&glint_scene_file::read(name)?),
            None => self.run_subject(),
        }
    }

    fn run_scene(&self, scene: &SceneFile) -> anyhow::Result<()> {
        let out = self.open(Some(scene))?;
        scene::draw(scene, &self.size.changes()?, |frame| {
            if let Subject::Wireframe(_) = frame.subject {
                let expected = "a scene with a camera";
                return Err(bad_value("--scene", expected, "a wireframe program").into());
            }
            let views = turn(
                &self.camera.of_scene(&self.field.options, frame.view)?,
                self.frames,
            )?;
            self.write(out, frame, &views, Some(scene))
        })?
    }

    fn run_subject(&self) -> anyhow::Result<()> {
        let out = self.open(None)?;
        let mut scene = self.field.scene(&self.size)?;
        let model = self.model.as_deref().map(|name| load(name, false));
        let model = model.transpose()?;
        let mesh = model.as_ref().map(|model| Mesh::new_checked(&model.mesh));
        let mesh = mesh.transpose()?;
        let colour = self.field.mesh_colour(&scene)?;
        let place = Place {
            colour,
            ..Place::default()
        };
        let object = mesh.filter(|_| colour.is_some());
        let object = object.map(|mesh| scene.object(&place, mesh));
        let frame = shown(&mut scene, mesh, object.as_slice());
        let frame = frame?.ok_or_else(|| nothing("--field or --scene"))?;
        let shown = CameraSubject {
            sphere: frame.subject.sphere(),
            model: self.model.as_deref(),
            has_mesh: mesh.is_some(),
            stereo: frame.stereo,
        };
        let options = &self.field.options;
        let views = self.camera.turn(options, &shown, self.frames)?;
        self.write(out, &frame, &views, None)
    }

    /// Opens the output file, which must not be one of the inputs.
    fn open(&self, scene: Option<&SceneFile>) -> anyhow::Result<Output> {
        let names = [
            self.model.as_deref(),
            self.scene.as_deref(),
            self.field.file(),
        ];
        let names = names.into_iter().flatten();
        let meshes = scene
            .into_iter()
            .flat_map(SceneFile::meshes)
            .map(String::as_str);
        let files = names.chain(meshes).map(PathBuf::from);
        let camera = self.camera.file().map(PathBuf::from);
        Output::open(&self.out, ANIMATION, files.chain(camera))
    }

    /// Renders a frame for each camera, and writes the animation.
    fn write(
        &self,
        out: Output,
        frame: &Frame,
        views: &[View],
        scene: Option<&SceneFile>,
    ) -> anyhow::Result<()> {
        let mut spool = out.spool()?;
        let mut drawn = Vec::new();
        let animation = self.animation(BufWriter::new(&spool), frame.size.pixels());
        let mut animation = animation.with_context(|| out.unwritable())?;
        self.draw(frame, views, scene, &mut |Rendered { image, stats }| {
            animation.add(&image).with_context(|| out.unwritable())?;
            drawn.push(stats);
            Ok(())
        })?;
        animation.finish().with_context(|| out.unwritable())?;
        spool.rewind()?;
        out.write(|out| io::copy(&mut spool, out).map(|_| ()))?;
        if let Some(first) = drawn.first() {
            remarks(frame, first)?.iter().for_each(warn);
        }
        let cycles: Option<Vec<u64>> = drawn.iter().map(|stats| stats.cycles).collect();
        let cycles = cycles.map(|cycles| {
            let sum: u128 = cycles.into_iter().map(u128::from).sum();
            (sum / u128::from(self.frames)) as u64
        });
        let outcome = Outcome {
            model: self.model.as_deref(),
            field: self.field.name(),
            scene: self.scene.as_deref(),
            board: self.board.to_string(),
            size: frame.size.pixels(),
            frames: self.frames,
            cycles,
        };
        if self.transfer.json {
            return print_json(&outcome);
        }
        let shown = outcome.model.or(outcome.field).or(outcome.scene);
        let cycles = cycles.map_or(String::new(), |cycles| format!(", {cycles} cycles each"));
        say(format_args!(
            "{} frames around {}, {}, by {}{cycles}",
            self.frames,
            shown.unwrap_or_default(),
            frame.size,
            self.board
        ))
    }

    /// Starts the animation in the format that the output's extension selects.
    fn animation<W: Write>(&self, out: W, size: [u32; 2]) -> io::Result<Animation<W>> {
        let is_gif = self
            .out
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("gif"));
        if is_gif {
            Animation::gif(out, size, self.rate)
        } else {
            Animation::png(out, size, self.frames.into(), self.rate)
        }
    }

    /// Renders a frame for each camera, and calls `take` with each picture.
    fn draw(
        &self,
        frame: &Frame,
        views: &[View],
        scene: Option<&SceneFile>,
        take: &mut dyn FnMut(Rendered) -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        let bar = count_bar("drawing", "frames");
        bar.set_length(views.len() as u64);
        let mut take = |drawn| {
            bar.inc();
            take(drawn)
        };
        match &self.board {
            ModelOrBoard::Model => {
                for &view in views {
                    take(on_model(&Frame { view, ..*frame })?)?;
                }
            }
            ModelOrBoard::Board(name) => self.draw_on(name, frame, views, scene, &mut take)?,
        }
        bar.finish();
        Ok(())
    }

    /// Draws a frame for each camera on a board, and uploads the meshes once.
    fn draw_on(
        &self,
        name: &BoardName,
        frame: &Frame,
        views: &[View],
        scene: Option<&SceneFile>,
        take: &mut dyn FnMut(Rendered) -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        let mut board = self.transfer.line.board(name)?;
        let route = self.transfer.transfer.unwrap_or(Route::of(name));
        let mut renderer = BoardRenderer::new(Console::new(&mut *board))
            .with_backend(self.backend)
            .with_scene(scene.cloned())
            .with_route(route);
        for (number, &view) in views.iter().enumerate() {
            let stats = match number {
                0 => renderer.show(&Frame { view, ..*frame })?,
                _ => renderer.look(&view)?,
            };
            let image = renderer.image(frame.size)?;
            take(Rendered { image, stats })?;
        }
        Ok(())
    }
}
