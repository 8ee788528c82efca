//! `cargo xtask`: sets up, builds, tests and demonstrates Glint.

#![forbid(unsafe_code)]

mod bootstrap;
mod gateware;
mod paths;
mod run;

use anyhow::Result;
use clap::{Parser, Subcommand};

/// Sets up, builds, tests and demonstrates Glint.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Install what is missing: Debian packages, the Rust target, the Python environment
    Bootstrap,
    /// Build the SoC of a board
    Gateware {
        /// Which board
        #[arg(long, value_enum, default_value = "virtual")]
        board: gateware::Board,
        /// Also build the virtual board's library that writes waveforms
        #[arg(long)]
        waveforms: bool,
    },
}

fn main() -> Result<()> {
    match Arguments::parse().task {
        Task::Bootstrap => bootstrap::bootstrap(),
        Task::Gateware { board, waveforms } => {
            gateware::build(board)?;
            if waveforms {
                gateware::build_with_waveforms()?;
            }
            Ok(())
        }
    }
}
