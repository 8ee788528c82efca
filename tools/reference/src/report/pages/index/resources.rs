//! The blocks of the gateware: their resources, read from the tables of docs/resources.md, and what they compute.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};

use crate::report::table::Table;

/// What a block computes, how exact it is, and the page with its figures.
const ACCELERATORS: [(&str, &str, &str, &str); 14] = [
    (
        "vertex_stage",
        "positions on the screen and depths of vertices",
        "rounding of its words",
        "report/kernels.md#number-formats-of-the-pipeline",
    ),
    (
        "setup",
        "edges, planes and light of triangles",
        "edges exact, planes rounded",
        "formats/triangle.md#pixels",
    ),
    (
        "triangle_raster",
        "pixels of triangles",
        "exact",
        "report/triangle.md",
    ),
    (
        "triangle_engine",
        "triangles with flat shading",
        "coverage exact, depth rounded",
        "report/triangle.md",
    ),
    (
        "triangle_engine_smooth",
        "triangles with flat and smooth shading",
        "colours rounded",
        "report/gouraud.md",
    ),
    ("line_setup", "segments of wireframes", "exact", "line.md"),
    ("line_raster", "pixels of segments", "exact", "line.md"),
    (
        "raymarcher",
        "all distance fields, two lanes",
        "by its threshold of a hit",
        "report/raymarch.md",
    ),
    (
        "ring_lane",
        "a lane of rays for the sponge",
        "distances rounded down",
        "report/raymarch.md",
    ),
    (
        "field_sphere",
        "distances to spheres",
        "rounded down",
        "report/kernels.md#length-of-a-vector",
    ),
    (
        "gesture_engine",
        "sums of a hand's pixels",
        "exact",
        "report/gesture.md",
    ),
    (
        "band_buffer",
        "pixels and depths of a band of rows",
        "exact",
        "triangle.md",
    ),
    (
        "scanout",
        "the picture on the monitor",
        "exact",
        "scanout.md",
    ),
    (
        "i2c_engine",
        "transfers of a sensor's bytes",
        "exact",
        "imu.md",
    ),
];

/// Resources of blocks, by the blocks' names.
pub struct Blocks(BTreeMap<String, Resources>);

#[derive(Clone)]
struct Resources {
    lut: String,
    ff: String,
    dsp: String,
    bram: String,
}

impl Blocks {
    /// Reads the first table of docs/resources.md.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let text =
            std::fs::read_to_string(path).with_context(|| format!("reading {}", path.display()))?;
        let mut blocks = BTreeMap::new();
        let first = text.lines().skip_while(|line| !line.starts_with('|'));
        for line in first.take_while(|line| line.starts_with('|')) {
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            if let ["", name, lut, _, _, _, ff, dsp, bram, ..] = cells[..] {
                let [lut, ff, dsp, bram] = [lut, ff, dsp, bram].map(str::to_owned);
                blocks.insert(name.to_owned(), Resources { lut, ff, dsp, bram });
            }
        }
        Ok(Self(blocks))
    }

    fn of(&self, block: &str) -> Result<&Resources> {
        let found = self.0.get(block);
        found.with_context(|| format!("docs/resources.md: expected a row of the block {block}"))
    }

    /// Formats LUTs and DSP48 of a block.
    ///
    /// # Errors
    /// When docs/resources.md has no such block.
    pub fn cells(&self, block: &str) -> Result<String> {
        let Resources { lut, dsp, .. } = self.of(block)?;
        Ok(format!("`{block}`: {lut}, {dsp}"))
    }

    /// Formats the table of the accelerators as Markdown.
    ///
    /// # Errors
    /// When docs/resources.md lacks a block.
    pub fn table(&self) -> Result<String> {
        let mut table = Table::new([
            "block", "computes", "error", "LUT:", "FF:", "DSP48:", "RAMB36:",
        ]);
        for (block, computes, error, page) in ACCELERATORS {
            let Resources { lut, ff, dsp, bram } = self.of(block)?.clone();
            table.row([
                format!("[{block}](../{page})"),
                computes.to_owned(),
                error.to_owned(),
                lut,
                ff,
                dsp,
                bram,
            ]);
        }
        Ok(table.finish())
    }
}
