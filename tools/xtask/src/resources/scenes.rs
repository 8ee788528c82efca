//! `cargo xtask resources --scenes`: the sizes of the builds for the built-in scenes, and the cycles of their frames.

use std::fs;
use std::process::Command;

use anyhow::{Context, Result, bail};
use glint_scene::{Needs, Scene};
use serde::Deserialize;

use super::SOC;
use super::measure::{measured_line, two_at_a_time};
use super::number::number;
use super::size::{Resource, Size};
use crate::gateware::{self, Board};
use crate::{firmware, paths, run, scenes};

/// The resources of a build in the columns of the table, with the names of their limits in a scene file.
const COLUMNS: [(Resource, &str); 4] = [
    (Resource::Lut, "lut"),
    (Resource::Ff, "ff"),
    (Resource::Dsp48, "dsp"),
    (Resource::Ramb36, "ramb36"),
];

/// LUTs of the XC7S50.
const LUTS: f64 = 32_600.0;

/// Name of the build for all scenes.
const ALL: &str = "all";

/// The statistics of a frame from `glint render --stats`, as far as the table has them.
#[derive(Deserialize)]
struct Stats {
    cycles: u64,
    clock: u64,
}

/// A row of the table.
struct Row {
    name: String,
    options: Vec<String>,
    size: Size,
    /// Cycles of a frame and frames a second; `None` for the build for all scenes, and for smooth shading.
    frame: Option<[f64; 2]>,
    budget: Vec<(&'static str, f64)>,
}

/// Measures the builds, prints the table, and writes `docs/scene-builds.md` with `write`. The frames are drawn by the virtual board
/// with all blocks.
///
/// # Errors
/// A build or a measurement fails, or is beyond the limits of its scene.
pub fn resources(write: bool) -> Result<()> {
    let scenes: Vec<Scene> = scenes::all().collect();
    let mut builds = vec![(ALL.to_owned(), Needs::of(&scenes).options())];
    builds.extend(
        scenes
            .iter()
            .map(|scene| (scene.name().to_owned(), scene.needs().options())),
    );
    for (name, options) in &builds {
        let options: Vec<_> = options.iter().map(String::as_str).collect();
        gateware::build_beside(Board::Urbana, name, &options)?;
    }
    let names = builds
        .iter()
        .map(|(name, _)| format!("{SOC}-{name}"))
        .collect();
    let sizes = two_at_a_time(names, |name| {
        Size::parse(&measured_line("size", &["--size"], name)?)
    })?;
    gateware::build(Board::Virtual)?;
    firmware::build(Board::Virtual, &[])?;
    run::step(
        "build glint",
        Command::new("cargo")
            .args(["build", "-p", "glint", "--bin", "glint"])
            .current_dir(paths::root()),
    )?;
    let rows = builds.into_iter().map(|(name, options)| {
        let soc = format!("{SOC}-{name}");
        let size = sizes.iter().find(|size| size.name == soc).cloned();
        let scene = scenes.iter().find(|scene| scene.name() == name);
        Ok(Row {
            size: size.with_context(|| format!("no size of {name}"))?,
            // The soft core would make the descriptors of smooth frames, in minutes on the virtual board.
            frame: scene
                .filter(|scene| !scene.needs().smooth)
                .map(frame)
                .transpose()?,
            budget: scene.map(Scene::budget).unwrap_or_default().to_vec(),
            name,
            options,
        })
    });
    let rows = rows.collect::<Result<Vec<_>>>()?;
    let table = table(&rows);
    print!("\n{table}");
    if write {
        let path = paths::root().join("docs/scene-builds.md");
        fs::write(&path, page(&table)).with_context(|| format!("writing {}", path.display()))?;
        run::print_progress("wrote docs/scene-builds.md");
    }
    within(&rows)
}

/// Cycles of a scene's frame, and frames a second.
fn frame(scene: &Scene) -> Result<[f64; 2]> {
    let folder = paths::target().join("scenes");
    fs::create_dir_all(&folder).with_context(|| format!("creating {}", folder.display()))?;
    let stats = folder.join(scene.name()).with_extension("json");
    run::step(
        &format!("frame of {}", scene.name()),
        Command::new(paths::target().join("debug/glint"))
            .args([
                "render",
                "--board",
                "virtual",
                "--scene",
                scene.name(),
                "--stats",
            ])
            .arg(&stats)
            .arg("--out")
            .arg(stats.with_extension("png"))
            .current_dir(paths::root()),
    )?;
    let text =
        fs::read_to_string(&stats).with_context(|| format!("reading {}", stats.display()))?;
    let Stats { cycles, clock } = serde_json::from_str(&text)?;
    Ok([cycles as f64, clock as f64 / cycles as f64])
}

/// The value of a row that a limit of a scene bounds; `None` for one that is not measured here.
fn value(row: &Row, name: &str) -> Option<f64> {
    match (name, row.frame) {
        ("cycles", Some([cycles, _])) => Some(cycles),
        ("fps", Some([_, rate])) => Some(rate),
        _ => {
            let column = COLUMNS.iter().find(|(_, limit)| *limit == name);
            column.map(|(resource, _)| row.size.of(*resource))
        }
    }
}

fn table(rows: &[Row]) -> String {
    let full = rows
        .iter()
        .find(|row| row.name == ALL)
        .map(|row| row.size.of(Resource::Lut));
    let mut out = "| scene | LUT | of all | of the XC7S50 | FF | DSP48 | RAMB36 | cycles | frames a second | build |\n\
                   |---|---:|---:|---:|---:|---:|---:|---:|---:|---|\n"
        .to_owned();
    for row in rows {
        let [lut, ff, dsp, ramb] = COLUMNS.map(|(resource, _)| row.size.of(resource));
        let share = full.map_or(0.0, |full| 100.0 * lut / full);
        let [cycles, rate] = row.frame.map_or_else(Default::default, |frame| {
            frame.map(|value| number(value.floor()))
        });
        out += &format!(
            "| `{}` | {} | {share:.0} % | {:.0} % | {} | {} | {} | {cycles} | {rate} | `{}` |\n",
            row.name,
            number(lut),
            100.0 * lut / LUTS,
            number(ff),
            number(dsp),
            number(ramb),
            row.options.join(" ")
        );
    }
    out
}

fn page(table: &str) -> String {
    format!(
        "<!-- Generated by `cargo xtask resources --scenes --write`. Do not edit. -->

# Builds for scenes

The cells of the Urbana's SoC in the build for each [scene](scenes.md), and in the build for `{ALL}` scenes, by Yosys as in
[resources.md](resources.md). Cycles are those of the scene's frame, in its size, on the virtual board with all blocks and two lanes, which
has no smooth shading. The last column has the options of `cargo xtask gateware`.

{table}"
    )
}

/// Fails if a row is beyond a limit of its scene: `fps` is a least value, all others are greatest ones.
fn within(rows: &[Row]) -> Result<()> {
    let mut lines = Vec::new();
    for row in rows {
        for (name, limit) in &row.budget {
            let Some(value) = value(row, name) else {
                continue;
            };
            let is_within = if *name == "fps" {
                value >= *limit
            } else {
                value <= *limit
            };
            if !is_within {
                lines.push(format!(
                    "{}: {name}: budget {limit}, measured {}",
                    row.name,
                    number(value.floor())
                ));
            }
        }
    }
    if lines.is_empty() {
        return Ok(());
    }
    bail!("beyond the budgets of scenes/*.toml:\n{}", lines.join("\n"))
}
