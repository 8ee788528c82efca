//! Builds the page `kernels.md` of the report, on small kernels and on number formats.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, made, write};
use crate::report::experiments::kernels::Row;
use crate::report::plot::{self, Diagram, Point};
use crate::report::table::{Table, bold, optional, read_csv};

const CYCLES: &str = "median cycles of a call on the SoC";
const RELATIVE: &str = "largest relative error";

/// A family of kernels: its name in the table, the name of its diagram, and its axes.
pub struct Family {
    /// Name in the column `family`.
    pub name: &'static str,
    /// The diagram's file is `kernels-FILE.svg`.
    file: &'static str,
    diagram: Diagram,
}

/// The families with diagrams, in the order of the page.
pub const FAMILIES: [Family; 9] = [
    family(
        "reciprocal",
        "reciprocal",
        "Reciprocal 1/x",
        RELATIVE,
        CYCLES,
    ),
    family(
        "inverse root",
        "inverse-root",
        "Reciprocal square root",
        RELATIVE,
        CYCLES,
    ),
    family("root", "root", "Square root", RELATIVE, CYCLES),
    family("division", "division", "Quotient a/b", RELATIVE, CYCLES),
    family("length", "length", "Length of a vector", RELATIVE, CYCLES),
    family(
        "unit",
        "unit",
        "Vector scaled to length 1",
        "largest error of a component",
        CYCLES,
    ),
    family(
        "depth",
        "depth",
        "Stored depth",
        "largest relative error of the depth",
        "bits of a depth",
    ),
    family(
        "colour",
        "colour",
        "Stored colour",
        "largest error of a channel, in 1/255",
        "bits of a pixel",
    ),
    family(
        "format",
        "format",
        "Words of the pipeline",
        "largest error, in pixels or in 1/255 of the light",
        "bits of a word",
    ),
];

const fn family(
    name: &'static str,
    file: &'static str,
    title: &'static str,
    across: &'static str,
    up: &'static str,
) -> Family {
    Family {
        name,
        file,
        diagram: Diagram { title, across, up },
    }
}

/// Rebuilds the page and its diagrams from the CSV file in `folder`.
///
/// # Errors
/// When the table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let rows: Vec<Row> = read_csv(&folder.join("kernels.csv"))?;
    let mut values = Vec::new();
    for family in &FAMILIES {
        let rows: Vec<Row> = of(&rows, family.name);
        let file = format!("kernels-{}.svg", family.file);
        plot::write(&family.diagram, &points(&rows), &folder.join(&file))?;
        values.push((family.file, table(&rows)));
    }
    let made = rows
        .first()
        .map_or_else(String::new, |row| made(&row.commit, &row.tools));
    values.push(("made", made));
    write(
        &fill(include_str!("kernels.md"), &values)?,
        &folder.join("kernels.md"),
    )
}

/// The rows of a family.
pub fn of(rows: &[Row], family: &str) -> Vec<Row> {
    rows.iter()
        .filter(|row| row.family == family)
        .cloned()
        .collect()
}

/// Formats errors and costs of kernels as Markdown.
pub fn table(rows: &[Row]) -> String {
    let in_cycles = rows
        .iter()
        .any(|row| row.cycles_median.is_some() && row.bits.is_none());
    let mut table = Table::new([
        "word length, method",
        "largest error:",
        "at",
        "RMS:",
        if in_cycles { "cycles:" } else { "bits:" },
        "inputs:",
    ]);
    for row in rows {
        let cycles = match (row.cycles_min, row.cycles_median, row.cycles_max) {
            (Some(min), Some(median), Some(max)) => format!("{min} / {median} / {max}"),
            _ => "not measured".to_owned(),
        };
        table.row([
            bold(&row.config, row.shipped),
            format!("{:.2e}", row.max_err),
            row.argmax.clone(),
            format!("{:.2e}", row.rms),
            if in_cycles {
                cycles
            } else {
                optional(row.bits)
            },
            row.samples.to_string(),
        ]);
    }
    table.finish()
}

/// Returns the points of a diagram. Kernels of other libraries, those by Newton steps, and the numbers of a stage are families; all
/// other kernels are single points.
pub fn points(rows: &[Row]) -> Vec<Point> {
    let point = |row: &Row| {
        let (family, short) = match row.config.split_once(": ") {
            Some((family, short)) => (family, short),
            None if row.config.contains("Newton") || row.config.contains("entries") => {
                ("tables and Newton steps", row.config.as_str())
            }
            None => ("integers", row.config.as_str()),
        };
        Point {
            family: family.to_owned(),
            label: short.to_owned(),
            error: row.max_err,
            cost: row
                .bits
                .map(f64::from)
                .or(row.cycles_median.map(|cycles| cycles as f64)),
            shipped: row.shipped,
        }
    };
    // A point without an error, or without a cost, cannot be drawn.
    let measured = rows.iter().map(point).filter(|point| point.error > 0.0);
    measured.filter(|point| point.cost.is_some()).collect()
}
