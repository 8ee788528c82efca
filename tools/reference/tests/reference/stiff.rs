//! Runs the catalogue of stiff cases.

use std::collections::BTreeSet;

use glint_reference::report::experiments::stiff::{Part, Row, errors, measure};
use glint_reference::report::table::read_csv;
use glint_reference::report::workspace;
use glint_reference::stiff::{catalogue, kinds};

#[test]
fn every_case_has_its_expected_outcome_and_its_row() {
    let cases = measure(Part::Host, None).expect("a readable catalogue");
    let differing: Vec<_> = cases.iter().filter(|case| !case.holds()).collect();
    assert!(
        differing.is_empty(),
        "outcomes differ from tools/reference/stiff: {differing:#?}"
    );
    let committed: Vec<Row> = read_csv(&workspace::path("docs/report/stiff.csv")).expect("a table");
    assert_eq!(errors(&cases), committed, "run `cargo xtask report stiff`");
    assert!(
        cases.len() >= 200,
        "{} cases: expected at least 200",
        cases.len()
    );

    let subjects = catalogue::read(&workspace::path("tools/reference/stiff")).expect("readable");
    let cases = subjects.iter().flat_map(|subject| &subject.cases);
    let used: BTreeSet<_> = cases.map(|case| case.kind.as_str()).collect();
    let kinds = kinds::all().into_iter().map(|kind| kind.name);
    let unused: Vec<_> = kinds.filter(|name| !used.contains(name)).collect();
    assert!(unused.is_empty(), "kinds without a case: {unused:?}");
}
