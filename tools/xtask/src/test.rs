//! `cargo xtask test`: sets up the machine, then runs every check.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, mpsc};
use std::thread;
use std::time::Instant;

use anyhow::{Result, bail};
use rustix::thread::CpuSet;

use crate::gateware::{self, Board, Library};
use crate::rust_tests::{self, Programs};
use crate::{bootstrap, cores, firmware, modules, resources, run, scenes, walk, web};

/// Sets up, builds and tests everything. A failed check does not stop the other checks; a failed build stops the command.
///
/// The gateware's builds and checks run on one half of the cores, and cargo's on the other. The Rust tests need both, and run on each half
/// when its other work has ended.
///
/// # Errors
/// A build or a check fails; the error names the checks.
pub fn test() -> Result<()> {
    let start = Instant::now();
    bootstrap::programs()?;

    let results = CheckResults::default();
    let [gateware_cores, cargo_cores] = cores::halves();
    let tests = thread::scope(|scope| -> Result<Arc<Programs>> {
        let (gateware_is_built, gateware_builds) = mpsc::channel();
        let (models_are_built, models) = mpsc::channel();
        let (tests_are_built, built_tests) = mpsc::channel();
        let results = &results;
        scope.spawn(move || {
            let built = build_gateware(&gateware_cores);
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
            // If a build of cargo's has failed, its thread has dropped the sender.
            let Ok(tests): Result<Arc<Programs>, _> = built_tests.recv() else {
                return;
            };
            results.add(walk::walk(&walk::SAMPLE.map(str::to_owned)));
            tests.run(&[]);
        });
        cores::keep_to(&cargo_cores);
        firmware::build(Board::Virtual, &[])?;
        web::build(None)?;
        results.add(scenes::generate(true));
        results.add(modules::check());
        results.add(crate::interface::write(true));
        results.add(cargo("formatting", &["fmt", "--all", "--check"]));
        results.add(linted("clippy", &["check", "--all-targets"]));
        let firmware = ["--package", "glint-firmware", "--features", "peers"];
        let firmware = [&["check", "--target", firmware::TARGET], &firmware[..]].concat();
        results.add(linted("clippy of the firmware", &firmware));
        results.add(firmware::check_peers().map(|_| ()));
        let documentation = ["doc", "--no-deps", "--document-private-items"];
        results.add(linted("rustdoc", &documentation));
        let tests = Arc::new(Programs::build(&[])?);
        gateware_builds.recv().expect("the builds do not panic")?;
        let _ = tests_are_built.send(Arc::clone(&tests));
        models.recv().expect("the gateware's checks do not panic");
        tests.run(&[]);
        results.add_tests(rust_tests::run_examples());
        Ok(tests)
    })?;
    results.add_tests(tests.results());

    let minutes = start.elapsed().as_secs_f64() / 60.0;
    println!("{minutes:.1} minutes");
    results.finish()
}

/// Sets up Python and builds the gateware that tests use, on `cores`; they stay those of this thread.
fn build_gateware(cores: &CpuSet) -> Result<()> {
    cores::keep_to(cores);
    bootstrap::python_environment()?;
    gateware::build(Board::Virtual)?;
    gateware::build(Board::Urbana)
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
    let environment = [("GLINT_VIRTUAL_BOARD", folder.as_os_str())];
    thread::scope(|scope| {
        for half in cores::halves() {
            let (tests, environment) = (&tests, &environment);
            scope.spawn(move || {
                cores::keep_to(&half);
                tests.run(environment);
            });
        }
    });
    let passed = tests.results()?;
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

/// Runs a cargo command as a check with clippy as the compiler and warnings as errors. `cargo clippy` is not used: its
/// compiler differs from that of `cargo doc`, which would compile every crate again.
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
