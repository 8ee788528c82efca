//! `cargo xtask test`: every check, on a machine that it sets up itself.

use std::ffi::OsStr;
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, mpsc};
use std::thread;
use std::time::Instant;

use anyhow::{Result, bail};

use crate::gateware::{self, Board};
use crate::{bootstrap, firmware, modules, pac, paths, resources, run, scenes, walk};

/// Sets up, builds and tests everything. A failed check does not stop the other checks; a failed build stops the command.
///
/// The checks of the gateware run in parallel with those of cargo, because most checks keep one core busy. The Rust tests wait
/// for the gateware tests, which build the verilated models that the Rust tests use.
///
/// # Errors
/// A build or a check fails; the error names the checks.
pub fn test() -> Result<()> {
    let start = Instant::now();
    bootstrap::bootstrap()?;
    gateware::build(Board::Virtual)?;
    gateware::build(Board::Urbana)?;

    let results = CheckResults::default();
    let (models_are_built, models) = mpsc::channel();
    thread::scope(|scope| -> Result<()> {
        scope.spawn(|| {
            results.add(gateware_check("gateware tests", "gateware/tests/run.py"));
            // The error is ignored: sending fails only if the receiver is gone because a build has failed.
            let _ = models_are_built.send(());
            results.add(gateware_check("proofs", "gateware/formal/run.py"));
            results.add(resources::check_own_blocks().map(|()| 1));
            results.add(resources::check_clock_rates().map(|()| 1));
        });
        firmware::build(Board::Virtual, &[])?;
        results.add(pac::generate(true).map(|()| 1));
        results.add(scenes::generate(true).map(|()| 1));
        results.add(modules::check().map(|()| 1));
        results.add(cargo("formatting", &["fmt", "--all", "--check"]));
        results.add(cargo(
            "clippy",
            &["clippy", "--all-targets", "--", "-D", "warnings"],
        ));
        results.add(cargo(
            "clippy of the firmware",
            &[
                "clippy",
                "--package",
                "glint-firmware",
                "--target",
                firmware::TARGET,
                "--features",
                "peers",
                "--",
                "-D",
                "warnings",
            ],
        ));
        results.add(documentation());
        results.add(cargo("build of the tests", &["test", "--no-run"]));
        scope.spawn(|| results.add(walk::walk(&walk::SAMPLE.map(str::to_owned)).map(|()| 1)));
        models.recv().expect("the gateware's checks do not panic");
        results.add(cargo_tests(&[], &[]));
        Ok(())
    })?;

    let minutes = start.elapsed().as_secs_f64() / 60.0;
    println!("{minutes:.1} minutes");
    results.finish()
}

/// Sets up and runs the tests on the virtual board, the firmware's and those of `glint`, on a board whose system clock has
/// `megahertz` MHz. The board is built beside the standard one.
///
/// # Errors
/// A build or a test fails.
pub fn test_at_clock(megahertz: &str) -> Result<()> {
    bootstrap::bootstrap()?;
    let folder = gateware::build_beside(Board::Virtual, megahertz, &["--clock", megahertz])?;
    firmware::build(Board::Virtual, &[])?;
    let passed = cargo_tests(
        &["-p", "virtual-board", "-p", "glint", "--test", "board"],
        &[("GLINT_VIRTUAL_BOARD", folder.as_os_str())],
    )?;
    println!("{passed} passed at {megahertz} MHz");
    Ok(())
}

/// Numbers of passed checks, and the errors of failed ones.
#[derive(Default)]
struct CheckResults {
    passed: AtomicU32,
    failures: Mutex<Vec<String>>,
}

impl CheckResults {
    fn add(&self, outcome: Result<u32>) {
        match outcome {
            Ok(count) => {
                self.passed.fetch_add(count, Ordering::Relaxed);
            }
            Err(error) => self.lock().push(error.to_string()),
        }
    }

    fn lock(&self) -> MutexGuard<'_, Vec<String>> {
        self.failures.lock().expect("checks do not panic")
    }

    /// Prints the counts; fails if a check has failed.
    fn finish(&self) -> Result<()> {
        let failures = self.lock();
        println!(
            "{} passed, {} failed",
            self.passed.load(Ordering::Relaxed),
            failures.len()
        );
        if !failures.is_empty() {
            bail!("{}", failures.join("\n"));
        }
        Ok(())
    }
}

/// Runs a cargo command as a check.
fn cargo(name: &str, arguments: &[&str]) -> Result<u32> {
    run::step(
        name,
        Command::new("cargo")
            .args(arguments)
            .current_dir(paths::root()),
    )?;
    Ok(1)
}

fn documentation() -> Result<u32> {
    run::step(
        "rustdoc",
        Command::new("cargo")
            .args(["doc", "--no-deps", "--document-private-items"])
            .env("RUSTDOCFLAGS", "-D warnings")
            .current_dir(paths::root()),
    )?;
    Ok(1)
}

/// Runs a Python program as a check: the gateware tests, or the proofs.
fn gateware_check(name: &str, program: &str) -> Result<u32> {
    run::step(
        name,
        Command::new(paths::venv_program("python"))
            .arg(program)
            .current_dir(paths::root()),
    )?;
    Ok(1)
}

/// Runs the Rust tests that `selection` selects, or without a selection all of them, including those on the virtual board, with
/// `environment`. Returns the number of passed tests. Output of failed tests is printed again at the end.
fn cargo_tests(selection: &[&str], environment: &[(&str, &OsStr)]) -> Result<u32> {
    let mut passed = 0;
    let mut failures = Vec::new();
    let mut in_failures = false;
    let outcome = run::watched_step(
        "cargo test",
        Command::new("cargo")
            .args(["test", "--no-fail-fast"])
            .args(selection)
            .envs(environment.iter().copied())
            .current_dir(paths::root()),
        |line| {
            passed += passed_tests(line).unwrap_or(0);
            in_failures = line == "failures:" || in_failures && !line.starts_with("test result: ");
            if in_failures {
                failures.push(line.to_owned());
            }
        },
    );
    for line in failures {
        println!("    {line}");
    }
    outcome.map(|()| passed)
}

/// Returns the number of passed tests from the last line of a test program's output: `test result: ok. 12 passed; 0 failed; …`.
fn passed_tests(line: &str) -> Option<u32> {
    let counts = line.strip_prefix("test result: ")?;
    let before = counts.split(" passed;").next()?;
    before.rsplit(' ').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::passed_tests;

    #[test]
    fn counts_the_tests_of_a_closing_line() {
        let line = "test result: ok. 12 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out";
        assert_eq!(passed_tests(line), Some(12));
        assert_eq!(passed_tests("running 12 tests"), None);
    }
}
