//! Reading and writing of rows as CSV files, and formatting of Markdown tables.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Writes rows to a CSV file.
///
/// # Errors
/// When the file cannot be written.
pub fn write_csv<T: Serialize>(rows: &[T], path: &Path) -> Result<()> {
    let mut writer =
        csv::Writer::from_path(path).with_context(|| format!("cannot write {}", path.display()))?;
    for row in rows {
        writer.serialize(row)?;
    }
    writer.flush()?;
    Ok(())
}

/// Reads rows from a CSV file.
///
/// # Errors
/// When the file is missing, or a line does not have the columns of such a row.
pub fn read_csv<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>> {
    let mut reader =
        csv::Reader::from_path(path).with_context(|| format!("cannot read {}", path.display()))?;
    reader
        .deserialize()
        .collect::<Result<_, _>>()
        .with_context(|| format!("{}: unexpected line", path.display()))
}

/// As [`read_csv`], but returns no rows if the file is missing. A run with `--quick` does not write every file.
///
/// # Errors
/// When a line does not have the columns of such a row.
pub fn read_optional_csv<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>> {
    if path.exists() {
        read_csv(path)
    } else {
        Ok(vec![])
    }
}

/// A Markdown table of `N` columns, built row by row.
pub struct Table<const N: usize> {
    text: String,
}

impl<const N: usize> Table<N> {
    /// Makes a table without rows. If a heading ends in `:`, its column is right-aligned.
    pub fn new(headings: [&str; N]) -> Self {
        let mut table = Self {
            text: String::new(),
        };
        table.row(headings.map(|heading| heading.trim_end_matches(':').to_owned()));
        let rules = headings.map(|heading| match heading.ends_with(':') {
            true => "---:",
            false => "---",
        });
        let _ = writeln!(table.text, "|{}|", rules.join("|"));
        table
    }

    /// Adds a row.
    pub fn row(&mut self, cells: [String; N]) {
        let _ = writeln!(self.text, "| {} |", cells.join(" | "));
    }

    /// Returns the complete table as text, with a line end after the last row.
    pub fn finish(self) -> String {
        self.text
    }
}

/// Formats `text` as Markdown, in bold if `bold` is set.
pub fn bold(text: impl std::fmt::Display, bold: bool) -> String {
    let mark = if bold { "**" } else { "" };
    format!("{mark}{text}{mark}")
}

/// Formats the value as text, or returns an empty text if there is no value.
pub fn optional<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}
