//! Names of the measured blocks.

use std::fs;

use anyhow::{Context, Result};

use crate::paths;

/// This project's own blocks. The block that takes longest to measure comes first.
pub const OWN: [&str; 11] = [
    "ring_lane",
    "setup",
    "triangle_raster",
    "band_buffer",
    "scanout",
    "vertex_stage",
    "line_setup",
    "line_raster",
    "gesture_engine",
    "i2c_engine",
    "flash_reader",
];

/// Engines that consist of the blocks in `OWN`, in several builds, and parts of the raymarcher. The tables list them, but they
/// take too long to be measured by `cargo xtask test`.
pub const BUILDS: [&str; 10] = [
    "triangle_engine_smooth",
    "raymarcher",
    "triangle_engine",
    "raymarcher_sponge",
    "raymarcher_round",
    "raymarcher_faces",
    "ring_lane_all",
    "ray_generator",
    "ray_paint",
    "round_light",
];

/// Engines of the Urbana's default build, which the page shows placed and routed besides [`OWN`].
pub const ENGINES: [&str; 2] = ["triangle_engine", "raymarcher_faces"];

/// The modules of the raymarcher's fields: the files `field_*.sv`, except `field_unit.sv`, which contains all of them.
///
/// # Errors
/// The folder cannot be read.
pub fn fields() -> Result<Vec<String>> {
    let folder = paths::root().join("gateware/rtl/raymarch");
    let files = fs::read_dir(&folder).with_context(|| format!("reading {}", folder.display()))?;
    let mut names = Vec::new();
    for file in files {
        let path = file?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        if name.starts_with("field_") && name != "field_unit" {
            names.push(name.into_owned());
        }
    }
    names.sort();
    Ok(names)
}

/// Blocks that together are the smallest triangle engine, which draws triangles of one colour each.
pub const FLAT_PARTS: [&str; 3] = ["vertex_stage", "setup", "triangle_raster"];
/// Name of the block that is the sum of [`FLAT_PARTS`].
pub const FLAT: &str = "flat_build";

/// Name of the whole design in the Urbana's FPGA.
pub const SOC: &str = "soc";

/// The blocks in the order of their rows in the tables. Other measured modules come after them.
pub const ROWS: [&str; 26] = [
    "scanout",
    "i2c_engine",
    "flash_reader",
    "vertex_stage",
    "setup",
    "triangle_raster",
    FLAT,
    "line_setup",
    "line_raster",
    "gesture_engine",
    "band_buffer",
    "triangle_engine",
    "triangle_engine_smooth",
    "field_menger",
    "field_box",
    "field_sphere",
    "ring_lane",
    "ring_lane_all",
    "ray_generator",
    "round_light",
    "ray_paint",
    "raymarcher",
    "raymarcher_round",
    "raymarcher_faces",
    "raymarcher_sponge",
    SOC,
];

/// Sorts results of blocks into the order of the tables.
pub fn sort_by_row<T>(results: &mut [T], name: impl Fn(&T) -> &str) {
    results.sort_by_key(|result| {
        let row = ROWS.iter().position(|row| *row == name(result));
        row.unwrap_or(ROWS.len())
    });
}
