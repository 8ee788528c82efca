//! `cargo xtask modules`: the structure of the sources.
//!
//! The command checks three rules: no circle of modules in a crate, no `#[path]`, no hand-written source file above
//! [`files::MOST_LINES`] lines.
//!
//! **Circles.** An arrow from module A to module B counts when A names an item that B defines. B is the module that defines the
//! item, not one that re-exports it. These do not count:
//! - a re-export (`pub use child::X`) of an item from below;
//! - the name of a module alone (`mod child;`, `use crate::child;`);
//! - code under `#[cfg(test)]`.
//!
//! A module is a file: an inline module belongs to the file around it. Libraries, binaries, tests and examples are checked, each as
//! a crate of its own. A method call makes no arrow; the path to a type does. `use path::*` makes arrows for the used names.
//!
//! `cargo modules dependencies --acyclic` does the same with rust-analyzer, which takes minutes to compile. This check uses
//! `syn`, which is compiled for the derive macros in any case: the names that it finds are enough here.

mod arrows;
mod circles;
mod files;
mod tree;

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, bail};
use serde::Deserialize;

use crate::paths;
use arrows::Arrows;
use tree::Crate;

/// Checks the three rules for the whole workspace.
///
/// # Errors
/// A rule is violated, or a source cannot be read. The error lists every violation on a line of its own.
pub fn check() -> Result<()> {
    let mut faults = Vec::new();
    let mut path_attributes = BTreeSet::new();
    for target in targets()? {
        let tree = Crate::load(&target.src_path, &|path| fs::read_to_string(path).ok())
            .with_context(|| format!("reading the modules of {}", target.name))?;
        for circle in circles(&tree) {
            faults.push(format!("{} ({}): {circle}", target.name, target.kind[0]));
        }
        path_attributes.extend(tree.path_attributes);
    }
    let count = faults.len();
    let root = format!("{}/", paths::root().display());
    faults.extend(path_attributes.iter().map(|attribute| {
        let attribute = attribute.strip_prefix(&root).unwrap_or(attribute);
        format!("{attribute}: `#[path]`")
    }));
    let too_long = files::too_long(&paths::root())?;
    let summary = format!(
        "{count} circles of modules, {} `#[path]` attributes, {} files of more than {} lines",
        path_attributes.len(),
        too_long.len(),
        files::MOST_LINES
    );
    faults.extend(too_long);
    if !faults.is_empty() {
        bail!("{summary}:\n{}", faults.join("\n"));
    }
    Ok(())
}

/// Returns the circles of one crate as chains such as `a → b (B) → a (A)`: module `a` uses the item `B` of module `b`, which uses
/// the item `A` of module `a`.
fn circles(tree: &Crate) -> Vec<String> {
    let arrows = arrows::arrows(tree);
    circles::circles(&arrows)
        .iter()
        .map(|circle| chain(tree, &arrows, circle))
        .collect()
}

fn chain(tree: &Crate, arrows: &Arrows, circle: &[usize]) -> String {
    let mut text = tree.modules[circle[0]].name.clone();
    for (place, from) in circle.iter().enumerate() {
        let to = circle[(place + 1) % circle.len()];
        let names: Vec<&str> = arrows[&(*from, to)].iter().map(String::as_str).collect();
        let shown = names[..names.len().min(3)].join(", ");
        let more = if names.len() > 3 { ", …" } else { "" };
        text += &format!(" → {} ({shown}{more})", tree.modules[to].name);
    }
    text
}

/// The part of the output of `cargo metadata` that the check uses.
#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    targets: Vec<Target>,
}

/// A crate of a package, as `cargo metadata` lists it.
#[derive(Deserialize)]
struct Target {
    name: String,
    kind: Vec<String>,
    src_path: PathBuf,
}

/// Lists every crate of the workspace.
fn targets() -> Result<Vec<Target>> {
    let output = Command::new("cargo")
        .args([
            "metadata",
            "--no-deps",
            "--offline",
            "--format-version",
            "1",
        ])
        .current_dir(paths::root())
        .output()
        .context("running cargo metadata")?;
    if !output.status.success() {
        bail!(
            "cargo metadata: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    let metadata: Metadata =
        serde_json::from_slice(&output.stdout).context("reading cargo metadata")?;
    Ok(metadata
        .packages
        .into_iter()
        .flat_map(|package| package.targets)
        .collect())
}

#[cfg(test)]
mod tests;
