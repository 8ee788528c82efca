//! Fuzzes every parser of external bytes, and prints the number of inputs per second.
#![forbid(unsafe_code)]

use anyhow::Context;
use clap::{Parser, ValueEnum};
use glint::fuzz::{Inputs, Target};
use indicatif::{ProgressBar, ProgressStyle};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Run fuzz targets on generated inputs; a panic is a finding.
///
/// The bytes of an input depend only on its seed and its number. The input of a finding is written
/// to a file; --only with the input's number runs it again.
#[derive(Parser)]
struct Arguments {
    /// Fuzz targets to run [default: all].
    #[arg(value_enum)]
    targets: Vec<Target>,
    /// Number of inputs that each target runs.
    #[arg(long, default_value_t = 100_000)]
    inputs: u64,
    /// Seed of the inputs.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of threads.
    #[arg(long, default_value_t = 1)]
    jobs: u64,
    /// Run only the input with this number.
    #[arg(long)]
    only: Option<u64>,
}

/// Number of consecutive inputs that a thread takes at a time.
const STRIDE: u64 = 256;

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let targets = if arguments.targets.is_empty() {
        Target::value_variants().to_vec()
    } else {
        arguments.targets.clone()
    };
    let mut findings = 0;
    for target in targets {
        let inputs = Inputs::new(target, arguments.seed);
        if let Some(number) = arguments.only {
            let accepted = inputs.run(number);
            println!("{target:?} {number}: accepted {accepted}");
            continue;
        }
        findings += fuzz(target, &inputs, &arguments)?;
    }
    anyhow::ensure!(
        findings == 0,
        "{findings} findings: inputs on which a target panicked"
    );
    Ok(())
}

/// Counts of the inputs of one target, shared by the threads that run them.
#[derive(Default)]
struct Tally {
    /// Number of the first input that no thread has taken.
    next: AtomicU64,
    done: AtomicU64,
    accepted: AtomicU64,
    findings: AtomicU64,
    /// Longest run time of an input in microseconds.
    slowest: AtomicU64,
}

fn fuzz(target: Target, inputs: &Inputs, arguments: &Arguments) -> anyhow::Result<u64> {
    let tally = Tally::default();
    let bar = ProgressBar::new(arguments.inputs).with_message(format!("{target:?}"));
    bar.set_style(ProgressStyle::with_template(
        "{msg} {wide_bar} {pos}/{len} {per_sec} {eta}",
    )?);
    let start = Instant::now();
    let quiet = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    std::thread::scope(|scope| {
        for _ in 0..arguments.jobs.max(1) {
            scope.spawn(|| work(target, inputs, arguments, &tally, &bar));
        }
    });
    std::panic::set_hook(quiet);
    bar.finish_and_clear();
    let seconds = start.elapsed().as_secs_f64();
    let value = |count: &AtomicU64| count.load(Ordering::Relaxed);
    let slowest = value(&tally.slowest);
    println!(
        "{target:?}: {} inputs (seed {}) in {seconds:.1} s, {:.0} a second; {:.1} % accepted; slowest {:.1} ms; {} panics",
        value(&tally.done),
        arguments.seed,
        value(&tally.done) as f64 / seconds,
        100.0 * value(&tally.accepted) as f64 / value(&tally.done).max(1) as f64,
        slowest as f64 / 1000.0,
        value(&tally.findings),
    );
    Ok(value(&tally.findings))
}

fn work(target: Target, inputs: &Inputs, arguments: &Arguments, tally: &Tally, bar: &ProgressBar) {
    loop {
        let first = tally.next.fetch_add(STRIDE, Ordering::Relaxed);
        if first >= arguments.inputs {
            return;
        }
        let mut accepted = 0;
        let last = arguments.inputs.min(first + STRIDE);
        for number in first..last {
            let start = Instant::now();
            let run = catch_unwind(AssertUnwindSafe(|| inputs.run(number)));
            tally.slowest.fetch_max(
                start.elapsed().min(Duration::from_secs(3600)).as_micros() as u64,
                Ordering::Relaxed,
            );
            accepted += u64::from(matches!(run, Ok(true)));
            if run.is_err() {
                tally.findings.fetch_add(1, Ordering::Relaxed);
                if let Err(error) = keep(target, inputs, number) {
                    eprintln!("{error:#}");
                }
            }
        }
        tally.accepted.fetch_add(accepted, Ordering::Relaxed);
        let done = tally.done.fetch_add(last - first, Ordering::Relaxed);
        bar.set_position(done);
    }
}

/// Writes the input of a finding to a file.
fn keep(target: Target, inputs: &Inputs, number: u64) -> anyhow::Result<()> {
    let path = format!("fuzz-{target:?}-{number}.bin").to_lowercase();
    std::fs::write(&path, inputs.input(number))
        .with_context(|| format!("{path}: cannot be written"))?;
    eprintln!(
        "{target:?} {number} panicked; its input is in {path}, and --only {number} shows the message"
    );
    Ok(())
}
