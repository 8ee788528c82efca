//! Frames a second of distance fields: a part of the page `raymarch.md`. The whole SoC draws them, with LiteDRAM and the
//! scan-out at work.

use std::fmt::Write as _;

use anyhow::{Context, Result, ensure};
use glint::board::{SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::render::{self, FieldSubject, Renderer, Route, Scene, Subject};
use glint_core::appearance::Appearance;
use glint_core::field::Field;
use glint_core::picture::Backend;
use glint_core::stereo::Stereo;
use glint_reference::camera::{Camera, Vector};
use glint_reference::field::views;
use indicatif::ProgressBar;
use serde::Serialize;
use virtual_board::{Start, VirtualBoard};

use crate::soc::{self, Bench, CLOCKS};
use crate::{in_workspace, progress_bar};

/// A build of the SoC: its folder below `target/gateware`, and its raymarcher's lanes.
struct Build {
    folder: &'static str,
    lanes: u32,
}

const FIELDS: Build = Build {
    folder: "virtual",
    lanes: 2,
};
const SPONGE: Build = Build {
    folder: "virtual-sponge",
    lanes: 4,
};

/// What is measured: a field, the eyes that look at it, and how often it is to be drawn.
struct Case {
    field: &'static str,
    stereo: Option<&'static str>,
    prepass: bool,
    size: (u32, u32),
    build: Build,
    cameras: fn() -> Vec<(&'static str, Camera)>,
    /// Where each camera is turned to.
    path: fn() -> Vec<Vector>,
    /// Frames a second at the clock of this number in [`CLOCKS`]: at least, and the aim.
    clock: usize,
    at_least: f64,
    aim: Option<f64>,
}

impl Case {
    fn eyes(&self) -> u32 {
        if self.stereo.is_some() { 2 } else { 1 }
    }

    fn shown_prepass(&self) -> &str {
        if self.prepass { "yes" } else { "" }
    }
}

const CASES: [Case; 5] = [
    Case {
        field: "menger:4",
        stereo: Some("0.03,1.5"),
        prepass: false,
        size: (320, 180),
        build: FIELDS,
        cameras: of_the_sponge,
        path: views::path,
        clock: 0,
        at_least: 60.0,
        aim: Some(120.0),
    },
    Case {
        field: "menger:4",
        stereo: None,
        prepass: false,
        size: (1280, 720),
        build: SPONGE,
        cameras: of_the_sponge,
        path: still,
        clock: 1,
        at_least: 30.0,
        aim: None,
    },
    Case {
        field: "menger:4",
        stereo: None,
        prepass: true,
        size: (1280, 720),
        build: SPONGE,
        cameras: of_the_sponge,
        path: still,
        clock: 0,
        at_least: 30.0,
        aim: Some(60.0),
    },
    Case {
        field: "lattice:1,0.3",
        stereo: Some("0.03,1.5"),
        prepass: false,
        size: (320, 180),
        build: FIELDS,
        cameras: of_the_lattice,
        path: still,
        clock: 0,
        at_least: 57.0,
        aim: None,
    },
    Case {
        field: "lattice:1,0.3",
        stereo: Some("0.03,1.5"),
        prepass: true,
        size: (320, 180),
        build: FIELDS,
        cameras: of_the_lattice,
        path: still,
        clock: 0,
        at_least: 60.0,
        aim: None,
    },
];

fn of_the_sponge() -> Vec<(&'static str, Camera)> {
    let views = views::views().into_iter();
    views
        .map(|(name, eye, target)| (name, views::camera(eye, target)))
        .collect()
}

fn of_the_lattice() -> Vec<(&'static str, Camera)> {
    vec![
        (
            "aside",
            views::camera([2.1875, 1.6875, 1.3125], [0.015625, 0.0, 0.03125]),
        ),
        ("down", views::camera([0.5, 0.5, 0.5], [0.625, 0.75, -1.0])),
    ]
}

fn still() -> Vec<Vector> {
    vec![[0.0; 3]]
}

/// A pose of a camera: a line of `raymarch-rates.csv`.
#[derive(Serialize)]
pub struct Row {
    field: &'static str,
    /// As it is typed; nothing for one eye.
    stereo: Option<&'static str>,
    prepass: bool,
    width: u32,
    height: u32,
    lanes: u32,
    view: &'static str,
    /// In degrees.
    yaw: f64,
    pitch: f64,
    roll: f64,
    rays: u32,
    evaluations: u64,
    /// A frame alone: from the first register written to the end seen.
    cycles_alone: u64,
    /// A frame of many that follow each other, for the slowest pose.
    cycles_frame: Option<f64>,
    commit: String,
    #[serde(skip)]
    case: usize,
}

/// Draws everything. Two boards at a time.
pub fn measure(commit: &str) -> Result<Vec<Row>> {
    let firmware = built_firmware(None)?;
    let mut work = Vec::new();
    for (number, case) in CASES.iter().enumerate() {
        let cameras = (case.cameras)().into_iter();
        work.extend(cameras.map(|(view, camera)| (number, case, view, camera)));
    }
    let frames = work.iter().map(|(_, case, ..)| (case.path)().len() as u64);
    let bar = progress_bar(frames.sum())?;
    let rows = soc::two_at_a_time(&work, |&(number, case, view, ref camera)| {
        bar.set_message(format!("{} {view} on the SoC", case.field));
        let (width, height) = case.size;
        let name = format!("{} {view} at {width}x{height}", case.field);
        let mut rows =
            draw(&firmware, case, view, camera, commit, &bar).with_context(|| name.clone())?;
        rows.iter_mut().for_each(|row| row.case = number);
        let cycles = rows.iter().find_map(|row| row.cycles_frame);
        bar.suspend(|| eprintln!("{name}: {:.0} cycles", cycles.unwrap_or_default()));
        Ok(rows)
    })?;
    bar.finish_and_clear();
    Ok(rows.into_iter().flatten().collect())
}

/// Draws what a camera sees, on a board of its own.
fn draw(
    firmware: &[u8],
    case: &Case,
    view: &'static str,
    camera: &Camera,
    commit: &str,
    bar: &ProgressBar,
) -> Result<Vec<Row>> {
    let library = format!("target/gateware/{}/libglint_soc.so", case.build.folder);
    let board = VirtualBoard::builder()
        .library(in_workspace(&library))
        .start(Start::Fast { firmware })
        .build()?;
    let mut board = SimulatedBoard::new(board);
    let mut console = Console::new(&mut board);
    console.greet()?;
    let mut renderer = Renderer::new(console);
    let field = Field::parse(case.field).map_err(|error| anyhow::anyhow!("{error}"))?;
    let stereo = case.stereo.map(Stereo::parse).transpose();
    let stereo = stereo.map_err(|error| anyhow::anyhow!("{error}"))?;
    let mut rows: Vec<Row> = Vec::new();
    let mut last = None;
    for angles in (case.path)() {
        let scene = Scene {
            subject: Subject::Field(FieldSubject {
                field: &field,
                appearance: &Appearance::default(),
                stereo,
                prepass: case.prepass,
            }),
            view: camera.turned(angles).view().map_err(anyhow::Error::msg)?,
            size: case.size,
            backend: Some(Backend::Gateware),
        };
        let expected = render::on_model(&scene)?;
        let stats = if rows.is_empty() {
            renderer.show(&scene, Route::Memory, &mut |_, _| {})?
        } else {
            renderer.look(&scene.view)?
        };
        ensure!(
            stats.backend.as_deref() == Some("gateware"),
            "the soft core has drawn it"
        );
        let found = renderer.colour(case.size, Route::Memory, &mut |_, _| {})?;
        ensure!(
            found == expected.frame.colour && stats.rays == expected.stats.rays,
            "turned by {angles:?} degrees, the raymarcher's frame is not the model's"
        );
        let rays = stats.rays.context("no rays were counted")?;
        let [yaw, pitch, roll] = angles;
        rows.push(Row {
            field: case.field,
            stereo: case.stereo,
            prepass: case.prepass,
            width: case.size.0,
            height: case.size.1,
            lanes: case.build.lanes,
            view,
            yaw,
            pitch,
            roll,
            rays: rays.rays,
            evaluations: rays.evaluations,
            cycles_alone: stats.cycles.context("no cycles")?,
            cycles_frame: None,
            commit: commit.to_owned(),
            case: 0,
        });
        last = Some(scene.view);
        bar.inc(1);
    }
    // No other pose is drawn back to back.
    if let Some(slowest) = rows.iter_mut().max_by_key(|row| row.cycles_alone) {
        let angles = [slowest.yaw, slowest.pitch, slowest.roll];
        let view = camera.turned(angles).view().map_err(anyhow::Error::msg)?;
        if last != Some(view) {
            renderer.look(&view)?;
        }
        slowest.cycles_frame = Some(Bench::measure(&mut renderer, "field")?.frame("cycles")?);
    }
    Ok(rows)
}

/// A view's poses.
struct View<'a> {
    name: &'a str,
    poses: Vec<&'a Row>,
    /// The slowest of them, and its frame of many.
    slowest: &'a Row,
    cycles: f64,
}

impl<'a> View<'a> {
    fn of(case: usize, rows: &'a [Row]) -> Vec<Self> {
        let mut views: Vec<Self> = Vec::new();
        for row in rows.iter().filter(|row| row.case == case) {
            match views.last_mut() {
                Some(view) if view.name == row.view => view.poses.push(row),
                _ => views.push(Self {
                    name: row.view,
                    poses: vec![row],
                    slowest: row,
                    cycles: 0.0,
                }),
            }
            if let (Some(view), Some(cycles)) = (views.last_mut(), row.cycles_frame) {
                (view.slowest, view.cycles) = (row, cycles);
            }
        }
        views
    }

    fn mean_alone(&self) -> f64 {
        let cycles: u64 = self.poses.iter().map(|row| row.cycles_alone).sum();
        cycles as f64 / self.poses.len() as f64
    }
}

/// The rows as they stand in the page: what is asked of each case, and what each of its views takes.
pub fn table(rows: &[Row]) -> Result<String> {
    let mut text = String::from(
        "| field | eyes | size | lanes | prepass | slowest measured | asked | aim |\n|---|---|---|---|---|---|---|---|\n",
    );
    for (number, case) in CASES.iter().enumerate() {
        let views = View::of(number, rows);
        let clock = CLOCKS[case.clock];
        let rate = clock / views.iter().map(|view| view.cycles).fold(0.0, f64::max);
        let mark = if rate >= case.at_least { "" } else { "**" };
        writeln!(
            text,
            "| {} | {} | {}×{} | {} | {} | {mark}{rate:.2} frames a second at {} MHz{mark} | {} | {} |",
            case.field,
            case.eyes(),
            case.size.0,
            case.size.1,
            case.build.lanes,
            case.shown_prepass(),
            clock / 1e6,
            case.at_least,
            case.aim.map_or(String::new(), |aim| aim.to_string()),
        )?;
    }
    text.push_str(
        "\n| field | eyes | size | prepass | view | poses | cycles a frame alone: mean, slowest | slowest, back to back | fps at 81.25 MHz | at 100 MHz | evaluations a ray | a clock and lane |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for (number, case) in CASES.iter().enumerate() {
        for view in View::of(number, rows) {
            let evaluations = view.slowest.evaluations as f64;
            writeln!(
                text,
                "| {} | {} | {}×{} | {} | {} | {} | {:.0}, {} | {:.0} | {:.1} | {:.1} | {:.2} | {:.3} |",
                case.field,
                case.eyes(),
                case.size.0,
                case.size.1,
                case.shown_prepass(),
                view.name,
                view.poses.len(),
                view.mean_alone(),
                view.slowest.cycles_alone,
                view.cycles,
                CLOCKS[0] / view.cycles,
                CLOCKS[1] / view.cycles,
                evaluations / f64::from(view.slowest.rays),
                evaluations / view.cycles / f64::from(case.build.lanes),
            )?;
        }
    }
    Ok(text)
}
