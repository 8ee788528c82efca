//! Experiment: FPGA resources of current and earlier triangle engines, with flat and with smooth shading.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};

use crate::report::provenance::Provenance;
use crate::report::table::read_csv;
use crate::report::workspace;

/// Name of the current engine.
pub const TODAY: &str = "Glint";
/// Name of the engine that shades a group of eight pixels per clock.
pub const GROUP: &str = "eight divisions a clock, planes of the channels at once";
/// Name of the engine that shades one pixel per clock.
pub const PIXEL: &str = "a division a clock, planes of the channels at once";
/// Name of the engine that shades one pixel per clock, and computes the channels' planes sequentially.
pub const PLANES: &str = "a division a clock, planes one after the other";

/// Names of earlier engines, and the last commit of each.
const EARLIER: [(&str, &str); 3] = [
    (GROUP, "e91335dce5f7"),
    (PIXEL, "c70268e40724"),
    (PLANES, "71b672ffed3a"),
];

/// The shading modes of an engine, each with its module in `gateware/resources/modules.py`.
const MODULES: [(&str, &str); 2] = [
    ("flat", "triangle_engine"),
    ("flat and smooth", "triangle_engine_smooth"),
];

/// Name prefixes of the instances that divide light by depth.
const DIVISIONS: [&str; 2] = ["pixel_colour", "quotients"];

/// Resources of a triangle engine: a line of `gouraud-cost.csv`.
#[derive(Clone, Serialize, Deserialize)]
pub struct Cost {
    /// Name of the engine.
    pub engine: String,
    /// The shading modes of the engine.
    pub shading: String,
    /// Number of LUTs, including the LUTs used as memory.
    #[serde(rename = "LUT")]
    pub lut: u32,
    /// Number of flip-flops.
    #[serde(rename = "FF")]
    pub ff: u32,
    /// Number of DSP48 slices.
    #[serde(rename = "DSP48")]
    pub dsp: u32,
    /// Number of block RAMs, in units of 36 Kbit.
    #[serde(rename = "RAMB36")]
    pub bram: f64,
    /// Longest path between registers, in LUT levels (docs/resources.md).
    pub path: u32,
    /// LUTs of the instances that divide light by depth.
    pub division_lut: u32,
    /// DSP48 slices of the instances that divide light by depth.
    pub division_dsp: u32,
    /// Commit of the measured engine.
    pub commit: String,
}

/// Output of Yosys for a module: numbers of cells by kind, and length of the longest path.
#[derive(Deserialize)]
struct Cells {
    logic: u32,
    srl: u32,
    lutram: u32,
    ff: u32,
    dsp48: u32,
    ramb36: u32,
    ramb18: u32,
    path: u32,
    instances: Vec<Instance>,
}

/// Cells of an instance within a module, without the cells of nested instances.
#[derive(Deserialize)]
struct Instance {
    path: Vec<String>,
    lut: u32,
    dsp48: u32,
}

/// Synthesises the current engine and returns its resources.
///
/// # Errors
/// When the synthesis fails.
pub fn today() -> Result<Vec<Cost>> {
    let commit = &Provenance::find().commit;
    costs(
        TODAY,
        commit,
        &workspace::path(""),
        &["-m", "resources.size"],
    )
}

/// Synthesises the earlier engines, from the gateware of their commits, and returns their resources.
///
/// # Errors
/// When a commit does not exist in git, or the synthesis fails.
pub fn earlier() -> Result<Vec<Cost>> {
    let mut rows = Vec::new();
    for (engine, commit) in EARLIER {
        let program = ["gateware/tests/run.py", "--size"];
        rows.extend(costs(engine, commit, &gateware_of(commit)?, &program)?);
    }
    Ok(rows)
}

/// Returns the committed resources of the earlier engines.
///
/// # Errors
/// When a line of the table does not have the columns of a [`Cost`].
pub fn kept() -> Result<Vec<Cost>> {
    let mut rows: Vec<Cost> = read_csv(&workspace::path("docs/report/gouraud-cost.csv"))?;
    rows.retain(|row| row.engine != TODAY);
    Ok(rows)
}

/// Extracts the gateware of a commit from git, and returns its folder.
fn gateware_of(commit: &str) -> Result<PathBuf> {
    let folder = workspace::path("target/report").join(commit);
    std::fs::create_dir_all(&folder)
        .with_context(|| format!("cannot create the folder {}", folder.display()))?;
    let archive = folder.join("gateware.tar");
    run(Command::new("git")
        .args(["archive", "--output"])
        .arg(&archive)
        .args([commit, "gateware"])
        .current_dir(workspace::path("")))?;
    run(Command::new("tar")
        .arg("-xf")
        .arg(&archive)
        .current_dir(&folder))?;
    Ok(folder)
}

/// Synthesises both modules of the engine in the folder `root`, with a Python program from that folder.
fn costs(engine: &str, commit: &str, root: &Path, program: &[&str]) -> Result<Vec<Cost>> {
    MODULES
        .into_iter()
        .map(|(shading, module)| {
            eprintln!("{engine}, {shading} …");
            let cells = cells(module, root, program)?;
            let divides = |instance: &&Instance| {
                let mut names = instance.path.iter();
                names.any(|name| DIVISIONS.iter().any(|start| name.starts_with(start)))
            };
            let divisions = || cells.instances.iter().filter(divides);
            Ok(Cost {
                engine: engine.to_owned(),
                shading: shading.to_owned(),
                lut: cells.logic + cells.srl + cells.lutram,
                ff: cells.ff,
                dsp: cells.dsp48,
                bram: f64::from(cells.ramb36) + f64::from(cells.ramb18) / 2.0,
                path: cells.path,
                division_lut: divisions().map(|instance| instance.lut).sum(),
                division_dsp: divisions().map(|instance| instance.dsp48).sum(),
                commit: commit.to_owned(),
            })
        })
        .collect()
}

fn cells(module: &str, root: &Path, program: &[&str]) -> Result<Cells> {
    let output = run(Command::new(workspace::path(".venv/bin/python"))
        .args(program)
        .arg(module)
        .env("PYTHONPATH", root.join("gateware"))
        .current_dir(root))?;
    let text = String::from_utf8_lossy(&output.stdout);
    serde_json::from_str(&text).with_context(|| format!("expected a size in JSON, found `{text}`"))
}

/// Runs a program, and returns its output if it succeeds.
fn run(command: &mut Command) -> Result<Output> {
    let output = command
        .output()
        .with_context(|| format!("cannot run {command:?}: run `cargo xtask bootstrap`"))?;
    let text = [&output.stdout[..], &output.stderr[..]].concat();
    ensure!(
        output.status.success(),
        "{command:?}: {}",
        String::from_utf8_lossy(&text)
    );
    Ok(output)
}
