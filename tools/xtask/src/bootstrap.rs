//! Setup of a Debian machine: packages, Rust targets, the Python environment.

use std::fs;
use std::process::Command;

use anyhow::{Context, Result, bail};

use crate::{firmware, paths, run};

/// Debian packages and their purposes.
const PACKAGES: [(&str, &str); 9] = [
    (
        "ccache",
        "caches the objects of the C library for the BIOS of each board",
    ),
    ("chromium", "opens the live page in tests"),
    ("clang-19", "compiles the verilated SoC"),
    ("gcc-riscv64-unknown-elf", "compiles the LiteX BIOS"),
    (
        "libclang-rt-19-dev",
        "provides branch counters for the verilated SoC",
    ),
    ("llvm-19", "merges the branch counts for the compiler"),
    ("make", "builds the LiteX BIOS"),
    ("python3-tk", "interprets the script for Vivado in tests"),
    (
        "python3-venv",
        "creates the environment of the Python packages",
    ),
];

/// Rust target of the live page's emulated board.
pub const WEB_TARGET: &str = "wasm32-unknown-unknown";

/// Rust targets of the firmware and of the live page.
const RUST_TARGETS: [&str; 2] = [firmware::TARGET, WEB_TARGET];

/// Pinned Python packages, for the gateware and for the report.
const REQUIREMENTS: [&str; 2] = [
    "gateware/requirements.txt",
    "tools/reference/requirements.txt",
];

/// Installs missing prerequisites. Returns quickly if everything is installed.
///
/// # Errors
/// Lists each missing prerequisite with the command that installs it.
pub fn bootstrap() -> Result<()> {
    all([debian_packages(), rust_targets(), python_environment()])
}

/// Installs the prerequisites of the Rust crates: all prerequisites except the Python environment.
///
/// # Errors
/// Those of [`bootstrap`].
pub fn programs() -> Result<()> {
    all([debian_packages(), rust_targets()])
}

/// Joins the errors of missing prerequisites.
fn all<const COUNT: usize>(outcomes: [Result<()>; COUNT]) -> Result<()> {
    let missing: Vec<String> = outcomes
        .into_iter()
        .filter_map(Result::err)
        .map(|error| format!("- {error:#}"))
        .collect();
    if !missing.is_empty() {
        bail!("the setup is incomplete:\n{}", missing.join("\n"));
    }
    Ok(())
}

fn debian_packages() -> Result<()> {
    let missing: Vec<&str> = PACKAGES
        .iter()
        .map(|(package, _)| *package)
        .filter(|package| !is_present(package))
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    for (package, purpose) in PACKAGES
        .iter()
        .filter(|(package, _)| missing.contains(package))
    {
        run::print_progress(&format!("  missing: {package} ({purpose})"));
    }
    let by_hand = format!(
        "apt-get update && apt-get install --no-install-recommends {}",
        missing.join(" ")
    );
    if !run::succeeds(Command::new("sh").args(["-c", "test \"$(id -u)\" = 0"])) {
        bail!("Debian packages: root required; run: sudo sh -c '{by_hand}'");
    }
    run::step("apt-get update", Command::new("apt-get").arg("update"))?;
    run::step(
        "apt-get install",
        Command::new("apt-get")
            .args(["install", "--yes", "--no-install-recommends"])
            .args(&missing)
            .env("DEBIAN_FRONTEND", "noninteractive"),
    )
    .with_context(|| format!("Debian packages: run: {by_hand}"))
}

/// Whether the program of a package runs. The program may have been installed without the package.
fn is_present(package: &str) -> bool {
    match package {
        "gcc-riscv64-unknown-elf" => {
            run::succeeds(Command::new("riscv64-unknown-elf-gcc").arg("--version"))
        }
        "libclang-rt-19-dev" => {
            let program = "echo 'int main() { return 0; }' | clang++-19 -fprofile-generate -x c++ -o /dev/null -";
            run::succeeds(Command::new("sh").args(["-c", program]))
        }
        // Only the subcommands of some releases have the option `--version`.
        "llvm-19" => run::succeeds(Command::new("llvm-profdata-19").args(["merge", "--version"])),
        "python3-tk" => run::succeeds(Command::new("python3").args(["-c", "import tkinter"])),
        "python3-venv" => run::succeeds(Command::new("python3").args(["-c", "import ensurepip"])),
        program => run::succeeds(Command::new(program).arg("--version")),
    }
}

/// Installs missing Rust targets.
///
/// # Errors
/// Names the command that installs the missing targets.
pub fn rust_targets() -> Result<()> {
    let mut missing = Vec::new();
    for target in RUST_TARGETS {
        let installed = Command::new("rustc")
            .args(["--print", "target-libdir", "--target", target])
            .output()
            .context("rustc: not found; install Rust with rustup")?;
        let folder = String::from_utf8_lossy(&installed.stdout).trim().to_owned();
        if !fs::exists(&folder).unwrap_or(false) {
            missing.push(target);
        }
    }
    if missing.is_empty() {
        return Ok(());
    }
    run::step(
        "rustup target add",
        Command::new("rustup")
            .args(["target", "add"])
            .args(&missing),
    )
    .with_context(|| {
        let missing = missing.join(" ");
        format!("Rust targets: run: rustup target add {missing}")
    })
}

/// Creates the Python environment with Debian's package `python3-venv`.
///
/// # Errors
/// Python is missing or too old, or its packages cannot be installed.
pub fn python_environment() -> Result<()> {
    let supported = "import sys; sys.exit(sys.version_info < (3, 11))";
    if !run::succeeds(Command::new("python3").args(["-c", supported])) {
        bail!("python3: expected version 3.11 or later (Debian 12 has it)");
    }
    let mut requirements = String::new();
    for file in REQUIREMENTS {
        requirements += &fs::read_to_string(paths::root().join(file))
            .with_context(|| format!("reading {file}"))?;
    }
    let stamp = paths::venv().join("requirements.installed");
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == requirements) {
        return Ok(());
    }
    run::step(
        "python environment",
        Command::new("python3")
            .args(["-m", "venv", "--clear"])
            .arg(paths::venv()),
    )
    .context("the Python environment: expected Debian's package python3-venv")?;
    run::step(
        "python packages",
        Command::new(paths::venv_program("pip"))
            .args(["install", "--disable-pip-version-check", "--no-compile"])
            .args(REQUIREMENTS.iter().flat_map(|file| ["--requirement", file]))
            .current_dir(paths::root()),
    )
    .context("the Python packages: expected access to PyPI")?;
    fs::write(&stamp, requirements).with_context(|| format!("writing {}", stamp.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tests run after the set-up, so every program must be found; otherwise its package would be installed at each run.
    #[test]
    fn no_package_is_missing_after_the_setup() {
        for (package, _) in PACKAGES {
            assert!(is_present(package), "{package}");
        }
    }
}
