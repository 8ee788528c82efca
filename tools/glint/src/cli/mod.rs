//! The command line.

mod board;
mod camera;
mod common;
mod completions;
mod config;
mod convert;
mod demo;
mod field;
mod flash;
mod gesture;
mod heading;
mod image;
mod imu;
mod info;
mod loading;
mod man;
mod messages;
mod new;
mod options;
mod orbit;
mod output;
mod ports;
mod progress;
mod render;
mod scene;
mod subject;
mod terminal;
mod texture;
mod wireframe;

use clap::{CommandFactory, Parser, Subcommand};
use messages::{Loudness, set_loudness};

pub use messages::fail;

/// Host program of Glint: converts meshes, renders pictures, controls boards.
///
/// MODEL is a mesh file (.obj, .stl, .ply, .gltf, .glb, .glm) or a generator: cube, icosphere:N (frequency, 1 to 64), torus-knot,
/// gear, teapot, scan:N (frequency, 1 to 64), sponge:N (0 to 4). BOARD is `emulated`, `virtual`, a serial port such as
/// /dev/ttyUSB1, or `serial` for the port that `glint ports` guesses. ~/.config/glint/config.toml sets the defaults: `board =
/// "NAME"`, `baud = NUMBER`. Exit code 2: bad input, with one line that names the location, the expected value and the found
/// value. Exit code 1: any other failure.
#[derive(Parser)]
#[command(name = "glint", version, max_term_width = 110)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Print no warnings, notes or progress.
    #[arg(short, long, global = true)]
    quiet: bool,
    /// Print each step with its time.
    #[arg(short, long, global = true, conflicts_with = "quiet")]
    verbose: bool,
    /// Replace output files that are not empty; by default they are an error.
    #[arg(short, long, global = true)]
    force: bool,
}

#[derive(Subcommand)]
enum Command {
    Model(convert::ModelArguments),
    Convert(convert::ConvertArguments),
    Texture(texture::TextureArguments),
    Render(Box<render::RenderArguments>),
    Orbit(Box<orbit::OrbitArguments>),
    Upload(flash::UploadArguments),
    Flash(flash::FlashArguments),
    Console(terminal::ConsoleArguments),
    Board(board::BoardArguments),
    New(new::NewArguments),
    Info(info::InfoArguments),
    Ports(ports::PortsArguments),
    Completions(completions::CompletionsArguments),
    Man(man::ManArguments),
    Demo(demo::DemoArguments),
    #[command(subcommand)]
    Imu(imu::ImuCommand),
    #[command(subcommand)]
    Gesture(gesture::GestureCommand),
    #[command(subcommand)]
    Image(image::ImageCommand),
    #[command(subcommand)]
    Scene(scene::SceneCommand),
    #[command(subcommand)]
    Wireframe(wireframe::WireframeCommand),
}

impl Arguments {
    /// Runs the command.
    pub fn run(self) -> anyhow::Result<()> {
        output::set_replace(self.force);
        set_loudness(match (self.quiet, self.verbose) {
            (true, _) => Loudness::Quiet,
            (_, true) => Loudness::Verbose,
            _ => Loudness::Usual,
        });
        match self.command {
            Command::Model(arguments) => arguments.run(),
            Command::Convert(arguments) => arguments.run(),
            Command::Texture(arguments) => arguments.run(),
            Command::Render(arguments) => arguments.run(),
            Command::Orbit(arguments) => arguments.run(),
            Command::Upload(arguments) => arguments.run(),
            Command::Flash(arguments) => arguments.run(),
            Command::Console(arguments) => arguments.run(),
            Command::Board(arguments) => arguments.run(),
            Command::New(arguments) => arguments.run(),
            Command::Info(arguments) => arguments.run(),
            Command::Ports(arguments) => arguments.run(),
            Command::Completions(arguments) => arguments.run(Self::command()),
            Command::Man(arguments) => arguments.run(Self::command()),
            Command::Demo(arguments) => arguments.run(),
            Command::Imu(command) => command.run(),
            Command::Gesture(command) => command.run(),
            Command::Image(command) => command.run(),
            Command::Scene(command) => command.run(),
            Command::Wireframe(command) => command.run(),
        }
    }
}
