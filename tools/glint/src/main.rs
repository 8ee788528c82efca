//! The program `glint`: models in, pictures out.
#![forbid(unsafe_code)]

mod cli;

use clap::Parser;
use glint::error::{FormatError, InputError};
use std::process::ExitCode;

/// The exit code for input that is not what it should be; clap takes the same for a wrong command line.
const BAD_INPUT: u8 = 2;
/// The exit code for everything else that went wrong.
const FAILED: u8 = 1;

fn main() -> ExitCode {
    let Err(error) = cli::Arguments::parse().run() else {
        return ExitCode::SUCCESS;
    };
    let bad_input = error
        .chain()
        .any(|cause| cause.is::<InputError>() || cause.is::<FormatError>());
    // One line, whatever an operating system or a board has said.
    eprintln!(
        "error: {}",
        format!("{error:#}").trim_end().replace('\n', " ")
    );
    ExitCode::from(if bad_input { BAD_INPUT } else { FAILED })
}
