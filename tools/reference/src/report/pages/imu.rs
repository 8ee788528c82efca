//! Builds the page `imu.md` of the report, on the attitude from gyroscope and accelerometer.

use std::path::Path;

use anyhow::Result;

use super::template::{fill, made, write};
use crate::imu::measure::LEFT_BIAS;
use crate::report::experiments::imu::filters::FilterErrors;
use crate::report::experiments::imu::methods::{RATES, Trial};
use crate::report::experiments::imu::soft_core::{Kernel, Replay};
use crate::report::experiments::imu::stiff::StiffCase;
use crate::report::experiments::imu::targets::Target;
use crate::report::experiments::imu::time::ErrorsAtTime;
use crate::report::plot::{self, Band, Diagram, Point};
use crate::report::table::{Table, bold, read_csv};

/// Rebuilds the page and its diagrams from the CSV files in `folder`.
///
/// # Errors
/// When a table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let targets: Vec<Target> = read_csv(&folder.join("imu.csv"))?;
    let trials: Vec<Trial> = read_csv(&folder.join("imu-methods.csv"))?;
    let kernels: Vec<Kernel> = read_csv(&folder.join("imu-cycles.csv"))?;
    let replays: Vec<Replay> = read_csv(&folder.join("imu-replay.csv"))?;
    let filters: Vec<FilterErrors> = read_csv(&folder.join("imu-filters.csv"))?;
    let stiff: Vec<StiffCase> = read_csv(&folder.join("imu-stiff.csv"))?;
    let moments: Vec<ErrorsAtTime> = read_csv(&folder.join("imu-time.csv"))?;
    for (motion, title) in [
        ("tumble", "Tumble of 700 °/s: error against cycles"),
        ("coning", "Coning of 5° at 10 Hz: error against cycles"),
    ] {
        draw_methods(motion, title, &trials, folder)?;
    }
    draw_moments(&moments, folder)?;
    let page = fill(
        include_str!("imu.md"),
        &[
            ("left bias", format!("{LEFT_BIAS:?}")),
            ("targets", table(&targets)),
            ("methods", method_table(&trials)),
            ("cycles", cycle_table(&kernels)),
            ("replay", replay_text(&replays)),
            ("filters", filter_table(&filters)),
            ("stiff", stiff_table(&stiff)),
            (
                "made",
                targets
                    .first()
                    .map_or_else(String::new, |row| made(&row.commit, &row.tools)),
            ),
        ],
    )?;
    write(&page, &folder.join("imu.md"))
}

/// Formats the table of errors with their requirements and goals as Markdown.
pub fn table(targets: &[Target]) -> String {
    let mut table = Table::new(["error", "required:", "goal:", "measured:", "reached"]);
    for target in targets {
        let unit = &target.unit;
        table.row([
            target.what.clone(),
            limit(target.at_least) + unit,
            limit(target.aim) + unit,
            error(target.measured) + unit,
            match target.reached.as_str() {
                "aim" => "goal",
                "at least" => "requirement",
                _ => "missed",
            }
            .to_owned(),
        ]);
    }
    table.finish()
}

/// Formats a required limit, in scientific notation if it is below 1/1000.
fn limit(limit: f64) -> String {
    if limit < 1e-3 {
        format!("{limit:e}")
    } else {
        format!("{limit}")
    }
}

/// Formats an error: in scientific notation if it is below 0.01, otherwise with two decimals.
fn error(error: f64) -> String {
    if error < 0.01 {
        format!("{error:.1e}")
    } else {
        format!("{error:.2}")
    }
}

fn method_table(trials: &[Trial]) -> String {
    let mut table = Table::new([
        "motion", "method", "cycles:", "50:", "100:", "200:", "500:", "1000:", "order:",
    ]);
    for rows in trials.chunks_exact(RATES.len()) {
        let [a, b, c, d, last] = rows else {
            continue;
        };
        let [a, b, c, d, e] = [a, b, c, d, last].map(|row| format!("{:.1e}", row.error));
        table.row([
            last.motion.clone(),
            bold(&last.method, last.shipped),
            last.cycles
                .map_or_else(|| "–".into(), |cycles| cycles.to_string()),
            a,
            b,
            c,
            d,
            e,
            format!("{:.1}", last.order.unwrap_or(f64::NAN)),
        ]);
    }
    table.finish()
}

fn cycle_table(kernels: &[Kernel]) -> String {
    let mut table = Table::new([
        "cycles a sample, as shipped",
        "required:",
        "goal:",
        "median:",
        "largest:",
    ]);
    for kernel in kernels {
        table.row([
            kernel.what.clone(),
            kernel.at_least.to_string(),
            kernel.aim.to_string(),
            kernel.median.to_string(),
            kernel.max.to_string(),
        ]);
    }
    table.finish()
}

fn replay_text(replays: &[Replay]) -> String {
    let lines = replays.iter().map(|replay| {
        let Replay {
            board,
            samples,
            differing,
            cycles,
        } = replay;
        let cycles = cycles.map(|cycles| format!(", {cycles} cycles a sample"));
        format!(
            "- {board} board: {samples} samples, {differing} attitudes differ from the host's in any bit{}.\n",
            cycles.unwrap_or_default()
        )
    });
    let lines: String = lines.collect();
    format!("A hand motion at 1 kHz, with tilt and a tracked bias, on the soft core:\n\n{lines}")
}

fn filter_table(filters: &[FilterErrors]) -> String {
    let mut table = Table::new([
        "filter",
        "rest:",
        "hand, sideways:",
        "hand, up and down:",
        "walk:",
    ]);
    for row in filters {
        let [rest, hand, nod, walk] =
            [row.rest, row.hand, row.nod, row.walk].map(|error| format!("{error:.2}"));
        table.row([bold(&row.filter, row.shipped), rest, hand, nod, walk]);
    }
    table.finish()
}

fn stiff_table(stiff: &[StiffCase]) -> String {
    let mut table = Table::new(["case", "other methods", "Glint", "outcome"]);
    for row in stiff {
        table.row([&row.case, &row.other, &row.glint, &row.outcome].map(String::clone));
    }
    table.finish()
}

fn draw_methods(motion: &str, title: &'static str, trials: &[Trial], folder: &Path) -> Result<()> {
    let diagram = Diagram {
        title,
        across: "error after 20 s, in degrees",
        up: "cycles a second",
    };
    let points: Vec<Point> = trials
        .iter()
        .filter(|trial| trial.motion == motion)
        .map(|trial| Point {
            family: trial.method.clone(),
            label: format!("{} Hz", trial.rate),
            error: trial.error,
            cost: trial.cycles.map(|cycles| cycles as f64 * trial.rate),
            shipped: trial.shipped,
        })
        .collect();
    plot::write(&diagram, &points, &folder.join(format!("imu-{motion}.svg")))
}

fn draw_moments(moments: &[ErrorsAtTime], folder: &Path) -> Result<()> {
    let series = |error: fn(&ErrorsAtTime) -> f64| -> Vec<(f64, f64)> {
        let point = |moment: &ErrorsAtTime| (moment.seconds, error(moment).max(1e-8));
        moments.iter().map(point).collect()
    };
    plot::write_lines(
        &Diagram {
            title: "Hand motion at 1 kHz: errors over time",
            across: "seconds",
            up: "error in degrees",
        },
        &[
            ("firmware against f64", series(|moment| moment.numeric)),
            ("counts against truth", series(|moment| moment.counts)),
            ("with the sensor's noise", series(|moment| moment.sensor)),
        ],
        &Band {
            name: "noise alone, one to three standard deviations",
            low: series(|moment| moment.floor),
            high: series(|moment| 3.0 * moment.floor),
        },
        &folder.join("imu-time.svg"),
    )
}
