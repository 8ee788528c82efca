//! Builds the index of the report, `README.md`: what Glint uses for each kernel, its errors and cost, and its neighbours.

mod entries;
mod resources;

use std::path::Path;

use anyhow::Result;
use serde::Serialize;

use self::entries::{Choice, Entry};
use self::resources::Blocks;
use super::template::{fill, write};
use crate::report::plot::{self, Diagram, Point};
use crate::report::table::{Table, write_csv};
use crate::report::workspace;

const OVERVIEW: Diagram = Diagram {
    title: "Kernels on the soft core: cycles against error",
    across: "largest error, relative or of a number up to 1",
    up: "median cycles of a call on the SoC",
};

/// A configuration of a kernel: a line of `index.csv`.
#[derive(Serialize)]
struct Row<'a> {
    kernel: &'a str,
    config: &'a str,
    shipped: bool,
    /// Largest error, or the only one that the page has.
    error: f64,
    rms: Option<f64>,
    error_unit: &'a str,
    cost: Option<f64>,
    cost_unit: &'a str,
    page: &'a str,
}

/// Rebuilds the index, its diagram and its tables from the CSV files of all pages in `folder` and from docs/resources.md.
///
/// # Errors
/// When a table is missing or a file cannot be written.
pub fn rebuild(folder: &Path) -> Result<()> {
    let entries = entries::read(folder)?;
    let blocks = Blocks::read(&workspace::path("docs/resources.md"))?;
    let rows: Vec<Row> = entries.iter().flat_map(rows).collect();
    write_csv(&rows, &folder.join("index.csv"))?;
    plot::write(&OVERVIEW, &points(&entries), &folder.join("overview.svg"))?;
    let page = fill(
        include_str!("index.md"),
        &[
            ("kernels", kernel_table(&entries, &blocks)?),
            ("accelerators", blocks.table()?),
        ],
    )?;
    write(&page, &folder.join("README.md"))
}

fn rows(entry: &Entry) -> impl Iterator<Item = Row<'_>> {
    entry.choices.iter().map(|choice| Row {
        kernel: entry.name,
        config: &choice.config,
        shipped: choice.shipped,
        error: choice.error,
        rms: choice.rms,
        error_unit: entry.error_unit,
        cost: choice.cost,
        cost_unit: entry.cost_unit,
        page: entry.page,
    })
}

/// The Pareto front of each kernel on the soft core: configurations that no other one beats in both error and cycles.
fn points(entries: &[Entry]) -> Vec<Point> {
    let on_core = entries.iter().filter(|entry| entry.in_overview);
    on_core
        .flat_map(|entry| {
            let beaten = |choice: &Choice| {
                entry.choices.iter().any(|other| {
                    let costs = other.cost.zip(choice.cost);
                    costs.is_some_and(|(other, own)| other < own) && other.error <= choice.error
                })
            };
            let kept = entry
                .choices
                .iter()
                .filter(move |choice| choice.shipped || choice.cost.is_some() && !beaten(choice));
            kept.map(|choice| Point {
                family: entry.name.to_owned(),
                label: if choice.shipped {
                    entry.name.to_owned()
                } else {
                    String::new()
                },
                error: choice.error,
                cost: choice.cost,
                shipped: choice.shipped,
            })
        })
        .collect()
}

/// Formats what Glint uses for each kernel, with the next cheaper and the next more exact choice, as Markdown.
fn kernel_table(entries: &[Entry], blocks: &Blocks) -> Result<String> {
    let mut table = Table::new([
        "kernel",
        "Glint's choice",
        "largest error:",
        "RMS:",
        "cost:",
        "block: LUT, DSP48",
        "next cheaper: error, cost",
        "next more exact: error, cost",
    ]);
    for entry in entries {
        let is_first = |own: &Choice| {
            let same = |other: &&Choice| {
                other.shipped && (other.error, other.cost) == (own.error, own.cost)
            };
            let first = entry.choices.iter().find(same);
            own.shipped && first.is_some_and(|first| std::ptr::eq(first, own))
        };
        for shipped in entry.choices.iter().filter(|choice| is_first(choice)) {
            let neighbour = |choice: Option<&Choice>| {
                let named = |choice: &Choice| {
                    format!(
                        "{}: {:.1e}, {}",
                        choice.config,
                        choice.error,
                        cost(choice.cost)
                    )
                };
                choice.map_or_else(|| "none measured".to_owned(), named)
            };
            let block = entry
                .block
                .filter(|(_, part)| shipped.config.contains(part));
            let error = format!("{:.2e} {}", shipped.error, entry.error_unit);
            table.row([
                format!("[{}]({})", entry.name, entry.page),
                shipped.config.clone(),
                error.trim_end().to_owned(),
                shipped
                    .rms
                    .map_or_else(String::new, |rms| format!("{rms:.1e}")),
                format!("{} {}", cost(shipped.cost), entry.cost_unit),
                block.map_or(Ok(String::new()), |(name, _)| blocks.cells(name))?,
                neighbour(cheaper(entry, shipped)),
                neighbour(more_exact(entry, shipped)),
            ]);
        }
    }
    Ok(table.finish())
}

fn cost(cost: Option<f64>) -> String {
    match cost {
        None => "not measured".to_owned(),
        Some(cost) if cost >= 100.0 || cost.fract() == 0.0 => format!("{cost:.0}"),
        Some(cost) => format!("{cost:.2}"),
    }
}

/// The most exact of the configurations that cost less.
fn cheaper<'a>(entry: &'a Entry, shipped: &Choice) -> Option<&'a Choice> {
    let own = shipped.cost?;
    let less = entry
        .choices
        .iter()
        .filter(|choice| choice.cost.is_some_and(|cost| cost < own));
    less.min_by(|a, b| a.error.total_cmp(&b.error))
}

/// The cheapest of the configurations with a smaller error. Those without a measured cost come last.
fn more_exact<'a>(entry: &'a Entry, shipped: &Choice) -> Option<&'a Choice> {
    let better = entry
        .choices
        .iter()
        .filter(|choice| choice.error < shipped.error);
    better.min_by(|a, b| {
        let cost = |choice: &Choice| choice.cost.unwrap_or(f64::INFINITY);
        cost(a)
            .total_cmp(&cost(b))
            .then(b.error.total_cmp(&a.error))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry() -> Entry {
        let choice = |config: &str, error, cost: f64, shipped| Choice {
            config: config.to_owned(),
            shipped,
            error,
            rms: None,
            cost: (cost > 0.0).then_some(cost),
        };
        Entry {
            name: "a kernel",
            page: "page.md",
            error_unit: "",
            cost_unit: "cycles",
            block: None,
            in_overview: true,
            choices: vec![
                choice("cheapest", 1e-1, 1.0, false),
                choice("cheap", 1e-2, 5.0, false),
                choice("own", 1e-3, 10.0, true),
                choice("worse", 1e-2, 20.0, false),
                choice("better", 1e-4, 30.0, false),
                choice("best", 1e-6, 40.0, false),
                choice("unmeasured", 1e-5, 0.0, false),
            ],
        }
    }

    #[test]
    fn neighbours_are_the_next_ones_on_each_side() {
        let entry = entry();
        let own = &entry.choices[2];
        let name = |choice: Option<&Choice>| choice.map(|choice| choice.config.clone());
        assert_eq!(name(cheaper(&entry, own)).as_deref(), Some("cheap"));
        assert_eq!(name(more_exact(&entry, own)).as_deref(), Some("better"));
        assert_eq!(name(cheaper(&entry, &entry.choices[0])), None);
        assert_eq!(name(more_exact(&entry, &entry.choices[5])), None);
        assert_eq!(
            name(more_exact(&entry, &entry.choices[4])).as_deref(),
            Some("best"),
            "a measured choice comes before one without a cost"
        );
    }

    #[test]
    fn the_diagram_leaves_out_what_another_choice_beats() {
        assert_eq!(points(&[entry()]).len(), 5);
    }
}
