//! Execution of console commands, in one module for each subject.
//!
//! A reply is text, and after it `ok` or `error: …`. A line of the text that programs read has a key and its value.

mod appearance;
mod bench;
mod camera;
mod demo;
mod frame;
pub mod gesture;
pub mod imu;
mod machine;
mod object;
pub mod replay;
mod scene;
pub mod statistics;
mod upload;

pub use frame::send_frame;

use glint_core::console::{Command, Effect, Executor};
use glint_core::feature::{Feature, OBJECT};
use glint_core::scene::commands as lines_of;

use crate::error::CommandError;
use crate::job::{Outcome, Reply};
use crate::machine::Machine;

impl<'l> Executor<'l> for Machine {
    type Output = Outcome<'l>;

    fn left_out(&mut self, feature: Feature) -> Outcome<'l> {
        Err(CommandError::LeftOut(feature))
    }
}

/// Executes a line of the console as a command. Returns the command's reply; `None` for a blank line. A command that sets the picture
/// or changes the uploads stops the demo.
///
/// # Errors
/// The line is not a command, or the command fails.
// Not inlined, because the code of the main loop would otherwise grow by several KiB.
#[inline(never)]
pub fn execute<'l>(
    machine: &mut Machine,
    line: &'l str,
) -> Result<Option<Reply>, CommandError<'l>> {
    let Some(command) = Command::parse(line).map_err(CommandError::Parse)? else {
        return Ok(None);
    };
    let reply = execute_one(machine, command)?;
    if command.effect() != Effect::None {
        machine.demo.stop();
    }
    execute_lines(machine, reply).map(Some)
}

/// Shows a scene of the demo.
///
/// # Errors
/// As of the command `scene`.
#[inline(never)]
pub fn show_scene<'l>(machine: &mut Machine, name: &'l str) -> Outcome<'l> {
    let reply = scene::show(machine, name)?;
    execute_lines(machine, reply)
}

/// Executes the lines of a scene, if the reply has them. If a line fails, the scene at start is shown; without a sensor, the scene is
/// shown as it is.
fn execute_lines<'l>(machine: &mut Machine, mut reply: Reply) -> Outcome<'l> {
    let Reply::Lines(lines) = reply else {
        return Ok(reply);
    };
    // `scene` has checked the lines.
    for (_, command) in lines_of(lines).flatten() {
        let executed = match command {
            // A scene with the name of the mesh is not meant.
            Command::Scene { name: Some(mesh) } => {
                scene::show_mesh(machine, mesh).map(|()| Reply::Done)
            }
            command => execute_one(machine, command),
        };
        reply = executed.or_else(|error| {
            if !error.is_of_sensor() {
                scene::reset(machine)?;
            }
            Err(error)
        })?;
    }
    Ok(reply)
}

#[inline(never)]
fn execute_one<'l>(machine: &mut Machine, command: Command<'l>) -> Outcome<'l> {
    let reply = command.execute(machine);
    if OBJECT.is_built {
        // The options of the scene are those of all objects.
        let Machine { models, scene, .. } = machine;
        models
            .objects_mut()
            .set_options(|mesh| scene.options().subject(mesh));
    }
    reply
}
