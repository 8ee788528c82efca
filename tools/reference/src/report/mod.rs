//! The report on error against run time, in docs/report.
//!
//! [`experiments`] measure and return rows. [`table`] writes and reads rows as CSV files. [`pages`] makes the pages and
//! diagrams from the CSV files alone, so that a page can be rebuilt and checked without measuring again.

pub mod cycles;
pub mod experiments;
pub mod pages;
pub mod plot;
pub mod progress;
pub mod provenance;
pub mod soc;
pub mod table;
pub mod workspace;
