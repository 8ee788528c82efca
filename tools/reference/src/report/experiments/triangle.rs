//! Experiment: the speed of the triangle engine on the whole SoC, where scan-out also uses LiteDRAM.

use anyhow::{Context, Result, ensure};
use glint::board::{self, SimulatedBoard, built_firmware};
use glint::console::Console;
use glint::convert::{self, Options};
use glint::error::Location;
use glint::generate;
use glint::polygons::{Corner, Polygons};
use glint::render::{self, BoardRenderer, Frame, Route, Stats, Subject};
use glint::view;
use glint_core::camera::View;
use glint_core::mesh::Mesh;
use glint_core::picture::{Backend, Size};
use glint_model::SIZES;
use serde::{Deserialize, Serialize};

use Target::{Clocks, Fill, Frames, Sustained};

use crate::report::soc::{self, BackToBack, CLOCK};

/// The required drawing speed of a scene. Most kinds of requirement also have a goal.
#[derive(Clone, Copy)]
enum Target {
    /// Lower bound of the pixels per walking clock of the rasterizer (counter `cycles_walking`).
    Fill(f64),
    /// Lower bound and goal of the pixels per clock, for frames drawn back to back.
    Sustained(f64, f64),
    /// Upper bound and goal of the clocks per triangle.
    Clocks(f64, f64),
    /// Lower bound and goal of the frames per second at 81.25 MHz.
    Frames(f64, Option<f64>),
}

const SMALL: (u32, u32) = SIZES[0];
const LARGE: (u32, u32) = SIZES[2];

/// Number of frames that are drawn back to back. The first geometry pass overlaps no raster pass; with this number of frames its effect on
/// the mean is small.
const FRAMES: u32 = 8;

/// A scene: one triangle that covers the whole screen, or a generated model. The name of a scene begins with the name of its model.
struct Case {
    name: &'static str,
    size: (u32, u32),
    half_width: f64,
    target: Target,
}

const SCREEN: &str = "one triangle over the whole screen";
const FILE_ORDER: &str = "scan:59, order of its file";

static CASES: [Case; 9] = [
    Case {
        half_width: 0.5,
        ..model(SCREEN, LARGE, Target::Fill(8.0))
    },
    model("icosphere:6", SMALL, Sustained(2.1, 2.6)),
    model("icosphere:12", LARGE, Sustained(3.9, 4.4)),
    model("icosphere:32, small triangles", SMALL, Clocks(28.0, 10.0)),
    model("scan:59, 69,620 triangles", SMALL, Clocks(5.0, 4.5)),
    model(FILE_ORDER, SMALL, Clocks(9.0, 8.0)),
    model(
        "icosphere:10, 2,000 triangles",
        SMALL,
        Frames(600.0, Some(1000.0)),
    ),
    model("icosphere:23, 10,580 triangles", LARGE, Frames(60.0, None)),
    model("icosphere:39, 30,420 triangles", LARGE, Frames(60.0, None)),
];

/// Returns the case of a model at distance 2. In its picture a sphere of diameter 1 would fill 96 % of the height.
const fn model(name: &'static str, size: (u32, u32), target: Target) -> Case {
    Case {
        name,
        size,
        half_width: 0.4781,
        target,
    }
}

impl Case {
    fn mesh(&self) -> Result<Vec<u8>> {
        if self.name == SCREEN {
            return screen();
        }
        let options = Options {
            keep_order: self.name == FILE_ORDER,
            ..Options::default()
        };
        let name = self.name.split(',').next().unwrap_or_default();
        let made = generate::named(name).and_then(|model| convert::convert(&model, options));
        let (mesh, _) = made.map_err(|error| anyhow::anyhow!("{name}: {error}"))?;
        Ok(mesh)
    }
}

/// Creates a mesh of one triangle. At distance 1 from the camera, the triangle covers the whole screen and lies within the guard band, so
/// it is not clipped.
fn screen() -> Result<Vec<u8>> {
    let mut polygons = Polygons::default();
    let corners = [[-1.09, -1.0, -0.4], [1.09, -1.0, -0.4], [0.0, -1.0, 1.2]];
    let made = || -> Result<Polygons, glint::error::FormatError> {
        let mut numbers = Vec::new();
        for corner in corners {
            numbers.push(Corner::at(polygons.add_point(corner, Location::Whole)?));
        }
        polygons.add_face(&numbers, None, Location::Whole)?;
        Ok(polygons)
    }();
    let options = Options {
        keep_scale: true,
        ..Options::default()
    };
    made.and_then(|polygons| convert::convert(&polygons, options))
        .map(|(mesh, _)| mesh)
        .map_err(|error| anyhow::anyhow!("{error}"))
}

/// Returns the view from the point (0, −2, 0) along +y.
pub fn ahead(half_width: f64) -> Result<View> {
    let json = format!(
        r#"{{"eye":[0,-2,0],"u":[1,0,0],"v":[0,0,-1],"n":[0,1,0],"half_width":{half_width},"near":0.5}}"#
    );
    view::parse(json.as_bytes()).map_err(|error| anyhow::anyhow!("{error}"))
}

/// Speed of the triangle engine in a scene: a line of `triangle.csv`. Each number of cycles is for one frame, in clocks of the SoC.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Name of the scene.
    pub scene: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Half the width of the picture, in world units on the plane at distance 1.
    pub half_width: f64,
    /// Number of triangles in the mesh.
    pub triangles: u32,
    /// Number of drawn triangles.
    pub drawn: u32,
    /// Number of clipped triangles.
    pub clipped: u32,
    /// Number of covered pixels, counted by the model.
    pub pixels: u64,
    /// Cycles of a frame drawn alone, from the first register write until the firmware detects the end of the frame.
    pub cycles_alone: u64,
    /// Cycles of the geometry pass of a frame drawn alone.
    pub cycles_geometry: u64,
    /// Cycles of the raster pass of a frame drawn alone.
    pub cycles_raster: u64,
    /// Mean cycles per frame of many frames drawn back to back.
    pub cycles_frame: f64,
    /// Mean cycles of the geometry pass of a frame drawn back to back. Another frame's raster pass uses the memory at the same time.
    pub cycles_geometry_together: f64,
    /// Mean cycles of the raster pass of a frame drawn back to back. Another frame's geometry pass uses the memory at the same time.
    pub cycles_raster_together: f64,
    /// Fraction of `cycles_raster` spent on groups of 8 pixels with covered pixels.
    pub covered: f64,
    /// Fraction of `cycles_raster` spent on groups of 8 pixels without covered pixels.
    pub empty: f64,
    /// Fraction of `cycles_raster` in which a finished band waits until the previous band has been flushed to memory.
    pub flush: f64,
    /// Remaining fraction of `cycles_raster`.
    pub other: f64,
    /// Fraction of `cycles_geometry` in which the geometry pass waits for writes to memory.
    pub geometry_writes: f64,
    /// Measured value of the required quantity.
    pub measured: f64,
    /// Unit of `measured`.
    pub unit: String,
    /// Required bound of `measured`: an upper bound if the unit is clocks per triangle, and a lower bound for every other unit.
    pub at_least: f64,
    /// Goal for `measured`, which is stricter than the bound.
    pub aim: Option<f64>,
    /// Whether `measured` meets the required bound.
    pub met: bool,
}

/// Cycles of a frame drawn by the soft core: a line of `triangle-cpu.csv`.
#[derive(Serialize, Deserialize)]
pub struct CpuRow {
    /// Name of the scene.
    pub scene: String,
    /// Number of cycles of a frame.
    pub cycles: u64,
}

/// Measures the triangle engine in the scenes whose name contains `only`, or in all scenes.
///
/// # Errors
/// When the board is not built, or a frame differs from the model's.
pub fn measure(only: Option<&str>) -> Result<Vec<Row>> {
    measure_cases(only, CASES.iter(), Backend::Gateware, measure_engine)
}

/// Name of the model that only the engine draws, because a frame drawn by the soft core takes minutes on the virtual board.
const FOR_THE_ENGINE_ALONE: &str = "scan:59";

/// Measures frames of the scenes of [`measure`], drawn by the soft core.
///
/// # Errors
/// When the board is not built, or a frame differs from the model's.
pub fn measure_cpu(only: Option<&str>) -> Result<Vec<CpuRow>> {
    let cases = CASES.iter();
    let cases = cases.filter(|case| !case.name.starts_with(FOR_THE_ENGINE_ALONE));
    measure_cases(only, cases, Backend::Cpu, |case, shown| {
        Ok(CpuRow {
            scene: case.name.to_owned(),
            cycles: shown.stats.cycles.context("no cycles")?,
        })
    })
}

/// A scene on a virtual board. The scene's first frame has been compared with the model's frame.
struct ShownScene<'r, 'b> {
    renderer: &'r mut BoardRenderer<'b, SimulatedBoard>,
    view: View,
    /// Statistics of the first frame.
    stats: Stats,
    /// The model's statistics of the frame.
    expected: Stats,
}

/// Starts a virtual board for each of `cases` whose name contains `only`, draws the scene by `backend`, and measures it.
fn measure_cases<R: Send>(
    only: Option<&str>,
    cases: impl Iterator<Item = &'static Case>,
    backend: Backend,
    measure: impl Fn(&Case, &mut ShownScene) -> Result<R> + Sync,
) -> Result<Vec<R>> {
    let firmware = built_firmware(None)?;
    let cases: Vec<_> = cases
        .filter(|case| only.is_none_or(|text| case.name.contains(text)))
        .collect();
    soc::two_at_a_time(&cases, |case| {
        eprintln!(
            "{} at {}x{} by {backend} …",
            case.name, case.size.0, case.size.1
        );
        let mut board = board::verilated(&firmware)?;
        let mut console = Console::new(&mut board);
        console.greet()?;
        let mut renderer = BoardRenderer::new(console)
            .with_backend(backend)
            .with_route(Route::Memory);
        let mesh = case.mesh()?;
        let subject = Subject::mesh(Mesh::new_checked(&mesh)?);
        let size = Size::of(case.size.0, case.size.1).context("not the size of a picture")?;
        let frame = Frame::new(subject, ahead(case.half_width)?, size);
        let expected = render::on_model(&frame)?;
        let stats = renderer.show(&frame)?;
        let found = renderer.colour(size)?;
        ensure!(
            found == expected.image.colour,
            "{}: the frame by {backend} is not the model's",
            case.name
        );
        measure(
            case,
            &mut ShownScene {
                renderer: &mut renderer,
                view: frame.view,
                stats,
                expected: expected.stats,
            },
        )
    })
}

/// Measures the engine in the displayed scene.
fn measure_engine(case: &Case, shown: &mut ShownScene) -> Result<Row> {
    // The triangle engine writes only words that may differ from the previous frame in the same frame buffer. The frame is therefore drawn
    // once into each of the two frame buffers before the measurement.
    shown.renderer.look(&shown.view)?;
    let alone = shown.renderer.look(&shown.view)?;
    let together = BackToBack::measure(shown.renderer, "triangle", FRAMES)?;
    row(case, &shown.expected, &alone, &together)
}

fn row(case: &Case, expected: &Stats, alone: &Stats, together: &BackToBack) -> Result<Row> {
    let expected = expected.triangles();
    let pixels = expected.pixels_covered;
    let engine = |name| {
        let counter = alone.engine.get(name);
        counter.with_context(|| format!("{}: the engine did not draw", case.name))
    };
    let triangles = alone.triangles();
    let share = |part: u64, whole: u64| part as f64 / whole as f64;
    let [raster, groups, empty, flush] =
        ["cycles_raster", "groups", "cycles_empty", "cycles_flush"].map(engine);
    let [raster, groups, empty, flush] = [raster?, groups?, empty?, flush?];
    let cycles_frame = together.frame("cycles")?;
    let (measured, unit, at_least, aim) = match case.target {
        Target::Fill(least) => {
            let fill = pixels as f64 / engine("cycles_walking")? as f64;
            (fill, "pixels a clock of the walk", least, None)
        }
        Sustained(least, aim) => {
            let rate = pixels as f64 / together.frame("cycles_busy")?;
            (rate, "pixels a clock", least, Some(aim))
        }
        Clocks(most, aim) => {
            let clocks = cycles_frame / f64::from(expected.triangles_in);
            (clocks, "clocks a triangle", most, Some(aim))
        }
        Frames(least, aim) => {
            let rate = CLOCK / cycles_frame;
            (rate, "frames a second at 81.25 MHz", least, aim)
        }
    };
    let met = match case.target {
        Clocks(..) => measured <= at_least,
        Fill(_) | Sustained(..) | Frames(..) => measured >= at_least,
    };
    Ok(Row {
        scene: case.name.to_owned(),
        width: case.size.0,
        height: case.size.1,
        half_width: case.half_width,
        triangles: triangles.triangles_in,
        drawn: triangles.triangles_drawn,
        clipped: triangles.triangles_clipped,
        pixels,
        cycles_alone: alone.cycles.context("no cycles")?,
        cycles_geometry: engine("cycles_geometry")?,
        cycles_raster: raster,
        cycles_frame,
        cycles_geometry_together: together.frame("cycles_geometry")?,
        cycles_raster_together: together.frame("cycles_raster")?,
        covered: share(groups, raster),
        empty: share(empty, raster),
        flush: share(flush, raster),
        other: 1.0 - share(groups + empty + flush, raster),
        geometry_writes: share(engine("stalled_lists")?, engine("cycles_geometry")?),
        measured,
        unit: unit.to_owned(),
        at_least,
        aim,
        met,
    })
}
