//! `cargo xtask`: sets up, builds, tests and demonstrates Glint.

#![forbid(unsafe_code)]

mod bootstrap;
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
}

fn main() -> Result<()> {
    match Arguments::parse().task {
        Task::Bootstrap => bootstrap::bootstrap(),
    }
}
