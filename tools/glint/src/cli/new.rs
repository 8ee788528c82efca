//! `glint new`.

use super::messages::{note, say};
use clap::Args;
use glint::project::{self, Source};
use std::path::PathBuf;

/// Rust target of the soft core.
const TARGET: &str = "riscv32im-unknown-none-elf";

/// Write a project for a program of your own: a game, an instrument, a demo on a board.
///
/// `cargo run` in the new folder builds the program and shows an emulated board with it in the browser.
#[derive(Args)]
pub struct NewArguments {
    /// Folder to create; its name is the program's name.
    path: PathBuf,
    /// Source of the library of programs: the path of a clone of Glint, or the URL of a git repository [default: the clone in GLINT_HOME,
    /// above this program or above the current folder, or the clone from which this program was installed].
    #[arg(long, value_name = "PATH|URL")]
    glint: Option<String>,
}

impl NewArguments {
    pub fn run(self) -> anyhow::Result<()> {
        let source = match &self.glint {
            Some(text) => Source::stated(text)?,
            None => Source::found()?,
        };
        project::write(&self.path, &source)?;
        let path = self.path.display();
        say(format_args!(
            "{path}: created; `cd {path}`, then `cargo run` shows the program in the browser"
        ))?;
        if !project::has_target(TARGET) {
            note(format!(
                "first install the Rust target of the soft core: `rustup target add {TARGET}`"
            ));
        }
        Ok(())
    }
}
