//! Builds the page `quality.md` of the report, on the qualities of pictures.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, made, write};
use crate::report::experiments::quality::{Cycles, Row};
use crate::report::plot::{self, Diagram, Point};
use crate::report::soc::CLOCKS;
use crate::report::table::{Table, bold, read_csv, read_optional_csv};

const WRONG: Diagram = Diagram {
    title: "Frames of the scenes: cycles against wrong pixels",
    across: "wrong pixels on the monitor, %",
    up: "cycles of a frame on the SoC",
};
const COLOUR: Diagram = Diagram {
    title: "Frames of the scenes: cycles against errors of colours",
    across: "RMS of the errors of a channel, 1/255",
    up: "cycles of a frame on the SoC",
};

/// The part by which cycles of equal frames differ, because scan-out reads memory at another time.
const SAME: f64 = 0.005;

/// A measured frame.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    /// Its errors.
    pub row: &'a Row,
    /// Its cycles; `None` if they are not measured.
    pub cycles: Option<u64>,
}

impl Measured<'_> {
    /// Whether this frame has no more cycles and no larger errors than another one, and less of one of them. Cycles that differ
    /// by less than `SAME` are equal.
    pub fn beats(&self, other: &Self) -> bool {
        let Some((own, others)) = self.cycles.zip(other.cycles) else {
            return false;
        };
        let [own, others] = [own, others].map(|cycles| cycles as f64);
        let others = match (own - others).abs() <= SAME * own {
            true => own,
            false => others,
        };
        let numbers = |frame: &Self, cycles: f64| [frame.row.wrong, frame.row.colour, cycles];
        let (own, others) = (numbers(self, own), numbers(other, others));
        own != others && own.iter().zip(&others).all(|(own, other)| own <= other)
    }
}

/// Puts errors and cycles of the same frames together, scene by scene.
pub fn frames<'a>(rows: &'a [Row], cycles: &[Cycles]) -> Vec<Vec<Measured<'a>>> {
    let measured = rows.iter().map(|row| {
        let same = |cycles: &&Cycles| {
            (&cycles.scene, cycles.width, &cycles.rays) == (&row.scene, row.width, &row.rays)
        };
        let cycles = cycles.iter().find(same).map(|cycles| cycles.cycles);
        Measured { row, cycles }
    });
    let measured: Vec<_> = measured.collect();
    let scenes = measured.chunk_by(|a, b| a.row.scene == b.row.scene);
    scenes.map(<[_]>::to_vec).collect()
}

/// Whether this frame is on the Pareto front of its scene.
pub fn is_on_front(frame: &Measured, scene: &[Measured]) -> bool {
    !scene.iter().any(|other| other.beats(frame))
}

/// Rebuilds the page and its diagrams from the CSV files in `folder`.
///
/// # Errors
/// When a table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let rows: Vec<Row> = read_csv(&folder.join("quality.csv"))?;
    let cycles: Vec<Cycles> = read_optional_csv(&folder.join("quality-cycles.csv"))?;
    let scenes = frames(&rows, &cycles);
    let made = rows
        .first()
        .map_or_else(String::new, |row| made(&row.commit, &row.tools));
    let draw = |diagram: &Diagram, error: fn(&Row) -> f64, name: &str| {
        plot::write(diagram, &points(&scenes, error), &folder.join(name))
    };
    draw(&WRONG, |row| 100.0 * row.wrong, "quality-wrong.svg")?;
    draw(&COLOUR, |row| row.colour, "quality-colour.svg")?;
    let page = fill(
        include_str!("quality.md"),
        &[
            ("qualities", qualities(&scenes)),
            ("frames", all(&scenes)),
            ("made", made),
        ],
    )?;
    write(&page, &folder.join("quality.md"))
}

/// Formats the errors of all frames as a Markdown table.
pub fn table(rows: &[Row]) -> String {
    all(&frames(rows, &[]))
}

/// The frames on the front of each scene, and those of the qualities.
fn points(scenes: &[Vec<Measured>], error: fn(&Row) -> f64) -> Vec<Point> {
    let mut points = Vec::new();
    for scene in scenes {
        for frame in scene {
            let shipped = frame.row.quality.is_some();
            // A logarithmic axis cannot show an error of 0.
            if error(frame.row) > 0.0 && (shipped || is_on_front(frame, scene)) {
                points.push(Point {
                    family: frame.row.scene.clone(),
                    label: String::new(),
                    error: error(frame.row),
                    cost: frame.cycles.map(|cycles| cycles as f64),
                    shipped,
                });
            }
        }
    }
    points
}

fn percent(part: f64) -> String {
    format!("{:.3} %", 100.0 * part)
}

fn rate(cycles: Option<u64>) -> String {
    let rate = cycles.map(|cycles| CLOCKS[0] / cycles as f64);
    rate.map_or("not measured".to_owned(), |rate| format!("{rate:.1}"))
}

/// One line per scene, with the three qualities side by side.
fn qualities(scenes: &[Vec<Measured>]) -> String {
    let mut table = Table::new([
        "scene",
        "fast: wrong pixels, colour, frames a second",
        "balanced",
        "exact",
    ]);
    for scene in scenes {
        let name = scene.first().map_or("", |frame| &frame.row.scene);
        let cell = |quality: &str| {
            let found = scene
                .iter()
                .find(|frame| frame.row.quality.as_deref() == Some(quality));
            found.map_or(String::new(), |frame| {
                let Row { wrong, colour, .. } = frame.row;
                format!("{}, {colour:.2}, {}", percent(*wrong), rate(frame.cycles))
            })
        };
        let [fast, balanced, exact] = ["fast", "balanced", "exact"].map(cell);
        table.row([format!("`{name}`"), fast, balanced, exact]);
    }
    table.finish()
}

fn all(scenes: &[Vec<Measured>]) -> String {
    let mut table = Table::new([
        "scene",
        "size",
        "rays",
        "quality",
        "wrong pixels:",
        "colour, RMS:",
        "cycles:",
        "frames a second:",
        "on the front",
    ]);
    for scene in scenes {
        for frame in scene {
            let row = frame.row;
            let is_on_front = frame.cycles.is_some() && is_on_front(frame, scene);
            table.row([
                format!("`{}`", row.scene),
                format!("{}×{}", row.width, row.width * 9 / 16),
                row.rays.clone().unwrap_or_default(),
                row.quality
                    .as_deref()
                    .map_or_else(String::new, |quality| bold(quality, true)),
                percent(row.wrong),
                format!("{:.2}", row.colour),
                frame
                    .cycles
                    .map_or("not measured".to_owned(), |cycles| cycles.to_string()),
                rate(frame.cycles),
                if is_on_front { "yes" } else { "" }.to_owned(),
            ]);
        }
    }
    table.finish()
}
