//! Builds the page `geometry.md` of the report, on errors of the geometry before rasterization.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, made, write};
use crate::report::experiments::geometry::{drift, precision};
use crate::report::plot::{self, Diagram, Point};
use crate::report::table::{Table, bold, read_csv};

const DIAGRAM: Diagram = Diagram {
    title: "Matrices, normals and projection: cycles against error",
    across: "largest error, in the unit of the kernel's table",
    up: "median cycles of a call on the SoC",
};

/// Rebuilds the page and its diagram from the CSV files in `folder`.
///
/// # Errors
/// When a table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let kernels: Vec<precision::Row> = read_csv(&folder.join("geometry-precision.csv"))?;
    let rows: Vec<drift::Row> = read_csv(&folder.join("geometry-drift.csv"))?;
    plot::write(&DIAGRAM, &points(&kernels), &folder.join("geometry.svg"))?;
    let of = |family: &str| {
        let rows = kernels.iter().filter(|row| row.family == family);
        kernel_table(rows)
    };
    let made = kernels
        .first()
        .map_or_else(String::new, |row| made(&row.commit, &row.tools));
    let page = fill(
        include_str!("geometry.md"),
        &[
            ("matrices", of("matrix")),
            ("normals", of("normal")),
            ("projections", of("projection")),
            ("drift", table(&rows)),
            ("made", made),
        ],
    )?;
    write(&page, &folder.join("geometry.md"))
}

fn points(kernels: &[precision::Row]) -> Vec<Point> {
    let point = |row: &precision::Row| Point {
        family: row.family.clone(),
        label: row.config.clone(),
        error: row.max_err,
        cost: row.cycles_median.map(|cycles| cycles as f64),
        shipped: row.shipped,
    };
    kernels.iter().map(point).collect()
}

/// Formats the errors and cycles of kernels as Markdown.
pub fn kernel_table<'r>(rows: impl IntoIterator<Item = &'r precision::Row>) -> String {
    let mut table = Table::new([
        "word length, method",
        "largest error:",
        "RMS:",
        "cycles, median:",
        "least to most:",
    ]);
    for row in rows {
        let cycles = row.cycles_median.map(|cycles| cycles.to_string());
        let range = row.cycles_min.zip(row.cycles_max);
        let range = range.map(|(least, most)| format!("{least} to {most}"));
        let missing = || "not measured".to_owned();
        table.row([
            bold(&row.config, row.shipped),
            format!("{:.2e}", row.max_err),
            format!("{:.2e}", row.rms),
            cycles.unwrap_or_else(missing),
            range.unwrap_or_else(missing),
        ]);
    }
    table.finish()
}

/// Formats the table of the drift as Markdown: a line for each session and form, with the errors after each number of steps.
pub fn table(rows: &[drift::Row]) -> String {
    let mut table = Table::new([
        "rotations",
        "motion",
        "1:",
        "10:",
        "100:",
        "1,000:",
        "10,000:",
        "growth:",
    ]);
    for line in rows.chunk_by(|a, b| (&a.session, &a.form) == (&b.session, &b.form)) {
        let error = |steps| {
            let row = line.iter().find(|row| row.steps == steps);
            row.map_or_else(String::new, |row| format!("{:.1e}", row.max_err))
        };
        if let [first, .., last] = line {
            table.row([
                first.session.clone(),
                first.form.clone(),
                error(1),
                error(10),
                error(100),
                error(1_000),
                error(10_000),
                format!("{:+.3} %", 100.0 * last.growth),
            ]);
        }
    }
    table.finish()
}
