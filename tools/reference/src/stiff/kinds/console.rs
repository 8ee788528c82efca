//! The console of the emulated board, which runs the real firmware.

use anyhow::{Context, Result};
use glint::console::{Console, ConsoleError};
use glint::transfer::{TransferError, upload};
use glint_vectors::Model;
use serde::Deserialize;
use virtual_board::virtual_mpu6050::{Chip, Fault, Imperfections, Source, State, Wires};
use virtual_board::{Simulation, Uart};

use crate::emulated::{Emulated, cycles, start};
use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![Kind::new("console", console), Kind::new("upload", uploaded)]
}

/// Outcome of a command: the reply, or the reason of the firmware's refusal. The outcome has only the reply's lines with a key of
/// `counted`, or all lines if `counted` is empty.
pub fn outcome(reply: Result<Vec<String>, ConsoleError>, counted: &[String]) -> Result<Outcome> {
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
pub struct Session {
    pub commands: Vec<String>,
    /// Sensor on the pins; by default none.
    pub sensor: Option<Sensor>,
    /// Run time in ms before the last command.
    #[serde(default)]
    pub wait: u64,
    /// Keys of the last reply's lines that are part of the outcome, by default all lines.
    #[serde(default)]
    pub lines: Vec<String>,
}

/// Commands that run before the commands of a case, to make pictures small and fast.
const SMALL: [&str; 2] = ["size 320 180", "aa 1"];

/// Starts a board with this sensor, which draws small pictures with one sample a pixel, and executes these commands and a wait in
/// milliseconds.
fn board_after(sensor: Option<Sensor>, commands: &[String], wait: u64) -> Result<Emulated> {
    let mut board = start()?;
    if let Some(sensor) = sensor {
        board.inner().plug(sensor.wires());
    }
    let mut console = Console::new(&mut board);
    console.greet()?;
    for command in SMALL {
        console.command(command)?;
    }
    for command in commands {
        // A refused command may be part of the case.
        let _ = console.command(command);
    }
    let wait = cycles(&mut board, wait);
    board.inner().run(wait);
    Ok(board)
}

/// Sends commands to a newly started board; states the reply to the last command.
fn console(session: Session) -> Result<Outcome> {
    let (last, before) = session.commands.split_last().context("commands")?;
    let mut board = board_after(session.sensor, before, session.wait)?;
    let reply = Console::new(&mut board).command(last);
    outcome(reply, &session.lines)
}

/// A virtual MPU-6050 on the pins.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sensor {
    /// At rest.
    Resting,
    /// Rotates at 100.03 °/s.
    Turning,
    /// Rotates at 3,000 °/s about each axis, beyond the range.
    Saturated,
    /// Measures constant counts.
    Frozen,
    /// Makes no measurements.
    Stalled,
    /// Holds SDA low.
    Stuck,
    /// Has the identification of another chip.
    Unknown,
    /// Is unplugged after 1,000 bytes.
    Vanishing,
}

impl Sensor {
    pub fn wires(self) -> Wires {
        let rate = match self {
            Self::Turning => [100.03, 0.0, 0.0],
            Self::Saturated => [3000.0; 3],
            _ => [0.0; 3],
        };
        let state = move |_| State {
            rate,
            ..State::default()
        };
        let imperfections = Imperfections {
            noise: 0.005,
            accel_noise: 0.0004,
            ..Imperfections::NONE
        };
        let mut chip = Chip::new(Source::Motion(Box::new(state)), imperfections, 1);
        chip.fault = match self {
            Self::Resting | Self::Turning | Self::Saturated => None,
            Self::Frozen => Some(Fault::Frozen),
            Self::Stalled => Some(Fault::Stalled),
            Self::Stuck => Some(Fault::StuckData(0)),
            Self::Unknown => Some(Fault::Identity(0)),
            Self::Vanishing => Some(Fault::Vanishing(1000)),
        };
        Wires::new(chip)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Upload {
    /// Sensor on the pins; by default none.
    sensor: Option<Sensor>,
    /// Commands before the upload.
    #[serde(default)]
    before: Vec<String>,
    /// Run time in ms after the commands.
    #[serde(default)]
    wait: u64,
    /// Bytes that are overwritten in a cube's mesh, each as offset and value.
    #[serde(default)]
    edits: Vec<(usize, u8)>,
    /// Length of the mesh, truncated or padded with zeros.
    length: Option<usize>,
    /// The command after the upload.
    then: String,
    /// Keys of the reply's lines that are part of the outcome, by default all lines.
    #[serde(default)]
    lines: Vec<String>,
}

/// Uploads a damaged cube; states the refusal, and the reply to the next command.
fn uploaded(input: Upload) -> Result<Outcome> {
    let mut bytes = Model::cube(8192).encoded();
    bytes.resize(input.length.unwrap_or(bytes.len()), 0);
    for (offset, byte) in input.edits {
        bytes[offset] = byte;
    }
    let mut board = board_after(input.sensor, &input.before, input.wait)?;
    let mut console = Console::new(&mut board);
    let refusal = match upload(&mut console, &bytes, None, 1, &mut |_, _| {}) {
        Ok(_) => "accepted".to_owned(),
        Err(TransferError::Console(ConsoleError::Refused { reason, .. })) => reason,
        Err(error) => error.to_string(),
    };
    let next = outcome(console.command(&input.then), &input.lines)?;
    Ok(Outcome::exact(format!("{refusal}; then {next}")))
}
