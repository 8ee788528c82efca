//! Checks README.md and the pages of docs: figures of accuracy, speed and cost link to the report, and no link is broken.

mod claim;
mod page;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::paths::root;
use page::Page;

/// The pages in a folder, as paths from the root.
fn pages_in(folder: &str) -> Vec<(PathBuf, Page)> {
    let files = fs::read_dir(root().join(folder)).expect("the folder exists");
    let paths = files.map(|file| Path::new(folder).join(file.expect("readable").file_name()));
    let mut paths: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .collect();
    paths.sort();
    let read = |path: PathBuf| {
        let text = fs::read_to_string(root().join(&path)).expect("readable");
        (path, Page::parse(&text))
    };
    paths.into_iter().map(read).collect()
}

/// All pages outside the report: README.md, the changelog and the pages of docs.
fn pages_of_users() -> Vec<(PathBuf, Page)> {
    ["", "docs", "docs/formats"].map(pages_in).concat()
}

/// Target file of a link in `page`, as a path from the root, and the link's anchor; `None` for a link to another site.
fn target<'a>(page: &Path, link: &'a str) -> Option<(PathBuf, Option<&'a str>)> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (file, anchor) = match link.split_once('#') {
        Some((file, anchor)) => (file, Some(anchor)),
        None => (link, None),
    };
    if file.is_empty() {
        return Some((page.to_owned(), anchor));
    }
    let folder = page.parent().unwrap_or(Path::new(""));
    let mut path = PathBuf::new();
    for part in folder.join(file).components() {
        match part {
            Component::ParentDir => {
                path.pop();
            }
            part => path.push(part),
        }
    }
    Some((path, anchor))
}

/// Whether the figures of the page at this path are generated: a page of the report, or of the resources.
fn is_report(path: &Path) -> bool {
    let generated = [
        "docs/program-sizes.md",
        "docs/resources.md",
        "docs/scene-builds.md",
    ];
    path.starts_with("docs/report") || generated.iter().any(|page| path == Path::new(page))
}

/// Claims of the page at this path in blocks without a link to the report, with their positions.
fn unlinked(path: &Path, page: &Page) -> Vec<String> {
    let leads_to_report =
        |link: &String| target(path, link).is_some_and(|(target, _)| is_report(&target));
    let blocks = page.blocks.iter();
    let blocks = blocks.filter(|block| !block.links.iter().any(leads_to_report));
    let claims = blocks.filter_map(|block| Some((block.line, claim::find(&block.text)?)));
    claims
        .map(|(line, claim)| format!("{}:{line}: {claim:?}", path.display()))
        .collect()
}

#[test]
fn a_claim_needs_a_link_to_the_report_in_its_block() {
    let claims = |text: &str| unlinked(Path::new("docs/lamp.md"), &Page::parse(text));
    let planted = [r#"docs/lamp.md:1: "12 cycles""#];
    assert_eq!(claims("It takes 12 cycles."), planted);
    assert_eq!(claims("It takes [12 cycles](formats.md#lamp)."), planted);
    assert_eq!(
        claims("It takes 12 cycles.\n\nSee [it](report/lamp.md)."),
        planted
    );
    assert_eq!(
        claims("It takes 12 cycles ([it](report/lamp.md#it))."),
        [""; 0]
    );
    assert_eq!(
        claims("A lamp of 12 W takes [few](resources.md) LUTs."),
        [""; 0]
    );
}

#[test]
fn every_claim_is_linked_to_the_report() {
    let mut claims = Vec::new();
    for (path, page) in pages_of_users() {
        // The changelog may state figures measured at the time of a change.
        if is_report(&path) || path == Path::new("CHANGELOG.md") {
            continue;
        }
        claims.extend(unlinked(&path, &page));
    }
    assert!(
        claims.is_empty(),
        "figures without a link to the report, in the same paragraph, item or row, or before the table: state them in docs/report and \
         link them, or leave them out:\n{}",
        claims.join("\n")
    );
}

#[test]
fn every_link_has_its_file_and_anchor() {
    let mut broken = Vec::new();
    let pages = [pages_of_users(), pages_in("docs/report")].concat();
    let pages: BTreeMap<PathBuf, Page> = pages.into_iter().collect();
    for (path, page) in &pages {
        for (line, link) in &page.links {
            let Some((target, anchor)) = target(path, link) else {
                continue;
            };
            let is_there = match anchor {
                None => root().join(&target).exists(),
                Some(anchor) => pages
                    .get(&target)
                    .is_some_and(|page| page.anchors.iter().any(|found| found == anchor)),
            };
            if !is_there {
                broken.push(format!("{}:{line}: {link}", path.display()));
            }
        }
    }
    assert!(
        broken.is_empty(),
        "links without a target:\n{}",
        broken.join("\n")
    );
}
