//! `glint demo`: the whole machine at work.

use super::common::{advance, bar, say, spinner};
use super::convert::load;
use anyhow::Context;
use clap::Args;
use glint::board::{Board, SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::flash;
use glint::model::Model;
use glint::picture::save_animation;
use glint::render::{self, Renderer, Route, Scene, Stats};
use glint_core::camera::View;
use glint_core::console::Backend;
use glint_core::fixed::{Q32_32, Turns, U4_28};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Show the whole machine: boot the virtual board, load its firmware, upload models, render, capture the monitor.
#[derive(Args)]
pub struct DemoArguments {
    /// Mesh files or generators' names; gear, icosphere:8 and teapot unless told.
    models: Vec<String>,
    /// The folder for the pictures.
    #[arg(long, default_value = "out")]
    out: PathBuf,
    /// The program to load [default: that of `cargo xtask firmware`].
    #[arg(long, value_name = "FILE")]
    firmware: Option<PathBuf>,
    /// Frames of the orbit.
    #[arg(long, default_value_t = 72)]
    orbit: u16,
}

const MODELS: [&str; 3] = ["gear", "icosphere:8", "teapot"];
/// Where a program goes and starts.
const MAIN_RAM: u32 = 0x4000_0000;
const SIZE: (u32, u32) = (320, 180);
const ORBIT_SIZE: (u32, u32) = (640, 360);
const ORBIT_FRAMES_PER_SECOND: u16 = 24;
/// The board's time that its BIOS may take.
const BOOT_MS: u64 = 10_000;

/// A line of the table.
struct Row {
    picture: PathBuf,
    stats: Stats,
    cycles_per_second: f64,
}

impl DemoArguments {
    pub fn run(self) -> anyhow::Result<()> {
        std::fs::create_dir_all(&self.out)
            .with_context(|| format!("{}: cannot be made", self.out.display()))?;
        let names: Vec<String> = if self.models.is_empty() {
            MODELS.map(str::to_owned).to_vec()
        } else {
            self.models.clone()
        };
        let models = names
            .iter()
            .map(|name| Ok((name.as_str(), load(name, false)?)))
            .collect::<anyhow::Result<Vec<_>>>()?;
        let firmware = built_firmware(self.firmware.as_deref())?;

        let mut board = SimulatedBoard::full()?;
        let mut renderer = Renderer::new(boot(&mut board, &firmware)?);
        let mut rows = Vec::new();
        for (number, (name, model)) in models.iter().enumerate() {
            rows.push(self.show(&mut renderer, name, model, number as u32)?);
        }
        let (name, model) = models.last().context("a model to orbit")?;
        let orbit = self.out.join("orbit.png");
        self.orbit(model, &orbit)?;
        print_table(&rows)?;
        say(format_args!(
            "{}: {} frames around {name}, rendered by the model on this machine: the gateware has no engine yet",
            orbit.display(),
            self.orbit
        ))
    }

    /// Uploads and renders a model, and looks at the monitor.
    fn show(
        &self,
        renderer: &mut Renderer<SimulatedBoard>,
        name: &str,
        model: &Model,
        number: u32,
    ) -> anyhow::Result<Row> {
        let (start, start_cycles) = (Instant::now(), renderer.board().inner().cycles());
        let view = camera(Turns::from_degrees(Q32_32::from_num(number * 50 + 30)))?;
        let scene = Scene {
            mesh: &model.mesh,
            view,
            size: SIZE,
            cull: true,
            backend: Some(Backend::Cpu),
        };
        let bar = bar(name);
        let stats = renderer.show(&scene, Route::Serial, &mut advance(&bar))?;
        bar.finish_and_clear();
        let spinner = spinner("the monitor shows a frame");
        let picture = renderer.board().inner().capture()?;
        spinner.finish_and_clear();
        let path = self.out.join(file_stem(name)).with_extension("png");
        picture
            .save(&path)
            .with_context(|| format!("{}: cannot be written", path.display()))?;

        let scale = virtual_board::WIDTH / SIZE.0 as usize;
        let expected = render::on_model(&scene)?.frame.colour;
        anyhow::ensure!(
            picture.scaled_back(scale)? == expected,
            "{name}: the monitor's picture is not the model's"
        );
        let cycles = renderer.board().inner().cycles() - start_cycles;
        Ok(Row {
            picture: path,
            stats,
            cycles_per_second: cycles as f64 / start.elapsed().as_secs_f64(),
        })
    }

    /// Renders a turn about a model.
    fn orbit(&self, model: &Model, path: &Path) -> anyhow::Result<()> {
        let spinner = spinner("the orbit");
        let frames = (0..self.orbit)
            .map(|number| {
                let turned = Turns(((u64::from(number) << 32) / u64::from(self.orbit)) as u32);
                let scene = Scene {
                    mesh: &model.mesh,
                    view: camera(turned)?,
                    size: ORBIT_SIZE,
                    cull: true,
                    backend: Some(Backend::Cpu),
                };
                Ok(render::on_model(&scene)?.frame)
            })
            .collect::<anyhow::Result<Vec<_>>>()?;
        save_animation(path, &frames, ORBIT_FRAMES_PER_SECOND)
            .with_context(|| format!("{}: cannot be written", path.display()))?;
        spinner.finish_and_clear();
        Ok(())
    }
}

/// A polar angle of 60 degrees: a sixth of a turn.
const POLAR: u32 = (1_u64 << 32).div_euclid(6) as u32;

/// The half width of the image plane at distance 1: models nearly fill the picture's height.
const HALF_WIDTH: f64 = 0.6;

/// The camera at distance 2 and an azimuth.
fn camera(azimuth: Turns) -> anyhow::Result<View> {
    let view = View::spherical(Q32_32::from_num(2), azimuth, Turns(POLAR));
    view.and_then(|view| {
        View::new_checked(
            view.eye(),
            view.u(),
            view.v(),
            view.n(),
            U4_28::from_num(HALF_WIDTH),
            view.near(),
        )
    })
    .map_err(anyhow::Error::msg)
}

/// From reset through the BIOS's serial boot to the firmware's prompt.
fn boot<'b>(
    board: &'b mut SimulatedBoard,
    firmware: &[u8],
) -> anyhow::Result<Console<'b, SimulatedBoard>> {
    let (waiting, bar) = (spinner("the BIOS boots"), bar("firmware"));
    let start = Instant::now();
    let report = flash::flash(board, firmware, MAIN_RAM, BOOT_MS, &mut |done, all| {
        waiting.finish_and_clear();
        advance(&bar)(done, all);
    })?;
    bar.finish_and_clear();
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

/// A model's name as that of a file.
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
    say(
        "                                            cycles a frame   frames a second        simulated",
    )?;
    say(
        "picture                         triangles  (soft core)       81.25 MHz  100 MHz     cycles/s",
    )?;
    for Row {
        picture,
        stats,
        cycles_per_second,
    } in rows
    {
        let cycles = stats.cycles.unwrap_or_default();
        let rate = |hertz: f64| hertz / cycles as f64;
        say(format_args!(
            "{:<32}{:>9}{:>13}{:>16.2}{:>9.2}{:>13.0}",
            picture.display(),
            stats.triangles_in,
            cycles,
            rate(81.25e6),
            rate(100e6),
            cycles_per_second
        ))?;
    }
    Ok(())
}
