//! Builds the page `stiff.md` of the report, on stiff and extreme cases.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, write};
use crate::report::experiments::stiff::Row;
use crate::report::table::{Table, read_csv};

/// Rebuilds the page from the CSV files in `folder`.
///
/// # Errors
/// When a table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let mut rows: Vec<Row> = read_csv(&folder.join("stiff.csv"))?;
    rows.extend(read_csv::<Row>(&folder.join("stiff-virtual.csv"))?);
    let page = fill(
        include_str!("stiff.md"),
        &[
            ("count", rows.len().to_string()),
            ("cases", sections(&rows)),
        ],
    )?;
    write(&page, &folder.join("stiff.md"))
}

/// Formats the cases as Markdown, with a section for each subject.
pub fn sections(rows: &[Row]) -> String {
    let subjects = rows.chunk_by(|a, b| a.subject == b.subject);
    let sections = subjects.map(|rows| {
        let subject = rows.first().map_or("", |row| row.subject.as_str());
        format!("## {subject}\n\n{}", table(rows))
    });
    sections.collect::<Vec<_>>().join("\n")
}

fn table(rows: &[Row]) -> String {
    let mut table = Table::new(["case", "why it is hard", "expected", "measured"]);
    for row in rows {
        let measured = match (row.holds, row.measured == row.expected) {
            (true, true) => "the same".to_owned(),
            (true, false) => cell(&row.measured),
            (false, _) => format!("**differs:** {}", cell(&row.measured)),
        };
        table.row([
            cell(&row.case),
            cell(&row.why),
            cell(&row.expected),
            measured,
        ]);
    }
    table.finish()
}

/// Text for a cell: on one line, with messages as code.
fn cell(text: &str) -> String {
    let text = text.replace('|', "\\|").replace('\n', " ");
    match text.strip_prefix("refused: ") {
        Some(message) => format!("refused: `{message}`"),
        None => text,
    }
}
