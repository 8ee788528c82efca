//! `report`: measures the error of Glint's kernels against their run time and writes the pages of `docs/report`.

#![forbid(unsafe_code)]

mod cycles;
mod fixed_point;
mod gouraud;
mod imu;
mod page;
mod plot;
mod rates;
mod raymarch;
mod soc;
mod table;
mod triangle;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::{Args, Parser, Subcommand};
use glint_reference::sine::subjects::subjects;
use glint_reference::sine::sweep::sweep;
use glint_reference::sine::truth::reference_error;
use indicatif::{ProgressBar, ProgressStyle};

use cycles::Cycles;
use table::{Provenance, Row};

/// Measures error against run time.
#[derive(Parser)]
#[command(name = "report")]
struct Arguments {
    #[command(subcommand)]
    page: Page,
}

#[derive(Subcommand)]
enum Page {
    /// Sine and cosine, over all inputs, beside other libraries
    Sine(SineArguments),
    /// The triangle engine on the whole SoC, beside its targets
    Triangle(triangle::Arguments),
    /// Distance fields: the raymarcher's pictures against exact hits, and what they take
    Raymarch(raymarch::Arguments),
    /// Smooth shading beside light that is linear on the screen
    Gouraud(gouraud::Arguments),
    /// Attitudes from a gyroscope and an accelerometer against f64 and the truth
    Imu(imu::Arguments),
}

#[derive(Args)]
struct SineArguments {
    /// Take a sample of the inputs instead of all (seconds instead of minutes)
    #[arg(long)]
    quick: bool,
    /// Print the rows as JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Folder for sine.csv, sine.svg and sine.md [default: docs/report, or target/report with --quick]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    cycles: cycles::Source,
}

fn main() -> Result<()> {
    match Arguments::parse().page {
        Page::Sine(arguments) => sine(&arguments),
        Page::Triangle(arguments) => triangle::report(&arguments),
        Page::Raymarch(arguments) => raymarch::report(&arguments),
        Page::Gouraud(arguments) => gouraud::report(&arguments),
        Page::Imu(arguments) => imu::report(&arguments),
    }
}

/// A path from the workspace's root.
fn in_workspace(path: &str) -> PathBuf {
    let reference = Path::new(env!("CARGO_MANIFEST_DIR"));
    reference.ancestors().nth(2).unwrap_or(reference).join(path)
}

/// Steps in a sample; odd strides visit all low bits.
const SAMPLE: u64 = 1 << 15;

fn sine(arguments: &SineArguments) -> Result<()> {
    let cycles = sine_cycles(arguments);
    let subjects = subjects();
    let strides: Vec<u64> = subjects
        .iter()
        .map(|subject| {
            if arguments.quick {
                (subject.steps() / SAMPLE) | 1
            } else {
                1
            }
        })
        .collect();
    let steps = subjects
        .iter()
        .zip(&strides)
        .map(|(subject, stride)| subject.steps().div_ceil(*stride))
        .sum();
    let provenance = Provenance::find();
    let bar = progress_bar(steps)?;
    let mut rows = Vec::new();
    for (subject, &stride) in subjects.iter().zip(&strides) {
        bar.set_message(format!("{} {}", subject.kernel, subject.config));
        let statistics = sweep(subject, stride, &|steps| bar.inc(steps));
        let measured = match &cycles {
            Ok(cycles) => cycles.get(subject.kernel).copied(),
            Err(_) => None,
        };
        rows.push(Row::new(
            subject,
            stride,
            &statistics,
            measured,
            &provenance,
        ));
    }
    bar.set_message("the reference itself");
    let reference_error = reference_error(if arguments.quick { (1 << 14) + 1 } else { 15 });
    bar.finish_and_clear();

    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&rows)?);
    } else {
        print!("{}", table::terminal(&rows));
        println!("The f64 reference itself is off by at most {reference_error:.1e}.");
        if let Err(reason) = &cycles {
            println!("Cycles were not measured: {reason:#}.");
        }
    }
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => in_workspace(if arguments.quick {
            "target/report"
        } else {
            "docs/report"
        }),
    };
    std::fs::create_dir_all(&out)
        .with_context(|| format!("cannot make the folder {}", out.display()))?;
    table::write_csv(&rows, &out.join("sine.csv"))?;
    plot::write(
        &table::DIAGRAM,
        &table::points(&rows),
        &out.join("sine.svg"),
    )?;
    page::write(
        &rows,
        reference_error,
        cycles.as_ref().err(),
        &out.join("sine.md"),
    )?;
    eprintln!("wrote sine.csv, sine.svg and sine.md to {}", out.display());
    Ok(())
}

fn sine_cycles(arguments: &SineArguments) -> Result<Cycles> {
    arguments.cycles.measure("sine")
}

fn progress_bar(steps: u64) -> Result<ProgressBar> {
    let style = ProgressStyle::with_template("{msg:28} {wide_bar} {percent:>3} %, {eta} left")?;
    Ok(ProgressBar::new(steps).with_style(style))
}
