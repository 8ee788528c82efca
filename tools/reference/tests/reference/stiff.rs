//! Runs the catalogue of stiff cases.

use std::collections::BTreeSet;

use glint_reference::report::experiments::stiff::{Part, Row, measure};
use glint_reference::report::table::read_csv;
use glint_reference::report::workspace;
use glint_reference::stiff::kinds;

#[test]
fn every_case_has_its_expected_outcome_and_its_row() {
    let rows = measure(Part::Host, None).expect("the catalogue can be read");
    for row in rows.iter().filter(|row| !row.holds) {
        println!("{row:#?}");
    }
    assert!(
        rows.iter().all(|row| row.holds),
        "outcomes differ from tools/reference/stiff: `cargo xtask report stiff` shows them"
    );
    let committed: Vec<Row> = read_csv(&workspace::path("docs/report/stiff.csv")).expect("a table");
    for (row, committed) in rows.iter().zip(&committed) {
        assert_eq!(row, committed, "run `cargo xtask report stiff`");
    }
    assert_eq!(
        rows.len(),
        committed.len(),
        "run `cargo xtask report stiff`"
    );
    assert!(rows.len() >= 200, "{} cases: some got lost", rows.len());
    let virtual_rows: Vec<Row> =
        read_csv(&workspace::path("docs/report/stiff-virtual.csv")).expect("a table");
    assert!(virtual_rows.iter().all(|row| row.holds));
    let all = rows.iter().chain(&virtual_rows);
    let used: BTreeSet<_> = all.map(|row| row.kind.as_str()).collect();
    let unused = kinds::all().into_iter().map(|kind| kind.name);
    let unused: Vec<_> = unused.filter(|name| !used.contains(name)).collect();
    assert!(unused.is_empty(), "kinds without a case: {unused:?}");
}
