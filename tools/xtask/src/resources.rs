//! `cargo xtask resources`: FPGA resources of the gateware, against `gateware/budget.toml`.
//!
//! `gateware/tests/run.py --size` measures one block with Yosys; two blocks are measured at a time. [`size::Size`] has the
//! result, [`budget::Budget`] the limits; [`table`] prints both.

mod blocks;
mod budget;
mod size;
mod table;

use std::collections::VecDeque;
use std::fs;
use std::process::Command;
use std::sync::Mutex;
use std::time::Instant;

use anyhow::{Context, Result, bail};

use crate::gateware::{self, Board};
use crate::{bootstrap, paths, run};
use blocks::{BUILDS, FLAT, FLAT_PARTS, OWN, ROWS, SOC};
use budget::{Budget, Excess};
use size::Size;

/// Parallel runs of Yosys; each needs one core and about a gigabyte.
const AT_ONCE: usize = 2;

/// Options of the command line.
pub struct Options {
    /// Blocks to measure; empty: all.
    pub blocks: Vec<String>,
    /// Print only JSON to standard output.
    pub json: bool,
    /// Write `docs/resources.md`.
    pub write: bool,
}

/// Measures the selected blocks, prints their sizes, and compares them with the budget.
///
/// # Errors
/// A block exceeds its budget, or cannot be measured.
pub fn resources(options: &Options) -> Result<()> {
    if options.json {
        run::progress_to_stderr();
    }
    let start = Instant::now();
    let budget = Budget::read()?;
    bootstrap::bootstrap()?;
    let sizes = measure(selection(&options.blocks)?)?;
    let excesses = budget.excesses(&sizes);
    if options.json {
        println!("{:#}", table::json(&sizes, &excesses));
    } else {
        print!("\n{}", table::text(&sizes, &budget));
        println!("{:.0} s", start.elapsed().as_secs_f64());
    }
    if options.write {
        let path = paths::root().join("docs/resources.md");
        fs::write(&path, table::page(&sizes, &budget))
            .with_context(|| format!("writing {}", path.display()))?;
        run::print_progress("wrote docs/resources.md");
    }
    within(&excesses)
}

/// Measures this project's own blocks and compares them with the budget. The SoC is left out, because it takes too long to
/// measure in every test.
///
/// # Errors
/// As [`resources`].
pub fn check_own_blocks() -> Result<()> {
    let budget = Budget::read()?;
    within(&budget.excesses(&measure(OWN.map(String::from).into())?))
}

/// Fails if there is an excess; the error has one line for each excess.
fn within(excesses: &[Excess]) -> Result<()> {
    if excesses.is_empty() {
        return Ok(());
    }
    let lines: Vec<String> = excesses.iter().map(ToString::to_string).collect();
    bail!(
        "above the limits of gateware/budget.toml:\n{}",
        lines.join("\n")
    )
}

/// Returns the blocks to measure, without repeats. If `blocks` is empty, these are all blocks, the slowest to measure first.
fn selection(blocks: &[String]) -> Result<VecDeque<String>> {
    let mut names = VecDeque::new();
    let wanted = if blocks.is_empty() {
        let named = [&[SOC], &BUILDS[..], &OWN[..]].concat();
        let named = named.into_iter().map(String::from);
        named.chain(blocks::fields()?).collect()
    } else {
        blocks.to_vec()
    };
    for block in wanted.iter().map(String::as_str) {
        let parts = if block == FLAT {
            &FLAT_PARTS[..]
        } else {
            &[block]
        };
        for part in parts {
            if !names.iter().any(|name| name == part) {
                names.push_back((*part).to_owned());
            }
        }
    }
    Ok(names)
}

/// Measures blocks in parallel, and adds the sum `flat_build` if all its parts are among them.
fn measure(names: VecDeque<String>) -> Result<Vec<Size>> {
    if names.iter().any(|name| name == SOC) {
        gateware::build(Board::Urbana)?;
    }
    let queue = Mutex::new(names);
    let work = || -> Result<Vec<Size>> {
        let mut sizes = Vec::new();
        loop {
            let next = queue.lock().expect("no worker panics").pop_front();
            let Some(name) = next else {
                return Ok(sizes);
            };
            let size = measure_one(&name);
            if size.is_err() {
                queue.lock().expect("no worker panics").clear();
            }
            sizes.push(size?);
        }
    };
    let outcomes: Vec<Result<Vec<Size>>> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..AT_ONCE).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .map(|worker| worker.join().expect("a measuring thread does not panic"))
            .collect()
    });
    let mut sizes = outcomes
        .into_iter()
        .collect::<Result<Vec<_>>>()?
        .into_iter()
        .flatten()
        .collect();
    add_flat_build(&mut sizes);
    sizes.sort_by_key(|size| {
        ROWS.iter()
            .position(|row| *row == size.name)
            .unwrap_or(ROWS.len())
    });
    Ok(sizes)
}

fn measure_one(name: &str) -> Result<Size> {
    let mut line_of_size = String::new();
    run::watched_step(
        &format!("size of {name}"),
        Command::new(paths::venv_program("python"))
            .args(["gateware/tests/run.py", "--size", name])
            .current_dir(paths::root()),
        |line| {
            if line.starts_with('{') {
                line.clone_into(&mut line_of_size);
            }
        },
    )?;
    Size::parse(&line_of_size).with_context(|| format!("reading the size of {name}"))
}

/// Adds the block `flat_build`, the sum of `FLAT_PARTS`, if all of these are in `sizes`.
fn add_flat_build(sizes: &mut Vec<Size>) {
    let parts: Vec<&Size> = sizes
        .iter()
        .filter(|size| FLAT_PARTS.contains(&size.name.as_str()))
        .collect();
    if parts.len() == FLAT_PARTS.len() {
        let sum = Size::sum(FLAT, &parts);
        sizes.push(sum);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_each_block_once_and_the_flat_build_by_its_parts() {
        let select = |blocks: &[&str]| {
            let blocks: Vec<_> = blocks.iter().map(|b| (*b).to_owned()).collect();
            selection(&blocks).expect("the folder of the raymarcher")
        };
        assert_eq!(
            select(&[]).len(),
            OWN.len() + BUILDS.len() + blocks::fields().unwrap().len() + 1
        );
        assert_eq!(select(&[])[0], SOC);
        assert_eq!(select(&["scanout"]), ["scanout"]);
        assert_eq!(
            select(&["setup", FLAT]),
            ["setup", "vertex_stage", "triangle_raster"]
        );
    }

    #[test]
    fn adds_the_flat_build_when_its_parts_are_there() {
        let mut sizes: Vec<Size> = FLAT_PARTS.map(size::tests::size).into();
        add_flat_build(&mut sizes);
        assert_eq!(sizes.last().unwrap().name, FLAT);
        assert_eq!(sizes.last().unwrap().ff, 3 * sizes[0].ff);
        let mut sizes: Vec<Size> = ["setup", "scanout", "soc"].map(size::tests::size).into();
        add_flat_build(&mut sizes);
        assert_eq!(sizes.len(), 3);
    }

    #[test]
    fn fails_beyond_the_budget_only() {
        assert!(within(&[]).is_ok());
        let excess = Excess {
            block: "setup".to_owned(),
            resource: size::Resource::Lut,
            budget: 2400,
            measured: 2401.0,
        };
        let message = within(&[excess]).unwrap_err().to_string();
        assert_eq!(
            message,
            "above the limits of gateware/budget.toml:\nsetup: LUT: budget 2,400, measured 2,401"
        );
    }
}
