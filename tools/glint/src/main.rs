//! The program `glint`.
#![forbid(unsafe_code)]

mod cli;

use clap::Parser;
use glint::error::{FormatError, InputError};
use glint_scene_file::SceneError;
use std::process::ExitCode;

/// Exit code for bad input; clap uses it for a bad command line too.
const BAD_INPUT: u8 = 2;
/// Exit code for every other failure.
const FAILED: u8 = 1;

fn main() -> ExitCode {
    let Err(error) = cli::Arguments::parse().run() else {
        return ExitCode::SUCCESS;
    };
    let bad_input = error.chain().any(|cause| {
        cause.is::<InputError>() || cause.is::<FormatError>() || cause.is::<SceneError>()
    });
    // The error is printed on one line, even if the message of an operating system or board has several.
    cli::fail(format!("{error:#}").trim_end().replace('\n', " "));
    ExitCode::from(if bad_input { BAD_INPUT } else { FAILED })
}
