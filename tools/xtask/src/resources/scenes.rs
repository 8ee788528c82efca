//! `cargo xtask resources --scenes`: the sizes of the builds for the built-in scenes, gateware and firmware, and what their frames take.

use std::fs;
use std::process::Command;
use std::slice;

use anyhow::{Context, Result, bail};
use glint_scene::{Needs, Scene};
use serde::Deserialize;

use super::SOC;
use super::budget::{Budget, Limits};
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

/// Bytes of a word of the engines' memory ports.
const WORD: f64 = 16.0;

/// Pictures a second that scan-out reads.
const REFRESH: f64 = 60.0;

/// Bytes of a pixel of the frame buffer.
const PIXEL: f64 = 2.0;

/// Name of the build for all scenes.
const ALL: &str = "all";

/// The statistics of a frame from `glint render --stats`, as far as the table has them.
#[derive(Deserialize)]
struct Stats {
    cycles: u64,
    clock: u64,
    words_read: u64,
    words_written: u64,
}

/// What a scene's frame takes.
struct Frame {
    cycles: f64,
    /// Frames a second, when one follows the other.
    rate: f64,
    /// Megabytes a second of main memory: the engines' at this rate, and scan-out's.
    memory: f64,
}

/// A row of the table.
struct Row {
    name: String,
    options: Vec<String>,
    size: Size,
    /// Bytes of the firmware's image.
    firmware: f64,
    /// `None` for the build for all scenes, and for smooth shading.
    frame: Option<Frame>,
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
        gateware::generate_beside(Board::Urbana, name, &options)?;
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
    run::build_program("glint", "glint")?;
    let rows = builds.into_iter().map(|(name, options)| {
        let soc = format!("{SOC}-{name}");
        let size = sizes.iter().find(|size| size.name == soc).cloned();
        let scene = scenes.iter().find(|scene| scene.name() == name);
        let firmware = firmware::build_for(
            Board::Urbana,
            scene.map_or(&scenes[..], slice::from_ref),
            &[],
        )?;
        Ok(Row {
            size: size.with_context(|| format!("no size of {name}"))?,
            firmware: firmware.length as f64,
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
    let table = table(&rows, &Budget::read()?.device);
    print!("\n{table}");
    if write {
        let path = paths::root().join("docs/scene-builds.md");
        fs::write(&path, page(&table)).with_context(|| format!("writing {}", path.display()))?;
        run::print_progress("wrote docs/scene-builds.md");
    }
    within(&rows)
}

/// Draws a scene's frame on the virtual board.
fn frame(scene: &Scene) -> Result<Frame> {
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
    let stats: Stats = serde_json::from_str(&text)?;
    let cycles = stats.cycles as f64;
    let rate = stats.clock as f64 / cycles;
    let engines = (stats.words_read + stats.words_written) as f64 * WORD * rate;
    let scan_out = scene.size().pixel_count() as f64 * PIXEL * REFRESH;
    Ok(Frame {
        cycles,
        rate,
        memory: (engines + scan_out) / 1e6,
    })
}

/// The value of a row that a limit of a scene bounds; `None` for one that is not measured here.
fn value(row: &Row, name: &str) -> Option<f64> {
    match name {
        "cycles" => row.frame.as_ref().map(|frame| frame.cycles),
        "fps" => row.frame.as_ref().map(|frame| frame.rate),
        "firmware" => Some(row.firmware),
        _ => {
            let column = COLUMNS.iter().find(|(_, limit)| *limit == name);
            column.map(|(resource, _)| row.size.of(*resource))
        }
    }
}

/// The rows as a table in Markdown; `device` has the limits of the XC7S50.
fn table(rows: &[Row], device: &Limits) -> String {
    let full = rows
        .iter()
        .find(|row| row.name == ALL)
        .map(|row| row.size.of(Resource::Lut));
    let mut out = "| scene | LUT | of all | FF | DSP48 | RAMB36 | slices | fits the XC7S50 | firmware | cycles | frames a second | \
                   memory | build |\n|---|---:|---:|---:|---:|---:|---:|---|---:|---:|---:|---:|---|\n"
        .to_owned();
    for row in rows {
        let lut = row.size.of(Resource::Lut);
        let share = full.map_or(0.0, |full| 100.0 * lut / full);
        let cells = [
            Resource::Ff,
            Resource::Dsp48,
            Resource::Ramb36,
            Resource::Slices,
        ];
        let cells = cells.map(|resource| number(row.size.of(resource)));
        let frame = row.frame.as_ref().map_or_else(Default::default, |frame| {
            [frame.cycles, frame.rate, frame.memory].map(|value| number(value.floor()))
        });
        out += &format!(
            "| `{}` | {} | {share:.0} % | {} | {} | {} | {} | `{}` |\n",
            row.name,
            number(lut),
            cells.join(" | "),
            fits(&row.size, device),
            number(row.firmware),
            frame.join(" | "),
            row.options.join(" ")
        );
    }
    out
}

/// Whether a build fits a device: "yes", or what it has too much of.
fn fits(size: &Size, device: &Limits) -> String {
    let beyond = device.iter().filter_map(|(resource, limit)| {
        let share = size.of(*resource) / f64::from(*limit) * 100.0;
        (share > 100.0).then(|| format!("{} {share:.0} %", resource.name()))
    });
    let beyond: Vec<_> = beyond.collect();
    if beyond.is_empty() {
        "yes".to_owned()
    } else {
        format!("no: {}", beyond.join(", "))
    }
}

fn page(table: &str) -> String {
    format!(
        "<!-- Generated by `cargo xtask resources --scenes --write`. Do not edit. -->

# Builds for scenes

The cells of the Urbana's SoC in the build for each [scene](scenes.md), and in the build for `{ALL}` scenes, by Yosys as in
[resources.md](resources.md): slices are the lower bound. The column `firmware` has the bytes of the image for the scene. Cycles are
those of the scene's frame, in its size, on the virtual board with all blocks and two lanes, which has no smooth shading. Frames a second
are as many as can be drawn one after the other. The column `memory` has the megabytes a second that the engines then move, plus those
of scan-out at 60 Hz, without the soft core's; [boards.md](boards.md) has what the memory of a board moves at most. The last column
has the options of `cargo xtask gateware`.

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

#[cfg(test)]
mod tests {
    use super::super::table::tests::measured;
    use super::*;

    #[test]
    fn a_row_has_what_is_beyond_the_device() {
        let row = Row {
            name: "lamp".into(),
            options: vec!["--blocks".into(), "scanout".into()],
            size: measured(None).sizes.remove(0),
            firmware: 54_321.0,
            frame: Some(Frame {
                cycles: 1_354_166.7,
                rate: 60.0,
                memory: 55.3,
            }),
            budget: vec![],
        };
        let device = Limits::from([(Resource::Lut, 1_234), (Resource::Ramb36, 2)]);
        let table = table(&[row], &device);
        let expected = "| `lamp` | 1,234 | 0 % | 2,000 | 7 | 2.5 | 400 | no: RAMB36 125 % | 54,321 | 1,354,166 | 60 | 55 \
                        | `--blocks scanout` |\n";
        assert!(table.ends_with(expected), "{table}");
    }
}
