//! Output of the commands: results on standard output, warnings and notes on standard error.

use anyhow::Context;
use clap::builder::styling::AnsiColor;
use serde::Serialize;
use std::io::Write;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};

/// Whether a command writes its output file to standard output.
static STDOUT_IS_OUTPUT: AtomicBool = AtomicBool::new(false);

/// Reserves standard output for an output file: from now on `say` prints to standard error. Returns false if standard output has
/// already been reserved.
pub fn reserve_stdout() -> bool {
    !STDOUT_IS_OUTPUT.swap(true, Ordering::Relaxed)
}

/// Prints a line to standard output, or to standard error if standard output is reserved for an output file. A closed pipe, as in
/// `| head`, is not an error.
pub fn say(line: impl std::fmt::Display) -> anyhow::Result<()> {
    let written = match STDOUT_IS_OUTPUT.load(Ordering::Relaxed) {
        true => writeln!(std::io::stderr(), "{line}"),
        false => writeln!(std::io::stdout(), "{line}"),
    };
    match written {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(error).context("standard output")
        }
        _ => Ok(()),
    }
}

/// Amount of output besides a command's result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loudness {
    /// Only errors.
    Quiet,
    /// Also warnings, notes and progress.
    Usual,
    /// Also each step with its time.
    Verbose,
}

static LOUDNESS: AtomicU8 = AtomicU8::new(Loudness::Usual as u8);

/// Sets the amount of output in addition to a command's result.
pub fn set_loudness(loudness: Loudness) {
    LOUDNESS.store(loudness as u8, Ordering::Relaxed);
}

/// Amount of output besides a command's result.
pub fn loudness() -> Loudness {
    const QUIET: u8 = Loudness::Quiet as u8;
    const VERBOSE: u8 = Loudness::Verbose as u8;
    match LOUDNESS.load(Ordering::Relaxed) {
        QUIET => Loudness::Quiet,
        VERBOSE => Loudness::Verbose,
        _ => Loudness::Usual,
    }
}

/// Prints a warning to standard error, on one line.
pub fn warn(text: impl std::fmt::Display) {
    if loudness() != Loudness::Quiet {
        print_labelled(AnsiColor::Yellow, "warning", text);
    }
}

/// Prints a note to standard error, on one line.
pub fn note(text: impl std::fmt::Display) {
    if loudness() != Loudness::Quiet {
        print_labelled(AnsiColor::Cyan, "note", text);
    }
}

/// Prints an error to standard error, on one line.
pub fn fail(text: impl std::fmt::Display) {
    print_labelled(AnsiColor::Red, "error", text);
}

/// Prints a label and a line to standard error. On a terminal the label is coloured like the command line's errors, unless the
/// environment sets NO_COLOR.
fn print_labelled(colour: AnsiColor, label: &str, text: impl std::fmt::Display) {
    let style = colour.on_default().bold();
    // An error of writing to standard error cannot be reported.
    let _ = writeln!(anstream::stderr(), "{style}{label}:{style:#} {text}");
}

/// Prints a value as JSON on one line.
pub fn print_json(value: &impl Serialize) -> anyhow::Result<()> {
    say(serde_json::to_string(value)?)
}
