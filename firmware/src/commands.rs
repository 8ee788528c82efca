//! Execution of console commands, in one module for each subject.
//!
//! A reply is text, and after it `ok` or `error: …`. A line of the text that programs read has a key and its value.

mod appearance;
mod bench;
mod camera;
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

use glint_core::console::{Command, Executor};
use glint_core::feature::{Feature, OBJECT};

use crate::error::CommandError;
use crate::job::{Outcome, Reply};
use crate::machine::Machine;

impl<'l> Executor<'l> for Machine {
    type Output = Outcome<'l>;

    fn left_out(&mut self, feature: Feature) -> Outcome<'l> {
        Err(CommandError::LeftOut(feature))
    }
}

/// Executes a line of the console as a command. Returns the command's reply; `None` for a blank line.
///
/// # Errors
/// The line is not a command, or the command fails.
// Not inlined, because the code of the main loop would otherwise grow by several KiB.
#[inline(never)]
pub fn execute<'l>(
    machine: &mut Machine,
    line: &'l str,
) -> Result<Option<Reply>, CommandError<'l>> {
    let mut reply = execute_one(machine, line)?;
    if let Some(Reply::Lines(lines)) = reply {
        // No line of a scene shows another scene, so there are no lines of lines.
        for line in lines.lines() {
            reply = execute_one(machine, line)?;
        }
    }
    Ok(reply)
}

#[inline(never)]
fn execute_one<'l>(
    machine: &mut Machine,
    line: &'l str,
) -> Result<Option<Reply>, CommandError<'l>> {
    let Some(command) = Command::parse(line).map_err(CommandError::Parse)? else {
        return Ok(None);
    };
    let reply = command.execute(machine);
    if OBJECT.is_built {
        // The options of the scene are those of all objects.
        let Machine { models, scene, .. } = machine;
        models
            .objects_mut()
            .set_options(|mesh| scene.options().subject(mesh));
    }
    reply.map(Some)
}
