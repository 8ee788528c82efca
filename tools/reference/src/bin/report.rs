//! `report`: measures the errors and run times of Glint's computations and writes the tables and pages of `docs/report`.

#![forbid(unsafe_code)]

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use glint_core::picture::Samples;
use glint_core::quality::Quality;
use glint_reference::report::cycles::{Cycles, Source};
use glint_reference::report::experiments::{
    antialiasing, constants, cpu, geometry, gesture, gouraud, imu, kernels, long, quality,
    raymarch, sine, stiff, textures, timeline, triangle,
};
use glint_reference::report::provenance::{Commit, Provenance};
use glint_reference::report::table::write_csv;
use glint_reference::report::workspace;
use serde::Serialize;

/// Measures errors and run times for the pages of docs/report.
#[derive(Parser)]
#[command(name = "report")]
struct Arguments {
    #[command(subcommand)]
    page: Page,
    /// Folder of CSV files, page and diagrams [default: docs/report, or target/report with --quick or --only]
    #[arg(long, value_name = "DIR", global = true)]
    out: Option<PathBuf>,
    /// Write only the CSV files, without page and diagrams
    #[arg(long, global = true)]
    tables: bool,
}

#[derive(Subcommand)]
enum Page {
    /// Sine and cosine: errors over all inputs, and cycles, compared with other libraries
    Sine {
        /// Measure a sample of the inputs instead of all inputs (seconds instead of minutes)
        #[arg(long)]
        quick: bool,
        #[command(flatten)]
        cycles: Source,
    },
    /// Speed of the triangle engine on the whole SoC, compared with its requirements
    Triangle {
        /// Skip the soft core's frames, which take most of the time
        #[arg(long)]
        quick: bool,
        /// Measure only one table: engine, or cpu (frames drawn by the soft core)
        #[arg(long, value_name = "NAME", conflicts_with = "quick", value_parser = ["engine", "cpu"])]
        study: Option<String>,
        /// Measure only scenes whose name contains TEXT
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
    },
    /// Distance fields: errors, frames a second and studies of the raymarcher
    Raymarch {
        /// Measure only the errors of pictures of 320x180 (seconds instead of minutes)
        #[arg(long)]
        quick: bool,
        /// Measure only one table
        #[arg(long, value_name = "NAME", conflicts_with = "quick", value_parser = ["pictures", "rates", "scenes", "words", "fillet"])]
        study: Option<String>,
        /// Measure only the rates of fields whose text contains TEXT
        #[arg(long, value_name = "TEXT", requires = "study")]
        only: Option<String>,
    },
    /// Smooth shading and its alternatives: errors, clocks and FPGA resources
    Gouraud {
        /// Skip the FPGA resources, which take most of the time
        #[arg(long)]
        quick: bool,
        /// Also synthesise the engines of earlier commits again
        #[arg(long, conflicts_with = "quick")]
        earlier: bool,
    },
    /// Textures: errors of positions with fewer divisions, misses of caches for texels, errors of filters and formats, speed of the engine
    Textures {
        /// Skip the frames on the virtual board
        #[arg(long)]
        quick: bool,
    },
    /// Matrices, normals and projection with several word lengths: errors and cycles; drift of the wireframe simulator's rotation
    Geometry {
        #[command(flatten)]
        cycles: Source,
    },
    /// Attitudes from gyroscope and accelerometer, compared with f64 and with the true attitude
    Imu {
        /// Shorten long motions to a tenth and skip motions of a day (half a minute instead of ten minutes)
        #[arg(long)]
        quick: bool,
        #[command(flatten)]
        cycles: Source,
    },
    /// Camera control by a hand: errors of the hand's centre, and errors, lag and cycles of filters
    Gesture {
        #[command(flatten)]
        cycles: Source,
    },
    /// Reciprocals, roots, quotients, lengths, depth codes, colours and number formats: errors, and cycles or bits
    Kernels {
        /// Measure a sample of the inputs instead of all inputs
        #[arg(long)]
        quick: bool,
        #[command(flatten)]
        cycles: Source,
    },
    /// Picture quality: errors and frames a second of each scene at each size
    Quality {
        /// Measure only the errors of pictures of 320x180
        #[arg(long)]
        quick: bool,
        /// Measure only one table: errors or cycles
        #[arg(long, value_name = "NAME", conflicts_with = "quick", value_parser = ["errors", "cycles"])]
        study: Option<String>,
        /// Measure only scenes whose name contains TEXT
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
    },
    /// One and four samples a pixel: errors against 64 samples, patterns, dithering, cycles
    Antialiasing {
        /// Measure only one table or group of tables: errors or cycles
        #[arg(long, value_name = "NAME", value_parser = ["errors", "cycles"])]
        study: Option<String>,
        /// Measure only scenes whose name contains TEXT
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
    },
    /// Cycles of a frame of each scene by cause: soft core, engine passes, memory, evaluations
    Timeline {
        /// Measure only scenes whose name contains TEXT
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
    },
    /// Variants of the soft core: clock rate and cells alone, and cycles of frames on the SoC
    Cpu {
        /// Measure only one table: cores (clock rates and cells, which take minutes each), or frames
        #[arg(long, value_name = "NAME", value_parser = ["cores", "frames"])]
        study: Option<String>,
        /// Measure only variants whose names contain TEXT
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
    },
    /// Long runs of the whole firmware on the emulated board: 1,000,000 frames, counters that wrap, a day of the sensor
    Long {
        /// Shorten the runs to a hundredth (minutes instead of hours)
        #[arg(long)]
        quick: bool,
        /// Measure only one table
        #[arg(long, value_name = "NAME", value_parser = long::STUDIES)]
        study: Option<String>,
        /// Simulated hours of the sensor, minutes of run time each
        #[arg(
            long,
            value_name = "HOURS",
            default_value_t = 24.0,
            conflicts_with = "quick"
        )]
        hours: f64,
    },
    /// Stiff and extreme cases: run the catalogue tools/reference/stiff, and fail if an outcome differs
    Stiff {
        /// Run only cases whose name or subject contains TEXT, and write no page
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
        /// Run only the cases of the virtual board, which take minutes
        #[arg(long = "virtual")]
        on_virtual_board: bool,
    },
    /// Rebuild all pages and diagrams from their tables, without measuring
    Pages,
}

impl Page {
    /// Whether `--quick` or `--only` restricts the page's measurements.
    fn is_partial(&self) -> bool {
        match self {
            Self::Sine { quick, .. }
            | Self::Gouraud { quick, .. }
            | Self::Imu { quick, .. }
            | Self::Textures { quick }
            | Self::Kernels { quick, .. }
            | Self::Long { quick, .. } => *quick,
            Self::Triangle { quick, only, .. }
            | Self::Raymarch { quick, only, .. }
            | Self::Quality { quick, only, .. } => *quick || only.is_some(),
            Self::Antialiasing { only, .. }
            | Self::Timeline { only }
            | Self::Cpu { only, .. }
            | Self::Stiff { only, .. } => only.is_some(),
            Self::Geometry { .. } | Self::Gesture { .. } | Self::Pages => false,
        }
    }
}

/// The output folder.
struct Folder {
    path: PathBuf,
    provenance: Provenance,
}

impl Folder {
    /// Writes a table of rows with the commit and the tools.
    fn write<T: Serialize>(&self, name: &str, rows: &[T]) -> Result<()> {
        self.write_with(name, rows, &self.provenance)
    }

    /// Writes a table of rows with the commit.
    fn write_with_commit<T: Serialize>(&self, name: &str, rows: &[T]) -> Result<()> {
        let commit = self.provenance.commit.clone();
        self.write_with(name, rows, &Commit { commit })
    }

    fn write_with<T: Serialize>(
        &self,
        name: &str,
        rows: &[T],
        provenance: &impl Serialize,
    ) -> Result<()> {
        let rows: Vec<_> = rows.iter().map(|row| (row, provenance)).collect();
        self.write_alone(name, &rows)
    }

    /// Writes a table of the rows alone. A table is written as soon as it is complete, because the next table may take minutes.
    fn write_alone<T: Serialize>(&self, name: &str, rows: &[T]) -> Result<()> {
        let path = self.path.join(name).with_extension("csv");
        write_csv(rows, &path)?;
        eprintln!("wrote {}: {} rows", path.display(), rows.len());
        Ok(())
    }

    /// Builds the named pages, or all pages, from the tables.
    fn make_pages(&self, names: &[&str]) -> Result<()> {
        let python = workspace::path(".venv/bin/python");
        let made = Command::new(&python)
            .arg(workspace::path("tools/reference/pages"))
            .arg("--out")
            .arg(&self.path)
            .args(names)
            .status()
            .with_context(|| format!("{}: cannot start", python.display()))?;
        ensure!(made.success(), "the pages cannot be made");
        Ok(())
    }
}

fn main() -> Result<()> {
    let matches = Arguments::command().get_matches();
    let arguments = Arguments::from_arg_matches(&matches)?;
    let default = match arguments.page.is_partial() {
        true => "target/report",
        false => "docs/report",
    };
    let folder = arguments.out.unwrap_or_else(|| workspace::path(default));
    std::fs::create_dir_all(&folder)
        .with_context(|| format!("cannot create the folder {}", folder.display()))?;
    let to = Folder {
        path: folder,
        provenance: Provenance::find(),
    };
    match arguments.page {
        Page::Sine { quick, cycles } => measure_sine(quick, &cycles, &to)?,
        Page::Triangle { quick, study, only } => {
            measure_triangle(quick, study.as_deref(), only.as_deref(), &to)?;
        }
        Page::Raymarch { quick, study, only } => {
            measure_raymarch(quick, study.as_deref(), only.as_deref(), &to)?;
        }
        Page::Gouraud { quick, earlier } => measure_gouraud(quick, earlier, &to)?,
        Page::Textures { quick } => {
            to.write("textures-runs", &textures::runs::measure())?;
            to.write("textures-cache", &textures::cache::measure())?;
            to.write("textures-filters", &textures::filters::measure())?;
            to.write("textures-formats", &textures::filters::measure_formats())?;
            if !quick {
                to.write("textures-engine", &textures::engine::measure()?)?;
            }
        }
        Page::Geometry { cycles } => {
            let cycles = cycles.measure("geometry")?;
            to.write("geometry-precision", &geometry::precision::measure(&cycles))?;
            to.write("geometry-drift", &geometry::drift::measure())?;
            to.write("geometry-turns", &geometry::turns::measure()?)?;
        }
        Page::Imu { quick, cycles } => measure_imu(quick, &cycles, &to)?,
        Page::Gesture { cycles } => measure_gesture(&cycles, &to)?,
        Page::Kernels { quick, cycles } => {
            let cycles = cycles.measure("kernels")?;
            let rows = kernels::measure(if quick { 64 } else { 1 }, &cycles)?;
            to.write("kernels", &rows)?;
        }
        Page::Quality { quick, study, only } => {
            measure_quality(quick, study.as_deref(), only.as_deref(), &to)?;
        }
        Page::Antialiasing { study, only } => {
            measure_antialiasing(study.as_deref(), only.as_deref(), &to)?;
        }
        Page::Timeline { only } => {
            to.write(
                "timeline",
                &timeline::measure(only.as_deref().unwrap_or_default())?,
            )?;
        }
        Page::Cpu { study, only } => {
            let only = only.as_deref().unwrap_or_default();
            if study.as_deref() != Some("frames") {
                to.write_with_commit("cpu-cores", &cpu::cores(only)?)?;
            }
            if study.as_deref() != Some("cores") {
                to.write("cpu", &cpu::frames(only)?)?;
            }
        }
        Page::Long {
            quick,
            study,
            hours,
        } => {
            measure_long(quick, study.as_deref(), hours, &to)?;
        }
        Page::Stiff {
            only,
            on_virtual_board,
        } => {
            measure_stiff(only.as_deref(), on_virtual_board, &to)?;
            if only.is_some() {
                return Ok(());
            }
        }
        Page::Pages => {
            to.write_alone("constants", &constants::all())?;
            return to.make_pages(&[]);
        }
    }
    match matches.subcommand_name() {
        Some(page) if !arguments.tables => to.make_pages(&[page]),
        _ => Ok(()),
    }
}

fn measure_sine(quick: bool, cycles: &Source, to: &Folder) -> Result<()> {
    let cycles = cycles.measure("sine").unwrap_or_else(|reason| {
        eprintln!("no cycles: {reason:#}");
        Cycles::new()
    });
    let (rows, reference) = sine::measure(quick, &cycles)?;
    to.write("sine", &rows)?;
    to.write_alone("sine-reference", &[reference])
}

/// Measures the engine and the soft core, or only the table `study`.
fn measure_triangle(
    quick: bool,
    study: Option<&str>,
    only: Option<&str>,
    to: &Folder,
) -> Result<()> {
    if study != Some("cpu") {
        to.write("triangle", &triangle::measure(only)?)?;
    }
    if study != Some("engine") && !quick {
        to.write_with_commit("triangle-cpu", &triangle::measure_cpu(only)?)?;
    }
    Ok(())
}

/// Measures all tables of the raymarcher, or only the table `study`.
fn measure_raymarch(
    quick: bool,
    study: Option<&str>,
    only: Option<&str>,
    to: &Folder,
) -> Result<()> {
    if study.is_none_or(|study| study == "pictures") {
        to.write("raymarch", &raymarch::pictures::measure(quick))?;
    }
    if study.map_or(!quick, |study| study == "rates") {
        to.write_with_commit(
            "raymarch-rates",
            &raymarch::rates::measure(only.unwrap_or_default())?,
        )?;
    }
    if study.map_or(!quick, |study| study == "scenes") {
        let scenes = quality::scenes(only.unwrap_or_default());
        let fields = scenes.filter(|scene| scene.scene().shows_field());
        let cycles = quality::cycles(fields, Some(Samples::One))?;
        to.write_with_commit("raymarch-scenes", &cycles)?;
    }
    if study.map_or(!quick, |study| study == "words") {
        to.write_with_commit("raymarch-words", &raymarch::words::measure()?)?;
    }
    if study.map_or(!quick, |study| study == "fillet") {
        to.write_with_commit("raymarch-fillet", &raymarch::fillet::measure())?;
    }
    Ok(())
}

fn measure_gouraud(quick: bool, earlier: bool, to: &Folder) -> Result<()> {
    to.write("gouraud", &gouraud::scenes::measure())?;
    to.write_with_commit("gouraud-forms", &gouraud::forms::measure())?;
    to.write_with_commit("gouraud-colours", &gouraud::colours::measure())?;
    to.write_with_commit("gouraud-clocks", &gouraud::clocks::measure()?)?;
    if quick {
        return Ok(());
    }
    let mut costs = gouraud::engines::today()?;
    costs.extend(match earlier {
        true => gouraud::engines::earlier()?,
        false => gouraud::engines::kept()?,
    });
    to.write_alone("gouraud-cost", &costs)
}

/// Measures errors and cycles, or only the table `study`.
fn measure_quality(
    quick: bool,
    study: Option<&str>,
    only: Option<&str>,
    to: &Folder,
) -> Result<()> {
    let only = only.unwrap_or_default();
    if study != Some("cycles") {
        let wanted = |quality: Quality| !quick || quality == Quality::Fast;
        to.write("quality", &quality::errors(only, wanted)?)?;
    }
    if study != Some("errors") && !quick {
        let cycles = quality::cycles(quality::scenes(only), None)?;
        to.write_with_commit("quality-cycles", &cycles)?;
    }
    Ok(())
}

/// Measures errors and cycles, or only the table or group of tables `study`.
fn measure_antialiasing(study: Option<&str>, only: Option<&str>, to: &Folder) -> Result<()> {
    let only = only.unwrap_or_default();
    if study != Some("cycles") {
        let tables = antialiasing::tables::measure(only)?;
        to.write("antialiasing", &tables.errors)?;
        to.write_with_commit("antialiasing-patterns", &tables.patterns)?;
        to.write_with_commit("antialiasing-dither", &tables.dither)?;
        to.write_with_commit("antialiasing-light", &tables.light)?;
    }
    if study != Some("errors") {
        to.write_with_commit("antialiasing-cycles", &antialiasing::cycles::measure(only)?)?;
    }
    Ok(())
}

/// Executes all long runs, or only the run of the table `study`.
fn measure_long(quick: bool, study: Option<&str>, hours: f64, to: &Folder) -> Result<()> {
    let is_selected = |name: &str| study.is_none_or(|study| study == name);
    let (turns, hours) = if quick { (4, 0.24) } else { (400, hours) };
    if is_selected("orbit") {
        to.write_with_commit(
            "long-orbit",
            &long::orbit::measure(turns, long::orbit::FRAMES)?,
        )?;
    }
    if is_selected("uptime") {
        to.write_with_commit("long-uptime", &long::uptime::measure(quick)?)?;
    }
    for path in long::sensor::Path::ALL {
        if is_selected(path.name()) {
            to.write_with_commit(
                &format!("long-{}", path.name()),
                &long::sensor::measure(path, hours)?,
            )?;
        }
    }
    Ok(())
}

/// Runs the cases and prints the outcomes that differ from the catalogue. Errors are only measured in cases that run on the host.
fn measure_stiff(only: Option<&str>, on_virtual_board: bool, to: &Folder) -> Result<()> {
    let part = match on_virtual_board {
        false => stiff::Part::Host,
        true => stiff::Part::VirtualBoard,
    };
    let cases = stiff::measure(part, only)?;
    let differing: Vec<_> = cases.iter().filter(|case| !case.holds()).collect();
    for case in &differing {
        eprintln!(
            "{}: expected {:?}, measured {:?}",
            case.case, case.expected, case.outcome
        );
    }
    ensure!(
        differing.is_empty(),
        "{} of {} cases differ: fix the code, or state and explain the outcome in tools/reference/stiff",
        differing.len(),
        cases.len()
    );
    eprintln!("{} cases have the expected outcome", cases.len());
    match part == stiff::Part::Host && only.is_none() {
        true => to.write_alone("stiff", &stiff::errors(&cases)),
        false => Ok(()),
    }
}

fn measure_imu(quick: bool, source: &Source, to: &Folder) -> Result<()> {
    let part = if quick { 0.1 } else { 1.0 };
    let cycles = source.measure("attitude")?;
    let replays = imu::soft_core::replays(source, (100_000.0 * part) as u64)?;
    to.write_alone("imu-cycles", &imu::soft_core::kernels(&cycles)?)?;
    to.write_alone("imu-replay", &replays)?;
    let count = imu::targets::one_count(part);
    to.write("imu", &imu::targets::measure(part, count))?;
    to.write_with_commit("imu-methods", &imu::methods::measure(&cycles))?;
    to.write_with_commit("imu-filters", &imu::filters::measure(part))?;
    to.write_alone(
        "imu-stiff",
        &imu::stiff::measure(part, (!quick).then_some(count)),
    )?;
    to.write_alone("imu-time", &imu::time::measure(190.0 * part))
}

fn measure_gesture(cycles: &Source, to: &Folder) -> Result<()> {
    let cycles = cycles.measure("gesture")?;
    let recordings = gesture::recordings();
    to.write("gesture-filters", &gesture::filters(&recordings, &cycles))?;
    let centres = gesture::centres(50, false);
    to.write_with_commit(
        "gesture",
        &gesture::targets(&centres, &recordings, &cycles)?,
    )?;
    to.write_with_commit("gesture-centre", &centres)?;
    to.write_with_commit("gesture-stiff", &gesture::stiff())
}
