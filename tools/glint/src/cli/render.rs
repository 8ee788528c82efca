//! `glint render`.

use super::common::{LineArguments, advance, bar, print_json, say, spinner, write_file};
use super::convert::load;
use anyhow::Context;
use clap::{Args, ValueEnum};
use glint::board::{Board, SimulatedBoard};
use glint::console::Console;
use glint::error::FormatError;
use glint::picture::Frame;
use glint::render::{self, Rendered, Renderer, Route, Scene, Stats};
use glint::view;
use glint_core::camera::View;
use glint_model::RenderError;
use glint_model::frame::MAX_EYE;
use serde::Serialize;
use std::path::PathBuf;

/// Render a model to a picture.
#[derive(Args)]
pub struct RenderArguments {
    /// A mesh file or a generator's name.
    model: String,
    /// A camera on a sphere about the origin: the distance (2 to 5), azimuth and polar angle in degrees. half_width is 0.9
    /// and near 0.1.
    #[arg(
        long,
        value_name = "R,THETA,PHI",
        default_value = "2,30,60",
        conflicts_with = "view",
        allow_hyphen_values = true
    )]
    camera: String,
    /// A camera from a file: {"eye":[x,y,z],"u":[..],"v":[..],"n":[..],"half_width":h,"near":z}.
    #[arg(long, value_name = "VIEW.json")]
    view: Option<PathBuf>,
    /// Who renders: `model` (the bit-exact model, on this machine), `virtual` (the verilated SoC) or a serial port.
    #[arg(long, default_value = "model")]
    board: String,
    /// Which renderer of a board [default: gateware where the board has it]. The model stands for both, as they are
    /// bit-exact.
    #[arg(long, value_enum)]
    backend: Option<Backend>,
    /// 320x180, 640x360 or 1280x720.
    #[arg(long, value_name = "WxH", default_value = "320x180")]
    size: String,
    /// The picture to write.
    #[arg(long, value_name = "PICTURE.png")]
    out: PathBuf,
    /// Write the distance along n in world units: one little-endian f32 a pixel, +inf where nothing was drawn.
    #[arg(long, value_name = "DEPTH.f32")]
    depth: Option<PathBuf>,
    /// Write cycles, triangles, pixels and the clock as JSON.
    #[arg(long, value_name = "STATS.json")]
    stats: Option<PathBuf>,
    /// Draw back faces too.
    #[arg(long)]
    no_cull: bool,
    /// Where colours come from: faces, or vertices.
    #[arg(long, value_enum, default_value_t = Shading::Flat)]
    shading: Shading,
    /// Leave the model's coordinates as they are, and refuse those outside [-2, 2).
    #[arg(long)]
    keep_scale: bool,
    /// Where the picture of a board is taken from: its memory, or the virtual board's monitor.
    #[arg(long, value_enum, default_value_t = Capture::Frame)]
    capture: Capture,
    /// How mesh and picture pass between here and a board [default: memory on the virtual board, serial on a port].
    #[arg(long, value_enum)]
    transfer: Option<Route>,
    #[command(flatten)]
    line: LineArguments,
    /// Print what was done as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Backend {
    /// The soft core.
    Cpu,
    /// The engines.
    Gateware,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Shading {
    /// A triangle's own colour and normal.
    Flat,
    /// Those of its vertices, interpolated.
    Smooth,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Capture {
    /// The frame buffer.
    Frame,
    /// The video pins, scaled back.
    Monitor,
}

/// What is printed with `--json`.
#[derive(Serialize)]
struct Outcome<'a> {
    model: &'a str,
    board: &'a str,
    size: [u32; 2],
    #[serde(flatten)]
    stats: &'a Stats,
}

impl RenderArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let view = self.camera()?;
        let size = parse_size(&self.size)?;
        let model = load(&self.model, self.keep_scale)?;
        let scene = Scene {
            mesh: &model.mesh,
            view,
            size,
            cull: !self.no_cull,
            shading: match self.shading {
                Shading::Flat => glint_model::Shading::Flat,
                Shading::Smooth => glint_model::Shading::Smooth,
            },
            backend: self.backend.map(|backend| match backend {
                Backend::Cpu => glint_core::console::Backend::Cpu,
                Backend::Gateware => glint_core::console::Backend::Gateware,
            }),
        };
        let Rendered { frame, stats } = self.render(&scene)?;
        frame
            .picture()
            .save(&self.out)
            .with_context(|| format!("{}: cannot be written", self.out.display()))?;
        if let Some(path) = &self.depth {
            frame
                .save_depth(path, &render::depth_scale(&scene)?)
                .with_context(|| format!("{}: cannot be written", path.display()))?;
        }
        if let Some(path) = &self.stats {
            let json = serde_json::to_string_pretty(&stats)? + "\n";
            write_file(path, json.as_bytes())?;
        }
        if self.json {
            let outcome = Outcome {
                model: &self.model,
                board: &self.board,
                size: [size.0, size.1],
                stats: &stats,
            };
            return print_json(&outcome);
        }
        print_stats(&stats)
    }

    fn camera(&self) -> anyhow::Result<View> {
        let Some(path) = &self.view else {
            return Ok(view::spherical(&self.camera).map_err(|error| error.in_file("--camera"))?);
        };
        let view = view::read(path)?;
        if !view.is_within(MAX_EYE) {
            let found = RenderError::Eye(view.eye()).to_string();
            let error = FormatError::whole("a camera", found);
            return Err(error.in_file(path.display().to_string()).into());
        }
        Ok(view)
    }

    fn render(&self, scene: &Scene) -> anyhow::Result<Rendered> {
        anyhow::ensure!(
            self.board == "virtual" || self.capture == Capture::Frame,
            "--capture monitor: only the virtual board has a monitor to look at"
        );
        match self.board.as_str() {
            "model" => {
                let spinner = spinner("rendering");
                let rendered = render::on_model(scene)?;
                spinner.finish_and_clear();
                Ok(rendered)
            }
            "virtual" => {
                let mut board = self.line.virtual_board()?;
                let route = self.transfer.unwrap_or(Route::Memory);
                let mut rendered = self.on_board(&mut board, scene, route)?;
                if self.capture == Capture::Monitor {
                    rendered.frame.colour = from_monitor(&mut board, scene.size)?;
                }
                Ok(rendered)
            }
            port => {
                let mut board = self.line.serial_board(port)?;
                self.on_board(&mut board, scene, self.transfer.unwrap_or(Route::Serial))
            }
        }
    }

    fn on_board(
        &self,
        board: &mut dyn Board,
        scene: &Scene,
        route: Route,
    ) -> anyhow::Result<Rendered> {
        let mut renderer = Renderer::new(Console::new(board));
        let bar = bar("mesh and frames");
        let (width, height) = scene.size;
        let stats = renderer.show(scene, route, &mut advance(&bar))?;
        let mut frame = Frame {
            width,
            height,
            colour: Vec::new(),
            depth: Vec::new(),
        };
        if self.capture == Capture::Frame {
            frame.colour = renderer.colour(scene.size, route, &mut advance(&bar))?;
        }
        if self.depth.is_some() {
            frame.depth = renderer.depth(scene.size, route, &mut advance(&bar))?;
        }
        bar.finish_and_clear();
        Ok(Rendered { frame, stats })
    }
}

/// The frame that the virtual board's monitor shows, scaled back to the size it was drawn in.
fn from_monitor(board: &mut SimulatedBoard, (width, _): (u32, u32)) -> anyhow::Result<Vec<u16>> {
    let spinner = spinner("the monitor shows a frame");
    let picture = board.inner().capture()?;
    spinner.finish_and_clear();
    let scale = virtual_board::WIDTH / width as usize;
    Ok(picture.scaled_back(scale)?)
}

fn parse_size(text: &str) -> anyhow::Result<(u32, u32)> {
    let size = text
        .split_once('x')
        .and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    size.filter(|size| glint_model::SIZES.contains(size))
        .ok_or_else(|| {
            let error = FormatError::whole(
                "320x180, 640x360 or 1280x720",
                glint::error::quote(text.as_bytes()),
            );
            error.in_file("--size").into()
        })
}

fn print_stats(stats: &Stats) -> anyhow::Result<()> {
    say(format_args!(
        "triangles  {} in, {} culled, {} clipped, {} drawn",
        stats.triangles_in, stats.triangles_culled, stats.triangles_clipped, stats.triangles_drawn
    ))?;
    say(format_args!(
        "pixels     {} tested, {} covered, {} drawn",
        stats.pixels_tested, stats.pixels_covered, stats.pixels_drawn
    ))?;
    if let (Some(cycles), Some(clock)) = (stats.cycles, stats.clock) {
        let (rate, megahertz) = (clock as f64 / cycles as f64, clock as f64 / 1e6);
        say(format_args!(
            "cycles     {cycles} by the {}, {rate:.2} frames a second at {megahertz} MHz",
            stats.backend.as_deref().unwrap_or("board")
        ))?;
    }
    Ok(())
}
