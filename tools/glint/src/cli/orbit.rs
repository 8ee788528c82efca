//! `glint orbit`.

use super::camera::LensArguments;
use super::common::{TransferArguments, named, size};
use super::convert::load;
use super::messages::{print_json, say, warn};
use super::output::{ANIMATION, Output};
use super::progress::count_bar;
use anyhow::Context;
use clap::Args;
use glint::board::{BoardName, ModelOrBoard};
use glint::console::Console;
use glint::picture::{Image, write_animation, write_gif};
use glint::render::{
    BoardRenderer, Frame, MeshSubject, Rendered, Route, Subject, on_model, remarks,
};
use glint_core::colour::Shading;
use glint_core::fixed::Turns;
use glint_core::mesh::Mesh;
use glint_core::picture::Backend;
use serde::Serialize;
use std::path::PathBuf;

/// Render an animation in which the camera goes once around a model.
#[derive(Args)]
pub struct OrbitArguments {
    /// A mesh file, `-` for one from standard input, or a generator's name.
    model: String,
    /// Animation to write: an animated PNG, or a GIF, which has 256 colours a frame. `-` is standard output, for a PNG.
    #[arg(long, value_name = "ANIMATION.png|ANIMATION.gif")]
    out: PathBuf,
    /// Number of frames.
    #[arg(long, default_value_t = 36, value_parser = clap::value_parser!(u16).range(1..=360))]
    frames: u16,
    /// Frames a second of the animation. A GIF has steps of 1/100 s.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u16).range(1..=50))]
    rate: u16,
    #[command(flatten)]
    lens: LensArguments,
    /// The renderer: `model` (the bit-exact model, in this process), `emulated` (the firmware in an emulator), `virtual`
    /// (the verilated SoC) or a serial port.
    #[arg(long, default_value = "model")]
    board: ModelOrBoard,
    /// The backend of a board: `cpu` (the soft core) or `gateware` (the accelerators) [default: gateware where the board has it].
    #[arg(long, value_parser = named(Backend::ALL, Backend::name))]
    backend: Option<Backend>,
    /// Size of the pictures: 320x180, 640x360 or 1280x720.
    #[arg(long, value_name = "WxH", default_value = "320x180")]
    size: String,
    /// Source of the colours: `flat` (triangles), or `smooth` (vertices, interpolated).
    #[arg(long, value_parser = named(Shading::ALL, Shading::name), default_value_t)]
    shading: Shading,
    /// Draw back faces too.
    #[arg(long)]
    no_cull: bool,
    #[command(flatten)]
    transfer: TransferArguments,
}

/// The output of `--json`.
#[derive(Serialize)]
struct Outcome<'a> {
    model: &'a str,
    board: String,
    size: [u32; 2],
    frames: u16,
    /// Mean of the cycles of a frame, if the renderer counts them.
    #[serde(skip_serializing_if = "Option::is_none")]
    cycles: Option<u64>,
}

impl OrbitArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let size = size(&self.size)?;
        let out = Output::open(&self.out, ANIMATION, [&self.model])?;
        let model = load(&self.model, false)?;
        let mesh = Mesh::new_checked(&model.mesh)?;
        let sphere = self.subject(mesh).sphere();
        let sphere = sphere.context("expected a mesh with vertices")?;
        let up = self.lens.up_of(Some(&self.model));
        let views = (0..self.frames).map(|number| {
            let turned = (u64::from(number) << 32) / u64::from(self.frames);
            self.lens
                .framed(&sphere, &self.model, up, Turns(turned as u32))
        });
        let views = views.collect::<anyhow::Result<Vec<_>>>()?;
        let frames: Vec<Frame> = views
            .into_iter()
            .map(|view| Frame::new(self.subject(mesh), view, size))
            .collect();
        let drawn = self.draw(&frames)?;
        if let (Some(frame), Some(first)) = (frames.first(), drawn.first()) {
            remarks(frame, &first.stats)?.iter().for_each(warn);
        }
        let cycles: Option<Vec<u64>> = drawn.iter().map(|drawn| drawn.stats.cycles).collect();
        let cycles = cycles.map(|cycles| {
            let sum: u128 = cycles.into_iter().map(u128::from).sum();
            (sum / u128::from(self.frames)) as u64
        });
        let images: Vec<Image> = drawn.into_iter().map(|drawn| drawn.image).collect();
        let is_gif = self
            .out
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("gif"));
        out.write(|out| match is_gif {
            true => write_gif(out, &images, self.rate),
            false => write_animation(out, &images, self.rate),
        })?;
        let outcome = Outcome {
            model: &self.model,
            board: self.board.to_string(),
            size: size.pixels(),
            frames: self.frames,
            cycles,
        };
        if self.transfer.json {
            return print_json(&outcome);
        }
        let cycles = cycles.map_or(String::new(), |cycles| format!(", {cycles} cycles each"));
        say(format_args!(
            "{} frames around {}, {size}, by {}{cycles}",
            self.frames, self.model, self.board
        ))
    }

    fn subject<'m>(&self, mesh: Mesh<'m>) -> Subject<'m> {
        Subject::Mesh(MeshSubject {
            cull: !self.no_cull,
            shading: self.shading,
            ..MeshSubject::new(mesh)
        })
    }

    fn draw(&self, frames: &[Frame]) -> anyhow::Result<Vec<Rendered>> {
        let bar = count_bar("drawing", "frames");
        bar.set_length(frames.len() as u64);
        let drawn = match &self.board {
            ModelOrBoard::Model => frames
                .iter()
                .map(|frame| {
                    let drawn = on_model(frame)?;
                    bar.inc();
                    Ok(drawn)
                })
                .collect(),
            ModelOrBoard::Board(name) => self.draw_on(name, frames, &mut || bar.inc()),
        };
        bar.finish();
        drawn
    }

    /// Draws frames of one mesh on a board, which gets the mesh once.
    fn draw_on(
        &self,
        name: &BoardName,
        frames: &[Frame],
        advance: &mut dyn FnMut(),
    ) -> anyhow::Result<Vec<Rendered>> {
        let mut board = self.transfer.line.board(name)?;
        let route = self.transfer.transfer.unwrap_or(Route::of(name));
        let mut renderer = BoardRenderer::new(Console::new(&mut *board)).with_backend(self.backend);
        let mut drawn = Vec::new();
        for frame in frames {
            let stats = match drawn.is_empty() {
                true => renderer.show(frame, route, &mut |_, _| {})?,
                false => renderer.look(&frame.view)?,
            };
            let image = Image {
                colour: renderer.colour(frame.size, route, &mut |_, _| {})?,
                ..Image::empty(frame.size)
            };
            drawn.push(Rendered { image, stats });
            advance();
        }
        Ok(drawn)
    }
}
