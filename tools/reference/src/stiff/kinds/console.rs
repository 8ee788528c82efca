//! The console of the emulated board, which runs the real firmware.

use std::sync::LazyLock;

use anyhow::{Result, bail};
use glint::board::{EmulatedBoard, SimulatedBoard, built_firmware};
use glint::console::{Console, ConsoleError};
use glint::transfer::{TransferError, upload};
use glint_vectors::Model;
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![Kind::new("console", console), Kind::new("upload", uploaded)]
}

static FIRMWARE: LazyLock<Result<Vec<u8>, String>> =
    LazyLock::new(|| built_firmware(None).map_err(|error| error.to_string()));

/// A board that has just started.
fn start() -> Result<SimulatedBoard<EmulatedBoard>> {
    match &*FIRMWARE {
        Ok(firmware) => Ok(SimulatedBoard::emulated(firmware)?),
        Err(error) => bail!("{error}: run `cargo xtask firmware`"),
    }
}

/// The reply to a command, or the reason of the firmware's refusal. Of the reply count the lines whose first word is one of `counted`, or all
/// lines if there is none.
fn outcome(reply: Result<Vec<String>, ConsoleError>, counted: &[String]) -> Result<Outcome> {
    let counts = |line: &String| {
        let word = line.split(' ').next().unwrap_or_default();
        counted.is_empty() || counted.iter().any(|counted| counted == word)
    };
    match reply {
        Ok(lines) if lines.is_empty() => Ok(Outcome::exact("ok")),
        Ok(lines) => {
            let lines: Vec<_> = lines.into_iter().filter(counts).collect();
            Ok(Outcome::exact(lines.join("; ")))
        }
        Err(ConsoleError::Refused { reason, .. }) => Ok(Outcome::Refused(reason)),
        Err(error) => Err(error.into()),
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Session {
    commands: Vec<String>,
    /// First words of the lines of the last reply that count; by default all lines.
    #[serde(default)]
    lines: Vec<String>,
}

/// Sends commands to a board that has just started; states the reply to the last one.
fn console(Session { commands, lines }: Session) -> Result<Outcome> {
    let mut board = start()?;
    let mut console = Console::new(&mut board);
    console.greet()?;
    let mut reply = Ok(Vec::new());
    for command in commands {
        reply = console.command(&command);
    }
    outcome(reply, &lines)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Upload {
    /// Commands before it.
    #[serde(default)]
    before: Vec<String>,
    /// Bytes that are written over those of a cube: an offset and the byte.
    #[serde(default)]
    edits: Vec<(usize, u8)>,
    /// Length to which the mesh is cut or filled with zeros.
    length: Option<usize>,
    /// The command that follows.
    then: String,
    /// First words of the lines of its reply that count; by default all lines.
    #[serde(default)]
    lines: Vec<String>,
}

/// Uploads a damaged cube, and states the refusal, and the reply to a command after it.
fn uploaded(input: Upload) -> Result<Outcome> {
    let mut bytes = Model::cube(8192).encoded();
    bytes.resize(input.length.unwrap_or(bytes.len()), 0);
    for (offset, byte) in input.edits {
        bytes[offset] = byte;
    }
    let mut board = start()?;
    let mut console = Console::new(&mut board);
    console.greet()?;
    for command in input.before {
        console.command(&command)?;
    }
    let refusal = match upload(&mut console, &bytes, None, 1, &mut |_, _| {}) {
        Ok(()) => "accepted".to_owned(),
        Err(TransferError::Console(ConsoleError::Refused { reason, .. })) => reason,
        Err(error) => error.to_string(),
    };
    let next = outcome(console.command(&input.then), &input.lines)?;
    Ok(Outcome::exact(format!("{refusal}; then {next}")))
}
