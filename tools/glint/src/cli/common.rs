//! Options, access to boards, progress bars and output that the commands share.

use anyhow::Context;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use glint::board::{
    Board, BoardName, EmulatedBoard, SerialBoard, SimulatedBoard, Simulation, built_firmware,
};
use glint::console::Console;
use glint::error::{FormatError, InputError, quote};
use glint::transfer::Route;
use glint_core::picture::Size;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::io::Write;
use std::path::PathBuf;
use std::time::Duration;

/// Options for the connection to a board.
#[derive(clap::Args)]
pub struct LineArguments {
    /// Baud rate of a serial port, in bits per second.
    #[arg(long, default_value_t = 115_200, value_name = "BITS")]
    pub baud: u32,
    /// Firmware of the emulated or the virtual board [default: the one built by `cargo xtask firmware`].
    #[arg(long, value_name = "FILE")]
    pub firmware: Option<PathBuf>,
}

impl LineArguments {
    /// Starts a virtual board and runs it to the firmware's first prompt.
    pub fn virtual_board(&self) -> anyhow::Result<SimulatedBoard> {
        let firmware = built_firmware(self.firmware.as_deref())?;
        started(SimulatedBoard::fast(&firmware)?)
    }

    /// Starts an emulated board and runs it to the firmware's first prompt.
    pub fn emulated_board(&self) -> anyhow::Result<SimulatedBoard<EmulatedBoard>> {
        let firmware = built_firmware(self.firmware.as_deref())?;
        started(SimulatedBoard::emulated(&firmware)?)
    }

    /// Opens a board on a serial port, and ends what an earlier program has left there.
    pub fn serial_board(&self, port: &str) -> anyhow::Result<SerialBoard> {
        let mut board = SerialBoard::open(port, self.baud)?;
        let spinner = spinner("waiting for the board");
        Console::new(&mut board).synchronise()?;
        spinner.finish_and_clear();
        Ok(board)
    }

    /// Opens the board that `name` selects, which may not run its firmware yet.
    pub fn unsynchronised_board(&self, name: &BoardName) -> anyhow::Result<Box<dyn Board>> {
        match name {
            BoardName::Serial(port) => Ok(Box::new(SerialBoard::open(port, self.baud)?)),
            simulated => self.board(simulated),
        }
    }

    /// Opens the board that `name` selects. A simulated board is started and runs its firmware.
    pub fn board(&self, name: &BoardName) -> anyhow::Result<Box<dyn Board>> {
        Ok(match name {
            BoardName::Emulated => Box::new(self.emulated_board()?),
            BoardName::Virtual => Box::new(self.virtual_board()?),
            BoardName::Serial(port) => Box::new(self.serial_board(port)?),
        })
    }
}

/// Runs a board to the firmware's first prompt.
fn started<S: Simulation>(mut board: SimulatedBoard<S>) -> anyhow::Result<SimulatedBoard<S>> {
    let spinner = spinner("the board starts");
    Console::new(&mut board).greet()?;
    spinner.finish_and_clear();
    Ok(board)
}

/// Options of a command that transfers data to and from a board, and prints a result.
#[derive(clap::Args)]
pub struct TransferArguments {
    /// Route of the data to and from a board [default: memory for the emulated and the virtual board, serial for a board on a serial port].
    #[arg(long, value_enum)]
    pub transfer: Option<Route>,
    #[command(flatten)]
    pub line: LineArguments,
    /// Print the result as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Returns a clap parser that accepts the names of the values in `all` and converts a name to its value.
pub fn named<T: Copy + Send + Sync + 'static, const N: usize>(
    all: [T; N],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(all.map(name)).try_map(move |found| {
        let value = all.into_iter().find(|value| name(*value) == found);
        value.ok_or("not one of the names")
    })
}

/// A spinner for work of unknown length. It is drawn on a terminal only.
pub fn spinner(label: &str) -> ProgressBar {
    let spinner = ProgressBar::new_spinner().with_message(label.to_owned());
    spinner.set_style(style("{spinner} {msg} {elapsed}"));
    spinner.enable_steady_tick(Duration::from_millis(200));
    spinner
}

/// A progress bar that counts bytes. It is drawn on a terminal only.
pub fn bar(label: &str) -> ProgressBar {
    let bar = ProgressBar::new(0).with_message(label.to_owned());
    bar.set_style(style("{msg} {wide_bar} {bytes}/{total_bytes} {eta}"));
    bar
}

/// A progress bar that counts items, which the text `items` names. It is drawn on a terminal only.
pub fn count_bar(label: &str, items: &str) -> ProgressBar {
    let bar = ProgressBar::new(0).with_message(label.to_owned());
    let template = format!("{{msg}} {{wide_bar}} {{pos}}/{{len}} {items} {{eta}}");
    bar.set_style(style(&template));
    bar
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// Returns a progress callback that sets the position and the length of a bar.
pub fn advance(bar: &ProgressBar) -> impl FnMut(u64, u64) {
    move |done, all| {
        bar.set_length(all);
        bar.set_position(done);
    }
}

/// Prints a line to standard output. A closed pipe, as with `| head`, is no error.
pub fn say(line: impl std::fmt::Display) -> anyhow::Result<()> {
    match writeln!(std::io::stdout(), "{line}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(error).context("standard output")
        }
        _ => Ok(()),
    }
}

/// Prints a warning to standard error, on one line.
pub fn warn(text: impl std::fmt::Display) {
    // There is no place to report that standard error is closed.
    let _ = writeln!(std::io::stderr(), "warning: {text}");
}

/// Prints a note to standard error, on one line.
pub fn note(text: impl std::fmt::Display) {
    // There is no place to report that standard error is closed.
    let _ = writeln!(std::io::stderr(), "note: {text}");
}

/// Prints a value as JSON on one line.
pub fn print_json(value: &impl Serialize) -> anyhow::Result<()> {
    say(serde_json::to_string(value)?)
}

/// Returns the error for an option or an argument whose value is not as `expected`.
pub fn bad_value(name: &str, expected: &str, found: impl Into<String>) -> InputError {
    FormatError::whole(expected, found).in_file(name.escape_debug().to_string())
}

/// Parses the option `--size`.
pub fn size(text: &str) -> anyhow::Result<Size> {
    let size = Size::ALL.into_iter().find(|size| size.to_string() == text);
    size.ok_or_else(|| {
        let found = quote(text.as_bytes());
        bad_value("--size", "320x180, 640x360 or 1280x720", found).into()
    })
}
