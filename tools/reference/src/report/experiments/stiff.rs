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
use crate::stiff::outcome::{Expected, Outcome};

/// Expected and measured outcome of a case.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Name of the case.
    pub case: String,
    /// Kind of the case.
    pub kind: String,
    /// Expected outcome.
    pub expected: Expected,
    /// Measured outcome.
    pub outcome: Outcome,
}

impl Measured {
    /// Whether the measured outcome agrees with the expected outcome.
    pub fn holds(&self) -> bool {
        self.expected.holds(&self.outcome)
    }
}

/// Measured error of a case whose error is bounded: a line of `stiff.csv`. The outcomes of all other cases equal those in the catalogue.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the case.
    pub case: String,
    /// The error with its unit.
    pub error: String,
}

/// Returns the rows of the cases whose outcome is an error.
pub fn errors(measured: &[Measured]) -> Vec<Row> {
    let error = |measured: &Measured| match &measured.outcome {
        Outcome::Error(..) => Some(Row {
            case: measured.case.clone(),
            error: measured.outcome.to_string(),
        }),
        Outcome::Exact(_) | Outcome::Refused(_) => None,
    };
    measured.iter().filter_map(error).collect()
}

/// A part of the catalogue. The parts are run separately.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The cases on this host and on the emulated board.
    Host,
    /// The cases on the virtual board, run sequentially on one board.
    VirtualBoard,
}

/// Runs the cases of a part: all cases, or only those whose name or subject contains `only`.
///
/// # Errors
/// The catalogue cannot be read, or a case has an unknown kind.
pub fn measure(part: Part, only: Option<&str>) -> Result<Vec<Measured>> {
    let subjects = read(&workspace::path("tools/reference/stiff"))?;
    let kinds = kinds::all().into_iter().map(|kind| (kind.name, kind));
    let kinds: BTreeMap<_, _> = kinds.collect();
    let wanted = |text: &str| only.is_none_or(|only| text.contains(only));
    let cases: Vec<_> = subjects
        .iter()
        .filter(|subject| subject.on_virtual_board == (part == Part::VirtualBoard))
        .flat_map(|subject| subject.cases.iter().map(move |case| (&subject.title, case)))
        .filter(|(subject, case)| wanted(subject) || wanted(&case.name))
        .map(|(_, case)| case)
        .collect();
    let run = |case: &&Case| {
        let kind = kinds.get(case.kind.as_str());
        let kind = kind.with_context(|| format!("{}: no kind {:?}", case.name, case.kind))?;
        run(case, kind).with_context(|| case.name.clone())
    };
    match part {
        Part::Host => two_at_a_time(&cases, run),
        Part::VirtualBoard => cases.iter().map(run).collect(),
    }
}

fn run(case: &Case, kind: &Kind) -> Result<Measured> {
    // If a case cannot be run or panics, the other cases are run nevertheless.
    let outcome = match catch_unwind(AssertUnwindSafe(|| kind.run(case.input.clone()))) {
        Ok(outcome) => {
            outcome.unwrap_or_else(|error| Outcome::exact(format!("cannot be run: {error:#}")))
        }
        Err(_) => Outcome::exact("panicked"),
    };
    Ok(Measured {
        case: case.name.clone(),
        kind: case.kind.clone(),
        expected: case.expected()?,
        outcome,
    })
}
