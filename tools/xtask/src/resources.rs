//! `cargo xtask resources`: FPGA resources of the gateware and its clock rates, against `gateware/budget.toml`.
//!
//! `gateware/tests/size.py` measures one block with Yosys, `gateware/tests/route.py` places and routes one; two blocks are
//! measured at a time. [`size::Size`] and [`route::Rates`] have the results, [`budget::Budget`] the limits; [`table`] prints
//! them, [`page`] is `docs/resources.md`.

mod blocks;
mod budget;
mod instances;
mod measure;
mod number;
mod page;
mod route;
mod scenes;
mod size;
mod table;

use std::collections::VecDeque;
use std::fs;
use std::time::Instant;

use anyhow::{Context, Result, bail};

use crate::gateware::{self, Board};
use crate::{bootstrap, paths, run};
use blocks::{BUILDS, ENGINES, FLAT, FLAT_PARTS, OWN, SOC, sort_by_row};
use budget::Budget;
use measure::{measured_line, two_at_a_time};
use route::Seeds;
use size::Size;
use table::Measured;

/// Options of the command line.
pub struct Options {
    /// Blocks to measure; empty: all blocks, or with `route` the own blocks.
    pub blocks: Vec<String>,
    /// Measure clock rates by place and route instead of sizes.
    pub route: bool,
    /// Print the sizes of the instances in the blocks, or in the SoC if none is named, down to this depth instead.
    pub tree: Option<usize>,
    /// Measure the builds for the built-in scenes instead.
    pub scenes: bool,
    /// Print only JSON to standard output.
    pub json: bool,
    /// Write `docs/resources.md`; with `scenes`, `docs/scene-builds.md`.
    pub write: bool,
}

/// Measures the selected blocks, prints the results, and compares them with the budget. The results are clock rates with
/// [`Options::route`], otherwise sizes, and both for the page.
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
    if options.scenes {
        return scenes::resources(options.write);
    }
    if let Some(depth) = options.tree {
        return tree(options, depth);
    }
    let mut measured = Measured::default();
    if !options.route || options.write {
        measured.sizes = measure_sizes(selection(&options.blocks, all()?))?;
    }
    if options.route {
        let engines = if options.write { &ENGINES[..] } else { &[] };
        let routed = strings(&[&OWN[..], engines].concat());
        measured.rates = Some(route::measure(selection(&options.blocks, routed))?);
    }
    if options.json {
        println!("{:#}", table::json(&measured, &budget));
    } else {
        print!("\n{}", table::text(&measured, &budget));
        println!("{:.0} s", start.elapsed().as_secs_f64());
    }
    if options.write {
        let path = paths::root().join("docs/resources.md");
        fs::write(&path, page::page(&measured, &budget))
            .with_context(|| format!("writing {}", path.display()))?;
        run::print_progress("wrote docs/resources.md");
    }
    within(&budget, &measured)
}

/// Measures blocks and prints their instances.
fn tree(options: &Options, depth: usize) -> Result<()> {
    let sizes = measure_sizes(selection(&options.blocks, strings(&[SOC])))?;
    let sizes = sizes.iter().filter(|size| size.name != FLAT);
    if options.json {
        let trees: Vec<_> = sizes
            .map(|size| instances::json(&size.name, &size.instances, depth))
            .collect();
        println!("{:#}", serde_json::Value::from(trees));
    } else {
        for size in sizes {
            print!("\n{}", instances::text(&size.name, &size.instances, depth));
        }
    }
    Ok(())
}

/// Measures this project's own blocks and compares their sizes with the budget. The SoC is left out, because it takes too long
/// to measure in every test.
///
/// # Errors
/// As [`resources`].
pub fn check_own_blocks() -> Result<()> {
    let measured = Measured {
        sizes: measure_sizes(strings(&OWN).into())?,
        rates: None,
    };
    within(&Budget::read()?, &measured)
}

/// Measures the blocks that have a minimum clock rate in the budget, with one seed, and compares them with it. The soft core's rate is
/// that of the budget, because its place and route takes longer than that of all these blocks.
///
/// # Errors
/// As [`resources`].
pub fn check_clock_rates() -> Result<()> {
    let budget = Budget::read()?;
    let rates = route::measure_blocks(budget.routed(), Seeds::First)?;
    for rate in &rates {
        budget.reference.check_version(rate)?;
    }
    refuse(&budget.shortfalls(&rates, budget.reference.mhz))
}

/// Fails if there is an excess or a shortfall, or if the soft core's measured rate is not that of the budget.
fn within(budget: &Budget, measured: &Measured) -> Result<()> {
    let excesses = budget.excesses(&measured.sizes);
    let mut lines: Vec<String> = excesses.iter().map(ToString::to_string).collect();
    if let Some(rates) = &measured.rates {
        let shortfalls = budget.shortfalls(&rates.blocks, rates.reference.mhz);
        lines.extend(shortfalls.iter().map(ToString::to_string));
        let stale = budget.reference.check(&rates.reference).err();
        lines.extend(stale.map(|error| error.to_string()));
    }
    refuse(&lines)
}

/// Fails with a line for each of `problems`, if there is one.
fn refuse(problems: &[impl ToString]) -> Result<()> {
    if problems.is_empty() {
        return Ok(());
    }
    let lines: Vec<String> = problems.iter().map(ToString::to_string).collect();
    bail!(
        "beyond the limits of gateware/budget.toml:\n{}",
        lines.join("\n")
    )
}

fn strings(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// Names of all blocks, the slowest to measure first.
fn all() -> Result<Vec<String>> {
    let mut names = strings(&[&[SOC], &BUILDS[..], &OWN[..]].concat());
    names.extend(blocks::fields()?);
    Ok(names)
}

/// Returns the blocks to measure, without repeats: `blocks`, or `all` if it is empty.
fn selection(blocks: &[String], all: Vec<String>) -> VecDeque<String> {
    let mut names = VecDeque::new();
    let wanted = if blocks.is_empty() {
        all
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
    names
}

/// Measures the sizes of blocks in parallel, and adds the sum `flat_build` if all its parts are among them.
fn measure_sizes(names: VecDeque<String>) -> Result<Vec<Size>> {
    if names.iter().any(|name| name == SOC) {
        gateware::build(Board::Urbana)?;
    }
    let mut sizes = two_at_a_time(names, |name| {
        Size::parse(&measured_line("size", &["--size"], name)?)
    })?;
    add_flat_build(&mut sizes);
    sort_by_row(&mut sizes, |size| &size.name);
    Ok(sizes)
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
        let select = |blocks: &[&str]| selection(&strings(blocks), all().unwrap());
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
        let budget: Budget = toml::from_str(budget::tests::BUDGET).unwrap();
        let mut measured = Measured {
            sizes: vec![size::tests::size("setup")],
            rates: Some(route::tests::rates()),
        };
        assert!(within(&budget, &measured).is_ok());
        measured.sizes[0].logic += 1;
        measured.rates.as_mut().unwrap().blocks[0].mhz = 99.0;
        assert_eq!(
            within(&budget, &measured).unwrap_err().to_string(),
            "beyond the limits of gateware/budget.toml:\nsetup: LUT: budget 1,234, measured 1,235\n\
             setup: ratio to vexriscv: at least 1.25, measured 1.24"
        );
    }
}
