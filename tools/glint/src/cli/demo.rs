//! `glint demo`: a demonstration of the whole system.

use super::camera::{angles, whole};
use super::convert::load;
use super::messages::say;
use super::output::{Output, PICTURE};
use super::progress::{advance, bar, spinner};
use anyhow::Context;
use clap::Args;
use glint::board::Uart;
use glint::board::{self, Board, SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::convert::Options;
use glint::flash;
use glint::model::Model;
use glint::picture::{Image, write_animation};
use glint::program;
use glint::render::{
    BoardRenderer, FieldSubject, Frame, MeshSubject, Parts, Rendered, Route, Stats, Subject,
    on_model, samples_command, size_command,
};
use glint::scene::{self, Changes};
use glint::view;
use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::colour::Shading;
use glint_core::field::{Field, Menger, Primitive};
use glint_core::fixed::{Q32_32, Turns, U8_28};
use glint_core::light::Background;
use glint_core::matrix::Matrix;
use glint_core::mesh::Mesh;
use glint_core::picture::{Backend, Samples, Size};
use glint_core::quality::Quality;
use glint_core::stereo::{Stereo, Tint};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Demonstrate the whole system: boot the virtual board, load its firmware, upload models, render, capture the monitor.
#[derive(Args)]
pub struct DemoArguments {
    /// Mesh files or generators [default: icosphere:6, gear, teapot]. The first model is uploaded
    /// over the serial line of a board that boots through its BIOS; the other models are written
    /// directly to the memory of a second board.
    models: Vec<String>,
    /// Output folder.
    #[arg(long, default_value = "out")]
    out: PathBuf,
    /// Firmware image [default: the output of `cargo xtask firmware`].
    #[arg(long, value_name = "FILE")]
    firmware: Option<PathBuf>,
    /// Number of frames of the animation in which the camera turns around a model.
    #[arg(long, default_value_t = 24)]
    orbit: u16,
    /// Number of frames of the stereo animation of a Menger sponge.
    #[arg(long, default_value_t = 4)]
    sponge: u16,
    /// Only write the first picture: the first model, or without models the scene `room`, drawn by the bit-exact model on this machine.
    #[arg(long)]
    first: bool,
}

const MODELS: [&str; 3] = ["icosphere:6", "gear", "teapot"];
/// Load address and entry point of the firmware.
const MAIN_RAM: u32 = 0x4000_0000;
const SIZE: Size = Size::W1280;
const SAMPLES: Samples = Samples::Four;
/// Size of the frame that the soft core draws too, for a comparison.
const COMPARED: Size = Size::W320;
/// File name of the first picture.
const FIRST: &str = "first.png";
/// The scene of the first picture.
const FIRST_SCENE: &str = "room";
const ORBIT_FRAMES_PER_SECOND: u16 = 12;
const SPONGE: Field = Field::Primitive(Primitive::Menger(Menger { depth: 4 }));
const EYES: Stereo = Stereo {
    half_separation: Q32_32::lit("0.05"),
    zero_parallax: Q32_32::lit("2.2"),
    tint: Tint::RedBlue,
};
const SPONGE_FRAMES_PER_SECOND: u16 = 3;
/// Longest wait for the BIOS's serial boot request, in milliseconds of the board's time.
const BOOT_MS: u64 = 10_000;

/// A model with its name on the command line.
type Named<'n> = (&'n str, Model);

/// The results of a model: a row of the table that the demo prints.
struct Row {
    number: u32,
    picture: PathBuf,
    stats: Stats,
    /// Number of triangles of the model.
    triangles: u32,
}

impl DemoArguments {
    pub fn run(self) -> anyhow::Result<()> {
        std::fs::create_dir_all(&self.out)
            .with_context(|| format!("{}: cannot be created", self.out.display()))?;
        check_folder(&self.out)?;
        if self.first {
            return self.write_first();
        }
        let names = match &self.models[..] {
            [] => MODELS.to_vec(),
            names => names.iter().map(String::as_str).collect(),
        };
        let models = names
            .into_iter()
            .map(|name| Ok((name, load(name, Options::default())?)));
        let models = models.collect::<anyhow::Result<Vec<_>>>()?;
        let firmware = match &self.firmware {
            Some(path) => program::read(path)?.image,
            None => built_firmware(None)?,
        };

        // The two boards run in parallel: the simulation of a board uses one CPU core, and most hosts have at least two.
        let (first, others) = models.split_first().context("no model")?;
        let (mut rows, mut lines, compared) = std::thread::scope(|scope| {
            let second = scope.spawn(|| self.second_board(first, others, &firmware));
            let (first, compared) = self.first_board(first, &firmware)?;
            let _waiting = spinner("waiting for the second board");
            let second = second.join();
            let (mut rows, lines) =
                second.map_err(|_| anyhow::anyhow!("the second board's thread panicked"))??;
            rows.push(first);
            anyhow::Ok((rows, lines, compared))
        })?;
        rows.sort_by_key(|row| row.number);
        lines.insert(0, compared);
        print_table(&rows)?;
        lines.into_iter().try_for_each(say)
    }

    /// Draws a picture by the model, writes it and prints its name.
    fn write_first(&self) -> anyhow::Result<()> {
        let path = self.out.join(FIRST);
        let (shown, drawn) = match self.models.first() {
            Some(name) => {
                let model = load(name, Options::default())?;
                let shading = if model.is_smooth() {
                    Shading::Smooth
                } else {
                    Shading::Flat
                };
                let mesh = Mesh::new_checked(&model.mesh)?;
                let subject = Subject::Mesh(MeshSubject {
                    shading,
                    ..MeshSubject::new(mesh)
                });
                let frame = frame(subject, view_of(&model, 0)?);
                (name.clone(), on_model(&frame)?)
            }
            None => {
                let changes = Changes {
                    size: Some(SIZE),
                    samples: Some(SAMPLES),
                    ..Changes::default()
                };
                let scene = super::scene::read(FIRST_SCENE)?;
                (
                    format!("scene {FIRST_SCENE}"),
                    scene::draw(&scene, &changes, on_model)??,
                )
            }
        };
        write_picture(&path, |out| drawn.image.picture().write_png(out))?;
        say(format_args!(
            "{}: {shown}, {SIZE}, {SAMPLES} samples a pixel, by the bit-exact model",
            path.display()
        ))
    }

    /// Draws a model on the first board, over the serial line only: BIOS, serial boot of the firmware, upload of the model. Then
    /// gateware and soft core draw a small picture, for a comparison of the cycles, which the returned line states.
    fn first_board(&self, model: &Named, firmware: &[u8]) -> anyhow::Result<(Row, String)> {
        let mut board = board::verilated_bios()?;
        let console = boot(&mut board, firmware)?;
        let bar = bar(model.0);
        let mut renderer = BoardRenderer::new(console)
            .with_backend(Backend::Gateware)
            .with_progress(advance(&bar));
        let row = self.show(&mut renderer, model, 0)?;
        bar.finish();
        let _waiting = spinner("the soft core draws a frame");
        let view = view_of(&model.1, 0)?;
        let mut cycles = |backend| {
            let commands = [
                format!("backend {backend}"),
                size_command(COMPARED),
                samples_command(Samples::One),
            ];
            for command in commands {
                renderer.console().command(&command)?;
            }
            let stats = renderer.look(&view)?;
            stats.cycles.context("no cycles in the reply")
        };
        let [by_gateware, by_cpu] = [cycles(Backend::Gateware)?, cycles(Backend::Cpu)?];
        let compared = format!(
            "{} in {COMPARED} with one sample a pixel: soft core {by_cpu} cycles, gateware {by_gateware}: {:.0} times as fast",
            model.0,
            by_cpu as f64 / by_gateware as f64
        );
        Ok((row, compared))
    }

    /// Runs the second board, which starts with the firmware in its memory. It shows `models`,
    /// which are uploaded through its memory, animates an orbit around the last model (around
    /// `first` without `models`) and a flight to the sponge, and shows the built-in scenes. The
    /// thread of the first board shows the progress.
    fn second_board(
        &self,
        first: &Named,
        models: &[Named],
        firmware: &[u8],
    ) -> anyhow::Result<(Vec<Row>, Vec<String>)> {
        let mut board = board::verilated(firmware)?;
        let mut console = Console::new(&mut board);
        console.greet()?;
        let mut renderer = BoardRenderer::new(console)
            .with_backend(Backend::Gateware)
            .with_route(Route::Memory);
        let mut rows = Vec::new();
        for (number, model) in (1..).zip(models) {
            rows.push(self.show(&mut renderer, model, number)?);
        }
        let (name, model) = models.last().unwrap_or(first);
        let clock = renderer.board().inner().clock_hz();
        let path = self.out.join("orbit.png");
        let cycles = self.orbit(&mut renderer, model, &path)?;
        let around = format!("{} frames around {name}", self.orbit);
        let mut lines = vec![line(&path, &around, cycles, clock)];
        let path = self.out.join("sponge.png");
        let cycles = self.sponge(&mut renderer, &path)?;
        let towards = format!("{} frames towards {SPONGE}, for two eyes", self.sponge);
        lines.push(line(&path, &towards, cycles, clock));
        for name in SCENES {
            let path = self.out.join(name).with_extension("png");
            let (scene, cycles) = show_scene(&mut renderer, name, &path)?;
            lines.push(line(&path, &scene, cycles, clock));
        }
        Ok((rows, lines))
    }

    /// Draws a model on the board, saves the monitor's picture, and checks that it equals the picture of the bit-exact model.
    fn show(
        &self,
        renderer: &mut BoardRenderer<SimulatedBoard>,
        (name, model): &Named,
        number: u32,
    ) -> anyhow::Result<Row> {
        let mesh = Mesh::new_checked(&model.mesh)?;
        let view = view_of(model, number)?;
        let frame = frame(Subject::mesh(mesh), view);
        let stats = renderer.show(&frame)?;
        let picture = renderer.board().inner().capture()?;
        let path = self.out.join(file_stem(name)).with_extension("png");
        write_picture(&path, |out| picture.write_png(out))?;

        let scale = virtual_board::WIDTH / SIZE.width() as usize;
        anyhow::ensure!(
            picture.scaled_back(scale)? == on_model(&frame)?.image.colour,
            "{name}: the picture on the monitor differs from the model's"
        );
        Ok(Row {
            number,
            picture: path,
            stats,
            triangles: mesh.triangle_count(),
        })
    }

    /// Writes an animation of one turn of the camera around a model to `path`. Returns the mean number of cycles of a frame.
    fn orbit<B: Board>(
        &self,
        renderer: &mut BoardRenderer<B>,
        model: &Model,
        path: &Path,
    ) -> anyhow::Result<u64> {
        let mesh = Mesh::new_checked(&model.mesh)?;
        let mut film = Film::default();
        for (number, view) in views(model, angles(self.orbit))?.into_iter().enumerate() {
            let stats = match number {
                0 => renderer.show(&frame(Subject::mesh(mesh), view))?,
                _ => renderer.look(&view)?,
            };
            film.add(&stats, renderer.image(SIZE)?)?;
        }
        film.write(path, ORBIT_FRAMES_PER_SECOND)
    }

    /// Writes an animation to `path` in which the camera moves towards the sponge and around it. Returns the mean number of
    /// cycles of a frame.
    fn sponge<B: Board>(
        &self,
        renderer: &mut BoardRenderer<B>,
        path: &Path,
    ) -> anyhow::Result<u64> {
        let subject = FieldSubject {
            field: &SPONGE,
            appearance: &Appearance::default(),
            quality: Quality::default(),
        };
        let mut film = Film::default();
        for number in 0..self.sponge {
            let part = f64::from(number) / f64::from(self.sponge.max(2) - 1);
            let between = |from: f64, to: f64| format!("{:.3}", from + (to - from) * part);
            // The camera's distance in world units, and azimuth and polar angle in degrees.
            let place = [between(3.2, 2.2), between(15.0, 60.0), between(80.0, 55.0)];
            let view = view::spherical(&place.join(","))?.with_half_width(HALF_WIDTH)?;
            let frame = Frame {
                stereo: Some(EYES),
                ..frame(Subject::Field(subject), view)
            };
            let Rendered { image, stats } = renderer.render(&frame, Parts::COLOUR)?;
            anyhow::ensure!(
                image.colour == on_model(&frame)?.image.colour,
                "frame {number} of the sponge differs from the model's"
            );
            film.add(&stats, image)?;
        }
        film.write(path, SPONGE_FRAMES_PER_SECOND)
    }
}

/// Frames of an animation that the gateware has drawn.
#[derive(Default)]
struct Film {
    images: Vec<Image>,
    cycles: u64,
}

impl Film {
    fn add(&mut self, stats: &Stats, image: Image) -> anyhow::Result<()> {
        self.cycles += cycles_of_gateware(stats)?;
        self.images.push(image);
        Ok(())
    }

    /// Writes the animation to `path`, and returns the mean number of cycles of a frame.
    fn write(self, path: &Path, frames_per_second: u16) -> anyhow::Result<u64> {
        write_picture(path, |out| {
            write_animation(out, &self.images, frames_per_second)
        })?;
        Ok(self.cycles / self.images.len().max(1) as u64)
    }
}

/// Returns the number of cycles of a frame; a frame drawn by the soft core is an error.
fn cycles_of_gateware(stats: &Stats) -> anyhow::Result<u64> {
    anyhow::ensure!(
        stats.backend.as_deref() == Some("gateware"),
        "expected a frame by the gateware, found one by the soft core"
    );
    Ok(stats.cycles.unwrap_or_default())
}

/// Rejects a folder that already contains pictures besides the first one, unless they may be replaced.
fn check_folder(folder: &Path) -> anyhow::Result<()> {
    let files = folder.read_dir();
    let files = files.with_context(|| format!("{}: cannot be read", folder.display()))?;
    for file in files {
        let path = file?.path();
        let is_picture = path.extension().is_some_and(|extension| extension == "png");
        if is_picture && !path.ends_with(FIRST) {
            // The error message of `Output` states how to replace files.
            Output::open(&path, PICTURE, [""; 0])?;
        }
    }
    Ok(())
}

fn write_picture(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> anyhow::Result<()> {
    Output::open(path, PICTURE, [""; 0])?.write(write)
}

/// A frame of the demo's pictures.
fn frame(subject: Subject, view: View) -> Frame {
    Frame {
        samples: SAMPLES,
        sky: Background::Gradient.gradient(),
        ..Frame::new(subject, view, SIZE)
    }
}

/// The cameras that show a whole model, `turned` about its up axis.
fn views(model: &Model, turned: impl Iterator<Item = Turns>) -> anyhow::Result<Vec<View>> {
    let meshes = [(Mesh::new_checked(&model.mesh)?, Matrix::IDENTITY)];
    Ok(whole(meshes.into_iter(), model.up, turned, None)?)
}

/// The camera that shows model `number`.
fn view_of(model: &Model, number: u32) -> anyhow::Result<View> {
    let views = views(model, [azimuth(number)].into_iter())?;
    views.first().copied().context("no vertex")
}

/// Draws a built-in scene on the board with flat shading, which every gateware build has, checks that its picture equals the
/// picture of the bit-exact model, and writes it to `path`. Returns a description of the picture and the number of cycles of the frame.
fn show_scene<B: Board>(
    renderer: &mut BoardRenderer<B>,
    name: &str,
    path: &Path,
) -> anyhow::Result<(String, u64)> {
    let scene = super::scene::read(name)?;
    let show = format!("scene {name}");
    let commands = [
        show,
        "shading flat".into(),
        size_command(SIZE),
        samples_command(SAMPLES),
    ];
    let Rendered { image, stats } = renderer.render_after(&commands, SIZE, Parts::COLOUR)?;
    let changes = Changes {
        shading: Some(Shading::Flat),
        size: Some(SIZE),
        samples: Some(SAMPLES),
        ..Changes::default()
    };
    let expected = scene::draw(&scene, &changes, on_model)??;
    anyhow::ensure!(
        image.colour == expected.image.colour,
        "scene {name}: the picture differs from the model's"
    );
    write_picture(path, |out| image.picture().write_png(out))?;
    let description = match scene.scene().options.shading {
        Shading::Flat => format!("scene {name}"),
        Shading::Smooth => format!("scene {name}, with flat shading in place of smooth"),
    };
    Ok((description, cycles_of_gateware(&stats)?))
}

/// Formats the summary line of an animation or a scene; `cycles` is the mean number of cycles of a frame, and `clock` the
/// frequency of the board's clock in Hz.
fn line(path: &Path, what: &str, cycles: u64, clock: u32) -> String {
    let clock = f64::from(clock);
    format!(
        "{}: {what}, by the gateware in {cycles} cycles each: {:.0} frames a second at {} MHz",
        path.display(),
        clock / cycles as f64,
        clock / 1e6
    )
}

/// The angle by which the camera is turned for the picture of model `number`, so that each model is seen from a different side.
fn azimuth(number: u32) -> Turns {
    Turns::from_degrees(Q32_32::from_num(number * 50))
}

/// The built-in scenes of the demo.
const SCENES: [&str; 3] = ["objects", "simplegpu", "wireframe"];

/// Half of the picture's width at distance 1, in world units, for the sponge.
const HALF_WIDTH: U8_28 = U8_28::lit("0.6");

/// Boots a board from reset: the BIOS, its serial boot, then the firmware up to its prompt. Returns the firmware's console.
fn boot<'b>(
    board: &'b mut SimulatedBoard,
    firmware: &[u8],
) -> anyhow::Result<Console<'b, SimulatedBoard>> {
    let (waiting, bar) = (spinner("the BIOS boots"), bar("firmware"));
    let start = Instant::now();
    let report = flash::flash(board, firmware, MAIN_RAM, BOOT_MS, &mut |done, all| {
        waiting.finish();
        advance(&bar)(done, all);
    })?;
    bar.finish();
    let mut console = Console::new(board);
    console.hear(&report.said);
    let banner = console.greet()?;
    for line in banner.lines().filter(|line| !line.trim().is_empty()) {
        say(format_args!("  | {line}"))?;
    }
    let (milliseconds, cycles) = (console.board().now_ms(), console.board().inner().cycles());
    say(format_args!(
        "booted through the BIOS: {} bytes of firmware, {milliseconds} ms of the board's time, {:.2} million cycles a second\n",
        report.bytes,
        cycles as f64 / start.elapsed().as_secs_f64() / 1e6
    ))?;
    Ok(console)
}

/// File name of a model's picture, without extension.
fn file_stem(name: &str) -> String {
    let stem = Path::new(name)
        .file_stem()
        .map_or(name.into(), |stem| stem.to_string_lossy());
    stem.replace(
        |c: char| !c.is_ascii_alphanumeric() && c != '-' && c != '_',
        "-",
    )
}

fn print_table(rows: &[Row]) -> anyhow::Result<()> {
    say(format_args!(
        "Pictures of {SIZE} with {SAMPLES} samples a pixel, by the gateware of the virtual board:\n"
    ))?;
    say("                                        cycles     frames")?;
    say("picture                triangles       a frame   a second")?;
    for Row {
        picture,
        stats,
        triangles,
        ..
    } in rows
    {
        let cycles = stats.cycles.unwrap_or_default();
        let rate = stats.clock.unwrap_or_default() as f64 / cycles as f64;
        say(format_args!(
            "{:<23}{triangles:>9}{cycles:>14}{rate:>11.0}",
            picture.display(),
        ))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each part of the demo sets all parameters of its pictures, so earlier parts have no effect.
    #[test]
    fn pictures_after_a_mesh_are_the_models() {
        let firmware = built_firmware(None).unwrap();
        let mut board = board::emulated(&firmware).unwrap();
        let mut console = Console::new(&mut board);
        console.greet().unwrap();
        let mut renderer = BoardRenderer::new(console)
            .with_backend(Backend::Gateware)
            .with_route(Route::Memory);
        let model = load("teapot", Options::default()).unwrap();

        let folder = tempfile::tempdir().unwrap();
        let tour = DemoArguments {
            models: Vec::new(),
            out: folder.path().to_owned(),
            firmware: None,
            orbit: 2,
            sponge: 2,
            first: false,
        };
        let path = |name: &str| folder.path().join(name);
        tour.orbit(&mut renderer, &model, &path("orbit.png"))
            .unwrap();
        tour.sponge(&mut renderer, &path("sponge.png")).unwrap();
        for name in SCENES {
            let path = path(&format!("{name}.png"));
            let (scene, _) = show_scene(&mut renderer, name, &path).unwrap();
            assert_eq!(scene.contains("with flat shading"), name == "objects");
        }
    }
}
