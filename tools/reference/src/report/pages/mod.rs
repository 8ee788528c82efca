//! The pages of docs/report. The prose of a page comes from a Markdown template next to its module, and the figures come from
//! the CSV files.

pub mod geometry;
pub mod gesture;
pub mod gouraud;
pub mod imu;
mod index;
pub mod kernels;
pub mod long;
pub mod quality;
pub mod raymarch;
pub mod sine;
pub mod stiff;
mod template;
pub mod timeline;
pub mod triangle;

use std::path::Path;

use anyhow::Result;

/// Function that rebuilds a page and its diagrams in a folder, from the CSV files in the same folder.
pub type Rebuild = fn(&Path) -> Result<()>;

/// Name of each page, and the function that rebuilds it.
pub const PAGES: [(&str, Rebuild); 13] = [
    ("sine", sine::rebuild),
    ("triangle", triangle::rebuild),
    ("raymarch", raymarch::rebuild),
    ("gouraud", gouraud::rebuild),
    ("imu", imu::rebuild),
    ("geometry", geometry::rebuild),
    ("gesture", gesture::rebuild),
    ("kernels", kernels::rebuild),
    ("quality", quality::rebuild),
    ("timeline", timeline::rebuild),
    ("long", long::rebuild),
    ("stiff", stiff::rebuild),
    // The index is made from the tables of all other pages.
    ("README", index::rebuild),
];
