//! Experiment: all cases of the catalogue of stiff cases.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use crate::report::soc::two_at_a_time;
use crate::report::workspace;
use crate::stiff::catalogue::{Case, read};
use crate::stiff::kind::Kind;
use crate::stiff::kinds;
use crate::stiff::outcome::Outcome;

/// Expected and measured outcome of a case: a line of `stiff.csv`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Row {
    /// Title of the subject.
    pub subject: String,
    /// Name of the case.
    pub case: String,
    /// Kind of the case.
    pub kind: String,
    /// Input as JSON.
    pub input: String,
    /// Why the input is hard, or why the outcome is right.
    pub why: String,
    /// Expected outcome.
    pub expected: String,
    /// Measured outcome.
    pub measured: String,
    /// Whether the outcome is as expected.
    pub holds: bool,
}

/// The cases of the catalogue that run together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Those on this host and on the emulated board.
    Host,
    /// Those on the virtual board, one after the other because they share one.
    VirtualBoard,
}

/// Runs all cases of a part, or those whose name or subject contains `only`.
///
/// # Errors
/// The catalogue cannot be read, or a case has an unknown kind.
pub fn measure(part: Part, only: Option<&str>) -> Result<Vec<Row>> {
    let subjects = read(&workspace::path("tools/reference/stiff"))?;
    let kinds = kinds::all().into_iter().map(|kind| (kind.name, kind));
    let kinds: BTreeMap<_, _> = kinds.collect();
    let wanted = |text: &str| only.is_none_or(|only| text.contains(only));
    let cases: Vec<_> = subjects
        .iter()
        .filter(|subject| subject.on_virtual_board == (part == Part::VirtualBoard))
        .flat_map(|subject| subject.cases.iter().map(move |case| (&subject.title, case)))
        .filter(|(subject, case)| wanted(subject) || wanted(&case.name))
        .collect();
    let run = |(subject, case): &(&String, &Case)| {
        let kind = kinds.get(case.kind.as_str());
        let kind = kind.with_context(|| format!("{}: no kind {:?}", case.name, case.kind))?;
        run(subject, case, kind).with_context(|| case.name.clone())
    };
    match part {
        Part::Host => two_at_a_time(&cases, run),
        Part::VirtualBoard => cases.iter().map(run).collect(),
    }
}

fn run(subject: &str, case: &Case, kind: &Kind) -> Result<Row> {
    let expected = case.expected()?;
    // A case that cannot be run, or panics, must not hide the others.
    let outcome = match catch_unwind(AssertUnwindSafe(|| kind.run(case.input.clone()))) {
        Ok(outcome) => {
            outcome.unwrap_or_else(|error| Outcome::exact(format!("cannot be run: {error:#}")))
        }
        Err(_) => Outcome::exact("panicked"),
    };
    Ok(Row {
        subject: subject.to_owned(),
        case: case.name.clone(),
        kind: case.kind.clone(),
        input: serde_json::to_string(&case.input)?,
        why: case.why.clone(),
        expected: expected.stated(&outcome),
        measured: outcome.to_string(),
        holds: expected.holds(&outcome),
    })
}
