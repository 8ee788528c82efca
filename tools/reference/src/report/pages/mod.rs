//! The pages of docs/report: prose from a Markdown template beside each module, figures from the CSV files.

pub mod gouraud;
pub mod imu;
pub mod raymarch;
pub mod sine;
mod template;
pub mod triangle;

use std::path::Path;

use anyhow::Result;

/// A page with its diagrams, rebuilt from the CSV files in a folder into the same folder.
pub type Rebuild = fn(&Path) -> Result<()>;

/// All pages by name.
pub const PAGES: [(&str, Rebuild); 5] = [
    ("sine", sine::rebuild),
    ("triangle", triangle::rebuild),
    ("raymarch", raymarch::rebuild),
    ("gouraud", gouraud::rebuild),
    ("imu", imu::rebuild),
];
