//! The emulated board with the built firmware and a console.

use glint::board::Uart;
use std::sync::LazyLock;

use anyhow::{Context, Result, bail};
use glint::board::{self, Board, EmulatedBoard, SimulatedBoard, built_firmware};
use glint::console::Console;
use glint_core::camera::View;
use glint_core::console::{Command, Setting};

/// An emulated board with a console.
pub type Emulated = SimulatedBoard<EmulatedBoard>;

static FIRMWARE: LazyLock<Result<Vec<u8>, String>> =
    LazyLock::new(|| built_firmware(None).map_err(|error| error.to_string()));

/// The firmware image built by `cargo xtask firmware`.
///
/// # Errors
/// The firmware has not been built.
pub fn firmware() -> Result<&'static [u8]> {
    match &*FIRMWARE {
        Ok(firmware) => Ok(firmware),
        Err(error) => bail!("{error}"),
    }
}

/// Starts a board.
///
/// # Errors
/// The firmware has not been built.
pub fn start() -> Result<Emulated> {
    Ok(board::emulated(firmware()?)?)
}

/// Returns the number of clock cycles of a time in milliseconds.
pub fn cycles(board: &mut Emulated, milliseconds: u64) -> u64 {
    u64::from(board.inner().clock_hz()) / 1000 * milliseconds
}

/// Sends a command to an idle board, and returns the lines of its reply.
///
/// # Errors
/// The firmware refuses the command, or does not answer.
pub fn command(board: &mut Emulated, command: &str) -> Result<Vec<String>> {
    let lines = Console::new(board).command(command);
    lines.with_context(|| format!("the command {command:?}"))
}

/// The value of a key in a command's reply.
///
/// # Errors
/// The key is missing in the reply, or its value has an unexpected form.
pub fn value<T: std::str::FromStr>(board: &mut Emulated, line: &str, key: &str) -> Result<T> {
    let lines = command(board, line)?;
    Ok(glint::console::value(line, &lines, key)?)
}

/// The camera of a board, bit for bit.
///
/// # Errors
/// The board does not print the camera in the form that the console accepts.
pub fn view(board: &mut Emulated) -> Result<View> {
    let lines = command(board, "view")?;
    let line = lines.first().context("no camera")?;
    match Command::parse(line) {
        Ok(Some(Command::Set(Setting::View { view }))) => Ok(view),
        _ => bail!("expected a camera, found {line:?}"),
    }
}

/// Sends a command without reading its reply.
///
/// # Errors
/// The connection is broken.
pub fn begin(board: &mut Emulated, command: &str) -> Result<()> {
    // The zero byte at the start makes the firmware discard an unfinished line, as the host's console does.
    Ok(board.write(format!("\0{command}\r").as_bytes())?)
}
