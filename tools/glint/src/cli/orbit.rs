//! `glint orbit`.

use super::camera::CameraSubject;
use super::common::{DrawingArguments, bad_value};
use super::heading;
use super::messages::{print_json, say, warn};
use super::output::{ANIMATION, Output};
use super::progress::count_bar;
use super::subject::SubjectArguments;
use super::texture::print_textures;
use anyhow::Context;
use clap::Args;
use glint::board::{BoardName, ModelOrBoard};
use glint::convert::TextureReport;
use glint::picture::Animation;
use glint::render::{Frame, Rendered, Subject, on_model, remarks};
use glint_core::camera::View;
use glint_scene_file::SceneFile;
use serde::Serialize;
use std::io::{self, BufWriter, Seek, Write};
use std::path::PathBuf;

/// Render an animation in which the camera turns once around a model, a distance field, a model in
/// a field, or a scene.
///
/// By default the camera shows the whole model in all frames, and turns around it about the up axis. With a
/// camera option, in a field, and in a scene that states a camera, the camera turns around the
/// origin about the z axis. The first camera is that of `glint render`, except for the lens that shows the
/// whole model.
#[derive(Args)]
pub struct OrbitArguments {
    #[command(flatten)]
    subject: SubjectArguments,
    /// Animation to write: an animated PNG, or a GIF with 256 colours per frame. `-` writes a PNG
    /// to standard output.
    #[arg(long, value_name = "ANIMATION.png|ANIMATION.gif", help_heading = heading::PICTURE)]
    out: PathBuf,
    /// Number of frames.
    #[arg(long, help_heading = heading::PICTURE, default_value_t = 36, value_parser = clap::value_parser!(u16).range(1..=360))]
    frames: u16,
    /// Frames per second of the animation. The frame time of a GIF is a multiple of 1/100 s.
    #[arg(long, help_heading = heading::PICTURE, default_value_t = 20, value_parser = clap::value_parser!(u16).range(1..=50))]
    rate: u16,
    #[command(flatten, next_help_heading = heading::RENDERER)]
    drawing: DrawingArguments,
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
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    textures: &'a [TextureReport],
    /// Mean cycles of a frame, if the renderer counts cycles.
    #[serde(skip_serializing_if = "Option::is_none")]
    cycles: Option<u64>,
}

impl OrbitArguments {
    pub fn run(self) -> anyhow::Result<()> {
        self.drawing.check()?;
        let instead = "--field or --scene";
        let defaults = self.drawing.defaults();
        self.subject
            .with_frame(&[], false, instead, defaults, |shown| {
                let inputs = self.subject.inputs(shown.scene);
                let out = Output::open(&self.out, ANIMATION, inputs)?;
                if let Subject::Wireframe(_) = shown.frame.subject {
                    let expected = "a scene with a camera";
                    return Err(bad_value("--scene", expected, "a wireframe program").into());
                }
                let views = self.subject.turn(shown, self.frames)?;
                self.write(out, shown, &views)
            })
    }

    /// Renders a frame for each camera, and writes the animation.
    fn write(&self, out: Output, shown: &CameraSubject, views: &[View]) -> anyhow::Result<()> {
        let CameraSubject { frame, scene, .. } = *shown;
        let mut spool = out.spool()?;
        let mut drawn = Vec::new();
        let animation = self.animation(BufWriter::new(&spool), frame.size.pixels());
        let mut animation = animation.with_context(|| out.unwritable())?;
        self.draw(frame, views, scene, &mut |Rendered { image, stats }| {
            let picture = image.picture();
            animation.add(&picture).with_context(|| out.unwritable())?;
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
            model: self.subject.model.as_deref(),
            field: self.subject.field.name(),
            scene: self.subject.scene.as_deref(),
            board: self.drawing.board.to_string(),
            size: frame.size.pixels(),
            frames: self.frames,
            textures: shown.textures,
            cycles,
        };
        if self.drawing.transfer.json {
            return print_json(&outcome);
        }
        print_textures(shown.textures)?;
        let shown = outcome.model.or(outcome.field).or(outcome.scene);
        let cycles = cycles.map_or(String::new(), |cycles| format!(", {cycles} cycles each"));
        say(format_args!(
            "{} frames around {}, {}, by {}{cycles}",
            self.frames,
            shown.unwrap_or_default(),
            frame.size,
            self.drawing.board
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
        match &self.drawing.board {
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
        let mut board = self.drawing.transfer.line.board(name)?;
        let renderer = self.drawing.renderer(&mut *board, name);
        let mut renderer = renderer.with_scene(scene.cloned());
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
