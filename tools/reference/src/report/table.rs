//! Reading and writing of rows as CSV files.

use std::path::Path;

use anyhow::{Context, Result};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Writes rows to a CSV file. If a row is a tuple of structures, its columns are the columns of all structures in their order.
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
