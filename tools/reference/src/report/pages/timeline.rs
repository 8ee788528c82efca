//! Builds the page `timeline.md` of the report, on the parts of a frame and its bottleneck.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, made, write};
use crate::report::experiments::timeline::{LANES, Row};
use crate::report::plot::{self, Bar, Part};
use crate::report::soc::CLOCKS;
use crate::report::table::{Table, read_csv};

const TITLE: &str = "Frames of the scenes, part by part";
const ACROSS: &str = "cycles of the frame, %";

/// What limits a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bottleneck {
    /// The soft core without a pass of the engines.
    SoftCore,
    /// Geometry passes.
    Geometry,
    /// Raster passes.
    Raster,
    /// Evaluations of the field in raster passes.
    Evaluations,
    /// Commands that memory refuses during passes.
    Memory,
}

impl Bottleneck {
    fn name(self) -> &'static str {
        match self {
            Self::SoftCore => "soft core",
            Self::Geometry => "geometry",
            Self::Raster => "raster",
            Self::Evaluations => "evaluations",
            Self::Memory => "memory",
        }
    }
}

/// A frame with its bottleneck and bounds. Rates are frames a second at 81.25 MHz.
struct Object<'a> {
    row: &'a Row,
    bottleneck: Bottleneck,
    rate: f64,
    /// Largest rate with the bottleneck twice as fast.
    rate_halved: f64,
    /// Largest rate without the bottleneck.
    rate_without: f64,
    /// Largest rate of a soft core that works while the engines draw.
    rate_overlapped: f64,
}

impl<'a> Object<'a> {
    fn of(row: &'a Row) -> Self {
        let bottleneck = bottleneck(row);
        let cycles = row.cycles as f64;
        let limiting = limiting(row, bottleneck);
        let rate = |cycles: f64| CLOCKS[0] / cycles;
        Self {
            row,
            bottleneck,
            rate: rate(cycles),
            rate_halved: rate(cycles - limiting / 2.0),
            rate_without: rate(cycles - limiting),
            rate_overlapped: rate(row.soft_core.max(passes(row)) as f64),
        }
    }
}

/// Cycles of the passes of the engines.
fn passes(row: &Row) -> u64 {
    row.geometry + row.raster
}

/// Cycles in which the lanes make all evaluations, if no lane waits.
fn evaluating(row: &Row) -> f64 {
    row.evaluations.unwrap_or(0) as f64 / LANES as f64
}

/// What limits a frame: its longest part, or in a pass the evaluations or the memory, if they take more than half of it.
pub fn bottleneck(row: &Row) -> Bottleneck {
    if row.soft_core >= row.geometry.max(row.raster) {
        Bottleneck::SoftCore
    } else if row.raster >= row.geometry && 2.0 * evaluating(row) > row.raster as f64 {
        Bottleneck::Evaluations
    } else if 2 * row.refused > passes(row) {
        Bottleneck::Memory
    } else if row.raster >= row.geometry {
        Bottleneck::Raster
    } else {
        Bottleneck::Geometry
    }
}

/// Cycles of a frame that its bottleneck takes.
fn limiting(row: &Row, bottleneck: Bottleneck) -> f64 {
    match bottleneck {
        Bottleneck::SoftCore => row.soft_core as f64,
        Bottleneck::Geometry => row.geometry as f64,
        Bottleneck::Raster => row.raster as f64,
        Bottleneck::Evaluations => evaluating(row),
        Bottleneck::Memory => row.refused as f64,
    }
}

/// Rebuilds the page and its diagram from the CSV file in `folder`.
///
/// # Errors
/// When the table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let rows: Vec<Row> = read_csv(&folder.join("timeline.csv"))?;
    let objects: Vec<_> = rows.iter().map(Object::of).collect();
    let bars: Vec<_> = rows.iter().map(bar).collect();
    plot::write_bars(TITLE, ACROSS, &bars, &folder.join("timeline.svg"))?;
    let made = rows
        .first()
        .map_or_else(String::new, |row| made(&row.commit, &row.tools));
    let page = fill(
        include_str!("timeline.md"),
        &[
            ("lanes", LANES.to_string()),
            ("parts", table(&rows)),
            ("bottlenecks", bottlenecks(&objects)),
            ("made", made),
        ],
    )?;
    write(&page, &folder.join("timeline.md"))
}

/// The bars of a frame, in percent of its cycles.
fn bar(row: &Row) -> Bar {
    let percent = |cycles: f64| 100.0 * cycles / row.cycles as f64;
    let part = |name, from: u64, length: f64| Part {
        name,
        from: percent(from as f64),
        to: percent(from as f64 + length),
    };
    let (start, raster) = (row.soft_core, row.soft_core + row.geometry);
    Bar {
        label: format!("{}, {} cycles", row.scene, row.cycles),
        tracks: vec![
            vec![
                part("soft core", 0, row.soft_core as f64),
                part("geometry passes", start, row.geometry as f64),
                part("raster passes", raster, row.raster as f64),
            ],
            vec![part("refused by memory", start, row.refused as f64)],
            vec![part("evaluations", raster, evaluating(row))],
        ],
    }
}

/// Formats the parts of the frames as a Markdown table.
pub fn table(rows: &[Row]) -> String {
    let mut table = Table::new([
        "scene",
        "size",
        "cycles:",
        "soft core:",
        "geometry passes:",
        "raster passes:",
        "refused:",
        "evaluations, in cycles:",
        "words of 16 bytes:",
    ]);
    for row in rows {
        table.row([
            format!("`{}`", row.scene),
            format!("{}×{}", row.width, row.width * 9 / 16),
            row.cycles.to_string(),
            row.soft_core.to_string(),
            row.geometry.to_string(),
            row.raster.to_string(),
            row.refused.to_string(),
            match row.evaluations {
                Some(_) => format!("{:.0}", evaluating(row)),
                None => String::new(),
            },
            row.words.to_string(),
        ]);
    }
    table.finish()
}

fn bottlenecks(objects: &[Object]) -> String {
    let mut table = Table::new([
        "scene",
        "bottleneck",
        "part of the frame:",
        "frames a second:",
        "bottleneck twice as fast, at most:",
        "without it, at most:",
        "soft core beside the engines, at most:",
    ]);
    for object in objects {
        let row = object.row;
        let part = limiting(row, object.bottleneck) / row.cycles as f64;
        table.row([
            format!("`{}`", row.scene),
            object.bottleneck.name().to_owned(),
            format!("{:.0} %", 100.0 * part),
            format!("{:.1}", object.rate),
            format!("{:.1}", object.rate_halved),
            format!("{:.1}", object.rate_without),
            format!("{:.1}", object.rate_overlapped),
        ]);
    }
    table.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(soft_core: u64, geometry: u64, raster: u64) -> Row {
        Row {
            scene: "lamp".into(),
            width: 320,
            cycles: soft_core + geometry + raster,
            soft_core,
            geometry,
            raster,
            refused: 0,
            words: 0,
            evaluations: None,
            commit: String::new(),
            tools: String::new(),
        }
    }

    #[test]
    fn the_longest_part_limits_a_frame_or_what_limits_this_part() {
        let cases = [
            (row(500, 300, 200), Bottleneck::SoftCore),
            (row(200, 500, 300), Bottleneck::Geometry),
            (row(200, 300, 500), Bottleneck::Raster),
            (
                Row {
                    refused: 401,
                    ..row(200, 300, 500)
                },
                Bottleneck::Memory,
            ),
            (
                Row {
                    refused: 400,
                    ..row(200, 300, 500)
                },
                Bottleneck::Raster,
            ),
            (
                Row {
                    refused: 401,
                    ..row(500, 300, 200)
                },
                Bottleneck::SoftCore,
            ),
            (
                Row {
                    evaluations: Some(502),
                    refused: 401,
                    ..row(200, 300, 500)
                },
                Bottleneck::Evaluations,
            ),
            (
                Row {
                    evaluations: Some(500),
                    ..row(200, 300, 500)
                },
                Bottleneck::Raster,
            ),
        ];
        for (row, expected) in cases {
            assert_eq!(bottleneck(&row), expected, "{row:?}");
        }
    }

    #[test]
    fn bounds_are_those_of_the_rest_of_the_frame() {
        let row = row(200, 300, 500);
        let object = Object::of(&row);
        let cycles = |rate: f64| (CLOCKS[0] / rate).round();
        assert_eq!(cycles(object.rate), 1000.0);
        assert_eq!(cycles(object.rate_halved), 750.0);
        assert_eq!(cycles(object.rate_without), 500.0);
        assert_eq!(cycles(object.rate_overlapped), 800.0);
    }
}
