//! Builds the page `geometry.md` of the report, on errors of the geometry before rasterization.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, made, write};
use crate::report::experiments::geometry::Row;
use crate::report::table::{Table, read_csv};

/// Rebuilds the page from the CSV file in `folder`.
///
/// # Errors
/// When the table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let rows: Vec<Row> = read_csv(&folder.join("geometry-drift.csv"))?;
    let made = rows
        .first()
        .map_or_else(String::new, |row| made(&row.commit, &row.tools));
    let page = fill(
        include_str!("geometry.md"),
        &[("table", table(&rows)), ("made", made)],
    )?;
    write(&page, &folder.join("geometry.md"))
}

/// Formats the table of the errors as Markdown: a line for each session and form, with the errors after each number of steps.
pub fn table(rows: &[Row]) -> String {
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
