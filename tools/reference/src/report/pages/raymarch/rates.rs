//! Tables of the raymarcher's frames per second and cycles on the whole SoC, for the page `raymarch.md`.

use crate::report::experiments::raymarch::rates::{CASES, Case, Row};
use crate::report::soc::CLOCKS;
use crate::report::table::{Table, bold, optional};

/// The measured poses of one view of a case.
struct View<'a> {
    name: &'a str,
    poses: Vec<&'a Row>,
    /// The slowest pose, which is the only pose that was drawn back to back.
    slowest: &'a Row,
    /// Mean cycles per frame of the slowest pose, drawn back to back.
    cycles: f64,
}

impl<'a> View<'a> {
    fn of(case: &Case, rows: &'a [Row]) -> Vec<Self> {
        let mut views: Vec<Self> = Vec::new();
        for row in rows.iter().filter(|row| case.contains(row)) {
            match views.last_mut() {
                Some(view) if view.name == row.view => view.poses.push(row),
                _ => views.push(Self {
                    name: &row.view,
                    poses: vec![row],
                    slowest: row,
                    cycles: 0.0,
                }),
            }
            if let (Some(view), Some(cycles)) = (views.last_mut(), row.cycles_frame) {
                (view.slowest, view.cycles) = (row, cycles);
            }
        }
        views
    }

    fn mean_alone(&self) -> f64 {
        let cycles: u64 = self.poses.iter().map(|row| row.cycles_alone).sum();
        cycles as f64 / self.poses.len() as f64
    }
}

/// Makes a row of a table: field, number of eyes, size, prepass and lanes of a case, followed by `cells`.
fn row<const CELLS: usize, const COLUMNS: usize>(
    case: &Case,
    cells: [String; CELLS],
) -> [String; COLUMNS] {
    const { assert!(COLUMNS == 5 + CELLS) };
    let case = [
        case.field.to_owned(),
        case.eyes().to_string(),
        format!("{}×{}", case.size.0, case.size.1),
        if case.prepass { "yes" } else { "" }.to_owned(),
        case.build.lanes.to_string(),
    ];
    let mut all = case.into_iter().chain(cells);
    std::array::from_fn(|_| all.next().expect("as many cells as columns"))
}

/// Formats the table of required and measured frames per second of each case as Markdown.
pub fn requirements(rows: &[Row]) -> String {
    if rows.is_empty() {
        return "Not measured.".to_owned();
    }
    let mut table = Table::new([
        "field",
        "eyes",
        "size",
        "prepass",
        "lanes",
        "measured, slowest view",
        "required",
        "goal",
    ]);
    for case in &CASES {
        let views = View::of(case, rows);
        let clock = CLOCKS[case.clock];
        let slowest = views.iter().map(|view| view.cycles).max_by(f64::total_cmp);
        let rate = slowest.map(|cycles| clock / cycles);
        let measured = rate.map(|rate| format!("{rate:.2} frames a second at {} MHz", clock / 1e6));
        let cells = [
            bold(
                measured.unwrap_or_else(|| "not measured".to_owned()),
                rate.is_some_and(|rate| rate < case.at_least),
            ),
            case.at_least.to_string(),
            optional(case.aim),
        ];
        table.row(row(case, cells));
    }
    table.finish()
}

/// Formats the table of cycles of each view as Markdown.
pub fn views(rows: &[Row]) -> String {
    let mut table = Table::new([
        "field",
        "eyes",
        "size",
        "prepass",
        "lanes",
        "view",
        "poses",
        "cycles, frame alone: mean, slowest",
        "slowest, back to back",
        "frames a second at 81.25 MHz",
        "at 100 MHz",
        "evaluations a ray",
        "evaluations a clock and lane",
    ]);
    for case in &CASES {
        for view in View::of(case, rows) {
            let evaluations = view.slowest.evaluations as f64;
            let cells = [
                view.name.to_owned(),
                view.poses.len().to_string(),
                format!("{:.0}, {}", view.mean_alone(), view.slowest.cycles_alone),
                format!("{:.0}", view.cycles),
                format!("{:.1}", CLOCKS[0] / view.cycles),
                format!("{:.1}", CLOCKS[1] / view.cycles),
                format!("{:.2}", evaluations / f64::from(view.slowest.rays)),
                format!(
                    "{:.3}",
                    evaluations / view.cycles / f64::from(case.build.lanes)
                ),
            ];
            table.row(row(case, cells));
        }
    }
    table.finish()
}
