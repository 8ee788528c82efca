//! Builds the page `long.md` of the report, on runs of hours of the board's time.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, write};
use crate::report::experiments::long::{orbit, sensor, uptime};
use crate::report::plot::{self, Band, Diagram, Line};
use crate::report::table::{Table, read_optional_csv};

/// Angle random walk of the sensor in degrees per √s: the density of its noise.
const WALK: f64 = 0.005;
/// Smallest error on the diagram, in degrees.
const LEAST: f64 = 1e-4;

/// Rebuilds the page and its diagram from the CSV files in `folder`.
///
/// # Errors
/// When a table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let file = |study: &str| folder.join(format!("long-{study}.csv"));
    let orbit: Vec<orbit::Row> = read_optional_csv(&file("orbit"))?;
    let uptime: Vec<uptime::Row> = read_optional_csv(&file("uptime"))?;
    let mut sensor: Vec<sensor::Row> = Vec::new();
    for path in sensor::Path::ALL {
        sensor.extend(read_optional_csv::<sensor::Row>(&file(path.name()))?);
    }
    if !sensor.is_empty() {
        draw(&sensor, folder)?;
    }
    let of_orbit = commits(orbit.iter().map(|row| &*row.commit));
    let of_uptime = commits(uptime.iter().map(|row| &*row.commit));
    let of_sensor = commits(sensor.iter().map(|row| &*row.commit));
    let page = fill(
        include_str!("long.md"),
        &[
            ("orbit", orbit_table(&orbit)),
            ("sensor", sensor_table(&sensor)),
            ("uptime", uptime_table(&uptime)),
            ("orbit's commit", of_orbit),
            ("uptime's commit", of_uptime),
            ("sensor's commits", of_sensor),
        ],
    )?;
    write(&page, &folder.join("long.md"))
}

/// The distinct commits of the rows, joined.
fn commits<'a>(of_rows: impl Iterator<Item = &'a str>) -> String {
    let mut commits: Vec<&str> = of_rows.collect();
    commits.dedup();
    match commits.is_empty() {
        true => "none".to_owned(),
        false => commits.join(" and "),
    }
}

/// Formats the table of the orbit as Markdown.
pub fn orbit_table(rows: &[orbit::Row]) -> String {
    let mut table = Table::new([
        "turns:",
        "frames:",
        "length:",
        "angle:",
        "against f64:",
        "other pictures:",
        "other cameras:",
    ]);
    for row in rows {
        table.row([
            row.turns.to_string(),
            row.frames.to_string(),
            format!("{:.2e}", row.length),
            format!("{:.2e}", row.angle),
            format!("{:.2e}", row.reference),
            row.differing.to_string(),
            row.displaced.to_string(),
        ]);
    }
    table.finish()
}

/// Formats the table of the sensor's attitudes as Markdown.
pub fn sensor_table(rows: &[sensor::Row]) -> String {
    let mut table = Table::new([
        "sensor",
        "after:",
        "heading:",
        "inclination:",
        "camera's basis:",
        "samples:",
        "lost:",
        "gaps:",
    ]);
    for row in rows {
        table.row([
            row.path.clone(),
            duration(row.seconds),
            format!("{:.3}°", row.heading),
            format!("{:.3}°", row.inclination),
            format!("{:.1e}", row.basis),
            row.samples.to_string(),
            row.lost.to_string(),
            row.gaps.to_string(),
        ]);
    }
    table.finish()
}

fn duration(seconds: f64) -> String {
    match seconds {
        seconds if seconds < 60.0 => format!("{seconds} s"),
        seconds if seconds < 3600.0 => format!("{} min", seconds / 60.0),
        seconds => format!("{} h", seconds / 3600.0),
    }
}

/// Formats the table of answers as Markdown.
pub fn uptime_table(rows: &[uptime::Row]) -> String {
    let mut table = Table::new(["when", "what", "expected", "measured"]);
    for row in rows {
        let measured = if row.measured == row.expected {
            "the same".to_owned()
        } else {
            format!("**differs:** {}", row.measured)
        };
        table.row([
            row.when.clone(),
            row.what.clone(),
            row.expected.clone(),
            measured,
        ]);
    }
    table.finish()
}

fn draw(rows: &[sensor::Row], folder: &Path) -> Result<()> {
    let line = |name: &'static str, path: sensor::Path, error: fn(&sensor::Row) -> f64| -> Line {
        let rows = rows.iter().filter(|row| row.path == path.name());
        let points = rows.map(|row| (row.seconds, error(row).abs().max(LEAST)));
        (name, points.collect())
    };
    let (rest, turning) = (sensor::Path::Rest, sensor::Path::Turning);
    let lines = [
        line("heading, at rest", rest, |row| row.heading),
        line("inclination, at rest", rest, |row| row.inclination),
        line("heading, turning", turning, |row| row.heading),
        line("inclination, turning", turning, |row| row.inclination),
    ];
    let walk = |deviations: f64| -> Vec<(f64, f64)> {
        let (_, points) = &lines[0];
        let point = |&(seconds, _): &(f64, f64)| (seconds, deviations * WALK * seconds.sqrt());
        points.iter().map(point).collect()
    };
    plot::write_lines(
        &Diagram {
            title: "The sensor: errors over time",
            across: "seconds",
            up: "error in degrees",
        },
        &lines,
        &Band {
            name: "noise alone, one to three standard deviations",
            low: walk(1.0),
            high: walk(3.0),
        },
        &folder.join("long-sensor.svg"),
    )
}
