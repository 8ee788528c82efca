//! `cargo xtask`: sets up, builds, tests and demonstrates Glint.

#![forbid(unsafe_code)]

#[cfg(test)]
mod architecture;
mod bootstrap;
mod cores;
mod demo;
#[cfg(test)]
mod documents;
mod firmware;
mod gateware;
mod generated;
mod interface;
mod modules;
mod paths;
mod programs;
mod report;
mod resources;
mod run;
mod rust_tests;
mod scenes;
mod test;
mod walk;
mod web;

use std::path::PathBuf;

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
    /// Install missing prerequisites: Debian packages, Rust targets and the Python environment
    Bootstrap,
    /// Build the gateware of a board
    Gateware {
        /// Board to build for
        #[arg(long, value_enum, default_value = "virtual")]
        board: gateware::Board,
        #[command(flatten)]
        options: gateware::Options,
        /// Also build a second library of the virtual board, which writes waveforms
        #[arg(long, conflicts_with_all = ["scene", "smooth", "texture", "no_sky", "fog", "no_antialiasing", "no_depths", "fields", "lanes", "cpu", "clock", "blocks"])]
        waveforms: bool,
    },
    /// Generate files from the gateware's descriptions: register access crate, register map, RTL packages, records
    Pac {
        /// Write nothing; fail if a generated file is stale
        #[arg(long)]
        check: bool,
    },
    /// Generate the firmware's built-in scenes from the files of the folder `scenes`
    Scenes {
        /// Write nothing; fail if the generated file is stale
        #[arg(long)]
        check: bool,
    },
    /// List the public interface of the library of programs; fail if an item has no example in its documentation
    Interface {
        /// Write nothing; fail if the interface differs from the committed list
        #[arg(long)]
        check: bool,
    },
    /// Build the firmware
    Firmware {
        /// Board to build for; the ULX3S has less memory than the others
        #[arg(long, value_enum, default_value = "virtual")]
        board: gateware::Board,
        /// Build exactly what these scenes need: names of built-in scenes, scene files, or `all` [default: every part]
        #[arg(long, value_name = "NAME|FILE.toml|all", value_delimiter = ',')]
        scene: Vec<String>,
        /// Further Cargo features of the firmware, from its Cargo.toml; `peers` adds kernels of other crates to the console command
        /// `bench`, `uptime` and `uncached` are for variants of the CPU
        #[arg(long, value_delimiter = ',')]
        features: Vec<String>,
    },
    /// Build the example programs of `firmware/examples`, for `glint board --web --firmware FILE`
    Programs,
    /// Build the live page with the emulated board, as a folder of files for any web server
    Web {
        /// Folder to write [default: target/web]
        #[arg(long, value_name = "FOLDER")]
        out: Option<PathBuf>,
    },
    /// Build everything, run it on the virtual board, write pictures to `out/`
    Demo {
        /// Arguments of `glint demo`: mesh files [default: generated models]
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Build everything and run every test
    Test {
        /// Run only the tests on the virtual board, at this frequency of its system clock in MHz: a multiple of 0.25 above 74.25
        #[arg(long, value_name = "MHZ")]
        clock: Option<String>,
    },
    /// Check the sources: no circular dependencies between modules, no `#[path]`
    Modules,
    /// Measure the FPGA resources of the gateware; fail if a block exceeds its limit in gateware/budget.toml
    Resources(resources::Options),
    /// Build the virtual board for each scene and with each single block; fail if a board does not answer, or if its picture differs from
    /// the complete build's or takes more cycles
    Walk {
        /// Builds to test: names of scenes, and `only-BLOCK` [default: all]
        builds: Vec<String>,
    },
    /// Measure errors and run times of the algorithms, and write the pages in docs/report
    Report {
        /// Page to measure: `sine`, `triangle`, `gouraud`, `raymarch`, `imu`, `geometry`, `gesture`, `kernels`, `quality`, `antialiasing`,
        /// `textures`, `timeline`, `cpu`, `long`, `stiff`; or `pages`: rebuild all pages from their tables [default: all pages, as a
        /// workflow of independent jobs]
        page: Option<String>,
        /// Measure samples only; write to target/report
        #[arg(long)]
        quick: bool,
        /// Number of parallel jobs of the whole report
        #[arg(long, value_name = "N", default_value_t = 2)]
        workers: u32,
        /// Options of the page, which `cargo xtask report PAGE -- --help` lists; without a page, targets and options of Snakemake
        #[arg(last = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
}

fn main() -> Result<()> {
    match Arguments::parse().task {
        Task::Bootstrap => bootstrap::bootstrap(),
        Task::Gateware {
            board,
            options,
            waveforms,
        } => {
            let options = options.arguments(board)?;
            let options: Vec<_> = options.iter().map(String::as_str).collect();
            if board == gateware::Board::Ulx3s {
                // The ULX3S build needs the tools that the set-up installs.
                bootstrap::bootstrap()?;
            }
            gateware::build_with(board, &options)?;
            if waveforms {
                gateware::build_with_waveforms()?;
            }
            Ok(())
        }
        Task::Pac { check } => {
            bootstrap::python_environment()?;
            gateware::write_generated(check)
        }
        Task::Scenes { check } => scenes::generate(check),
        Task::Interface { check } => interface::write(check),
        Task::Firmware {
            board,
            scene,
            features,
        } => {
            let features: Vec<_> = features.iter().map(String::as_str).collect();
            if scene.is_empty() {
                firmware::build(board, &features)?;
            } else {
                firmware::build_for(board, &scenes::read(&scene)?, &features)?;
            }
            Ok(())
        }
        Task::Programs => programs::build(),
        Task::Web { out } => web::build(out.as_deref()),
        Task::Demo { arguments } => demo::demo(&arguments),
        Task::Test { clock: None } => test::test(),
        Task::Test { clock: Some(clock) } => test::test_at_clock(&clock),
        Task::Modules => modules::check(),
        Task::Walk { builds } => walk::set_up_and_walk(&builds),
        Task::Resources(options) => resources::resources(&options),
        Task::Report {
            page: Some(page),
            quick,
            mut arguments,
            ..
        } => {
            if quick {
                arguments.insert(0, "--quick".to_owned());
            }
            report::page(&page, &arguments)
        }
        Task::Report {
            page: None,
            quick,
            workers,
            arguments,
        } => report::whole(quick, workers, &arguments),
    }
}
