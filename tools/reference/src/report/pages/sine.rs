//! Builds the page `sine.md` of the report, on kernels of sine and cosine.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, made, write};
use crate::report::experiments::sine::{Reference, Row};
use crate::report::plot::{self, Diagram, Point};
use crate::report::table::{Table, bold, read_csv};

const DIAGRAM: Diagram = Diagram {
    title: "Sine and cosine: cycles against largest error",
    across: "largest absolute error, over all inputs",
    up: "median cycles of a call on the SoC",
};

/// Rebuilds the page and its diagram from the CSV files in `folder`.
///
/// # Errors
/// When a table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let rows: Vec<Row> = read_csv(&folder.join("sine.csv"))?;
    let reference: Vec<Reference> = read_csv(&folder.join("sine-reference.csv"))?;
    plot::write(&DIAGRAM, &points(&rows), &folder.join("sine.svg"))?;
    write(&page(&rows, &reference)?, &folder.join("sine.md"))
}

/// Formats the table of the kernels' errors and cycles as Markdown.
pub fn table(rows: &[Row]) -> String {
    let mut table = Table::new([
        "kernel",
        "config",
        "output",
        "inputs",
        "max error",
        "ULP",
        "bits",
        "worst at",
        "RMS",
        "p99",
        "bias",
        "cycles",
    ]);
    for row in rows {
        table.row([
            bold(&row.kernel, row.shipped),
            row.config.clone(),
            row.word_length.clone(),
            row.inputs.clone(),
            format!("{:.3e}", row.max_err),
            format!("{:.3}", row.max_ulp),
            format!("{:.1}", row.bits()),
            row.argmax.clone(),
            format!("{:.2e}", row.rms),
            format!("{:.2e}", row.p99),
            format!("{:+.1e}", row.bias),
            match (row.cycles_min, row.cycles_median, row.cycles_max) {
                (Some(min), Some(median), Some(max)) => format!("{min} / {median} / {max}"),
                _ => "not measured".to_owned(),
            },
        ]);
    }
    table.finish()
}

fn identities(rows: &[Row]) -> String {
    let mut table = Table::new([
        "kernel",
        "config",
        "largest \\|sin² + cos² − 1\\|",
        "angles that break a symmetry of the circle",
    ]);
    for row in rows {
        table.row([
            row.kernel.clone(),
            format!("{}, {}", row.config, row.word_length),
            format!("{:.2e}", row.max_norm),
            row.asymmetric
                .map_or("not checked".to_owned(), |count| count.to_string()),
        ]);
    }
    table.finish()
}

fn page(rows: &[Row], reference: &[Reference]) -> Result<String> {
    let missing: Vec<&str> = rows
        .iter()
        .filter(|row| row.cycles_median.is_none())
        .map(|row| row.kernel.as_str())
        .collect();
    let missing = match missing[..] {
        [] => String::new(),
        _ => format!(
            "- No cycles, because not run on the SoC: {}.",
            missing.join(", ")
        ),
    };
    let error = reference.iter().map(|row| row.max_err).fold(0.0, f64::max);
    fill(
        include_str!("sine.md"),
        &[
            ("table", table(rows)),
            ("identities", identities(rows)),
            ("reference error", format!("{error:.1e}")),
            ("missing cycles", missing),
            (
                "made",
                rows.first()
                    .map_or_else(String::new, |row| made(&row.commit, &row.tools)),
            ),
        ],
    )
}

/// Returns the points of the diagram, one for each kernel. If a kernel has several rows, its point is made from the last row.
fn points(rows: &[Row]) -> Vec<Point> {
    let mut last: Vec<&Row> = Vec::new();
    for row in rows {
        last.retain(|other| other.kernel != row.kernel);
        last.push(row);
    }
    last.into_iter()
        .map(|row| Point {
            family: row.family.clone(),
            label: match row.cycles_median {
                Some(_) => format!("{} {}", row.kernel, row.word_length),
                None => row.kernel.clone(),
            },
            error: row.max_err,
            cost: row.cycles_median.map(|cycles| cycles as f64),
            shipped: row.shipped,
        })
        .collect()
}
