//! Experiment: frames per second of the raymarcher on the whole SoC, where scan-out also uses LiteDRAM.

use anyhow::{Context, Result, ensure};
use glint::board::built_firmware;
use glint::console::Console;
use glint::render::{self, BoardRenderer, FieldSubject, Frame, Route, Subject};
use glint_core::appearance::Appearance;
use glint_core::field::Field;
use glint_core::picture::{Backend, Size};
use glint_core::quality::Quality;
use glint_core::stereo::Stereo;
use indicatif::ProgressBar;
use serde::{Deserialize, Serialize};

use crate::camera::{Camera, Vector};
use crate::raymarch::views;
use crate::report::progress;
use crate::report::soc::{self, BackToBack};

/// Minimum duration of a measurement of frames drawn back to back, in cycles. The first frame takes up to 7,600 cycles more than every
/// other frame, which increases the mean by at most 0.3 %.
const LEAST_CYCLES: u64 = 3_000_000;

/// A verilated build of the SoC.
pub struct Build {
    /// Name of the build's folder in `target/gateware`.
    folder: &'static str,
    /// Number of lanes (parallel pipelines for evaluations of the field) of the build's raymarcher.
    pub lanes: u32,
}

const FIELDS: Build = Build {
    folder: "virtual",
    lanes: 2,
};
const FOUR_LANES: Build = Build {
    folder: "virtual-lattice-4",
    lanes: 4,
};

/// A measured field, with the required frames per second.
pub struct Case {
    /// Text form of the field, as typed in the console.
    pub field: &'static str,
    stereo: Option<&'static str>,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// The SoC build that draws the field.
    pub build: Build,
    cameras: fn() -> Vec<(&'static str, Camera)>,
    /// Returns the rotations of each camera, in degrees. Each rotation is a measured pose.
    path: fn() -> Vec<Vector>,
    /// Clock frequency to which the requirement refers, in MHz.
    pub clock: f64,
    /// Required frames per second.
    pub at_least: f64,
    /// Goal above the requirement, in frames per second.
    pub aim: Option<f64>,
}

impl Case {
    /// Whether `row` is a measurement of this case.
    pub fn contains(&self, row: &Row) -> bool {
        self.field == row.field
            && self.stereo == row.stereo.as_deref()
            && self.size == (row.width, row.height)
            && self.build.lanes == row.lanes
    }
}

/// The sponge, drawn for two eyes.
const STEREO_SPONGE: Case = Case {
    field: "menger:4",
    stereo: Some("0.03,1.5"),
    size: (320, 180),
    build: FIELDS,
    cameras: of_the_sponge,
    path: views::path,
    clock: 81.25,
    at_least: 300.0,
    aim: Some(400.0),
};

/// The sponge, drawn on the full screen.
const LARGE_SPONGE: Case = Case {
    stereo: None,
    size: (1280, 720),
    path: still,
    at_least: 60.0,
    aim: Some(70.0),
    ..STEREO_SPONGE
};

/// The lattice, drawn for two eyes.
const LATTICE: Case = Case {
    field: "lattice:1,0.3",
    cameras: of_the_lattice,
    path: still,
    at_least: 180.0,
    aim: Some(250.0),
    ..STEREO_SPONGE
};

/// All measured cases, in the order of the report's page.
pub const CASES: [Case; 4] = [
    STEREO_SPONGE,
    LARGE_SPONGE,
    LATTICE,
    Case {
        build: FOUR_LANES,
        ..LATTICE
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

/// Cycles of a frame in one pose of a camera: a line of `raymarch-rates.csv`. Cycles are clocks of the SoC.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Text form of the field, as typed in the console.
    pub field: String,
    /// Stereo parameters, as typed in the console; `None` for a picture of one eye.
    pub stereo: Option<String>,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Number of lanes (parallel pipelines for evaluations of the field) of the raymarcher.
    pub lanes: u32,
    /// Name of the view.
    pub view: String,
    /// Yaw of the pose to the right, in degrees.
    pub yaw: f64,
    /// Pitch of the pose downwards, in degrees.
    pub pitch: f64,
    /// Roll of the pose, in degrees.
    pub roll: f64,
    /// Number of rays of a frame.
    pub rays: u32,
    /// Number of evaluations of the field in a frame.
    pub evaluations: u64,
    /// Cycles of a frame drawn alone, from the first register write until the firmware detects the end of the frame.
    pub cycles_alone: u64,
    /// Mean cycles per frame of several frames drawn back to back. Measured only for the slowest pose of a view.
    pub cycles_frame: Option<f64>,
    /// Clock frequency to which the requirement refers, in MHz.
    pub clock: f64,
    /// Required frames per second.
    pub at_least: f64,
    /// Goal above the requirement, in frames per second.
    pub aim: Option<f64>,
}

/// Measures all cases whose field contains `only`, on two virtual boards at a time.
///
/// # Errors
/// When a board is not built, or a frame differs from the model's frame.
pub fn measure(only: &str) -> Result<Vec<Row>> {
    let firmware = built_firmware(None)?;
    let mut work = Vec::new();
    for case in CASES.iter().filter(|case| case.field.contains(only)) {
        let cameras = (case.cameras)().into_iter();
        work.extend(cameras.map(|(view, camera)| (case, view, camera)));
    }
    let frames = work.iter().map(|(case, ..)| (case.path)().len() as u64);
    let bar = progress::bar(frames.sum())?;
    let rows = soc::two_at_a_time(&work, |&(case, view, ref camera)| {
        bar.set_message(format!("{} {view} on the SoC", case.field));
        let (width, height) = case.size;
        let name = format!("{} {view} at {width}x{height}", case.field);
        let rows = draw(&firmware, case, view, camera, &bar).with_context(|| name.clone())?;
        let cycles = rows.iter().find_map(|row| row.cycles_frame);
        bar.suspend(|| eprintln!("{name}: {:.0} cycles", cycles.unwrap_or_default()));
        Ok(rows)
    })?;
    bar.finish_and_clear();
    Ok(rows.into_iter().flatten().collect())
}

/// Starts a virtual board and draws all poses of a camera on it.
fn draw(
    firmware: &[u8],
    case: &Case,
    view: &'static str,
    camera: &Camera,
    bar: &ProgressBar,
) -> Result<Vec<Row>> {
    let mut board = soc::started(case.build.folder, firmware)?;
    let mut console = Console::new(&mut board);
    console.greet()?;
    let mut renderer = BoardRenderer::new(console)
        .with_backend(Backend::Gateware)
        .with_route(Route::Memory);
    let size = Size::of(case.size.0, case.size.1).context("not the size of a picture")?;
    let field = Field::parse(case.field).map_err(|error| anyhow::anyhow!("{error}"))?;
    let stereo = case.stereo.map(Stereo::parse).transpose();
    let stereo = stereo.map_err(|error| anyhow::anyhow!("{error}"))?;
    let mut rows: Vec<Row> = Vec::new();
    let mut last = None;
    for angles in (case.path)() {
        let subject = FieldSubject {
            field: &field,
            appearance: &Appearance::default(),
            quality: Quality::default(),
        };
        let pose = camera.turned(angles).view().map_err(anyhow::Error::msg)?;
        let frame = Frame {
            stereo,
            ..Frame::new(Subject::Field(subject), pose, size)
        };
        let expected = render::on_model(&frame)?;
        let stats = if rows.is_empty() {
            renderer.show(&frame)?
        } else {
            renderer.look(&frame.view)?
        };
        ensure!(
            stats.backend.as_deref() == Some("gateware"),
            "expected a frame of the gateware, found the soft core's"
        );
        let found = renderer.colour(size)?;
        ensure!(
            found == expected.image.colour && stats.rays == expected.stats.rays,
            "turned by {angles:?} degrees, the raymarcher's frame is not the model's"
        );
        let rays = stats.rays.context("no ray counters in the reply")?;
        let [yaw, pitch, roll] = angles;
        rows.push(Row {
            field: case.field.to_owned(),
            stereo: case.stereo.map(str::to_owned),
            width: case.size.0,
            height: case.size.1,
            lanes: case.build.lanes,
            view: view.to_owned(),
            yaw,
            pitch,
            roll,
            rays: rays.rays,
            evaluations: rays.evaluations,
            cycles_alone: stats.cycles.context("no cycles in the reply")?,
            cycles_frame: None,
            clock: case.clock,
            at_least: case.at_least,
            aim: case.aim,
        });
        last = Some(frame.view);
        bar.inc(1);
    }
    // Only the slowest pose of the view is drawn back to back.
    if let Some(slowest) = rows.iter_mut().max_by_key(|row| row.cycles_alone) {
        let angles = [slowest.yaw, slowest.pitch, slowest.roll];
        let view = camera.turned(angles).view().map_err(anyhow::Error::msg)?;
        if last != Some(view) {
            renderer.look(&view)?;
        }
        let frames = LEAST_CYCLES.div_ceil(slowest.cycles_alone) as u32;
        let together = BackToBack::measure(&mut renderer, "field", frames)?;
        slowest.cycles_frame = Some(together.frame("cycles")?);
    }
    Ok(rows)
}
