//! `cargo xtask`: sets up, builds, tests and demonstrates Glint.

#![forbid(unsafe_code)]

mod bootstrap;
mod demo;
mod firmware;
mod gateware;
mod modules;
mod pac;
mod paths;
mod resources;
mod run;
mod test;

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
        /// Build smooth shading into the triangle engine
        #[arg(long)]
        smooth: bool,
        /// What the raymarcher is built for [default: all; of the urbana, which has no room for that: faces]
        #[arg(long, value_enum)]
        fields: Option<gateware::Fields>,
        /// Also build the virtual board's library that writes waveforms
        #[arg(long, conflicts_with_all = ["smooth", "fields"])]
        waveforms: bool,
    },
    /// Write the register access crate and the register map from the SoC's description
    Pac {
        /// Write nothing; fail when a file is not what would be written
        #[arg(long)]
        check: bool,
    },
    /// Build the program for the soft core
    Firmware {
        /// Features of the program; `peers` adds other crates' kernels to `bench`
        #[arg(long, value_delimiter = ',')]
        features: Vec<String>,
    },
    /// Build everything, run it on the virtual board, write its pictures into `out/`
    Demo {
        /// What `glint demo` takes: mesh files (none: generated ones)
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Build everything and run every test
    Test,
    /// Check the sources: no circle of modules, no `#[path]`, no file of more than 500 lines
    Modules,
    /// Measure what the gateware takes of the FPGA; fail beyond gateware/budget.toml
    Resources {
        /// What to measure: own blocks, `flat_build`, `soc` (none: all of them)
        blocks: Vec<String>,
        /// Print JSON; progress goes to standard error
        #[arg(long)]
        json: bool,
        /// Write docs/resources.md
        #[arg(long, conflicts_with = "blocks")]
        write: bool,
    },
    /// Measure error against run time and write docs/report
    Report {
        /// Page to measure: `sine`, `triangle`, `gouraud`, `raymarch`, `imu`; or `pages`: rebuild all pages from their tables
        page: String,
        /// Arguments of the report
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
}

fn main() -> Result<()> {
    match Arguments::parse().task {
        Task::Bootstrap => bootstrap::bootstrap(),
        Task::Gateware {
            board,
            smooth,
            fields,
            waveforms,
        } => {
            let mut options = vec![];
            if smooth {
                options.push("--smooth");
            }
            if let Some(fields) = fields {
                options.extend(["--fields", fields.name()]);
            }
            gateware::build_with(board, &options)?;
            if waveforms {
                gateware::build_with_waveforms()?;
            }
            Ok(())
        }
        Task::Pac { check } => pac::generate(check),
        Task::Firmware { features } => {
            let features: Vec<_> = features.iter().map(String::as_str).collect();
            firmware::build(&features).map(|_| ())
        }
        Task::Demo { arguments } => demo::demo(&arguments),
        Task::Test => test::test(),
        Task::Modules => modules::check(),
        Task::Resources {
            blocks,
            json,
            write,
        } => resources::resources(&resources::Options {
            blocks,
            json,
            write,
        }),
        Task::Report { page, arguments } => demo::report(&page, &arguments),
    }
}
