//! The report on errors and run times in docs/report.
//!
//! The [`experiments`] measure, and return rows of tables. [`table`] writes rows to CSV files and reads rows from CSV files.
//! `tools/reference/pages` creates the pages and diagrams from the CSV files alone, so pages can be rebuilt and checked without new
//! measurements.

pub mod cycles;
pub mod experiments;
pub mod progress;
pub mod provenance;
pub mod soc;
pub mod table;
pub mod workspace;
