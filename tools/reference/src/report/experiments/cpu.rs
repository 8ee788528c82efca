//! Experiment: the variants of the soft core, VexRiscv. Clock rate and cells of each alone, and the cycles of frames on a SoC with it.

use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use glint::board::built_firmware;
use glint::render::Stats;
use glint::scene::Changes;
use glint_scene_file::{SceneFile, built_in};
use litex_pac::variant::{VARIANTS, Variant};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::report::progress;
use crate::report::soc;
use crate::report::workspace;

/// The scenes: a mesh, a field of two eyes, a mesh whose descriptors the soft core makes, many spheres, and a program of segments.
const SCENES: [&str; 5] = [
    "holoforge",
    "poor-mans-vr",
    "simplegpu",
    "spheres",
    "wireframe",
];

/// Name of the default variant's block; every measurement of clock rates includes this block.
const REFERENCE: &str = "vexriscv";

/// Clock rate and cells of a variant: a line of `cpu-cores.csv`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Core {
    /// Name of the variant.
    pub variant: String,
    /// Clock rate on an ECP5 in MHz, the median of the placer's seeds.
    pub mhz: f64,
    /// Lowest clock rate of the seeds.
    pub mhz_min: f64,
    /// Highest clock rate of the seeds.
    pub mhz_max: f64,
    /// LUTs of the XC7S50, including those used as memory.
    pub lut: u32,
    /// Flip-flops.
    pub ff: u32,
    /// DSP48 slices.
    pub dsp48: u32,
    /// Block RAMs, in units of 36 Kbit.
    pub ramb36: f64,
}

/// Cycles of a frame: a line of `cpu.csv`.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    /// Name of the variant.
    pub variant: String,
    /// Features of the firmware, with a `+` between them.
    pub features: String,
    /// Name of the scene.
    pub scene: String,
    /// Width of the frame in pixels.
    pub width: u32,
    /// Number of cycles of the frame, if no other frame is drawn at the same time.
    pub cycles: u64,
    /// Number of cycles outside of the engines' passes.
    pub soft_core: u64,
}

/// Measures clock rates and cells of the variants whose names contain `only`, with `gateware/resources`.
///
/// # Errors
/// When a measurement fails.
pub fn cores(only: &str) -> Result<Vec<Core>> {
    let names: Vec<&str> = selection(only).map(|variant| variant.name).collect();
    let block = |name: &str| format!("{REFERENCE}_{name}");
    let routed = |name: &str| match name == VARIANTS[0].name {
        true => REFERENCE.to_owned(),
        false => block(name),
    };
    let blocks = |block: &dyn Fn(&str) -> String| names.iter().copied().map(block).collect();
    let Sizes { blocks: sizes } = measured(&[], blocks(&block))?;
    let Rates { routed: rates } = measured(&["--route"], blocks(&routed))?;
    let core = |name: &str| {
        let size = sizes.iter().find(|size| size.name == block(name));
        let size = size.with_context(|| format!("no size of {name}"))?;
        let rate = rates.iter().find(|rate| rate.name == routed(name));
        let rate = rate.with_context(|| format!("no clock rate of {name}"))?;
        let seeds = rate.seeds.iter().copied();
        Ok(Core {
            variant: name.to_owned(),
            mhz: rate.mhz,
            mhz_min: seeds.clone().fold(f64::INFINITY, f64::min),
            mhz_max: seeds.fold(0.0, f64::max),
            lut: size.lut,
            ff: size.ff,
            dsp48: size.dsp48,
            ramb36: size.ramb36,
        })
    };
    names.iter().copied().map(core).collect()
}

/// Measures a frame of each scene on a virtual board with each variant whose name contains `only`, and on a board with the default variant
/// and the firmware for variants without a cycle counter. Two boards run at a time.
///
/// # Errors
/// A board is not built, or a frame differs from the model's.
pub fn frames(only: &str) -> Result<Vec<Row>> {
    let default = VARIANTS[0];
    let counterless = Variant {
        features: &["uptime"],
        ..default
    };
    let counterless = Some(counterless).filter(|variant| variant.name.contains(only));
    let mut runs = Vec::new();
    for variant in selection(only).chain(counterless) {
        for name in SCENES {
            let scene = built_in(name).with_context(|| format!("no scene {name}"))?;
            runs.push((variant, scene));
        }
    }
    let bar = progress::bar(runs.len() as u64)?;
    let rows = soc::two_at_a_time(&runs, |(variant, scene)| {
        let name = format!("{} on {}", scene.name(), variant.name);
        bar.set_message(name.clone());
        let row = frame(*variant, scene).with_context(|| name);
        bar.inc(1);
        row
    })?;
    bar.finish_and_clear();
    Ok(rows)
}

/// The variants whose names contain `only`.
fn selection(only: &str) -> impl Iterator<Item = Variant> {
    let variants = VARIANTS.into_iter();
    variants.filter(move |variant| variant.name.contains(only))
}

fn frame(variant: Variant, scene: &SceneFile) -> Result<Row> {
    let folder = match variant.name == VARIANTS[0].name {
        true => "virtual".to_owned(),
        false => format!("virtual-cpu-{}", variant.name),
    };
    let image = [&["glint"], variant.features].concat().join("-");
    let image = workspace::path(&format!("target/firmware/{image}.bin"));
    let firmware = built_firmware(Some(&image))?;
    let stats: Stats = soc::frame_on(&folder, &firmware, scene, &Changes::default())?;
    Ok(Row {
        variant: variant.name.to_owned(),
        features: variant.features.join("+"),
        scene: scene.name().to_owned(),
        width: scene.size().width(),
        cycles: stats.cycles.context("no cycles in the reply")?,
        soft_core: stats.engine.get("cycles_soft_core")?,
    })
}

/// Output of the program `resources` for sizes in cells.
#[derive(Deserialize)]
struct Sizes {
    blocks: Vec<Size>,
}

/// Cells of a block.
#[derive(Deserialize)]
struct Size {
    name: String,
    lut: u32,
    ff: u32,
    dsp48: u32,
    ramb36: f64,
}

/// Output of the program `resources` for clock rates.
#[derive(Deserialize)]
struct Rates {
    routed: Vec<Rate>,
}

/// Clock rate of a block in MHz: the median, and of each seed.
#[derive(Deserialize)]
struct Rate {
    name: String,
    mhz: f64,
    seeds: Vec<f64>,
}

/// Runs the program `resources` on blocks, and returns its results. Its progress goes to standard error.
fn measured<T: DeserializeOwned>(options: &[&str], blocks: Vec<String>) -> Result<T> {
    let output = Command::new(workspace::path(".venv/bin/python"))
        .args(["-m", "resources", "--json"])
        .args(options)
        .args(&blocks)
        .env("PYTHONPATH", workspace::path("gateware"))
        .stderr(Stdio::inherit())
        .output()
        .context("cannot run the program `resources`: run `cargo xtask bootstrap`")?;
    ensure!(
        output.status.success(),
        "the program `resources` failed, for {}",
        blocks.join(" ")
    );
    let text = String::from_utf8_lossy(&output.stdout);
    serde_json::from_str(&text).with_context(|| format!("expected results in JSON, found `{text}`"))
}
