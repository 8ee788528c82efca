//! The program `glint`.
#![forbid(unsafe_code)]

mod cli;

use clap::Parser;
use glint::error::{FormatError, InputError};
use glint_scene_file::SceneError;
use std::process::ExitCode;

/// Exit code for bad input; clap also uses it for an invalid command line.
const BAD_INPUT: u8 = 2;
/// Exit code for any other failure.
const FAILED: u8 = 1;

fn main() -> ExitCode {
    let Err(error) = cli::Arguments::parse().run() else {
        return ExitCode::SUCCESS;
    };
    let bad_input = error.chain().any(|cause| {
        cause.is::<InputError>() || cause.is::<FormatError>() || cause.is::<SceneError>()
    });
    // The error is printed on one line, even if a message of the operating system or of a board has several lines.
    cli::fail(format!("{error:#}").trim_end().replace('\n', " "));
    ExitCode::from(if bad_input { BAD_INPUT } else { FAILED })
}
