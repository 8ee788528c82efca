//! Builds the page `raymarch.md` of the report, on the raymarcher.

mod rates;
mod studies;

use std::path::Path;

use anyhow::Result;
use glint_model::raymarch::{DEFAULT_TUNING, ROUND_TUNING};

use super::template::{fill, made, write};
use crate::raymarch::verilated::Raymarcher;
use crate::report::experiments::raymarch::pictures::Row;
use crate::report::experiments::raymarch::requirements::{
    FACES, IOU, LARGE_COST, MEDIAN, NORMALS, P99, SMALL_COST,
};
use crate::report::experiments::raymarch::trials::Trial;
use crate::report::table::{Table, optional, read_csv, read_optional_csv};

/// Rebuilds the page and the diagrams of its studies from the CSV files in `folder`.
///
/// # Errors
/// When the table of pictures is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let rows: Vec<Row> = read_csv(&folder.join("raymarch.csv"))?;
    let poses = read_optional_csv(&folder.join("raymarch-rates.csv"))?;
    let (mut trials, mut sections): (Vec<Trial>, String) = Default::default();
    for study in &studies::STUDIES {
        let of_study = study.read(folder)?;
        if !of_study.is_empty() {
            study.draw(&of_study, folder)?;
            sections += &study.section(&of_study);
        }
        trials.extend(of_study);
    }
    let rates: Vec<f64> = trials.iter().filter_map(Trial::rate).collect();
    let smallest = rates.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = rates.iter().copied().fold(0.0, f64::max);
    let pair = |[required, goal]: [f64; 2]| format!("{required} ({goal})");
    let scientific = |[required, goal]: [f64; 2]| format!("{required:.0e} ({goal:.0e})");
    let page = fill(
        include_str!("raymarch.md"),
        &[
            ("threshold", DEFAULT_TUNING.threshold.to_string()),
            ("footprint", DEFAULT_TUNING.footprint.to_string()),
            ("cap", DEFAULT_TUNING.cap.to_string()),
            ("round threshold", ROUND_TUNING.threshold.to_string()),
            ("round footprint", ROUND_TUNING.footprint.to_string()),
            ("round cap", (4 * ROUND_TUNING.cap).to_string()),
            ("IoU", pair(IOU)),
            ("median", scientific(MEDIAN)),
            ("p99", scientific(P99)),
            ("faces", pair(FACES.map(|part| 100.0 * part))),
            ("small cost", pair(SMALL_COST)),
            ("large cost", pair(LARGE_COST)),
            ("normals", NORMALS.to_string()),
            ("pictures", table(&rows)),
            ("rates", rates::requirements(&poses)),
            ("views", rates::views(&poses)),
            ("lanes", Raymarcher::LANES.to_string()),
            ("configurations", rates.len().to_string()),
            ("smallest rate", format!("{smallest:.2}")),
            ("largest rate", format!("{largest:.2}")),
            ("studies", sections),
            (
                "made",
                rows.first()
                    .map_or_else(String::new, |row| made(&row.commit, &row.tools)),
            ),
        ],
    )?;
    write(&page, &folder.join("raymarch.md"))
}

/// Formats the table of the pictures' errors and numbers of evaluations as Markdown.
pub fn table(rows: &[Row]) -> String {
    let mut table = Table::new([
        "field",
        "view",
        "size",
        "prepass",
        "IoU",
        "false hits, misses",
        "undecided",
        "depth: median, p99, max",
        "from the code",
        "wrong faces",
        "normals, p99",
        "evaluations a ray: mean, by cones, largest",
        "missed requirements",
        "missed goals",
    ]);
    for row in rows {
        let errors = |errors: [Option<f64>; 3]| errors.map(studies::error).join(", ");
        table.row([
            row.scene.clone(),
            row.view.clone(),
            format!("{}×{}", row.width, row.height),
            match row.prepass {
                0 => String::new(),
                side => format!("{side}×{side}"),
            },
            format!("{:.6}", row.iou),
            format!("{}, {}", row.false_hits, row.false_misses),
            row.undecided.to_string(),
            errors([row.depth_median, row.depth_p99, row.depth_max]),
            errors([row.code_median, row.code_p99, row.code_max]),
            format!("{:.2} %", 100.0 * row.wrong_faces),
            optional(row.normal_p99.map(|angle| format!("{angle:.2}°"))),
            format!(
                "{:.2}, {:.2}, {}",
                row.evaluations, row.evaluations_cones, row.evaluations_max
            ),
            row.missed.clone(),
            row.not_reached.clone(),
        ]);
    }
    table.finish()
}
