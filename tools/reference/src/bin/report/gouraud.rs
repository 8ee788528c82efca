//! The page `gouraud.md`: what smooth shading is off by, with and without the division at each pixel, and what it costs.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use glint_reference::smooth::{Measured, scenes};
use serde::{Deserialize, Serialize};

use crate::in_workspace;
use crate::table::Provenance;

#[derive(clap::Args)]
pub struct Arguments {
    /// Print the rows as JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Leave the gateware's cost out, which takes most of the time
    #[arg(long)]
    quick: bool,
    /// Folder for gouraud.csv and gouraud.md [default: docs/report, or target/report with --quick]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// A scene: a line of the CSV. Errors are in steps of a channel.
#[derive(Serialize)]
struct Row {
    scene: &'static str,
    triangles: u64,
    clipped: u64,
    back_faces: u64,
    pixels: u64,
    smallest_depth_code: u32,
    bound: f64,
    max_err: f64,
    rms: f64,
    rounded_max_err: f64,
    rounded_rms: f64,
    affine_max_err: f64,
    affine_rms: f64,
    commit: String,
}

impl Row {
    fn new(name: &'static str, bound: f64, measured: &Measured, commit: &str) -> Self {
        Self {
            scene: name,
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
            commit: commit.to_owned(),
        }
    }
}

/// The engine without and with smooth shading, as modules of `gateware/tests/run.py`.
const ENGINES: [(&str, &str); 2] = [
    ("flat", "triangle_engine"),
    ("flat and smooth", "triangle_engine_smooth"),
];

/// What Yosys counts in a module.
#[derive(Deserialize)]
struct Cost {
    logic: u32,
    srl: u32,
    lutram: u32,
    ff: u32,
    dsp48: u32,
    ramb36: u32,
    ramb18: u32,
    path: u32,
}

impl Cost {
    fn measure(module: &str) -> Result<Self> {
        let output = Command::new(in_workspace(".venv/bin/python"))
            .args(["gateware/tests/run.py", "--size", module])
            .current_dir(in_workspace(""))
            .output()
            .context("python: `cargo xtask bootstrap` makes the Python environment")?;
        let text = String::from_utf8_lossy(&output.stdout);
        ensure!(output.status.success(), "the size of {module}: {text}");
        serde_json::from_str(&text).with_context(|| format!("not a size: `{text}`"))
    }
}

pub fn report(arguments: &Arguments) -> Result<()> {
    let provenance = Provenance::find();
    let rows: Vec<Row> = scenes()
        .iter()
        .map(|scene| {
            Row::new(
                scene.name,
                scene.bound,
                &scene.measure(),
                &provenance.commit,
            )
        })
        .collect();
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&rows)?);
    } else {
        print!("{}", table(&rows)?);
    }
    let costs = if arguments.quick {
        vec![]
    } else {
        let measure = |(name, module)| Ok((name, Cost::measure(module)?));
        ENGINES.into_iter().map(measure).collect::<Result<_>>()?
    };
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => in_workspace(if arguments.quick {
            "target/report"
        } else {
            "docs/report"
        }),
    };
    std::fs::create_dir_all(&out)
        .with_context(|| format!("cannot make the folder {}", out.display()))?;
    let mut csv = csv::Writer::from_path(out.join("gouraud.csv"))
        .with_context(|| format!("cannot write gouraud.csv to {}", out.display()))?;
    rows.iter().try_for_each(|row| csv.serialize(row))?;
    csv.flush()?;
    std::fs::write(out.join("gouraud.md"), page(&rows, &costs, &provenance)?)
        .with_context(|| format!("cannot write gouraud.md to {}", out.display()))?;
    eprintln!("wrote gouraud.csv and gouraud.md to {}", out.display());
    Ok(())
}

fn table(rows: &[Row]) -> Result<String> {
    let mut text = String::from(
        "| scene | triangles, clipped, back faces | pixels | smallest depth | bound | Glint: max, RMS | rounding alone: RMS | affine: max, RMS |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        writeln!(
            text,
            "| {} | {}, {}, {} | {} | {} | {:.3} | {:.3}, {:.3} | {:.3} | {:.1}, {:.2} |",
            row.scene,
            row.triangles,
            row.clipped,
            row.back_faces,
            row.pixels,
            row.smallest_depth_code,
            row.bound,
            row.max_err,
            row.rms,
            row.rounded_rms,
            row.affine_max_err,
            row.affine_rms,
        )?;
    }
    Ok(text)
}

fn page(rows: &[Row], costs: &[(&str, Cost)], provenance: &Provenance) -> Result<String> {
    let mut text = String::from(
        "# Smooth shading: error with and without the division\n\n\
         Generated by `cargo xtask report gouraud`; the same numbers are in [gouraud.csv](gouraud.csv).\n\n\
         Errors are in steps of a channel, of which red and blue have 32 and green 64, over all channels of all covered pixels, \
         each triangle drawn alone. The reference is the f64 quotient of the exact planes through the snapped vertices: light that is \
         linear on the triangle in space. Every result is rounded to a step, so half a step is always lost; *rounding alone* is the \
         reference itself, rounded. *Affine* is light that is linear on the screen, in f64 before its rounding: no table, no \
         multiplication at the pixel. The smallest depth is in codes; the bound is that of [formats.md](../formats.md), for \
         the smallest depth that the scene could have.\n\n",
    );
    text.push_str(&table(rows)?);
    writeln!(
        text,
        "\nWhat the division buys is seen where a triangle is long: on a model of many small triangles affine light is as good, on a \
         floor it is wrong by a third of the range. Beside the rounding the division itself costs next to nothing, on slivers and at \
         the end of the range of depths too."
    )?;
    if !costs.is_empty() {
        text.push_str(
            "\n## Cost\n\n\
             | engine | LUT | FF | DSP48 | RAMB36 | path |\n|---|---:|---:|---:|---:|---:|\n",
        );
    }
    for (name, cost) in costs {
        writeln!(
            text,
            "| {name} | {} | {} | {} | {:.1} | {} |",
            cost.logic + cost.srl + cost.lutram,
            cost.ff,
            cost.dsp48,
            f64::from(cost.ramb36) + f64::from(cost.ramb18) / 2.0,
            cost.path,
        )?;
    }
    writeln!(
        text,
        "\nA group of pixels takes a clock with and without; [triangle.md](../triangle.md) has the clocks of whole frames, \
         [resources.md](../resources.md) says what a path is.\n\n\
         Made at commit {} with {}.",
        provenance.commit, provenance.tools
    )?;
    Ok(text)
}
