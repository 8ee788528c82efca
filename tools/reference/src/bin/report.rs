//! `report`: measures the errors and run times of Glint's computations and writes the pages of `docs/report`.

#![forbid(unsafe_code)]

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use clap::{Args, Parser, Subcommand};
use glint_core::picture::Size;
use glint_reference::report::cycles::{Cycles, Source};
use glint_reference::report::experiments::{
    geometry, gesture, gouraud, imu, kernels, long, quality, raymarch, sine, stiff, timeline,
    triangle,
};
use glint_reference::report::pages::{self, PAGES};
use glint_reference::report::table::write_csv;
use glint_reference::report::workspace;
use serde::Serialize;

/// Measures errors and run times for the pages of docs/report.
#[derive(Parser)]
#[command(name = "report")]
struct Arguments {
    #[command(subcommand)]
    page: Page,
}

#[derive(Subcommand)]
enum Page {
    /// Sine and cosine: errors over all inputs, and cycles, compared with other libraries
    Sine {
        /// Measure a sample of the inputs instead of all (seconds instead of minutes)
        #[arg(long)]
        quick: bool,
        #[command(flatten)]
        bench: Bench,
    },
    /// Speed of the triangle engine on the whole SoC, compared with its requirements
    Triangle {
        /// Leave out the soft core's frames, which take most of the time
        #[arg(long)]
        quick: bool,
        /// Measure only one table: engine, or cpu (the frames that the soft core draws)
        #[arg(long, value_name = "NAME", conflicts_with = "quick", value_parser = ["engine", "cpu"])]
        study: Option<String>,
        /// Measure only scenes whose name contains TEXT; the default folder is then target/report
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
        #[command(flatten)]
        output: Output,
    },
    /// Distance fields: errors, frames a second and studies of the raymarcher
    Raymarch {
        /// Measure only errors of pictures of 320x180 (seconds instead of minutes)
        #[arg(long)]
        quick: bool,
        /// Measure only one table: pictures, rates, or a study: fraction, cap, threshold, norm, end, prepass or normal
        #[arg(long, value_name = "NAME", conflicts_with_all = ["quick", "json"])]
        study: Option<String>,
        #[command(flatten)]
        output: Output,
    },
    /// Smooth shading and other forms of it: errors, clocks and FPGA resources
    Gouraud {
        /// Leave out the FPGA resources, which take most of the time
        #[arg(long)]
        quick: bool,
        /// Synthesise the engines of earlier commits again, too
        #[arg(long, conflicts_with = "quick")]
        earlier: bool,
        #[command(flatten)]
        output: Output,
    },
    /// Matrices, normals and projection with several word lengths: errors and cycles; drift of the wireframe simulator's rotation
    Geometry {
        #[command(flatten)]
        bench: Bench,
    },
    /// Attitudes from gyroscope and accelerometer, compared with f64 and with the true attitude
    Imu {
        /// Shorten long motions to a tenth and leave out motions of a day (half a minute instead of ten)
        #[arg(long)]
        quick: bool,
        #[command(flatten)]
        bench: Bench,
    },
    /// A hand that steers the camera: errors of its centre, and errors, lag and cycles of filters
    Gesture {
        #[command(flatten)]
        bench: Bench,
    },
    /// Reciprocals, roots, quotients, lengths, depth codes, colours and number formats: errors, and cycles or bits
    Kernels {
        /// Measure a sample of the inputs instead of all
        #[arg(long)]
        quick: bool,
        #[command(flatten)]
        bench: Bench,
    },
    /// Qualities of pictures: errors and frames a second of each scene in each size
    Quality {
        /// Measure only errors of pictures of 320x180
        #[arg(long)]
        quick: bool,
        /// Measure only one table: errors or cycles
        #[arg(long, value_name = "NAME", conflicts_with = "quick", value_parser = ["errors", "cycles"])]
        study: Option<String>,
        /// Measure only scenes whose name contains TEXT; the default folder is then target/report
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
        #[command(flatten)]
        output: Output,
    },
    /// Where the cycles of a frame of each scene go: soft core, passes of the engines, memory, evaluations
    Timeline {
        /// Measure only scenes whose name contains TEXT; the default folder is then target/report
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
        #[command(flatten)]
        output: Output,
    },
    /// Long runs of the whole firmware on the emulated board: 1,000,000 frames, counters that wrap, a day of the sensor
    Long {
        /// Shorten the runs to a hundredth (minutes instead of hours)
        #[arg(long)]
        quick: bool,
        /// Measure only one table
        #[arg(long, value_name = "NAME", value_parser = long::STUDIES)]
        study: Option<String>,
        /// Hours of the sensor, each of which takes minutes
        #[arg(
            long,
            value_name = "HOURS",
            default_value_t = 24.0,
            conflicts_with = "quick"
        )]
        hours: f64,
        #[command(flatten)]
        output: Output,
    },
    /// Stiff and extreme cases: runs the catalogue tools/reference/stiff, and fails where an outcome differs
    Stiff {
        /// Run only cases whose name or subject contains TEXT, and write no page
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
        /// Run the cases on the virtual board instead, which take minutes
        #[arg(long = "virtual")]
        on_virtual_board: bool,
        #[command(flatten)]
        output: Output,
    },
    /// Rebuild all pages and diagrams from their CSV files, without measuring
    Pages {
        /// Folder of CSV files, pages and diagrams [default: docs/report]
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// Options of a page that contains cycles of kernels on the soft core.
#[derive(Args)]
struct Bench {
    #[command(flatten)]
    output: Output,
    #[command(flatten)]
    cycles: Source,
}

#[derive(Args)]
struct Output {
    /// Print the rows as JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Folder of CSV files, page and diagrams [default: docs/report, or target/report with --quick]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write the CSV files alone, without page and diagrams
    #[arg(long)]
    tables: bool,
}

impl Output {
    /// Returns the folder for the results, and creates it if it is missing. `partial` selects the default folder of a quick run.
    fn folder(&self, partial: bool) -> Result<PathBuf> {
        let default = if partial {
            "target/report"
        } else {
            "docs/report"
        };
        let folder = self.out.clone().unwrap_or_else(|| workspace::path(default));
        std::fs::create_dir_all(&folder)
            .with_context(|| format!("cannot create the folder {}", folder.display()))?;
        Ok(folder)
    }

    /// Rebuilds a page from the CSV files in a folder, unless only these are wanted.
    fn rebuild(&self, name: &str, folder: &Path, rebuild: pages::Rebuild) -> Result<()> {
        if self.tables {
            return Ok(());
        }
        written(name, folder, rebuild)
    }

    /// Prints rows as JSON or as a table. `table` formats the rows as a table.
    fn print<T: Serialize>(&self, rows: &[T], table: fn(&[T]) -> String) -> Result<()> {
        if self.json {
            println!("{}", serde_json::to_string_pretty(rows)?);
        } else {
            print!("{}", table(rows));
        }
        Ok(())
    }
}

fn main() -> Result<()> {
    match Arguments::parse().page {
        Page::Sine { quick, bench } => measure_sine(quick, &bench),
        Page::Triangle {
            quick,
            study,
            only,
            output,
        } => measure_triangle(quick, study.as_deref(), only.as_deref(), &output),
        Page::Raymarch {
            quick,
            study,
            output,
        } => measure_raymarch(quick, study.as_deref(), &output),
        Page::Gouraud {
            quick,
            earlier,
            output,
        } => measure_gouraud(quick, earlier, &output),
        Page::Geometry { bench } => measure_geometry(&bench),
        Page::Imu { quick, bench } => measure_imu(quick, &bench),
        Page::Gesture { bench } => measure_gesture(&bench),
        Page::Kernels { quick, bench } => measure_kernels(quick, &bench),
        Page::Quality {
            quick,
            study,
            only,
            output,
        } => measure_quality(quick, study.as_deref(), only.as_deref(), &output),
        Page::Timeline { only, output } => measure_timeline(only.as_deref(), &output),
        Page::Long {
            quick,
            study,
            hours,
            output,
        } => measure_long(quick, study.as_deref(), hours, &output),
        Page::Stiff {
            only,
            on_virtual_board,
            output,
        } => measure_stiff(only.as_deref(), on_virtual_board, &output),
        Page::Pages { out } => {
            let folder = out.unwrap_or_else(|| workspace::path("docs/report"));
            PAGES
                .iter()
                .try_for_each(|(name, rebuild)| written(name, &folder, *rebuild))
        }
    }
}

/// Rebuilds a page in a folder and prints its path.
fn written(name: &str, folder: &Path, rebuild: pages::Rebuild) -> Result<()> {
    rebuild(folder).with_context(|| format!("the page {name}.md"))?;
    eprintln!("wrote {name}.md to {}", folder.display());
    Ok(())
}

fn measure_sine(quick: bool, bench: &Bench) -> Result<()> {
    let output = &bench.output;
    let cycles = bench.cycles.measure("sine").unwrap_or_else(|reason| {
        eprintln!("no cycles: {reason:#}");
        Cycles::new()
    });
    let (rows, reference) = sine::measure(quick, &cycles)?;
    output.print(&rows, pages::sine::table)?;
    let folder = output.folder(quick)?;
    write_csv(&rows, &folder.join("sine.csv"))?;
    write_csv(&[reference], &folder.join("sine-reference.csv"))?;
    output.rebuild("sine", &folder, pages::sine::rebuild)
}

/// Measures the engine and the soft core, or only the one that `study` names.
fn measure_triangle(
    quick: bool,
    study: Option<&str>,
    only: Option<&str>,
    output: &Output,
) -> Result<()> {
    let folder = output.folder(quick || only.is_some())?;
    if study != Some("cpu") {
        let rows = triangle::measure(only)?;
        output.print(&rows, pages::triangle::table)?;
        write_csv(&rows, &folder.join("triangle.csv"))?;
    }
    if study != Some("engine") && !quick {
        let rows = triangle::measure_cpu(only)?;
        output.print(&rows, pages::triangle::cpu_table)?;
        write_csv(&rows, &folder.join("triangle-cpu.csv"))?;
    }
    output.rebuild("triangle", &folder, pages::triangle::rebuild)
}

/// Measures the pictures, the rates and all studies of the raymarcher, or only what `study` names. Each table is written as soon as it is
/// complete, because the next one takes minutes to measure.
fn measure_raymarch(quick: bool, study: Option<&str>, output: &Output) -> Result<()> {
    let folder = output.folder(quick)?;
    if study.is_none_or(|study| study == "pictures") {
        let rows = raymarch::pictures::measure(quick);
        output.print(&rows, pages::raymarch::table)?;
        write_csv(&rows, &folder.join("raymarch.csv"))?;
    }
    if study.map_or(!quick, |study| study == "rates") {
        let rates = raymarch::rates::measure()?;
        write_csv(&rates, &folder.join("raymarch-rates.csv"))?;
    }
    if study.map_or(!quick, |study| !["pictures", "rates"].contains(&study)) {
        raymarch::studies::measure(study, |name, trials| {
            write_csv(trials, &folder.join(format!("raymarch-{name}.csv")))
        })?;
    }
    output.rebuild("raymarch", &folder, pages::raymarch::rebuild)
}

fn measure_gouraud(quick: bool, earlier: bool, output: &Output) -> Result<()> {
    let folder = output.folder(quick)?;
    let rows = gouraud::scenes::measure();
    output.print(&rows, pages::gouraud::table)?;
    write_csv(&rows, &folder.join("gouraud.csv"))?;
    write_csv(
        &gouraud::forms::measure(),
        &folder.join("gouraud-forms.csv"),
    )?;
    write_csv(
        &gouraud::clocks::measure()?,
        &folder.join("gouraud-clocks.csv"),
    )?;
    if !quick {
        let file = folder.join("gouraud-cost.csv");
        let mut costs = gouraud::engines::today()?;
        costs.extend(match earlier {
            true => gouraud::engines::earlier()?,
            false => gouraud::engines::kept(&file)?,
        });
        write_csv(&costs, &file)?;
    }
    output.rebuild("gouraud", &folder, pages::gouraud::rebuild)
}

fn measure_kernels(quick: bool, bench: &Bench) -> Result<()> {
    let output = &bench.output;
    let cycles = bench.cycles.measure("kernels")?;
    let rows = kernels::measure(None, if quick { 64 } else { 1 }, &cycles)?;
    output.print(&rows, pages::kernels::table)?;
    let folder = output.folder(quick)?;
    write_csv(&rows, &folder.join("kernels.csv"))?;
    output.rebuild("kernels", &folder, pages::kernels::rebuild)
}

/// Measures errors and cycles, or only the table that `study` names.
fn measure_quality(
    quick: bool,
    study: Option<&str>,
    only: Option<&str>,
    output: &Output,
) -> Result<()> {
    let folder = output.folder(quick || only.is_some())?;
    let only = only.unwrap_or_default();
    if study != Some("cycles") {
        let sizes = if quick { &Size::ALL[..1] } else { &Size::ALL };
        let rows = quality::errors(only, sizes)?;
        output.print(&rows, pages::quality::table)?;
        write_csv(&rows, &folder.join("quality.csv"))?;
    }
    if study != Some("errors") && !quick {
        let rows = quality::cycles(only)?;
        write_csv(&rows, &folder.join("quality-cycles.csv"))?;
    }
    output.rebuild("quality", &folder, pages::quality::rebuild)
}

fn measure_timeline(only: Option<&str>, output: &Output) -> Result<()> {
    let rows = timeline::measure(only.unwrap_or_default())?;
    output.print(&rows, pages::timeline::table)?;
    let folder = output.folder(only.is_some())?;
    write_csv(&rows, &folder.join("timeline.csv"))?;
    output.rebuild("timeline", &folder, pages::timeline::rebuild)
}

/// Runs all studies, or only the one that `study` names. Each table is written as soon as it is complete.
fn measure_long(quick: bool, study: Option<&str>, hours: f64, output: &Output) -> Result<()> {
    let folder = output.folder(quick)?;
    let file = |name: &str| folder.join(format!("long-{name}.csv"));
    let is_selected = |name: &str| study.is_none_or(|study| study == name);
    let (turns, hours) = if quick { (4, 0.24) } else { (400, hours) };
    if is_selected("orbit") {
        let rows = long::orbit::measure(turns, long::orbit::FRAMES)?;
        output.print(&rows, pages::long::orbit_table)?;
        write_csv(&rows, &file("orbit"))?;
    }
    if is_selected("uptime") {
        let rows = long::uptime::measure(quick)?;
        output.print(&rows, pages::long::uptime_table)?;
        write_csv(&rows, &file("uptime"))?;
    }
    for path in long::sensor::Path::ALL {
        if is_selected(path.name()) {
            let rows = long::sensor::measure(path, hours)?;
            output.print(&rows, pages::long::sensor_table)?;
            write_csv(&rows, &file(path.name()))?;
        }
    }
    output.rebuild("long", &folder, pages::long::rebuild)
}

fn measure_stiff(only: Option<&str>, on_virtual_board: bool, output: &Output) -> Result<()> {
    let (part, table) = match on_virtual_board {
        false => (stiff::Part::Host, "stiff.csv"),
        true => (stiff::Part::VirtualBoard, "stiff-virtual.csv"),
    };
    let rows = stiff::measure(part, only)?;
    output.print(&rows, pages::stiff::sections)?;
    let differing: Vec<_> = rows.iter().filter(|row| !row.holds).collect();
    for row in &differing {
        eprintln!(
            "{}: expected {:?}, measured {:?}",
            row.case, row.expected, row.measured
        );
    }
    ensure!(
        differing.is_empty(),
        "{} of {} cases differ: mend the code, or state and explain the outcome in tools/reference/stiff",
        differing.len(),
        rows.len()
    );
    if only.is_some() {
        return Ok(());
    }
    let folder = output.folder(false)?;
    write_csv(&rows, &folder.join(table))?;
    output.rebuild("stiff", &folder, pages::stiff::rebuild)
}

fn measure_geometry(bench: &Bench) -> Result<()> {
    let output = &bench.output;
    let cycles = bench.cycles.measure("geometry")?;
    let kernels = geometry::precision::measure(&cycles);
    output.print(&kernels, |rows| pages::geometry::kernel_table(rows))?;
    let folder = output.folder(false)?;
    write_csv(&kernels, &folder.join("geometry-precision.csv"))?;
    let drift = geometry::drift::measure();
    write_csv(&drift, &folder.join("geometry-drift.csv"))?;
    output.rebuild("geometry", &folder, pages::geometry::rebuild)
}

fn measure_imu(quick: bool, bench: &Bench) -> Result<()> {
    let (output, source) = (&bench.output, &bench.cycles);
    let part = if quick { 0.1 } else { 1.0 };
    let folder = output.folder(quick)?;
    let file = |name: &str| folder.join(name);
    let cycles = source.measure("attitude")?;
    let replays = imu::soft_core::replays(source, (100_000.0 * part) as u64)?;
    write_csv(&imu::soft_core::kernels(&cycles)?, &file("imu-cycles.csv"))?;
    write_csv(&replays, &file("imu-replay.csv"))?;
    eprintln!("targets …");
    let count = imu::targets::one_count(part);
    let targets = imu::targets::measure(part, count);
    write_csv(&targets, &file("imu.csv"))?;
    eprintln!("methods …");
    write_csv(&imu::methods::measure(&cycles), &file("imu-methods.csv"))?;
    eprintln!("filters …");
    write_csv(&imu::filters::measure(part), &file("imu-filters.csv"))?;
    eprintln!("stiff cases …");
    let stiff = imu::stiff::measure(part, (!quick).then_some(count));
    write_csv(&stiff, &file("imu-stiff.csv"))?;
    eprintln!("error over time …");
    write_csv(&imu::time::measure(190.0 * part), &file("imu-time.csv"))?;
    output.print(&targets, pages::imu::table)?;
    output.rebuild("imu", &folder, pages::imu::rebuild)
}

fn measure_gesture(bench: &Bench) -> Result<()> {
    let output = &bench.output;
    let cycles = bench.cycles.measure("gesture")?;
    let folder = output.folder(false)?;
    let file = |name: &str| folder.join(name);
    let recordings = gesture::recordings();
    let filters = gesture::filters(&recordings, &cycles);
    output.print(&filters, pages::gesture::table)?;
    write_csv(&filters, &file("gesture-filters.csv"))?;
    let centres = gesture::centres(50, false);
    let targets = gesture::targets(&centres, &recordings, &cycles)?;
    write_csv(&targets, &file("gesture.csv"))?;
    write_csv(&centres, &file("gesture-centre.csv"))?;
    write_csv(&gesture::stiff(), &file("gesture-stiff.csv"))?;
    output.rebuild("gesture", &folder, pages::gesture::rebuild)
}
