//! The Rust tests: builds the test programs, and runs them on the threads that ask for it.
//!
//! `cargo test` runs the programs one after another, and long programs end with a single test on one core. Here each thread takes the
//! next program when it has finished one.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, MutexGuard};
use std::vec::IntoIter;

use anyhow::{Result, bail};
use serde::Deserialize;

use crate::{paths, run};

/// Cargo options that compile the references in one part, and at the lowest level that inlines functions well: their tests save more
/// time by it than the build takes.
const QUICK_BUILD: [&str; 4] = [
    "--config",
    "profile.dev.package.glint-reference.opt-level=2",
    "--config",
    "profile.dev.package.glint-reference.codegen-units=1",
];

/// The longest-running programs, by package and target, longest first. These programs start first; otherwise a long program would
/// run alone at the end.
const LONGEST: [(&str, &str); 7] = [
    ("glint", "board"),
    ("glint", "page"),
    ("testbench", "triangle"),
    ("glint", "programs"),
    ("virtual-board", "board"),
    ("reference", "reference"),
    ("testbench", "raymarch"),
];

/// A built test program.
struct Program {
    path: PathBuf,
    /// Folder of the package, the working directory of its tests.
    package: PathBuf,
    target: String,
}

impl Program {
    /// The program's position in [`LONGEST`]; the list's length if absent.
    fn rank(&self) -> usize {
        let is_it = |(package, target): &(&str, &str)| {
            self.package.ends_with(package) && self.target == *target
        };
        LONGEST.iter().position(is_it).unwrap_or(LONGEST.len())
    }

    fn name(&self) -> String {
        let root = paths::root();
        let package = self.package.strip_prefix(&root).unwrap_or(&self.package);
        format!("tests of {}: {}", package.display(), self.target)
    }
}

/// The fields of cargo's messages about a built test program.
#[derive(Deserialize)]
struct Artifact {
    executable: Option<PathBuf>,
    manifest_path: PathBuf,
    target: Target,
    profile: Profile,
}

#[derive(Deserialize)]
struct Target {
    name: String,
}

#[derive(Deserialize)]
struct Profile {
    test: bool,
}

/// All test programs of a build, and the results of those that have run.
pub struct Programs {
    waiting: Mutex<IntoIter<Program>>,
    results: Mutex<Results>,
}

impl Programs {
    /// Builds the test programs of `selection`, arguments of `cargo test`; of the whole workspace if it is empty.
    ///
    /// # Errors
    /// The build fails.
    pub fn build(selection: &[&str]) -> Result<Self> {
        let mut programs = Vec::new();
        run::watched_step(
            "build of the tests",
            run::cargo(&[
                "test",
                "--no-run",
                "--message-format",
                "json-render-diagnostics",
            ])
            .args(QUICK_BUILD)
            .args(selection),
            |line| programs.extend(test_program(line)),
        )?;
        programs.sort_by_key(Program::rank);
        Ok(Self {
            waiting: Mutex::new(programs.into_iter()),
            results: Mutex::default(),
        })
    }

    /// Runs programs with `environment` until none is waiting. Several threads may do so at the same time.
    pub fn run(&self, environment: &[(&str, &OsStr)]) {
        // A separate function, because in `while let` the lock's guard would live until the program ends.
        let next = || lock(&self.waiting).next();
        while let Some(program) = next() {
            let mut command = Command::new(&program.path);
            command.current_dir(&program.package);
            run_tests(&program.name(), command, environment, &self.results);
        }
    }

    /// Prints the output of failed tests again. Returns the number of passed tests.
    ///
    /// # Errors
    /// A test has failed; the error names the programs.
    pub fn results(&self) -> Result<u32> {
        let results = lock(&self.results);
        for line in &results.output {
            println!("    {line}");
        }
        if !results.failed.is_empty() {
            bail!("{}", results.failed.join("\n"));
        }
        Ok(results.passed)
    }
}

/// Runs the examples in the documentation. Returns the number of passed examples.
///
/// # Errors
/// An example fails.
pub fn run_examples() -> Result<u32> {
    let results = Mutex::new(Results::default());
    let mut command = run::cargo(&["test", "--doc"]);
    command.args(QUICK_BUILD);
    run_tests("examples in the documentation", command, &[], &results);
    let results = results.into_inner().expect("tests do not panic");
    match results.failed.first() {
        Some(error) => bail!("{error}"),
        None => Ok(results.passed),
    }
}

#[derive(Default)]
struct Results {
    passed: u32,
    /// Output of the failed tests.
    output: Vec<String>,
    /// The error of each failed program.
    failed: Vec<String>,
}

/// Runs the test `command` as the step `name`, and adds its results.
fn run_tests(
    name: &str,
    mut command: Command,
    environment: &[(&str, &OsStr)],
    results: &Mutex<Results>,
) {
    let (mut passed, mut output, mut in_failures) = (0, Vec::new(), false);
    let outcome = run::watched_step(name, command.envs(environment.iter().copied()), |line| {
        passed += passed_tests(line).unwrap_or(0);
        in_failures = line == "failures:" || in_failures && !line.starts_with("test result: ");
        if in_failures {
            output.push(line.to_owned());
        }
    });
    let mut results = lock(results);
    results.passed += passed;
    results.output.append(&mut output);
    results
        .failed
        .extend(outcome.err().map(|error| error.to_string()));
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().expect("tests do not panic")
}

/// Returns the test program named by a line of cargo's output; `None` for any other line.
fn test_program(line: &str) -> Option<Program> {
    let Artifact {
        executable: Some(path),
        manifest_path,
        target,
        profile: Profile { test: true },
    } = serde_json::from_str(line).ok()?
    else {
        return None;
    };
    Some(Program {
        path,
        package: manifest_path.parent().map(Path::to_owned)?,
        target: target.name,
    })
}

/// Returns the number of passed tests from the last line of a test program's output: `test result: ok. 12 passed; 0 failed; …`.
fn passed_tests(line: &str) -> Option<u32> {
    let counts = line.strip_prefix("test result: ")?;
    let before = counts.split(" passed;").next()?;
    before.rsplit(' ').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_the_tests_of_a_closing_line() {
        let line = "test result: ok. 12 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out";
        assert_eq!(passed_tests(line), Some(12));
        assert_eq!(passed_tests("running 12 tests"), None);
    }

    #[test]
    fn finds_the_test_programs_in_the_messages_of_cargo() {
        let message = |executable: &str, test: bool| {
            format!(
                r#"{{"reason":"compiler-artifact","manifest_path":"/a/tools/glint/Cargo.toml","target":{{"name":"board"}},"profile":{{"test":{test}}},"executable":{executable}}}"#
            )
        };
        let program = test_program(&message(r#""/a/board-1""#, true)).expect("a program");
        assert_eq!(program.path, Path::new("/a/board-1"));
        assert_eq!(program.package, Path::new("/a/tools/glint"));
        assert_eq!((program.rank(), &*program.target), (0, "board"));
        for line in [
            &*message("null", true),
            &*message(r#""/a/board-1""#, false),
            r#"{"reason":"build-finished","success":true}"#,
            "   Compiling glint v0.1.0",
        ] {
            assert!(test_program(line).is_none(), "{line}");
        }
    }
}
