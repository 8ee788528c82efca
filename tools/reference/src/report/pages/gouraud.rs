//! Builds the page `gouraud.md` of the report, on smooth shading.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, made, write};
use crate::report::experiments::gouraud::{Cost, Row};
use crate::report::table::{Table, read_csv, read_optional_csv};

/// Rebuilds the page from the CSV files in `folder`.
///
/// # Errors
/// When a table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let rows: Vec<Row> = read_csv(&folder.join("gouraud.csv"))?;
    let costs: Vec<Cost> = read_optional_csv(&folder.join("gouraud-cost.csv"))?;
    let made = rows
        .first()
        .map_or_else(String::new, |row| made(&row.commit, &row.tools));
    let page = fill(
        include_str!("gouraud.md"),
        &[
            ("table", table(&rows)),
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

fn cost_table(costs: &[Cost]) -> String {
    if costs.is_empty() {
        return "Not measured.".to_owned();
    }
    let mut table = Table::new(["engine", "LUT:", "FF:", "DSP48:", "RAMB36:", "path:"]);
    for cost in costs {
        table.row([
            cost.engine.clone(),
            cost.lut.to_string(),
            cost.ff.to_string(),
            cost.dsp.to_string(),
            format!("{:.1}", cost.bram),
            cost.path.to_string(),
        ]);
    }
    table.finish()
}
