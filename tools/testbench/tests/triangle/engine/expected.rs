//! Frames drawn by the model, which the triangle engine must reproduce.

use glint_core::camera::View;
use glint_core::colour::Rounding;
use glint_core::fixed::U4_28;
use glint_core::light::Gradient;
use glint_core::mesh::{Mesh, Rgb565};
use glint_core::picture::Quarter;
use glint_model::triangle::setup::{Bounds, Oriented, Setup};
use glint_model::triangle::{PreparedMesh, draw_parts};
use glint_model::{
    DrawnTriangle, Fog, FrameBuffer, MeshSetup, Options, Projected, Shading, Sky, Stats,
};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

pub const SIZES: [(u32, u32); 3] = glint_model::SIZES;
pub const CLEAR: u16 = 0x1234;

/// A frame drawn by the model.
pub struct Expected {
    /// Size of the drawn picture in pixels, or in samples if a pixel has four samples.
    pub size: (u32, u32),
    /// The averages of a frame with four samples a pixel.
    pub averages: Option<Averages>,
    /// Frame constants and options of the first or only mesh.
    pub frame: MeshSetup,
    pub options: Options<'static>,
    /// The sky, which replaces the clear colour.
    pub sky: Option<Sky>,
    /// The fog on the triangles.
    pub fog: Option<Fog>,
    /// How colours are rounded.
    pub rounding: Rounding,
    pub colour: Vec<u16>,
    pub depth: Vec<u32>,
    /// Setups and colours of the clipped triangles.
    pub clipped: Vec<(Setup, Rgb565)>,
    pub stats: Stats,
}

/// The part of a frame with four samples a pixel that is drawn.
pub struct Averages {
    /// Size of the frame.
    pub size: (u32, u32),
    /// The quarter that is drawn; `None` for the whole frame.
    pub quarter: Option<Quarter>,
}

impl Expected {
    /// Size of the frame in memory.
    pub fn frame_size(&self) -> (u32, u32) {
        let averages = self.averages.as_ref();
        averages.map_or(self.size, |averages| averages.size)
    }
}

/// Draws a frame with the model.
pub fn expected(mesh: &[u8], view: &View, size: (u32, u32), cull: bool) -> Expected {
    expected_on(CLEAR, mesh, view, size, cull)
}

/// Draws a frame with the model on the background colour `clear`.
pub fn expected_on(clear: u16, mesh: &[u8], view: &View, size: (u32, u32), cull: bool) -> Expected {
    let options = Options {
        cull,
        clear,
        ..Options::default()
    };
    expected_with(options, mesh, view, size)
}

/// Draws a frame with the model, with smooth shading.
pub fn expected_smooth(
    rounding: Rounding,
    mesh: &[u8],
    view: &View,
    size: (u32, u32),
    cull: bool,
) -> Expected {
    let options = Options {
        cull,
        clear: CLEAR,
        shading: Shading::Smooth,
        ..Options::default()
    };
    expected_rounded(rounding, options, mesh, view, size)
}

/// Draws a frame with the model, with any options.
pub fn expected_with(
    options: Options<'static>,
    mesh: &[u8],
    view: &View,
    size: (u32, u32),
) -> Expected {
    expected_rounded(Rounding::Dithered, options, mesh, view, size)
}

fn expected_rounded(
    rounding: Rounding,
    options: Options<'static>,
    mesh: &[u8],
    view: &View,
    size: (u32, u32),
) -> Expected {
    let mesh = Mesh::new_checked(mesh).unwrap();
    let mut frame = MeshSetup::new(view, size.0, size.1, mesh.radius()).unwrap();
    if let Some(light) = options.light {
        frame.light = light.row;
    }
    expected_parts_in_fog(rounding, None, size, &[(mesh, frame, options)])
}

/// Draws a frame with the model in fog of a density per world unit and a colour.
pub fn expected_in_fog(
    rounding: Rounding,
    (density, colour): (f64, [u8; 3]),
    options: Options<'static>,
    mesh: &[u8],
    view: &View,
    size: (u32, u32),
) -> Expected {
    let mesh = Mesh::new_checked(mesh).unwrap();
    let frame = MeshSetup::new(view, size.0, size.1, mesh.radius()).unwrap();
    let fog = Fog::new(U4_28::from_num(density), frame.depth, colour);
    expected_parts_in_fog(rounding, fog, size, &[(mesh, frame, options)])
}

/// Draws a frame of several meshes with the model, from each mesh's frame constants and options.
pub fn expected_parts(size: (u32, u32), parts: &[(Mesh, MeshSetup, Options<'static>)]) -> Expected {
    expected_parts_in_fog(Rounding::Dithered, None, size, parts)
}

fn expected_parts_in_fog(
    rounding: Rounding,
    fog: Option<Fog>,
    size: (u32, u32),
    parts: &[(Mesh, MeshSetup, Options<'static>)],
) -> Expected {
    let pixels = (size.0 * size.1) as usize;
    let (mut colour, mut depth) = (vec![0; pixels], vec![0; pixels]);
    let vertices = parts.iter().map(|(mesh, ..)| mesh.largest_chunk()).max();
    let mut scratch = vec![Projected::Behind; vertices.unwrap_or(0)];
    let mut target = FrameBuffer {
        width: size.0,
        height: size.1,
        colour: &mut colour,
        depth: &mut depth,
        rounding,
    };
    let mut clipped = Vec::new();
    let mut show = |triangle: &DrawnTriangle| {
        if triangle.clipped {
            clipped.push(setup(triangle, size));
        }
    };
    let mut part = |number: usize| {
        parts
            .get(number)
            .map(|&(mesh, frame, options)| PreparedMesh {
                mesh,
                frame,
                options,
            })
    };
    let (_, frame, options) = parts[0];
    let stats = draw_parts(
        &mut part,
        Some(options.clear),
        fog.as_ref(),
        &mut target,
        &mut scratch,
        &mut show,
    )
    .unwrap();
    Expected {
        size,
        frame,
        options,
        averages: None,
        sky: None,
        fog,
        rounding,
        colour,
        depth,
        clipped,
        stats,
    }
}

/// The setup and the colour of a triangle.
fn setup(triangle: &DrawnTriangle, (width, height): (u32, u32)) -> (Setup, Rgb565) {
    let oriented = Oriented::new(triangle.vertices).unwrap();
    let bounds = Bounds::new(&oriented.vertices, width, height).unwrap();
    let setup = match &triangle.lit {
        None => Setup::new(&oriented, bounds),
        Some(lit) => Setup::smooth(&oriented, bounds, lit),
    };
    (setup, triangle.colour)
}

/// Makes an expected frame without triangles from colours and depth codes of another source.
pub fn picture(size: (u32, u32), view: &View, colour: Vec<u16>, depth: Vec<u32>) -> Expected {
    Expected {
        size,
        frame: MeshSetup::new(view, size.0, size.1, 0).unwrap(),
        options: Options {
            clear: CLEAR,
            ..Options::default()
        },
        averages: None,
        sky: None,
        fog: None,
        rounding: Rounding::Dithered,
        colour,
        depth,
        clipped: vec![],
        stats: Stats::default(),
    }
}

/// A gradient of random colours, which depends on the direction of view or has fixed places in the picture.
pub fn gradient(random: &mut Pcg64Mcg) -> Gradient {
    Gradient {
        colours: random.random(),
        is_fixed: random.random(),
    }
}
