//! The command line.

mod board;
mod camera;
mod common;
mod completions;
mod convert;
mod demo;
mod field;
mod flash;
mod gesture;
mod image;
mod imu;
mod orbit;
mod output;
mod render;
mod scene;
mod terminal;
mod wireframe;

use clap::{CommandFactory, Parser, Subcommand};

/// Host program of Glint: converts meshes, renders pictures, controls boards.
///
/// MODEL is a mesh file (.obj, .stl, .ply, .gltf, .glb, .glm) or a generator: cube, icosphere:N (frequency, 1 to 64), torus-knot, gear,
/// teapot, scan:N (frequency, 1 to 64), sponge:N (0 to 4). BOARD is `emulated`, `virtual` or a serial port such as /dev/ttyUSB1. Exit code 2:
/// bad input, with one line that names the place, what was expected and what was found. Exit code 1: any other failure.
#[derive(Parser)]
#[command(name = "glint", version, max_term_width = 110)]
pub struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Model(convert::ModelArguments),
    Convert(convert::ConvertArguments),
    Render(Box<render::RenderArguments>),
    Orbit(orbit::OrbitArguments),
    Upload(flash::UploadArguments),
    Flash(flash::FlashArguments),
    Console(terminal::ConsoleArguments),
    Board(board::BoardArguments),
    Completions(completions::CompletionsArguments),
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
        match self.command {
            Command::Model(arguments) => arguments.run(),
            Command::Convert(arguments) => arguments.run(),
            Command::Render(arguments) => arguments.run(),
            Command::Orbit(arguments) => arguments.run(),
            Command::Upload(arguments) => arguments.run(),
            Command::Flash(arguments) => arguments.run(),
            Command::Console(arguments) => arguments.run(),
            Command::Board(arguments) => arguments.run(),
            Command::Completions(arguments) => arguments.run(Self::command()),
            Command::Demo(arguments) => arguments.run(),
            Command::Imu(command) => command.run(),
            Command::Gesture(command) => command.run(),
            Command::Image(command) => command.run(),
            Command::Scene(command) => command.run(),
            Command::Wireframe(command) => command.run(),
        }
    }
}
