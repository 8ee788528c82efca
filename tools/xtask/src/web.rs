//! `cargo xtask web`: builds the live page with the emulated board, as a folder of files for any web server.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use serde_json::{Value, json};

use crate::bootstrap::{self, WEB_TARGET};
use crate::gateware::Board;
use crate::{firmware, paths, programs, run};

/// Cargo profile of the emulated board.
const PROFILE: &str = "wasm";

/// Folders with the files of the page and of its web worker.
const SOURCES: [&str; 2] = ["tools/live-page/web", "tools/emulated-board-wasm/web"];

/// Name of the emulated board's file. A folder with this file is the output of an earlier build.
const BOARD: &str = "board.wasm";

/// Name of the firmware's file, which the page starts first.
const FIRMWARE: &str = "firmware.bin";

/// Name of the list of programs that the page offers.
const PROGRAMS: &str = "programs.json";

/// The example that a visitor of the page would not look for.
const FAULTS: &str = "faults";

/// Builds the folder `out`, by default `target/web`, and replaces an earlier build there.
///
/// # Errors
/// A build fails, or the folder has files but no earlier build.
pub fn build(out: Option<&Path>) -> Result<()> {
    bootstrap::rust_targets()?;
    firmware::build(Board::Virtual, &[])?;
    programs::build()?;
    run::step(
        "build emulated-board-wasm",
        Command::new("cargo")
            .args([
                "build",
                "--package",
                "emulated-board-wasm",
                "--profile",
                PROFILE,
                // The example is the board of the page's tests.
                "--lib",
                "--examples",
            ])
            .args(["--target", WEB_TARGET])
            .current_dir(paths::root()),
    )?;
    let target = paths::target();
    let built = target
        .join(WEB_TARGET)
        .join(PROFILE)
        .join("emulated_board_wasm.wasm");
    let mut files = vec![
        (built, BOARD.to_owned()),
        (target.join("firmware/glint.bin"), FIRMWARE.to_owned()),
    ];
    for folder in SOURCES {
        files.extend(files_of(&paths::root().join(folder))?);
    }
    files.extend(files_of_programs()?);
    let default = target.join("web");
    let out = out.unwrap_or(&default);
    let bytes = replace(out, &files).with_context(|| out.display().to_string())?;
    let (count, shown) = (files.len(), out.display());
    run::print_progress(&format!(
        "  {shown}: {count} files, {bytes} bytes. Serve the folder by any web server, such as\n  \
         python3 -m http.server --bind 127.0.0.1 --directory {shown}\n  \
         A browser does not run the board from a file: address."
    ));
    Ok(())
}

/// The programs that the page offers, and their list.
fn files_of_programs() -> Result<Vec<(PathBuf, String)>> {
    let names = programs::names()?;
    let shown: Vec<_> = names.iter().filter(|name| *name != FAULTS).collect();
    let entries = shown
        .iter()
        .map(|name| json!({"name": name, "file": format!("{name}.bin")}));
    let firmware = json!({"name": "firmware", "file": FIRMWARE});
    let list: Value = [firmware].into_iter().chain(entries).collect();
    let path = programs::folder().join(PROGRAMS);
    firmware::write(&path, list.to_string().as_bytes())?;
    let images = shown.iter().map(|name| {
        let file = format!("{name}.bin");
        (programs::folder().join(&file), file)
    });
    Ok([(path, PROGRAMS.to_owned())]
        .into_iter()
        .chain(images)
        .collect())
}

/// The files of a folder, with their names.
fn files_of(folder: &Path) -> Result<Vec<(PathBuf, String)>> {
    let entries = fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    let file = |entry: std::io::Result<fs::DirEntry>| {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        Ok((entry.path(), name))
    };
    entries.map(file).collect()
}

/// Replaces the folder `out` by these files. Returns their total size in bytes.
fn replace(out: &Path, files: &[(PathBuf, String)]) -> Result<u64> {
    let has_files = fs::read_dir(out).is_ok_and(|mut entries| entries.next().is_some());
    if has_files && !out.join(BOARD).is_file() {
        bail!(
            "expected an empty folder or an earlier build of `cargo xtask web`; found other files"
        );
    }
    let part = out.with_extension("part");
    if part.exists() {
        fs::remove_dir_all(&part)?;
    }
    fs::create_dir_all(&part)?;
    let mut bytes = 0;
    for (source, name) in files {
        let copied = fs::copy(source, part.join(name));
        bytes += copied.with_context(|| source.display().to_string())?;
    }
    if out.exists() {
        fs::remove_dir_all(out)?;
    }
    fs::rename(&part, out)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_with_other_files_stays() {
        let folder = paths::target().join("tmp/xtask-web");
        // The output of an earlier run.
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        let source = folder.join("source");
        fs::write(&source, "1").unwrap();
        let out = folder.join("out");
        let files = |names: &[&str]| -> Vec<_> {
            names
                .iter()
                .map(|name| (source.clone(), (*name).to_owned()))
                .collect()
        };
        assert_eq!(replace(&out, &files(&[BOARD, "old"])).unwrap(), 2);
        assert_eq!(replace(&out, &files(&[BOARD])).unwrap(), 1);
        assert!(!out.join("old").exists() && !out.with_extension("part").exists());
        assert!(replace(&folder, &files(&[BOARD])).is_err() && source.exists());
    }
}
