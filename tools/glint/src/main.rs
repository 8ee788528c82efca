//! The program `glint`.
#![forbid(unsafe_code)]

mod cli;

use clap::Parser;
use glint::error::{FormatError, InputError};
use glint::project::ProjectError;
use glint::render;
use glint_model::RenderError;
use glint_scene_file::SceneError;
use std::process::ExitCode;

/// Exit code for bad input; clap also uses it for an invalid command line.
const BAD_INPUT: u8 = 2;
/// Exit code for any other failure.
const FAILED: u8 = 1;

/// Formats an error and its causes on one line, even if a message of the operating system or of a
/// board has several lines. A cause that is part of the message before it is left out.
fn one_line(error: &anyhow::Error) -> String {
    let mut messages: Vec<String> = Vec::new();
    for cause in error.chain() {
        let message = cause.to_string();
        if !messages.last().is_some_and(|last| last.contains(&message)) {
            messages.push(message);
        }
    }
    messages.join(": ").trim_end().replace('\n', " ")
}

/// Whether an error concerns a file or an option. Files and options also describe a frame that no
/// board can draw.
fn is_bad_input(error: &(dyn std::error::Error + 'static)) -> bool {
    let is_undrawable = matches!(error.downcast_ref(), Some(render::Error::Render(_)));
    is_undrawable
        || error.is::<RenderError>()
        || error.is::<InputError>()
        || error.is::<FormatError>()
        || error.is::<SceneError>()
        || matches!(
            error.downcast_ref(),
            Some(ProjectError::Name(_) | ProjectError::Exists(_) | ProjectError::NoGlint { .. })
        )
}

fn main() -> ExitCode {
    let Err(error) = cli::Arguments::parse().run() else {
        return ExitCode::SUCCESS;
    };
    let bad_input = error.chain().any(is_bad_input);
    match error.downcast_ref::<SceneError>() {
        Some(error) => error.to_string().lines().for_each(cli::fail),
        None => cli::fail(one_line(&error)),
    }
    ExitCode::from(if bad_input { BAD_INPUT } else { FAILED })
}
