//! Experiment: errors of smooth shading, and the FPGA resources of the triangle engine with and without it.

use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};

use crate::report::provenance::Provenance;
use crate::report::workspace;
use crate::triangle::smooth::{Measured, scenes};

/// Errors of a scene: a line of `gouraud.csv`. Errors are in steps of a colour channel of RGB565.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Description of the scene.
    pub scene: String,
    /// Number of drawn triangles: whole triangles, and those that the clipper made.
    pub triangles: u64,
    /// Number of drawn triangles that the clipper made.
    pub clipped: u64,
    /// Number of drawn triangles that show their back face.
    pub back_faces: u64,
    /// Number of covered pixels, summed over the triangles.
    pub pixels: u64,
    /// Smallest depth code of a covered pixel.
    pub smallest_depth_code: u32,
    /// Upper bound of the model's error (docs/formats.md, "Smooth shading", plus half a step for the last rounding).
    pub bound: f64,
    /// Largest error of the model's colours.
    pub max_err: f64,
    /// RMS of the errors of the model's colours.
    pub rms: f64,
    /// Largest error of the exact colours after rounding to whole steps.
    pub rounded_max_err: f64,
    /// RMS of the errors of the exact colours after rounding to whole steps.
    pub rounded_rms: f64,
    /// Largest error of colours that are interpolated linearly on the screen, without the division by depth.
    pub affine_max_err: f64,
    /// RMS of the errors of colours that are interpolated linearly on the screen.
    pub affine_rms: f64,
    /// Commit with which the scene was measured.
    pub commit: String,
    /// Versions of the tools with which the scene was measured.
    pub tools: String,
}

impl Row {
    fn new(name: &str, bound: f64, measured: &Measured, provenance: &Provenance) -> Self {
        Self {
            scene: name.to_owned(),
            triangles: measured.triangles,
            clipped: measured.clipped,
            back_faces: measured.back,
            pixels: measured.pixels,
            smallest_depth_code: measured.farthest,
            bound,
            max_err: measured.model.max,
            rms: measured.model.rms(),
            rounded_max_err: measured.rounded.max,
            rounded_rms: measured.rounded.rms(),
            affine_max_err: measured.affine.max,
            affine_rms: measured.affine.rms(),
            commit: provenance.commit.clone(),
            tools: provenance.tools.clone(),
        }
    }
}

/// Measures the errors of all scenes.
pub fn measure() -> Vec<Row> {
    let provenance = Provenance::find();
    scenes()
        .iter()
        .map(|scene| Row::new(scene.name, scene.bound, &scene.measure(), &provenance))
        .collect()
}

/// The triangle engines with flat shading alone and with both kinds of shading: each with a description of its shading and
/// with the module's name in `gateware/tests/run.py`.
const ENGINES: [(&str, &str); 2] = [
    ("flat", "triangle_engine"),
    ("flat and smooth", "triangle_engine_smooth"),
];

/// Resources of a triangle engine: a line of `gouraud-cost.csv`.
#[derive(Serialize, Deserialize)]
pub struct Cost {
    /// The kinds of shading that the engine supports.
    pub engine: String,
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
}

/// Numbers of cells of a module by their kind, and the length of the longest path, as found by Yosys.
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
}

/// Synthesises each of the `ENGINES` and returns its resources.
///
/// # Errors
/// When the synthesis fails.
pub fn costs() -> Result<Vec<Cost>> {
    ENGINES
        .into_iter()
        .map(|(engine, module)| {
            let cells = cells(module)?;
            Ok(Cost {
                engine: engine.to_owned(),
                lut: cells.logic + cells.srl + cells.lutram,
                ff: cells.ff,
                dsp: cells.dsp48,
                bram: f64::from(cells.ramb36) + f64::from(cells.ramb18) / 2.0,
                path: cells.path,
            })
        })
        .collect()
}

fn cells(module: &str) -> Result<Cells> {
    let output = Command::new(workspace::path(".venv/bin/python"))
        .args(["gateware/tests/run.py", "--size", module])
        .current_dir(workspace::path(""))
        .output()
        .context("cannot run .venv/bin/python: run `cargo xtask bootstrap`")?;
    let text = String::from_utf8_lossy(&output.stdout);
    ensure!(output.status.success(), "the size of {module}: {text}");
    serde_json::from_str(&text).with_context(|| format!("expected a size in JSON, found `{text}`"))
}
