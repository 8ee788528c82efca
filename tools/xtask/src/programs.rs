//! `cargo xtask programs`: builds the example programs for the soft core.
//!
//! The files of a program are `target/firmware/programs/NAME.elf` and its memory image, `NAME.bin`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};
use glint_program_image as image;
use litex_pac::memories::MAIN_RAM;

use crate::firmware::{TARGET, write};
use crate::{paths, run};

/// The packages of programs, with the folders of their sources.
const PACKAGES: [(&str, &str); 2] = [
    ("glint-program", "firmware/examples"),
    ("glint-embedded-3dgfx", "firmware/embedded-3dgfx/examples"),
];

/// Builds every example program.
///
/// # Errors
/// A program does not compile, or is not a program for the virtual board.
pub fn build() -> Result<()> {
    let built = paths::target().join("firmware-build");
    let mut cargo = Command::new("cargo");
    cargo.args(["build", "--examples"]);
    for (package, _) in PACKAGES {
        cargo.args(["--package", package]);
    }
    cargo.args(["--profile", "firmware", "--target", TARGET]);
    cargo.arg("--target-dir").arg(&built);
    cargo.current_dir(paths::root());
    run::step("build the example programs", &mut cargo)?;
    let folder = folder();
    fs::create_dir_all(&folder).with_context(|| format!("creating {}", folder.display()))?;
    for name in names()? {
        let elf = built.join(TARGET).join("firmware/examples").join(&name);
        let elf = fs::read(&elf).with_context(|| format!("reading {}", elf.display()))?;
        let image = image::of_elf(&elf, MAIN_RAM.size.into()).with_context(|| name.clone())?;
        let path = folder.join(&name).with_extension("elf");
        write(&path, &elf)?;
        write(&path.with_extension("bin"), &image)?;
        let path = Path::new("target/firmware/programs").join(&name);
        let (path, length) = (path.with_extension("elf"), image.len());
        run::print_progress(&format!("  {}: {length} bytes in memory", path.display()));
    }
    Ok(())
}

/// The folder of the built programs.
pub fn folder() -> PathBuf {
    paths::target().join("firmware/programs")
}

/// The names of the programs, in order.
///
/// # Errors
/// A folder of the sources cannot be read.
pub fn names() -> Result<Vec<String>> {
    let mut names = Vec::new();
    for (_, folder) in PACKAGES {
        let files = fs::read_dir(paths::root().join(folder));
        for file in files.with_context(|| format!("reading {folder}"))? {
            let path = file?.path();
            if path.extension().is_some_and(|extension| extension == "rs") {
                names.extend(
                    path.file_stem()
                        .map(|name| name.to_string_lossy().into_owned()),
                );
            }
        }
    }
    names.sort();
    Ok(names)
}
