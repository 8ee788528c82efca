//! Builds the page `triangle.md` of the report, on the triangle engine.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, made, write};
use crate::report::experiments::triangle::{CpuRow, Row};
use crate::report::plot::{self, Diagram, Point};
use crate::report::soc::CLOCKS;
use crate::report::table::{Table, bold, optional, read_csv, read_optional_csv};

const DIAGRAM: Diagram = Diagram {
    title: "Frames of the triangle engine and of the soft core",
    across: "triangles of the mesh",
    up: "cycles of a frame on the SoC",
};

/// Rebuilds the page and its diagram from the CSV files in `folder`.
///
/// # Errors
/// When the table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let rows: Vec<Row> = read_csv(&folder.join("triangle.csv"))?;
    let cpu: Vec<CpuRow> = read_optional_csv(&folder.join("triangle-cpu.csv"))?;
    plot::write(&DIAGRAM, &points(&rows, &cpu), &folder.join("triangle.svg"))?;
    let made = rows
        .first()
        .map_or_else(String::new, |row| made(&row.commit, &row.tools));
    let page = fill(
        include_str!("triangle.md"),
        &[
            ("requirements", requirements(&rows)),
            ("cycles", cycles(&rows, &cpu)),
            ("cpu commits", commits(&cpu)),
            ("parts", parts(&rows)),
            ("made", made),
        ],
    )?;
    write(&page, &folder.join("triangle.md"))
}

/// The frames by their triangles, a family for each size of the picture and each way to draw. The points of frames back to back have rings
/// and names.
fn points(rows: &[Row], cpu: &[CpuRow]) -> Vec<Point> {
    let point = |way: &str, row: &Row, cycles: f64| Point {
        family: format!("{}×{}, {way}", row.width, row.height),
        label: String::new(),
        error: f64::from(row.triangles),
        cost: Some(cycles),
        shipped: false,
    };
    let mut points = Vec::new();
    for row in rows {
        points.push(Point {
            label: row.scene.clone(),
            shipped: true,
            ..point("gateware, back to back", row, row.cycles_frame)
        });
        points.push(point("gateware, alone", row, row.cycles_alone as f64));
        let soft_core = cpu.iter().find(|cpu| cpu.scene == row.scene);
        points.extend(soft_core.map(|cpu| point("soft core", row, cpu.cycles as f64)));
    }
    points
}

/// Formats the tables of the engine as Markdown: requirements, cycles, and how the time of the passes is spent.
pub fn table(rows: &[Row]) -> String {
    [requirements(rows), cycles(rows, &[]), parts(rows)].join("\n")
}

/// Formats the table of the soft core's frames as Markdown.
pub fn cpu_table(rows: &[CpuRow]) -> String {
    let mut table = Table::new(["scene", "cycles on the CPU:"]);
    for row in rows {
        table.row([row.scene.clone(), row.cycles.to_string()]);
    }
    table.finish()
}

/// Returns the commits of the soft core's frames, each once.
fn commits(cpu: &[CpuRow]) -> String {
    let mut commits: Vec<&str> = cpu.iter().map(|row| row.commit.as_str()).collect();
    commits.dedup();
    match commits[..] {
        [] => "no commit".to_owned(),
        _ => commits.join(", "),
    }
}

fn requirements(rows: &[Row]) -> String {
    let mut table = Table::new([
        "scene",
        "size",
        "half width",
        "triangles in, drawn, clipped",
        "pixels",
        "measured",
        "required",
        "goal",
    ]);
    for row in rows {
        table.row([
            row.scene.clone(),
            format!("{}×{}", row.width, row.height),
            row.half_width.to_string(),
            format!("{}, {}, {}", row.triangles, row.drawn, row.clipped),
            row.pixels.to_string(),
            bold(format_args!("{:.2} {}", row.measured, row.unit), !row.met),
            row.at_least.to_string(),
            optional(row.aim),
        ]);
    }
    table.finish()
}

fn cycles(rows: &[Row], cpu: &[CpuRow]) -> String {
    let mut table = Table::new([
        "scene",
        "cycles, frame alone",
        "its geometry pass",
        "its raster pass",
        "cycles, back to back",
        "geometry, raster pass",
        "clocks a triangle",
        "frames a second at 81.25 MHz",
        "at 100 MHz",
        "cycles on the CPU",
    ]);
    for row in rows {
        table.row([
            row.scene.clone(),
            row.cycles_alone.to_string(),
            row.cycles_geometry.to_string(),
            row.cycles_raster.to_string(),
            format!("{:.0}", row.cycles_frame),
            format!(
                "{:.0}, {:.0}",
                row.cycles_geometry_together, row.cycles_raster_together
            ),
            format!("{:.2}", row.cycles_frame / f64::from(row.triangles)),
            format!("{:.1}", CLOCKS[0] / row.cycles_frame),
            format!("{:.1}", CLOCKS[1] / row.cycles_frame),
            cpu.iter()
                .find(|cpu| cpu.scene == row.scene)
                .map_or("not measured".to_owned(), |cpu| cpu.cycles.to_string()),
        ]);
    }
    table.finish()
}

fn parts(rows: &[Row]) -> String {
    let mut table = Table::new([
        "scene",
        "raster pass: covered groups",
        "empty groups",
        "wait for the flush",
        "rest: reading and entering triangles",
        "geometry pass: wait for a write",
    ]);
    let percent = |part: f64| format!("{:.0} %", 100.0 * part);
    for row in rows {
        table.row([
            row.scene.clone(),
            percent(row.covered),
            percent(row.empty),
            percent(row.flush),
            percent(row.other),
            percent(row.geometry_writes),
        ]);
    }
    table.finish()
}
