//! Checks the table of blocks in docs/architecture.md: the files in a block's row exist and are named after the block.

use std::collections::BTreeSet;
use std::fs;

use crate::paths::root;

/// Text of a cell whose kind of file the block does not have: a block that computes nothing has no model.
const ABSENT: &str = "–";

/// Cells of a table row, without backquotes.
fn cells(row: &str) -> Vec<String> {
    let row = row.trim().trim_matches('|');
    row.split('|')
        .map(|cell| cell.trim().trim_matches('`').to_owned())
        .collect()
}

/// Rows of the table of blocks, the header first.
fn table() -> Vec<Vec<String>> {
    let page = fs::read_to_string(root().join("docs/architecture.md")).unwrap();
    page.lines()
        .skip_while(|line| !line.starts_with("| block "))
        .take_while(|line| line.starts_with('|'))
        .filter(|line| !line.starts_with("|---"))
        .map(cells)
        .collect()
}

#[test]
fn every_part_of_a_block_has_its_name_and_exists() {
    let table = table();
    let (header, rows) = table.split_first().expect("the page has the table");
    assert_eq!(
        header.join(" "),
        "block RTL description driver model reference tests"
    );
    for row in rows {
        let (block, parts) = row.split_first().unwrap();
        assert_eq!(
            row.len(),
            header.len(),
            "{block}: the number of cells in its row differs from the header's"
        );
        for (part, kind) in parts.iter().zip(&header[1..]) {
            if part == ABSENT {
                continue;
            }
            let path = root().join(part);
            assert!(path.exists(), "{block}: {kind}: {part} does not exist");
            let name = path.file_stem().and_then(|name| name.to_str());
            assert_eq!(name, Some(block.as_str()), "{block}: {kind}: {part}");
        }
    }
}

#[test]
fn every_folder_of_rtl_is_a_block() {
    let blocks: BTreeSet<String> = table()[1..].iter().map(|row| row[0].clone()).collect();
    let folders: BTreeSet<String> = fs::read_dir(root().join("gateware/rtl"))
        .unwrap()
        .map(|entry| entry.unwrap())
        .filter(|entry| entry.file_type().unwrap().is_dir())
        .map(|entry| entry.file_name().into_string().unwrap())
        .filter(|folder| folder != "common")
        .collect();
    assert_eq!(blocks, folders);
}
