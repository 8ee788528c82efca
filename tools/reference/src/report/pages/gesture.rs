//! Builds the page `gesture.md` of the report, on the control of the camera by a hand.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, made, write};
use crate::report::experiments::gesture::{Centre, RATE, Row, Stiff, Target};
use crate::report::plot::{self, Diagram, Point};
use crate::report::table::{Table, bold, read_csv};

const COST: Diagram = Diagram {
    title: "Filters: cycles against tracking error",
    across: "tracking error during reaches, RMS, in degrees",
    up: "cycles of a channel and frame",
};

const NOISE: Diagram = Diagram {
    title: "Filters: noise at rest against tracking error",
    across: "tracking error during reaches, RMS, in degrees",
    up: "motion of the camera at rest, RMS, in degrees",
};

/// Rebuilds the page and its diagrams from the CSV files in `folder`.
///
/// # Errors
/// When a table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let targets: Vec<Target> = read_csv(&folder.join("gesture.csv"))?;
    let centres: Vec<Centre> = read_csv(&folder.join("gesture-centre.csv"))?;
    let filters: Vec<Row> = read_csv(&folder.join("gesture-filters.csv"))?;
    let stiff: Vec<Stiff> = read_csv(&folder.join("gesture-stiff.csv"))?;
    let cost = points(&filters, |row| {
        row.cycles.map(|cycles| cycles.max(1) as f64)
    });
    plot::write(&COST, &cost, &folder.join("gesture-cost.svg"))?;
    let noise = points(&filters, |row| Some(row.rest));
    plot::write(&NOISE, &noise, &folder.join("gesture-noise.svg"))?;
    let page = fill(
        include_str!("gesture.md"),
        &[
            ("rate", format!("{RATE}")),
            ("targets", target_table(&targets)),
            ("centres", centre_table(&centres)),
            ("filters", table(&filters)),
            ("stiff", stiff_table(&stiff)),
            (
                "made",
                filters
                    .first()
                    .map_or_else(String::new, |row| made(&row.commit, &row.tools)),
            ),
        ],
    )?;
    write(&page, &folder.join("gesture.md"))
}

/// Formats the table of the filters' errors and cycles as Markdown.
pub fn table(rows: &[Row]) -> String {
    let mut table = Table::new([
        "filter",
        "parameters",
        "at rest, RMS:",
        "lag:",
        "tracking, RMS:",
        "tracking, largest:",
        "cycles:",
    ]);
    for row in rows {
        table.row([
            bold(&row.filter, row.shipped),
            row.parameters.clone(),
            format!("{:.3}°", row.rest),
            format!("{:.1} ms", row.lag),
            format!("{:.2}°", row.tracking),
            format!("{:.1}°", row.largest),
            row.cycles
                .map_or_else(|| "–".to_owned(), |cycles| cycles.to_string()),
        ]);
    }
    table.finish()
}

fn target_table(rows: &[Target]) -> String {
    let mut table = Table::new(["what", "required:", "measured:", "reached"]);
    for row in rows {
        let measured = row.measured;
        table.row([
            row.what.clone(),
            format!("{}{}", row.at_least, row.unit),
            measured.map_or_else(
                || "–".to_owned(),
                |measured| format!("{}{}", (measured * 1e3).round() / 1e3, row.unit),
            ),
            match measured {
                Some(measured) if measured <= row.at_least => "yes",
                Some(_) => "missed",
                None => "not measured",
            }
            .to_owned(),
        ]);
    }
    table.finish()
}

fn centre_table(rows: &[Centre]) -> String {
    let mut table = Table::new(["hand", "counted", "RMS:", "99 % below:", "largest:"]);
    for row in rows {
        let [rms, p99, max] = [row.rms, row.p99, row.max].map(|error| format!("{error:.3}"));
        table.row([
            row.hand.clone(),
            bold(&row.counted, row.shipped),
            rms,
            p99,
            max,
        ]);
    }
    table.finish()
}

fn stiff_table(rows: &[Stiff]) -> String {
    let mut table = Table::new([
        "for a second, the frames show",
        "after 0.5 s",
        "reason",
        "camera moved:",
        "back after:",
        "largest turn in a frame:",
        "error at the end:",
    ]);
    for row in rows {
        table.row([
            row.case.clone(),
            row.presence.clone(),
            row.reason.clone(),
            format!("{:.2}°", row.moved),
            format!("{:.0} ms", row.back),
            format!("{:.2}°", row.step),
            format!("{:.2}°", row.end),
        ]);
    }
    table.finish()
}

fn points(rows: &[Row], cost: impl Fn(&Row) -> Option<f64>) -> Vec<Point> {
    let point = |row: &Row| Point {
        family: row.filter.clone(),
        label: row.parameters.clone(),
        error: row.tracking,
        cost: cost(row),
        shipped: row.shipped,
    };
    rows.iter().map(point).collect()
}
