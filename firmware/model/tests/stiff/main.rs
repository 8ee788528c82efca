//! The stiff cases: each row of the tables in docs/stiff.md has a function here that computes its outcome.

mod cameras;
mod case;
mod lines;
mod objects;
mod volume;
mod wireframes;

use std::collections::{BTreeMap, BTreeSet};

use case::Case;

const PAGE: &str = include_str!("../../../../docs/stiff.md");

/// The cases of all tables.
const CASES: [&[Case]; 5] = [
    cameras::CASES,
    objects::CASES,
    volume::CASES,
    lines::CASES,
    wireframes::CASES,
];

/// The rows of all tables without their headers: case and outcome.
fn rows() -> Vec<(&'static str, &'static str)> {
    let rows = PAGE.lines().filter_map(|line| line.strip_prefix("| "));
    rows.filter_map(|row| row.strip_suffix(" |")?.split_once(" | "))
        .filter(|&row| row != ("case", "outcome"))
        .collect()
}

#[test]
fn each_row_has_a_case_with_its_outcome() {
    let rows = rows();
    let stated: BTreeMap<_, _> = rows.iter().copied().collect();
    assert_eq!(stated.len(), rows.len(), "a case has two rows");
    let computed: BTreeMap<_, _> = CASES.concat().into_iter().collect();
    let names: BTreeSet<_> = stated.keys().chain(computed.keys()).collect();
    let mut differing = 0;
    for name in names {
        let stated = stated.get(name).map(|&outcome| outcome.to_owned());
        let computed = computed.get(name).map(|outcome| outcome());
        if stated != computed {
            println!("{name}\n  docs/stiff.md: {stated:?}\n  computed: {computed:?}");
            differing += 1;
        }
    }
    assert_eq!(
        differing, 0,
        "rows of docs/stiff.md that differ from the computed outcome"
    );
}
