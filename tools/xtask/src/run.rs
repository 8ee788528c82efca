//! Runs programs with a progress line, and shows their output only on failure.

use std::collections::VecDeque;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, IsTerminal, Write};
use std::process::{Child, Command, Stdio};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use rustix::param::clock_ticks_per_second;
use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};

use crate::paths;

/// Number of output lines shown on failure, from the end. The log has all lines.
const SHOWN_ON_FAILURE: usize = 60;

/// Progress lines of the running steps.
static SPINNERS: LazyLock<MultiProgress> = LazyLock::new(MultiProgress::new);

/// Whether to print progress to standard error instead of standard output.
static TO_STDERR: AtomicBool = AtomicBool::new(false);

/// Prints progress to standard error from now on, for commands with data on standard output.
pub fn progress_to_stderr() {
    TO_STDERR.store(true, Ordering::Relaxed);
}

/// Prints a line above the progress lines.
pub fn print_progress(line: &str) {
    SPINNERS.suspend(|| {
        if TO_STDERR.load(Ordering::Relaxed) {
            eprintln!("{line}");
        } else {
            println!("{line}");
        }
    });
}

/// Returns the cargo command of a check. The build is not incremental, because incremental compilation costs a clean build time and
/// space. The build has no debug information, which would take a tenth of the time and is not needed for the line numbers of panics.
pub fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new("cargo");
    command
        .args(arguments)
        .env("CARGO_INCREMENTAL", "0")
        .env("CARGO_PROFILE_DEV_DEBUG", "none")
        .current_dir(paths::root());
    command
}

/// Returns the command that runs a module or a program of the gateware in the Python environment.
pub fn python(arguments: &[&str]) -> Command {
    let mut command = Command::new(paths::venv_program("python"));
    command
        .args(arguments)
        .env("PYTHONPATH", paths::root().join("gateware"))
        .current_dir(paths::root());
    command
}

/// Runs `command` as the step `name`: shows its latest line of output while it runs, writes all output to `target/log`, and
/// prints one line with the run time and the processor time at the end.
///
/// # Errors
/// The program cannot be started, or fails. The end of a failed program's output is printed.
pub fn step(name: &str, command: &mut Command) -> Result<()> {
    watched_step(name, command, |_| ())
}

/// Runs a step like [`step`], and calls `watch` with each line of output.
///
/// # Errors
/// Those of [`step`].
pub fn watched_step(name: &str, command: &mut Command, mut watch: impl FnMut(&str)) -> Result<()> {
    let start = Instant::now();
    let bar = spinner(name);
    let log_path = log_path(name)?;
    let mut log =
        File::create(&log_path).with_context(|| format!("creating {}", log_path.display()))?;
    let (reader, writer) = std::io::pipe()?;
    command
        .stdin(Stdio::null())
        .stdout(writer.try_clone()?)
        .stderr(writer);
    let program = command.get_program().to_string_lossy().into_owned();
    let mut child = command
        .spawn()
        .with_context(|| format!("{name}: cannot start `{program}`"))?;
    // `command` still holds the writing ends of the pipe. Drop them here: reading ends only when all writing ends are closed,
    // those of the child process too.
    command.stdout(Stdio::null()).stderr(Stdio::null());
    let mut tail = VecDeque::new();
    let mut lines = BufReader::new(reader);
    let mut raw = Vec::new();
    while lines.read_until(b'\n', &mut raw)? > 0 {
        log.write_all(&raw)?;
        let line = String::from_utf8_lossy(&raw).trim_end().to_owned();
        watch(&line);
        bar.set_message(line.chars().take(90).collect::<String>());
        if tail.len() == SHOWN_ON_FAILURE {
            tail.pop_front();
        }
        tail.push_back(line);
        raw.clear();
    }
    let busy = processor_seconds(&child);
    let status = child.wait()?;
    bar.finish_and_clear();
    let seconds = start.elapsed().as_secs_f64();
    if status.success() {
        let busy = busy.map_or(String::new(), |busy| format!(" {busy:7.1} s CPU"));
        print_progress(&format!("  ok   {seconds:6.1} s{busy}  {name}"));
        return Ok(());
    }
    // One write, because another step may print at the same time.
    let tail: String = tail.iter().map(|line| format!("\n    {line}")).collect();
    print_progress(&format!("  FAIL {seconds:6.1} s  {name}{tail}"));
    bail!("{name} failed ({status}); see {}", log_path.display())
}

/// Waits until a child process has ended. Returns the processor time of the process and of those that it has waited for, in seconds: steps
/// run side by side, so the time that passes says little about one of them. `None` if the system does not tell.
fn processor_seconds(child: &Child) -> Option<f64> {
    /// Position of the first of the four times, behind the name of the program, which may contain spaces (proc_pid_stat(5)).
    const FIRST_TIME: usize = 11;
    let ended = WaitIdOptions::EXITED | WaitIdOptions::NOWAIT;
    // The system keeps the counters until `Child::wait`.
    waitid(WaitId::Pid(Pid::from_child(child)), ended).ok()?;
    let counters = fs::read_to_string(format!("/proc/{}/stat", child.id())).ok()?;
    let fields = counters.rsplit_once(')')?.1.split_whitespace();
    let times = fields.skip(FIRST_TIME).take(4).map(str::parse::<u64>);
    let ticks: u64 = times.sum::<Result<_, _>>().ok()?;
    Some(ticks as f64 / clock_ticks_per_second() as f64)
}

/// Runs `command` on this terminal, for programs with their own progress.
///
/// # Errors
/// The program cannot be started, or fails.
pub fn foreground(name: &str, command: &mut Command) -> Result<()> {
    let program = command.get_program().to_string_lossy().into_owned();
    let status = command
        .status()
        .with_context(|| format!("{name}: cannot start `{program}`"))?;
    if !status.success() {
        bail!("{name} failed ({status})");
    }
    Ok(())
}

/// Builds the `program` of a `package` of the workspace.
///
/// # Errors
/// Those of [`step`].
pub fn build_program(package: &str, program: &str) -> Result<()> {
    step(
        &format!("build {program}"),
        Command::new("cargo")
            .args(["build", "--package", package, "--bin", program])
            .current_dir(paths::root()),
    )
}

/// Builds a program of the workspace as a step, then runs it on this terminal.
///
/// # Errors
/// The build or the program fails.
pub fn program(package: &str, program: &str, subcommand: &str, arguments: &[String]) -> Result<()> {
    let select = ["--package", package, "--bin", program];
    build_program(package, program)?;
    foreground(
        &format!("{program} {subcommand}"),
        Command::new("cargo")
            .args(["run", "--quiet"])
            .args(select)
            .args(["--", subcommand])
            .args(arguments)
            .current_dir(paths::root()),
    )
}

/// Runs `command` without showing its output; returns whether it succeeds.
pub fn succeeds(command: &mut Command) -> bool {
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// Starts a spinner for the step `name`. Without a terminal it prints one line instead.
fn spinner(name: &str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        print_progress(&format!("  ...            {name}"));
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("  {spinner} {elapsed:>8}  {prefix}  {msg:.dim}")
        .expect("a valid constant template");
    let bar = SPINNERS.add(
        ProgressBar::new_spinner()
            .with_style(style)
            .with_prefix(name.to_owned()),
    );
    bar.enable_steady_tick(Duration::from_millis(120));
    bar
}

/// Path of a step's log: `target/log/NAME.log`, where NAME is made a valid file name.
fn log_path(name: &str) -> Result<std::path::PathBuf> {
    let folder = paths::target().join("log");
    fs::create_dir_all(&folder).with_context(|| format!("creating {}", folder.display()))?;
    let file: String = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    Ok(folder.join(file).with_extension("log"))
}
