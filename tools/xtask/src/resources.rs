//! `cargo xtask resources`: FPGA resources of the gateware and its clock rates. This module makes the builds;
//! `gateware/resources` measures them and prints the results.

mod scenes;

use std::ffi::OsStr;

use anyhow::Result;

use crate::gateware::{self, Board};
use crate::{bootstrap, run};

/// Name of the whole design in the Urbana's FPGA.
const SOC: &str = "soc";

/// Options of the command line.
#[derive(clap::Args)]
pub struct Options {
    /// Names of the blocks to measure, as in docs/resources.md; `soc` is the whole design [default: all; with `--route`,
    /// the project's own blocks]
    blocks: Vec<String>,
    /// Place and route on an ECP5 instead: clock rates of the blocks and of VexRiscv
    #[arg(long)]
    route: bool,
    /// Print only the sizes of the instances in the blocks [default: soc], largest first
    #[arg(long, conflicts_with = "route")]
    tree: bool,
    /// Depth of the printed tree of instances
    #[arg(long, requires = "tree", default_value_t = 3)]
    depth: usize,
    /// Measure the Urbana's build for each built-in scene and for all scenes, and the cycles of the scenes' frames
    #[arg(long, conflicts_with_all = ["blocks", "route", "tree", "json"])]
    scenes: bool,
    /// Print JSON; progress goes to standard error
    #[arg(long)]
    json: bool,
    /// Write docs/resources.md (with `--route`, cells and clock rates; with `--scenes`, docs/scene-builds.md instead)
    #[arg(long, conflicts_with_all = ["blocks", "tree"])]
    write: bool,
}

/// Measures the selected blocks, prints the results, and compares them with `gateware/budget.toml`.
///
/// # Errors
/// A block exceeds its budget, or cannot be measured.
pub fn resources(options: &Options) -> Result<()> {
    if options.json {
        run::progress_to_stderr();
    }
    bootstrap::bootstrap()?;
    let write = options.write.then_some("--write");
    if options.scenes {
        let builds = scenes::build()?;
        return measure(&[OsStr::new("--scenes"), builds.as_os_str()], write);
    }
    let has_sizes = !options.route || options.write;
    if has_sizes && (options.blocks.is_empty() || options.blocks.iter().any(|name| name == SOC)) {
        gateware::build(Board::Urbana)?;
    }
    let mut arguments: Vec<String> = options.blocks.clone();
    if options.tree {
        arguments.extend(["--tree".to_owned(), options.depth.to_string()]);
    }
    let flags = [(options.route, "--route"), (options.json, "--json")];
    let flags = flags
        .into_iter()
        .filter_map(|(is_set, flag)| is_set.then_some(flag));
    arguments.extend(flags.map(str::to_owned));
    measure(&arguments, write)
}

/// Measures the sizes of this project's own blocks, and the clock rates of the blocks with a minimum rate in the budget. Compares both
/// with the budget.
///
/// # Errors
/// Those of [`resources`].
pub fn check() -> Result<()> {
    run::step(
        "sizes and clock rates",
        &mut run::python(&["-m", "resources", "--check"]),
    )
}

fn measure(arguments: &[impl AsRef<OsStr>], write: Option<&str>) -> Result<()> {
    run::foreground(
        "the measurement",
        run::python(&["-m", "resources"])
            .args(arguments)
            .args(write),
    )
}
