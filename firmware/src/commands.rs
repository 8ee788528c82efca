//! Execution of console commands. Each submodule contains the commands of one subject.
//!
//! A reply is text, followed by `ok` or `error: …`. A line of machine-readable text is a key and its value.

mod bench;
mod demo;
mod frame;
pub mod gesture;
pub mod imu;
mod machine;
mod options;
pub mod replay;
mod scene;
pub mod statistics;
mod upload;

pub use frame::begin_download;
pub use upload::finish;

pub use scene::show as show_scene;

use glint_core::console::{Command, Effect};

use crate::error::CommandError;
use crate::job::{Job, Reply};
use crate::machine::Machine;

/// Executes a line of the console as a command. Returns the command's reply; `None` for a blank line. A command that changes the picture
/// or the uploads stops the demo.
///
/// # Errors
/// The line is not a valid command, or the command fails.
// Not inlined, because the code of the main loop would otherwise grow by several KiB.
#[inline(never)]
pub fn execute<'l>(
    machine: &mut Machine,
    line: &'l str,
) -> Result<Option<Reply>, CommandError<'l>> {
    let Some(command) = Command::parse(line).map_err(CommandError::Parse)? else {
        return Ok(None);
    };
    let reply = command.execute(machine)?;
    let changes = !matches!(command.effect(), Effect::None);
    machine.picture.may_note |= changes;
    // An upload command stops the demo later, when the upload has been accepted.
    if changes && !matches!(reply, Reply::After(Job::Transfer(_))) {
        machine.demo.stop();
    }
    Ok(Some(reply))
}
