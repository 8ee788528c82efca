//! Frames of meshes with textures, whose descriptors come from the model.

use glint_core::colour::{Rgb565, Shading};
use glint_core::light::{Light, MeshLighting};
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_core::texture::{Filter, Format, Sampler, Source, Texture, Wrap, encode};
use glint_model::triangle::descriptor::Descriptor;
use glint_model::triangle::setup::{Bounds, Setup};
use glint_model::triangle::textured::Textured;
use glint_model::{
    DrawnTriangle, Frame, FrameConstants, MeshLight, MeshSubject, Options, Projected, Stats,
    Subject,
};
use glint_vectors::meshes::textured_square;
use glint_vectors::{Camera, Picture};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::bench::Bench;
use super::expected::Expected;

/// A texture of random texels with all mip levels.
fn texture(random: &mut Pcg64Mcg) -> Source {
    let format = Format::ALL[random.random_range(0..3)];
    let size_log2 = [(); 2].map(|()| random.random_range(3..=7));
    let [width, height] = size_log2;
    let most = match format {
        Format::Rgb565 => u16::MAX,
        Format::Palette256 => 255,
        Format::Palette16 => 15,
    };
    let mut level = |level: u8| {
        let texels = [width, height].map(|side: u8| 1_usize << side.saturating_sub(level));
        (0..texels[0] * texels[1])
            .map(|_| random.random_range(0..=most))
            .collect()
    };
    let levels = (0..=width.max(height)).map(&mut level).collect();
    Source {
        format,
        size_log2,
        palette: (0..format.colours())
            .map(|_| Rgb565(random.random()))
            .collect(),
        sampler: Sampler {
            wrap: [(); 2].map(|()| Wrap::ALL[random.random_range(0..3)]),
            filter: Filter::ALL[random.random_range(0..2)],
        },
        key: random
            .random_bool(0.5)
            .then(|| random.random_range(0..=most)),
        levels,
    }
}

/// Offset of the mesh's texture numbers, which begin at 1, in the table of textures.
const BEFORE: u8 = 4;

/// A frame of a square with textures.
struct Shown {
    mesh: Vec<u8>,
    expected: Expected,
    /// The triangles that need no clipping.
    whole: Vec<(Descriptor, Bounds)>,
    /// The clipped triangles.
    clipped: Vec<(Descriptor, Bounds)>,
}

impl Shown {
    fn new(textures: &[Vec<u8>], eye: [f64; 3], repeats: f64) -> Self {
        let bytes = textured_square(textures, repeats);
        let mesh = Mesh::new_checked(&bytes).unwrap();
        let camera = Camera::looking(eye, [0.1, 0.5, 0.0], 0.8, 0.02);
        let frame = Frame {
            subject: Subject::Mesh(MeshSubject {
                shading: Shading::Flat,
                ..MeshSubject::new(mesh)
            }),
            view: camera.rounded(),
            size: Size::W320,
            clear: Rgb565(0x001F),
            lighting: MeshLighting {
                ambient: [0x60; 3],
                light: Light::at_camera([0xA0; 3]),
            },
            stereo: None,
        };
        let mut constants = FrameConstants::default();
        constants.update(&frame).unwrap();
        let mut scratch = vec![Projected::Behind; frame.scratch_vertices()];
        let (mut whole, mut clipped) = (vec![], vec![]);
        let mut put = |triangle: &DrawnTriangle, setup: &Setup, textured: Option<&Textured>| {
            let texture = textured.map(|textured| {
                let same = |texture: &Texture| texture.bytes() == textured.texture.bytes();
                let number = mesh.textures().position(|texture| same(&texture)).unwrap();
                textured.numbered(BEFORE + 1 + number as u8)
            });
            let drawn = (
                Descriptor::new(setup, triangle.colour, texture.as_ref()),
                setup.bounds,
            );
            if triangle.clipped {
                clipped.push(drawn);
            } else {
                whole.push(drawn);
            }
        };
        frame
            .set_up_meshes(&constants, &mut scratch, &mut put)
            .unwrap();
        let light: &MeshLight = Box::leak(Box::new(*constants.light().unwrap()));
        let picture = Picture::of_frame(&frame);
        let expected = Expected {
            size: (320, 180),
            frame: *constants.mesh().unwrap(),
            options: Options {
                clear: frame.clear.0,
                cull: true,
                light: Some(light),
                ..Options::default()
            },
            colour: picture.colour,
            depth: picture.depth,
            clipped: vec![],
            stats: Stats::default(),
        };
        Self {
            mesh: bytes,
            expected,
            whole,
            clipped,
        }
    }
}

#[test]
fn frames_with_textures() {
    let (mut pixels, mut clocks, mut by_pass) = (0, 0, 0);
    for seed in 0..24 {
        let mut random = Pcg64Mcg::new(u128::from(seed) << 1 | 1);
        let mut bench = Bench::of("texture", seed, [0.0, 0.3, 0.7][seed as usize % 3]);
        for count in 0..4 {
            let repeats = [0.5, 1.0, 4.0, 30.0][random.random_range(0..4)];
            let textures: Vec<_> = (0..random.random_range(1..=2))
                .map(|_| encode(&texture(&mut random)).unwrap())
                .collect();
            // From afar no triangle is clipped.
            let distance = if random.random_bool(0.5) { 1.0 } else { 3.0 };
            let eye = [
                random.random_range(-1.0..1.0),
                distance * random.random_range(-2.0..-0.3),
                distance * random.random_range(0.05..1.5),
            ];
            let shown = Shown::new(&textures, eye, repeats);
            let expected = &shown.expected;
            pixels += expected.depth.iter().filter(|&&code| code != 0).count();
            let name = format!("frame {count} of seed {seed}");
            clocks += if random.random_bool(0.7) {
                by_pass += shown.whole.len();
                let [_, raster] = bench.draw_textured(&name, expected, &shown.mesh, &shown.clipped);
                raster
            } else {
                let triangles = [shown.whole, shown.clipped].concat();
                bench.draw_set(&name, expected, &triangles, &textures)
            };
        }
    }
    println!("{pixels} pixels in {clocks} clocks, {by_pass} triangles by the geometry pass");
    assert!(pixels > 500_000 && by_pass > 40, "{pixels}, {by_pass}");
}

/// A cancelled frame does not change the next frame, whether its coordinates, its textures or its texels are being read.
#[test]
fn a_cancelled_frame_with_textures_leaves_a_working_engine() {
    let mut random = Pcg64Mcg::new(5);
    let textures = [(); 2].map(|()| encode(&texture(&mut random)).unwrap());
    let shown = Shown::new(&textures, [0.3, -3.0, 2.0], 1.0);
    for stalls in [0.0, 0.6] {
        let mut bench = Bench::of("texture", 9, stalls);
        for (port, clocks) in [
            ("geometry_start", 200),
            ("geometry_start", 90),
            ("raster_start", 40),
            ("raster_start", 150),
            ("raster_start", 230),
            ("raster_start", 700),
            ("raster_start", 3000),
        ] {
            let name = format!("{port} cancelled after {clocks} clocks with stalls {stalls}");
            bench.draw_textured(&name, &shown.expected, &shown.mesh, &shown.clipped);
            bench.cancel_after(port, clocks);
            bench.draw_textured(&name, &shown.expected, &shown.mesh, &shown.clipped);
        }
    }
}
