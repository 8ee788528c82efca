//! The report on errors and run times, whose pages are in docs/report.
//!
//! The [`experiments`] measure and return rows. The functions of [`table`] write rows to CSV files and read them.
//! `tools/reference/pages` makes the pages and their diagrams from the CSV files alone, so that a page can be rebuilt and checked
//! without new measurements.

pub mod cycles;
pub mod experiments;
pub mod progress;
pub mod provenance;
pub mod soc;
pub mod table;
pub mod workspace;
