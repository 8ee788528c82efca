//! `cargo xtask test`: sets up the machine, then runs every check.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, mpsc};
use std::thread;
use std::time::Instant;

use anyhow::{Result, bail};

use crate::gateware::{self, Board, Library};
use crate::rust_tests::{self, Programs};
use crate::{bootstrap, firmware, modules, resources, run, scenes, walk, web};

/// Sets up, builds and tests everything. A failed check does not stop the other checks; a failed build stops the command.
///
/// The Python packages and the gateware's builds and checks run in parallel with cargo's, because most of them use one core. The
/// Rust tests wait for the gateware tests, which build the verilated models that the Rust tests use.
///
/// # Errors
/// A build or a check fails; the error names the checks.
pub fn test() -> Result<()> {
    let start = Instant::now();
    bootstrap::programs()?;

    let results = CheckResults::default();
    let (gateware_is_built, gateware_builds) = mpsc::channel();
    let (models_are_built, models) = mpsc::channel();
    thread::scope(|scope| -> Result<()> {
        scope.spawn(|| {
            let built = bootstrap::python_environment()
                .and_then(|()| gateware::build(Board::Virtual))
                .and_then(|()| gateware::build(Board::Urbana));
            let is_built = built.is_ok();
            // Errors of sending are ignored: the receiver is dropped only if another build has failed.
            let _ = gateware_is_built.send(built);
            if !is_built {
                return;
            }
            results.add(gateware_check(
                "gateware tests",
                &["-m", "pytest", "gateware/tests"],
            ));
            let _ = models_are_built.send(());
            results.add(gateware_check("proofs", &["gateware/formal/run.py"]));
            results.add(resources::check());
        });
        firmware::build(Board::Virtual, &[])?;
        web::build(None)?;
        results.add(scenes::generate(true));
        results.add(modules::check());
        results.add(cargo("formatting", &["fmt", "--all", "--check"]));
        results.add(linted("clippy", &["check", "--all-targets"]));
        let firmware = ["--package", "glint-firmware", "--features", "peers"];
        let firmware = [&["check", "--target", firmware::TARGET], &firmware[..]].concat();
        results.add(linted("clippy of the firmware", &firmware));
        results.add(firmware::check_peers().map(|_| ()));
        let documentation = ["doc", "--no-deps", "--document-private-items"];
        results.add(linted("rustdoc", &documentation));
        let tests = Programs::build(&[])?;
        gateware_builds.recv().expect("the builds do not panic")?;
        scope.spawn(|| results.add(walk::walk(&walk::SAMPLE.map(str::to_owned))));
        models.recv().expect("the gateware's checks do not panic");
        results.add_tests(tests.run(&[]));
        results.add_tests(rust_tests::run_examples());
        Ok(())
    })?;

    let minutes = start.elapsed().as_secs_f64() / 60.0;
    println!("{minutes:.1} minutes");
    results.finish()
}

/// Sets up, and runs the firmware's and `glint`'s tests on a virtual board with a system clock of `megahertz` MHz. The standard
/// build of the board is kept.
///
/// # Errors
/// A build or a test fails.
pub fn test_at_clock(megahertz: &str) -> Result<()> {
    bootstrap::bootstrap()?;
    let folder = gateware::build_beside(megahertz, &["--clock", megahertz], Library::Profiled)?;
    firmware::build(Board::Virtual, &[])?;
    let tests = Programs::build(&["-p", "virtual-board", "-p", "glint", "--test", "board"])?;
    let passed = tests.run(&[("GLINT_VIRTUAL_BOARD", folder.as_os_str())])?;
    println!("{passed} passed at {megahertz} MHz");
    Ok(())
}

/// Number of passed checks, and the errors of failed checks.
#[derive(Default)]
struct CheckResults {
    passed: AtomicU32,
    failures: Mutex<Vec<String>>,
}

impl CheckResults {
    /// Adds the outcome of one check.
    fn add(&self, outcome: Result<()>) {
        self.add_tests(outcome.map(|()| 1));
    }

    /// Adds the outcome of tests, with the number of passed tests.
    fn add_tests(&self, outcome: Result<u32>) {
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
fn cargo(name: &str, arguments: &[&str]) -> Result<()> {
    run::step(name, &mut run::cargo(arguments))
}

/// Runs a cargo command as a check with clippy as the compiler and warnings as errors. `cargo clippy` uses another compiler than
/// `cargo doc`, which would then compile every crate again.
fn linted(name: &str, arguments: &[&str]) -> Result<()> {
    run::step(
        name,
        run::cargo(arguments)
            .env("RUSTC_WORKSPACE_WRAPPER", "clippy-driver")
            .env("CLIPPY_ARGS", "-Dwarnings")
            .env("RUSTDOCFLAGS", "-Dwarnings"),
    )
}

/// Runs a Python program as a check, such as the gateware tests or the proofs.
fn gateware_check(name: &str, program: &[&str]) -> Result<()> {
    run::step(name, &mut run::python(program))
}
