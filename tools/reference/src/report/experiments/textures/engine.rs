//! Experiment: the speed of the triangle engine with textures on the whole SoC, where scan-out also uses LiteDRAM.

use anyhow::{Context, Result, ensure};
use glint::board::built_firmware;
use glint::console::Console;
use glint::render::{self, BoardRenderer, Frame, Route, Subject};
use glint::{convert, generate};
use glint_core::camera::View;
use glint_core::colour::Rgb565;
use glint_core::mesh::Mesh;
use glint_core::picture::{Backend, Size};
use glint_core::texture::{Filter, Format, Sampler, Source, encode};
use glint_vectors::Camera;
use glint_vectors::meshes::{textured_square, wrapped};
use serde::{Deserialize, Serialize};

use crate::report::experiments::triangle::ahead;
use crate::report::soc::{self, BackToBack, CLOCK};
use crate::triangle::textured::globe;

/// The folder in `target/gateware` of the board with textures.
const BOARD: &str = "virtual-texture";
/// Number of frames that are drawn back to back, as for the triangles without textures.
const FRAMES: u32 = 8;
/// Half width of a picture in which a sphere of diameter 1 at distance 2 fills 96 % of the height.
const HALF_WIDTH: f64 = 0.4781;

/// A mesh on the board.
enum Model {
    /// `icosphere:12`, without a texture or with one around it.
    Sphere(Option<Texels>),
    /// A square of two triangles, whose far end is at the horizon.
    Floor(Texels),
    /// A sphere of this number of bands and twice as many sectors, with two triangles for each quadrilateral.
    Globe(u32, Texels),
}

/// A texture of random texels with all mip levels.
#[derive(Clone, Copy)]
struct Texels {
    size_log2: [u8; 2],
    format: Format,
    filter: Filter,
}

const fn texels(size_log2: [u8; 2], format: Format, filter: Filter) -> Texels {
    Texels {
        size_log2,
        format,
        filter,
    }
}

/// A measured scene with its requirement: pixels a clock, or frames a second at 81.25 MHz.
struct Case {
    name: &'static str,
    size: Size,
    model: Model,
    unit: &'static str,
    at_least: Option<f64>,
    aim: Option<f64>,
}

const PIXELS: &str = "pixels a clock";
const PICTURES: &str = "frames a second";

const fn case(
    name: &'static str,
    size: Size,
    model: Model,
    unit: &'static str,
    [at_least, aim]: [Option<f64>; 2],
) -> Case {
    Case {
        name,
        size,
        model,
        unit,
        at_least,
        aim,
    }
}

fn cases() -> Vec<Case> {
    use Filter::{Bilinear, Nearest};
    use Format::{Palette16, Palette256, Rgb565};
    use Model::{Floor, Globe, Sphere};
    use Size::{W640, W1280};
    const NONE: [Option<f64>; 2] = [None; 2];
    let square = [8, 8];
    let sphere = |name, texture, targets| case(name, W1280, Sphere(texture), PIXELS, targets);
    let floor = |name, filter, targets| {
        let model = Floor(texels([10, 10], Rgb565, filter));
        case(name, W1280, model, PICTURES, targets)
    };
    let globe = |name, bands| {
        let model = Globe(bands, texels([9, 8], Rgb565, Bilinear));
        case(name, W640, model, PICTURES, [Some(60.0), Some(200.0)])
    };
    vec![
        sphere("icosphere:12, no texture", None, NONE),
        sphere(
            "icosphere:12, 256×256, nearest",
            Some(texels(square, Rgb565, Nearest)),
            [Some(3.0), Some(4.0)],
        ),
        sphere(
            "icosphere:12, 256×256, bilinear",
            Some(texels(square, Rgb565, Bilinear)),
            [Some(1.5), Some(2.0)],
        ),
        sphere(
            "icosphere:12, 256×256 of 256 colours, nearest",
            Some(texels(square, Palette256, Nearest)),
            NONE,
        ),
        sphere(
            "icosphere:12, 256×256 of 16 colours, nearest",
            Some(texels(square, Palette16, Nearest)),
            NONE,
        ),
        floor("floor to the horizon, 1024×1024, nearest", Nearest, NONE),
        floor(
            "floor to the horizon, 1024×1024, bilinear",
            Bilinear,
            [Some(60.0), Some(120.0)],
        ),
        globe("globe of 10,000 triangles, 512×256, bilinear", 50),
        globe("globe of 48,400 triangles, 512×256, bilinear", 110),
    ]
}

impl Texels {
    fn encoded(self) -> Vec<u8> {
        let Self {
            size_log2,
            format,
            filter,
        } = self;
        let [width, height] = size_log2;
        // A linear congruential generator: any noise serves, because texels have no influence on time.
        let mut state = 1_u32;
        let mut noise = move || {
            state = state.wrapping_mul(0x0019_660d).wrapping_add(0x3c6e_f35f);
            (state >> 16) as u16
        };
        let mask = ((1_u32 << format.bits()) - 1) as u16;
        let mut level = |level: u8| {
            let [width, height] = [width, height].map(|side| 1_usize << side.saturating_sub(level));
            (0..width * height).map(|_| noise() & mask).collect()
        };
        let levels = (0..=width.max(height)).map(&mut level).collect();
        encode(&Source {
            size_log2,
            format,
            sampler: Sampler {
                filter,
                ..Sampler::default()
            },
            palette: (0..format.colours()).map(|_| Rgb565(noise())).collect(),
            levels,
            ..Source::default()
        })
        .expect("a good texture")
    }
}

impl Model {
    fn mesh(&self) -> Result<Vec<u8>> {
        Ok(match self {
            Self::Sphere(texels) => {
                let made = generate::named("icosphere:12")
                    .and_then(|model| convert::convert(&model, convert::Options::default()));
                let (mesh, _) = made.map_err(|error| anyhow::anyhow!("{error}"))?;
                match texels {
                    None => mesh,
                    Some(texels) => wrapped(&Mesh::new_checked(&mesh)?, texels.encoded()),
                }
            }
            Self::Floor(texels) => textured_square(&[texels.encoded()], 0.5),
            Self::Globe(bands, texels) => globe(texels.encoded(), *bands),
        })
    }

    fn view(&self) -> Result<View> {
        match self {
            Self::Sphere(_) | Self::Globe(..) => ahead(HALF_WIDTH),
            Self::Floor(_) => {
                Ok(Camera::looking([0.0, -1.9, 0.3], [0.0, 2.0, 0.0], 0.8, 0.02).rounded())
            }
        }
    }
}

/// Speed of the triangle engine with a texture: a line of `textures-engine.csv`. Numbers of cycles are means for frames drawn back to
/// back, in clocks of the SoC.
#[derive(Serialize, Deserialize)]
pub struct Row {
    /// Description of the scene.
    pub scene: String,
    /// Width in pixels.
    pub width: u32,
    /// Number of triangles in the mesh.
    pub triangles: u32,
    /// Number of drawn triangles.
    pub drawn: u32,
    /// Number of covered pixels.
    pub pixels: u64,
    /// Cycles of a frame.
    pub cycles_frame: f64,
    /// Cycles of the frame's geometry pass.
    pub cycles_geometry: f64,
    /// Cycles of the frame's raster pass.
    pub cycles_raster: f64,
    /// Covered pixels divided by the clocks in which a pass runs.
    pub rate: f64,
    /// Frames per second at 81.25 MHz.
    pub frames: f64,
    /// The unit of the two bounds.
    pub unit: String,
    /// The required bound.
    pub at_least: Option<f64>,
    /// The goal.
    pub aim: Option<f64>,
}

/// Measures the engine on virtual boards with textures.
///
/// # Errors
/// When the board is not built, or a frame differs from the model's.
pub fn measure() -> Result<Vec<Row>> {
    let firmware = built_firmware(None)?;
    let cases = cases();
    soc::two_at_a_time(&cases, |case| {
        eprintln!("{} at {} …", case.name, case.size);
        let mut board = soc::started(BOARD, &firmware)?;
        let mut console = Console::new(&mut board);
        console.greet()?;
        let mut renderer = BoardRenderer::new(console)
            .with_backend(Backend::Gateware)
            .with_route(Route::Memory);
        let mesh = case.model.mesh()?;
        let subject = Subject::mesh(Mesh::new_checked(&mesh)?);
        let frame = Frame::new(subject, case.model.view()?, case.size);
        let expected = render::on_model(&frame)?;
        let stats = renderer.show(&frame)?;
        ensure!(
            stats.backend.as_deref() == Some("gateware"),
            "{}: the soft core has drawn the frame",
            case.name
        );
        let found = renderer.colour(case.size)?;
        ensure!(
            found == expected.image.colour,
            "{}: the frame is not the model's",
            case.name
        );
        // Both frame buffers hold the picture before the measurement.
        renderer.look(&frame.view)?;
        let together = BackToBack::measure(&mut renderer, "triangle", FRAMES)?;
        row(case, &expected.stats, &together).with_context(|| case.name.to_owned())
    })
}

fn row(case: &Case, expected: &render::Stats, together: &BackToBack) -> Result<Row> {
    let expected = expected.triangles();
    let pixels = expected.pixels_covered;
    let cycles_frame = together.frame("cycles")?;
    Ok(Row {
        scene: case.name.to_owned(),
        width: case.size.width(),
        triangles: expected.triangles_in,
        drawn: expected.triangles_drawn,
        pixels,
        cycles_frame,
        cycles_geometry: together.frame("cycles_geometry")?,
        cycles_raster: together.frame("cycles_raster")?,
        rate: pixels as f64 / together.frame("cycles_busy")?,
        frames: CLOCK / cycles_frame,
        unit: case.unit.to_owned(),
        at_least: case.at_least,
        aim: case.aim,
    })
}
