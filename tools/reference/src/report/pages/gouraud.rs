//! Builds the page `gouraud.md` of the report, on smooth shading.

pub mod variants;

use std::path::Path;

use anyhow::Result;

use super::template::{fill, made, write};
use crate::report::experiments::gouraud::clocks;
use crate::report::experiments::gouraud::engines::Cost;
use crate::report::experiments::gouraud::scenes::Row;
use crate::report::plot::{self, Diagram};
use crate::report::table::{Table, read_csv, read_optional_csv};
use variants::{CLOCKS_SCENE, Variant};

const ERROR: &str =
    "RMS of the errors before the last rounding, in steps of a channel, in the worst scene";

const CLOCKS: Diagram = Diagram {
    title: "Smooth shading: clocks against error",
    across: ERROR,
    up: "clocks of the rasterizer for a pixel of icosphere:6",
};

const LUTS: Diagram = Diagram {
    title: "Smooth shading: LUTs against error",
    across: ERROR,
    up: "LUTs in addition to an engine with flat shading",
};

/// Rebuilds the page and its diagrams from the CSV files in `folder`.
///
/// # Errors
/// When a table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let rows: Vec<Row> = read_csv(&folder.join("gouraud.csv"))?;
    let forms = read_csv(&folder.join("gouraud-forms.csv"))?;
    let clocks: Vec<clocks::Row> = read_csv(&folder.join("gouraud-clocks.csv"))?;
    let costs: Vec<Cost> = read_optional_csv(&folder.join("gouraud-cost.csv"))?;
    let variants = variants::read(&forms, &clocks, &costs);
    let points = variants
        .iter()
        .map(|variant| variant.point(variant.clocks(CLOCKS_SCENE)));
    plot::write(
        &CLOCKS,
        &points.collect::<Vec<_>>(),
        &folder.join("gouraud-clocks.svg"),
    )?;
    let sized = variants
        .iter()
        .filter(|variant| variant.resources.is_some());
    let points = sized.map(|variant| variant.point(variant.luts()));
    plot::write(
        &LUTS,
        &points.collect::<Vec<_>>(),
        &folder.join("gouraud-luts.svg"),
    )?;
    let made = rows
        .first()
        .map_or_else(String::new, |row| made(&row.commit, &row.tools));
    let page = fill(
        include_str!("gouraud.md"),
        &[
            ("table", table(&rows)),
            ("forms", variant_table(&variants)),
            ("pictures", picture_table(&clocks)),
            ("rule error", format!("{:.1}", 100.0 * rule_error(&clocks))),
            ("costs", cost_table(&costs)),
            ("made", made),
        ],
    )?;
    write(&page, &folder.join("gouraud.md"))
}

/// Formats the table of the scenes' errors as Markdown.
pub fn table(rows: &[Row]) -> String {
    let mut table = Table::new([
        "scene",
        "triangles, clipped, back faces",
        "pixels",
        "smallest depth",
        "bound",
        "Glint: max, RMS",
        "rounding alone: RMS",
        "affine: max, RMS",
    ]);
    for row in rows {
        table.row([
            row.scene.clone(),
            format!("{}, {}, {}", row.triangles, row.clipped, row.back_faces),
            row.pixels.to_string(),
            row.smallest_depth_code.to_string(),
            format!("{:.3}", row.bound),
            format!("{:.3}, {:.3}", row.max_err, row.rms),
            format!("{:.3}", row.rounded_rms),
            format!("{:.1}, {:.2}", row.affine_max_err, row.affine_rms),
        ]);
    }
    table.finish()
}

fn variant_table(variants: &[Variant]) -> String {
    let mut table = Table::new([
        "form",
        "rate",
        "largest error: common, stiff scenes",
        "whole steps",
        "channels off",
        "clocks a pixel: icosphere:6, icosphere:2, inside it",
        "LUT:",
        "DSP48:",
    ]);
    for variant in variants {
        table.row(variant.cells());
    }
    table.finish()
}

fn picture_table(rows: &[clocks::Row]) -> String {
    let mut table = Table::new([
        "scene",
        "triangles:",
        "pixels:",
        "groups:",
        "a group a clock:",
        "a division a clock:",
        "two pixels a clock:",
        "a pixel a clock:",
    ]);
    for rows in rows.chunk_by(|a, b| a.scene == b.scene) {
        let clocks = |rate| {
            let row = rows.iter().find(|row| row.rate == rate);
            row.map_or_else(String::new, |row| {
                variants::italic(row.clocks, !row.measured)
            })
        };
        if let [row, ..] = rows {
            table.row([
                row.scene.clone(),
                row.triangles.to_string(),
                row.pixels.to_string(),
                row.groups.to_string(),
                clocks(clocks::GROUPS),
                clocks(clocks::ENDS),
                clocks(clocks::PAIRS),
                clocks(clocks::SHIPPED),
            ]);
        }
    }
    table.finish()
}

/// Returns the largest relative difference between computed and measured clocks, of rates that have both.
fn rule_error(rows: &[clocks::Row]) -> f64 {
    let measured = rows.iter().filter(|row| row.measured);
    let errors = measured.filter_map(|measured| {
        let computed = rows.iter().find(|row| {
            !row.measured && (&row.rate, &row.scene) == (&measured.rate, &measured.scene)
        })?;
        Some((computed.clocks as f64 / measured.clocks as f64 - 1.0).abs())
    });
    errors.fold(0.0, f64::max)
}

fn cost_table(costs: &[Cost]) -> String {
    if costs.is_empty() {
        return "Not measured.".to_owned();
    }
    let mut table = Table::new([
        "engine", "commit", "shading", "LUT:", "FF:", "DSP48:", "RAMB36:", "path:",
    ]);
    for cost in costs {
        table.row([
            cost.engine.clone(),
            cost.commit.clone(),
            cost.shading.clone(),
            cost.lut.to_string(),
            cost.ff.to_string(),
            cost.dsp.to_string(),
            format!("{:.1}", cost.bram),
            cost.path.to_string(),
        ]);
    }
    table.finish()
}
