//! `glint wireframe`.

use super::common::{DrawingArguments, bad_value, named, size};
use super::messages::{print_json, say, warn};
use super::output::{Output, PICTURE, PROGRAM, STATISTICS};
use super::progress::{advance, bar, spinner};
use super::render::print_stats;
use clap::{Args, Subcommand};
use glint::board::{BoardName, ModelOrBoard};
use glint::model;
use glint::render::{Frame, Rendered, Subject, WireframeSubject, on_model};
use glint::view;
use glint::wireframe::{self, Action, Form, Made, MotionForm, Played, Source};
use glint_core::picture::{Samples, Size};
use glint_core::wireframe::{Program, Viewing};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Wireframe simulator: check, convert, make and render programs.
///
/// A PROGRAM is a file in text form (.wft), one instruction per line, or in binary form (.wfb), 16 bytes per word: the eye, the
/// view plane, the window, up to 65535 segments, and an end. Numbers are multiples of 1/2048 from -16 to 15.9995.
#[derive(Subcommand)]
pub enum WireframeCommand {
    Check(CheckArguments),
    Convert(ConvertArguments),
    Make(MakeArguments),
    Render(RenderArguments),
}

/// Check a program, and show its viewing parameters and counts.
#[derive(Args)]
pub struct CheckArguments {
    /// Program to read: .wft or .wfb; `-` is standard input, whose form is detected from its contents.
    program: PathBuf,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

/// Convert a program between its text form and its binary form, without loss.
#[derive(Args)]
pub struct ConvertArguments {
    /// Program to read: .wft or .wfb; `-` is standard input, whose form is detected from its contents.
    input: PathBuf,
    /// Output file; the extension selects the form: .wft or .wfb.
    out: PathBuf,
}

/// Make a program that draws each edge of a model once.
///
/// In the picture, the model's z axis points up, and its y axis away from the viewer. With the
/// default eye, view plane and window, a model of the default size is completely visible in every
/// rotation about its centre.
#[derive(Args)]
pub struct MakeArguments {
    /// A mesh file or a generator's name.
    model: String,
    /// Output file; the extension selects the form: .wft or .wfb.
    #[arg(long, value_name = "PROGRAM")]
    out: PathBuf,
    /// Side of the box about the origin to which the model is scaled; less than 32.
    #[arg(
        long,
        value_name = "SIDE",
        default_value_t = 4.0,
        allow_hyphen_values = true
    )]
    extent: f64,
    /// Keep the model's coordinates; those outside [-16, 16) are an error.
    #[arg(long, conflicts_with = "extent")]
    keep_scale: bool,
    /// The eye; its z is at least 0 and greater than the z of the view plane.
    #[arg(
        long,
        value_name = "X,Y,Z",
        default_value = "0,0,8",
        allow_hyphen_values = true
    )]
    eye: String,
    /// The z of the view plane. Parts in front of the view plane are not drawn.
    #[arg(
        long,
        value_name = "Z",
        default_value = "4",
        allow_hyphen_values = true
    )]
    plane: String,
    /// The part of the view plane that fills the picture: lower left corner, then upper right corner.
    #[arg(
        long,
        value_name = "XL,YL,XH,YH",
        default_value = "-4,-2.25,4,2.25",
        allow_hyphen_values = true
    )]
    window: String,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

/// Render a program to a picture, after the keys of a script.
#[derive(Args)]
pub struct RenderArguments {
    /// Program to read: .wft or .wfb; `-` is standard input, whose form is detected from its contents.
    program: PathBuf,
    /// Picture file to write.
    #[arg(long, value_name = "PICTURE.png")]
    out: PathBuf,
    /// Keys to press, one per frame: up, down, left, right, zoom-in, zoom-out, or KEY:COUNT. After `rotate`, the arrow keys
    /// rotate by 1.79 degrees; at the start and after `pan`, they pan by 0.0625. The zoom keys move by 0.125 along z.
    #[arg(long, value_name = "KEY,KEY,...")]
    press: Option<String>,
    /// Arithmetic of the motion: `drift-free`, or `accumulated`, which rounds the end points after
    /// each step, as in the original design.
    #[arg(long, value_parser = named(MotionForm::ALL, MotionForm::name), default_value = "drift-free")]
    motion: MotionForm,
    #[command(flatten)]
    drawing: DrawingArguments,
    /// Size of the picture: 320x180, 640x360 or 1280x720.
    #[arg(long, value_name = "WxH", default_value = "1280x720")]
    size: String,
    /// Antialiasing: number of samples whose average is a pixel.
    #[arg(long, value_parser = named(Samples::ALL, Samples::name), default_value = "4")]
    aa: Samples,
    /// Write the counts of segments, lines and pixels as JSON.
    #[arg(long, value_name = "STATS.json")]
    stats: Option<PathBuf>,
}

impl WireframeCommand {
    pub fn run(self) -> anyhow::Result<()> {
        match self {
            Self::Check(arguments) => arguments.run(),
            Self::Convert(arguments) => arguments.run(),
            Self::Make(arguments) => arguments.run(),
            Self::Render(arguments) => arguments.run(),
        }
    }
}

/// Summary of a checked program, in the form that the command prints.
#[derive(Serialize)]
struct Summary {
    eye: [f64; 3],
    plane: f64,
    window: [f64; 4],
    segments: u32,
    bytes: usize,
}

impl Summary {
    fn new(program: &Program) -> Self {
        let Viewing { eye, plane, window } = program.viewing();
        let ([xl, yl], [xh, yh]) = (window.low, window.high);
        Self {
            eye: eye.map(f64::from),
            plane: f64::from(*plane),
            window: [xl, yl, xh, yh].map(f64::from),
            segments: program.segment_count(),
            bytes: program.bytes().len(),
        }
    }
}

impl CheckArguments {
    fn run(self) -> anyhow::Result<()> {
        let bytes = read(&self.program)?;
        let program = wireframe::check(&bytes)?;
        let summary = Summary::new(&program);
        if self.json {
            return print_json(&summary);
        }
        let Viewing { eye, plane, window } = program.viewing();
        let ([x, y, z], [xl, yl], [xh, yh]) = (*eye, window.low, window.high);
        say(format_args!("eye        {x} {y} {z}"))?;
        say(format_args!("plane      {plane}"))?;
        say(format_args!("window     {xl} {yl} {xh} {yh}"))?;
        say(format_args!(
            "program    {} segments, {} bytes in binary form",
            summary.segments, summary.bytes
        ))
    }
}

impl ConvertArguments {
    fn run(self) -> anyhow::Result<()> {
        let form = Form::of(&self.out)?;
        let out = Output::open(&self.out, PROGRAM, [&self.input])?;
        let bytes = read(&self.input)?;
        let program = form.encode(&wireframe::check(&bytes)?);
        out.write(|out| out.write_all(&program))
    }
}

/// The result of `make`, in the form that the command prints.
#[derive(Serialize)]
struct Written {
    segments: usize,
    dropped: usize,
    bytes: usize,
}

impl MakeArguments {
    fn run(self) -> anyhow::Result<()> {
        let form = Form::of(&self.out)?;
        let viewing = self.viewing()?;
        let extent = self.extent()?;
        let out = Output::open(&self.out, PROGRAM, [&self.model])?;
        let spinner = spinner("reading the model");
        let polygons = model::polygons(&self.model)?;
        let Made {
            bytes,
            segments,
            dropped,
        } = wireframe::make(polygons, extent, &viewing)
            .map_err(|error| error.in_file(&self.model))?;
        let program = form.encode(&wireframe::check(&bytes)?);
        out.write(|out| out.write_all(&program))?;
        spinner.finish();
        if self.json {
            return print_json(&Written {
                segments,
                dropped,
                bytes: bytes.len(),
            });
        }
        say(format_args!("written    {segments} segments"))?;
        say(format_args!(
            "dropped    {dropped} edges of length 0 after rounding to 2^-11"
        ))
    }

    /// Side of the box to which the model is scaled; `None` to keep the model's coordinates.
    fn extent(&self) -> anyhow::Result<Option<f64>> {
        if self.keep_scale {
            return Ok(None);
        }
        if self.extent > 0.0 && self.extent < 32.0 {
            return Ok(Some(self.extent));
        }
        let found = self.extent.to_string();
        Err(bad_value("--extent", "a side above 0 and below 32", found).into())
    }

    fn viewing(&self) -> anyhow::Result<Viewing> {
        let [plane] = wireframe::numbers(&self.plane, "a number Z")
            .map_err(|error| error.in_file("--plane"))?;
        Ok(Viewing {
            eye: wireframe::numbers(&self.eye, "a position X,Y,Z")
                .map_err(|error| error.in_file("--eye"))?,
            plane,
            window: wireframe::window(&self.window).map_err(|error| error.in_file("--window"))?,
        })
    }
}

impl RenderArguments {
    fn run(self) -> anyhow::Result<()> {
        self.drawing.check()?;
        let size = size(&self.size)?;
        let press = self.press.as_deref();
        let script = press.map(wireframe::script).transpose();
        let script = script.map_err(|error| error.in_file("--press"))?;
        let script = script.unwrap_or_default();
        let out = Output::open(&self.out, PICTURE, [&self.program])?;
        let statistics = self.stats.as_deref();
        let statistics = statistics.map(|path| Output::open(path, STATISTICS, [&self.program]));
        let statistics = statistics.transpose()?;
        let bytes = read(&self.program)?;
        let Played {
            bytes,
            pose,
            refused,
        } = wireframe::play(&wireframe::check(&bytes)?, &script, self.motion);
        let Rendered { image, stats } = match &self.drawing.board {
            ModelOrBoard::Model => {
                let program = wireframe::check(&bytes)?;
                let subject = Subject::Wireframe(WireframeSubject { program, pose });
                // The program has its own eye, so the frame's camera has no effect.
                let camera = view::spherical("2,30,60")?;
                on_model(&Frame {
                    samples: self.aa,
                    ..Frame::new(subject, camera, size)
                })?
            }
            ModelOrBoard::Board(name) => {
                // The board supports only the drift-free motion. The host has already computed the accumulated motion.
                let script = match self.motion {
                    MotionForm::DriftFree => &script[..],
                    MotionForm::Accumulated => &[],
                };
                self.on_board(name, &bytes, script, size)?
            }
        };
        out.write(|out| image.picture().write_png(out))?;
        if let Some(out) = statistics {
            out.write_json(&stats)?;
        }
        if self.drawing.transfer.json {
            return print_json(&stats);
        }
        print_stats(&stats, self.aa == Samples::Four && size.doubled().is_none())?;
        if refused > 0 {
            say(format_args!(
                "note       {refused} steps were skipped, because coordinates would have left their range"
            ))?;
        }
        Ok(())
    }

    fn on_board(
        &self,
        name: &BoardName,
        program: &[u8],
        script: &[Action],
        size: Size,
    ) -> anyhow::Result<Rendered> {
        let mut board = self.drawing.transfer.line.board(name)?;
        let bar = bar("program and frame");
        let renderer = self.drawing.renderer(&mut *board, name);
        let mut renderer = renderer.with_progress(advance(&bar));
        Ok(renderer.play(program, script, size, self.aa)?)
    }
}

/// Reads a program, and warns of data after its end.
pub fn read(path: &Path) -> anyhow::Result<Vec<u8>> {
    let Source { bytes, ignored } = wireframe::read(path)?;
    if let Some(ignored) = ignored {
        warn(format_args!("{}: {ignored}", path.display()));
    }
    Ok(bytes)
}
