//! `cargo xtask resources --scenes`: the sizes of the builds for the built-in scenes, gateware and firmware, and what their frames take.
//! [`page`] is docs/scene-builds.md.

mod page;
mod row;

use std::fs;
use std::process::Command;
use std::slice;

use anyhow::{Context, Result, bail};
use glint_scene_file::{Needs, SceneFile};

use super::SOC;
use super::budget::Budget;
use super::measure::{measured_line, two_at_a_time};
use super::number::number;
use super::size::Size;
use crate::firmware::Image;
use crate::gateware::{self, Board, Library};
use crate::{firmware, paths, run, scenes};
use row::{ALL, COLUMNS, Firmware, Frame, Row, Stats};

/// Size of a word of the engines' memory ports in bytes.
const WORD: f64 = 16.0;

/// Pictures a second that scan-out reads.
const REFRESH: f64 = 60.0;

/// Size of a pixel of the frame buffer in bytes.
const PIXEL: f64 = 2.0;

/// The share of the firmware with all parts that the firmware for a single scene takes at most.
const FIRMWARE_SHARE: f64 = 0.5;

/// Measures the builds, prints the tables, and writes `docs/scene-builds.md` with `write`. The virtual board draws the frames.
///
/// # Errors
/// A build or a measurement fails, or is beyond the limits of its scene.
pub fn resources(write: bool) -> Result<()> {
    let scenes: Vec<SceneFile> = scenes::all().collect();
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
    let options: Vec<_> = builds[0].1.iter().map(String::as_str).collect();
    let ulx3s = gateware::ulx3s_cells(ALL, &options)?;
    gateware::build(Board::Virtual)?;
    let full = firmware::build(Board::Virtual, &[])?;
    run::build_program("glint", "glint")?;
    let rows = builds.into_iter().map(|(name, options)| {
        let soc = format!("{SOC}-{name}");
        let size = sizes.iter().find(|size| size.name == soc).cloned();
        let scene = scenes.iter().find(|scene| scene.name() == name);
        Ok(Row {
            size: size.with_context(|| format!("no size of {name}"))?,
            firmware: firmware(&scenes, scene)?,
            is_single: scene.is_some_and(|scene| scene.scenes().is_empty()),
            frame: scene.map(frame).transpose()?,
            budget: scene.map(SceneFile::budget).unwrap_or_default().to_vec(),
            name,
            options,
        })
    });
    let rows = rows.collect::<Result<Vec<_>>>()?;
    let full = full.length as f64;
    let text = page::tables(&rows, &Budget::read()?.device, &ulx3s, full);
    print!("\n{text}");
    if write {
        let path = paths::root().join("docs/scene-builds.md");
        fs::write(&path, page::page(&text))
            .with_context(|| format!("writing {}", path.display()))?;
        run::print_progress("wrote docs/scene-builds.md");
    }
    within(&rows, full)
}

/// Builds the firmware for a scene, or for all `scenes` without one, and measures the stack on the emulated board.
fn firmware(scenes: &[SceneFile], scene: Option<&SceneFile>) -> Result<Firmware> {
    let built = scene.map_or(scenes, slice::from_ref);
    let image = firmware::build_for(Board::Urbana, built, &[])?;
    // The emulated board has no smooth shading.
    let flat = scene.filter(|scene| !scene.needs().smooth);
    let stack = flat.map(|scene| stack(scene, &image)).transpose()?;
    Ok(Firmware { image, stack })
}

/// Measures the stack that the firmware uses for the self-test and the scene's picture.
fn stack(scene: &SceneFile, image: &Image) -> Result<u64> {
    let name = scene.name();
    let binary = paths::target().join(format!("firmware/glint-{name}.bin"));
    let mut last = String::new();
    run::watched_step(
        &format!("stack of {name}"),
        Command::new("cargo")
            .args(["run", "--quiet", "--package", "emulated-board"])
            .args(["--example", "stack", "--"])
            .arg(binary)
            .args([image.stack.start, image.stack.end].map(|address| address.to_string()))
            .args(["selftest", &format!("scene {name}"), "render"])
            .current_dir(paths::root()),
        |line| line.clone_into(&mut last),
    )?;
    let bytes = last.trim().parse();
    bytes.with_context(|| format!("the stack of {name}: expected a number of bytes, got {last:?}"))
}

/// Draws a scene's frame on the virtual board with all blocks, which has no smooth shading: a scene with it is drawn by its own build.
fn frame(scene: &SceneFile) -> Result<Frame> {
    let name = scene.name();
    let needs = scene.needs();
    let board = if needs.smooth {
        let options = needs.options();
        let options: Vec<_> = options.iter().map(String::as_str).collect();
        gateware::build_beside(name, &options, Library::Quick)?
    } else {
        Board::Virtual.folder()
    };
    let folder = paths::target().join("scenes");
    fs::create_dir_all(&folder).with_context(|| format!("creating {}", folder.display()))?;
    let stats = folder.join(name).with_extension("json");
    run::step(
        &format!("frame of {name}"),
        Command::new(paths::target().join("debug/glint"))
            .args(["render", "--force", "--board", "virtual", "--scene", name])
            .arg("--stats")
            .arg(&stats)
            .arg("--out")
            .arg(stats.with_extension("png"))
            .env("GLINT_VIRTUAL_BOARD", board)
            .current_dir(paths::root()),
    )?;
    let text =
        fs::read_to_string(&stats).with_context(|| format!("reading {}", stats.display()))?;
    let stats: Stats = serde_json::from_str(&text)?;
    let rate = stats.clock as f64 / stats.cycles as f64;
    let engines = (stats.words_read + stats.words_written) as f64 * WORD * rate;
    let scan_out = scene.size().pixel_count() as f64 * PIXEL * REFRESH;
    Ok(Frame {
        stats,
        rate,
        memory: (engines + scan_out) / 1e6,
    })
}

/// The value of a row that a limit of a scene bounds; `None` for one that is not measured here.
fn value(row: &Row, name: &str) -> Option<f64> {
    match name {
        "cycles" => row.frame.as_ref().map(|frame| frame.stats.cycles as f64),
        "fps" => row.frame.as_ref().map(|frame| frame.rate),
        "firmware" => Some(row.firmware.image.length as f64),
        _ => {
            let column = COLUMNS.iter().find(|(_, limit)| *limit == name);
            column.map(|(resource, _)| row.size.of(*resource))
        }
    }
}

/// Fails if a row is beyond a limit of its scene: `fps` is a minimum, all others are maxima. A single scene's firmware is
/// limited to [`FIRMWARE_SHARE`] of the `full` bytes with all parts.
fn within(rows: &[Row], full: f64) -> Result<()> {
    let mut lines = Vec::new();
    for row in rows {
        let length = row.firmware.image.length as f64;
        if row.is_single && length > FIRMWARE_SHARE * full {
            lines.push(format!(
                "{}: firmware: expected at most {:.0} % of the {} bytes with all parts, measured {}",
                row.name,
                100.0 * FIRMWARE_SHARE,
                number(full),
                number(length)
            ));
        }
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
    bail!("beyond the budgets of the scenes:\n{}", lines.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::row::tests::row;
    use super::*;

    #[test]
    fn fails_beyond_a_limit_and_above_half_of_the_firmware() {
        let full = 108_642.0;
        let lamp = |budget: &[(&'static str, f64)]| Row {
            budget: budget.to_vec(),
            ..row("lamp")
        };
        let kept = [("cycles", 1_354_166.0), ("fps", 60.0), ("lut", 1_234.0)];
        within(&[lamp(&kept)], full).unwrap();
        let beyond = lamp(&[("fps", 60.5), ("firmware", 54_320.0)]);
        assert_eq!(
            within(&[beyond], full - 1.0).unwrap_err().to_string(),
            "beyond the budgets of the scenes:\n\
             lamp: firmware: expected at most 50 % of the 108,641 bytes with all parts, measured 54,321\n\
             lamp: fps: budget 60.5, measured 60\n\
             lamp: firmware: budget 54320, measured 54,321"
        );
        let list = Row {
            is_single: false,
            ..lamp(&[])
        };
        within(&[list], full - 1.0).unwrap();
    }
}
