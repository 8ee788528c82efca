//! The page `triangle.md`: the triangle engine on the whole SoC, with LiteDRAM and scan-out running.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use glint::board::{SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::convert::{self, Options};
use glint::error::Place;
use glint::generate;
use glint::polygons::{Corner, Polygons};
use glint::render::{self, Renderer, Route, Scene, Stats, Subject};
use glint::view;
use glint_core::camera::View;
use glint_core::picture::Backend;
use serde::Serialize;

use crate::in_workspace;
use crate::soc::{self, Bench, CLOCKS};
use crate::table::Provenance;

#[derive(clap::Args)]
pub struct Arguments {
    /// Print the rows as JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Leave the CPU's frames out, which take most of the time
    #[arg(long)]
    quick: bool,
    /// Only scenes whose name contains this
    #[arg(long, value_name = "TEXT")]
    only: Option<String>,
    /// Folder for triangle.csv and triangle.md [default: docs/report, or target/report with --only or --quick]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// What is asked of a scene.
#[derive(Clone, Copy)]
enum Target {
    /// Pixels a clock while a triangle is walked over, at least.
    Fill(f64),
    /// Pixels a clock, frames back to back: at least, and the aim.
    Sustained(f64, f64),
    /// Clocks a triangle: at most, and the aim.
    Triangle(f64, f64),
    /// Frames a second at 81.25 MHz: at least, and the aim.
    Frames(f64, Option<f64>),
}

struct Case {
    name: &'static str,
    mesh: fn() -> Result<Vec<u8>>,
    size: (u32, u32),
    half_width: f64,
    target: Target,
}

/// Half the image plane's width at distance 1 for which a sphere of diameter 1 at distance 2 fills 96 % of the height.
const FILLING: f64 = 0.4781;

const CASES: [Case; 7] = [
    Case {
        name: "one triangle over the whole screen",
        mesh: screen,
        size: (1280, 720),
        half_width: 0.5,
        target: Target::Fill(8.0),
    },
    Case {
        name: "icosphere:6",
        mesh: || named("icosphere:6"),
        size: (320, 180),
        half_width: FILLING,
        target: Target::Sustained(2.1, 2.6),
    },
    Case {
        name: "icosphere:12",
        mesh: || named("icosphere:12"),
        size: (1280, 720),
        half_width: FILLING,
        target: Target::Sustained(3.9, 4.4),
    },
    Case {
        name: "icosphere:32, small triangles",
        mesh: || named("icosphere:32"),
        size: (320, 180),
        half_width: FILLING,
        target: Target::Triangle(28.0, 10.0),
    },
    Case {
        name: "icosphere:10, 2,000 triangles",
        mesh: || named("icosphere:10"),
        size: (320, 180),
        half_width: FILLING,
        target: Target::Frames(600.0, Some(1000.0)),
    },
    Case {
        name: "icosphere:23, 10,580 triangles",
        mesh: || named("icosphere:23"),
        size: (1280, 720),
        half_width: FILLING,
        target: Target::Frames(60.0, None),
    },
    Case {
        name: "icosphere:39, 30,420 triangles",
        mesh: || named("icosphere:39"),
        size: (1280, 720),
        half_width: FILLING,
        target: Target::Frames(60.0, None),
    },
];

fn named(name: &str) -> Result<Vec<u8>> {
    let polygons = generate::named(name).map_err(|error| anyhow::anyhow!("{name}: {error}"))?;
    Ok(convert::convert(&polygons, Options::default())
        .map_err(|error| anyhow::anyhow!("{name}: {error}"))?
        .0)
}

/// A triangle that is seen over the whole screen at distance 1, inside the guard band.
fn screen() -> Result<Vec<u8>> {
    let mut polygons = Polygons::default();
    let corners = [[-1.09, -1.0, -0.4], [1.09, -1.0, -0.4], [0.0, -1.0, 1.2]];
    let made = || -> Result<Polygons, glint::error::FormatError> {
        let mut numbers = Vec::new();
        for corner in corners {
            numbers.push(Corner::at(polygons.add_point(corner, Place::Whole)?));
        }
        polygons.add_face(&numbers, None, Place::Whole)?;
        Ok(polygons)
    }();
    let options = Options { keep_scale: true };
    made.and_then(|polygons| convert::convert(&polygons, options))
        .map(|(mesh, _)| mesh)
        .map_err(|error| anyhow::anyhow!("{error}"))
}

/// From (0, −2, 0) along y.
fn ahead(half_width: f64) -> Result<View> {
    let json = format!(
        r#"{{"eye":[0,-2,0],"u":[1,0,0],"v":[0,0,-1],"n":[0,1,0],"half_width":{half_width},"near":0.5}}"#
    );
    view::parse(json.as_bytes()).map_err(|error| anyhow::anyhow!("{error}"))
}

/// A line of the CSV. Cycles are those of one frame, of the SoC's clock.
#[derive(Serialize)]
struct Row {
    scene: &'static str,
    width: u32,
    height: u32,
    triangles: u32,
    drawn: u32,
    clipped: u32,
    /// Pixels covered, counted by the model.
    pixels: u64,
    /// A frame alone: from the first register written to the end seen.
    cycles_alone: u64,
    /// Its passes.
    cycles_geometry: u64,
    cycles_raster: u64,
    /// A frame of many that follow each other.
    cycles_frame: f64,
    /// Its passes, which share memory then.
    cycles_geometry_together: f64,
    cycles_raster_together: f64,
    /// The same scene by the CPU.
    cycles_cpu: Option<u64>,
    /// Shares of the raster pass alone.
    covered: f64,
    empty: f64,
    flush: f64,
    other: f64,
    /// Share of the geometry pass alone in which memory did not take a write of it.
    geometry_writes: f64,
    measured: f64,
    unit: &'static str,
    at_least: f64,
    aim: Option<f64>,
    met: bool,
    commit: String,
}

pub fn report(arguments: &Arguments) -> Result<()> {
    let provenance = Provenance::find();
    let firmware = built_firmware(None)?;
    let wanted = |case: &&Case| {
        arguments
            .only
            .as_ref()
            .is_none_or(|text| case.name.contains(text.as_str()))
    };
    let cases: Vec<_> = CASES.iter().filter(wanted).collect();
    let rows = soc::two_at_a_time(&cases, |case| {
        eprintln!("{} at {}x{} …", case.name, case.size.0, case.size.1);
        measure(&firmware, case, arguments.quick, &provenance.commit)
    })?;
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&rows)?);
    } else {
        print!("{}", table(&rows)?);
    }
    let partial = arguments.quick || arguments.only.is_some();
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => in_workspace(if partial {
            "target/report"
        } else {
            "docs/report"
        }),
    };
    std::fs::create_dir_all(&out)
        .with_context(|| format!("cannot make the folder {}", out.display()))?;
    let mut csv = csv::Writer::from_path(out.join("triangle.csv"))?;
    for row in &rows {
        csv.serialize(row)?;
    }
    csv.flush()?;
    std::fs::write(out.join("triangle.md"), page(&rows, &provenance)?)?;
    eprintln!("wrote triangle.csv and triangle.md to {}", out.display());
    Ok(())
}

/// Measures a case on a board of its own.
fn measure(firmware: &[u8], case: &Case, quick: bool, commit: &str) -> Result<Row> {
    let mut board = SimulatedBoard::fast(firmware)?;
    let mut console = Console::new(&mut board);
    console.greet()?;
    let mut renderer = Renderer::new(console);
    let mesh = (case.mesh)()?;
    let mut scene = Scene {
        subject: Subject::mesh(&mesh),
        view: ahead(case.half_width)?,
        size: case.size,
        backend: Some(Backend::Gateware),
    };
    let expected = render::on_model(&scene)?;
    renderer.show(&scene, Route::Memory, &mut |_, _| {})?;
    let found = renderer.colour(case.size, Route::Memory, &mut |_, _| {})?;
    ensure!(
        found == expected.frame.colour,
        "{}: the engine's frame is not the model's",
        case.name
    );
    // Both frame buffers hold such a frame then, of which only what differs is written.
    renderer.look(&scene.view)?;
    let alone = renderer.look(&scene.view)?;
    let together = Bench::measure(&mut renderer, "triangle")?;
    let cpu = if quick {
        None
    } else {
        scene.backend = Some(Backend::Cpu);
        renderer.show(&scene, Route::Memory, &mut |_, _| {})?.cycles
    };
    row(case, commit, &expected.stats, &alone, &together, cpu)
}

fn row(
    case: &Case,
    commit: &str,
    expected: &Stats,
    alone: &Stats,
    together: &Bench,
    cycles_cpu: Option<u64>,
) -> Result<Row> {
    let expected = expected.triangles();
    let pixels = expected.pixels_covered;
    let engine = alone
        .engine
        .as_ref()
        .with_context(|| format!("{}: the engine did not draw", case.name))?;
    let triangles = alone.triangles();
    let share = |part: u64, whole: u64| part as f64 / whole as f64;
    let raster = engine.cycles_raster;
    let walking = engine.cycles_walking;
    let cycles_frame = together.frame("cycles")?;
    let (measured, unit, at_least, aim, met) = match case.target {
        Target::Fill(least) => {
            let fill = pixels as f64 / walking as f64;
            (
                fill,
                "pixels a clock of the walk",
                least,
                None,
                fill >= least,
            )
        }
        Target::Sustained(least, aim) => {
            let rate = pixels as f64 / together.frame("cycles_busy")?;
            (rate, "pixels a clock", least, Some(aim), rate >= least)
        }
        Target::Triangle(most, aim) => {
            let clocks = cycles_frame / f64::from(expected.triangles_in);
            (clocks, "clocks a triangle", most, Some(aim), clocks <= most)
        }
        Target::Frames(least, aim) => {
            let rate = CLOCKS[0] / cycles_frame;
            (
                rate,
                "frames a second at 81.25 MHz",
                least,
                aim,
                rate >= least,
            )
        }
    };
    Ok(Row {
        scene: case.name,
        width: case.size.0,
        height: case.size.1,
        triangles: triangles.triangles_in,
        drawn: triangles.triangles_drawn,
        clipped: triangles.triangles_clipped,
        pixels,
        cycles_alone: alone.cycles.context("no cycles")?,
        cycles_geometry: engine.cycles_geometry,
        cycles_raster: raster,
        cycles_frame,
        cycles_geometry_together: together.frame("cycles_geometry")?,
        cycles_raster_together: together.frame("cycles_raster")?,
        cycles_cpu,
        covered: share(engine.groups, raster),
        empty: share(engine.cycles_empty, raster),
        flush: share(engine.cycles_flush, raster),
        other: 1.0
            - share(
                engine.groups + engine.cycles_empty + engine.cycles_flush,
                raster,
            ),
        geometry_writes: share(engine.stalled_lists, engine.cycles_geometry),
        measured,
        unit,
        at_least,
        aim,
        met,
        commit: commit.to_owned(),
    })
}

/// The rows as they stand in the page.
fn table(rows: &[Row]) -> Result<String> {
    let mut text = String::from(
        "| scene | size | triangles in, drawn, clipped | pixels | measured | asked | aim |\n|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        writeln!(
            text,
            "| {} | {}×{} | {}, {}, {} | {} | {}{:.2} {}{} | {} | {} |",
            row.scene,
            row.width,
            row.height,
            row.triangles,
            row.drawn,
            row.clipped,
            row.pixels,
            if row.met { "" } else { "**" },
            row.measured,
            row.unit,
            if row.met { "" } else { "**" },
            row.at_least,
            row.aim.map_or(String::new(), |aim| aim.to_string()),
        )?;
    }
    text.push_str(
        "\n| scene | cycles a frame alone | its geometry | its raster | cycles a frame, back to back | geometry, raster then | fps at 81.25 MHz | at 100 MHz | by the CPU |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for row in rows {
        writeln!(
            text,
            "| {} | {} | {} | {} | {:.0} | {:.0}, {:.0} | {:.1} | {:.1} | {} |",
            row.scene,
            row.cycles_alone,
            row.cycles_geometry,
            row.cycles_raster,
            row.cycles_frame,
            row.cycles_geometry_together,
            row.cycles_raster_together,
            CLOCKS[0] / row.cycles_frame,
            CLOCKS[1] / row.cycles_frame,
            row.cycles_cpu
                .map_or("not measured".to_owned(), |cycles| cycles.to_string()),
        )?;
    }
    text.push_str(
        "\n| scene | raster: covered groups | empty groups | waiting for the flush | other: entering triangles, reading them | geometry: waiting to write |\n\
         |---|---|---|---|---|---|\n",
    );
    for row in rows {
        let percent = |share: f64| format!("{:.0} %", 100.0 * share);
        writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} |",
            row.scene,
            percent(row.covered),
            percent(row.empty),
            percent(row.flush),
            percent(row.other),
            percent(row.geometry_writes),
        )?;
    }
    Ok(text)
}

fn page(rows: &[Row], provenance: &Provenance) -> Result<String> {
    let mut text = String::from(
        "# The triangle engine on the whole SoC\n\n\
         Generated by `cargo xtask report triangle`; the same numbers are in [triangle.csv](triangle.csv).\n\n\
         Clock cycles of the SoC by the engine's own counters, with LiteDRAM and the scan-out at work. Every frame was compared \
         with the model's, bit for bit, before its cycles were taken. A frame *alone* counts everything from the first register \
         that the firmware writes to the end that it sees. *Back to back* means that the geometry of a frame is made while the \
         one before it is rastered, and that nothing waits for the screen; sustained pixels a clock are of such frames, over the \
         clocks in which a pass runs. What \
         was asked and is not met is bold.\n\n",
    );
    text.push_str(&table(rows)?);
    writeln!(
        text,
        "\nMade at commit {} with {}.",
        provenance.commit, provenance.tools
    )?;
    Ok(text)
}
