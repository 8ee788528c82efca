//! Frames of meshes with textures, whose descriptors come from the model.

use std::collections::BTreeSet;

use glint_core::appearance::Appearance;
use glint_core::camera::{Projection, View};
use glint_core::colour::{Rgb565, Rounding, Shading};
use glint_core::field::Field;
use glint_core::fixed::U4_28;
use glint_core::light::{Gradient, Light, MeshLighting};
use glint_core::mesh::Mesh;
use glint_core::picture::{Samples, Size};
use glint_core::quality::Quality;
use glint_core::texture::{Blend, Filter, Format, Sampler, Source, Texture, Wrap, encode};
use glint_model::triangle::descriptor::Descriptor;
use glint_model::triangle::setup::{Bounds, Setup};
use glint_model::triangle::textured::Textured;
use glint_model::{
    DrawnTriangle, FieldSubject, Frame, FrameConstants, MeshLight, MeshSubject, Options, Projected,
    Stats, Subject,
};
use glint_testbench::raymarch::Pixel;
use glint_vectors::meshes::{ahead, textured_layers, textured_square, wrapped};
use glint_vectors::{Camera, Picture};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::bench::Bench;
use super::expected::{Averages, Expected, gradient};
use super::fields::{bands, send_bands};
use super::generated;

/// A texture of random texels with all mip levels.
pub fn texture(random: &mut Pcg64Mcg) -> Source {
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
        blend: if random.random_bool(0.4) {
            Blend::Opaque
        } else {
            Blend::ALL[random.random_range(1..=8)]
        },
        levels,
    }
}

/// Kinds of textures that a test has drawn.
#[derive(Default)]
pub struct Kinds(BTreeSet<String>);

impl Kinds {
    /// Adds the kinds of a texture, and returns the texture.
    pub fn add(&mut self, source: Source) -> Source {
        let Source {
            format, sampler, ..
        } = &source;
        let kinds = [
            format!("{format:?}, {:?}", sampler.filter),
            format!("{format:?}, keyed: {}", source.key.is_some()),
            format!("{:?}", sampler.wrap),
            format!("{:?}", source.blend),
        ];
        self.0.extend(kinds);
        source
    }

    /// Checks that all kinds were drawn.
    pub fn assert_complete(&self) {
        let formats = Format::ALL.len();
        let wraps = Wrap::ALL.len() * Wrap::ALL.len();
        let count = formats * Filter::ALL.len() + 2 * formats + wraps + Blend::ALL.len();
        assert_eq!(self.0.len(), count, "{:#?}", self.0);
    }
}

/// Offset of the mesh's texture numbers, which begin at 1, in the table of textures.
pub const BEFORE: u8 = 4;

/// A frame of a mesh with textures.
pub struct Shown {
    pub mesh: Vec<u8>,
    pub expected: Expected,
    /// The triangles that need no clipping.
    pub whole: Vec<(Descriptor, Bounds)>,
    /// The clipped triangles.
    pub clipped: Vec<(Descriptor, Bounds)>,
    /// The pixels of the field around the mesh, by band.
    pub bands: Vec<Vec<Pixel>>,
}

/// The view of a camera at `eye` that looks at the square of the test meshes.
fn looking(eye: [f64; 3]) -> View {
    Camera::looking(eye, [0.1, 0.5, 0.0], 0.8, 0.02).rounded()
}

impl Shown {
    fn new(bytes: Vec<u8>, eye: [f64; 3]) -> Self {
        Self::before(bytes, eye, None, None, 0.0, Rounding::Dithered)
    }

    /// As [`new`](Self::new), in orthographic projection.
    pub fn orthographic(bytes: Vec<u8>, eye: [f64; 3], rounding: Rounding) -> Self {
        let view = looking(eye).with_projection(Projection::Orthographic);
        Self::seen(bytes, view, Size::W320, None, None, 0.0, rounding)
    }

    /// A mesh in a field, or before a sky, in fog of a density per world unit.
    pub fn before(
        bytes: Vec<u8>,
        eye: [f64; 3],
        field: Option<&FieldSubject>,
        sky: Option<Gradient>,
        fog: f64,
        rounding: Rounding,
    ) -> Self {
        Self::seen(bytes, looking(eye), Size::W320, field, sky, fog, rounding)
    }

    /// A mesh as a view shows it, in a field, or before a sky, and in fog.
    fn seen(
        bytes: Vec<u8>,
        view: View,
        size: Size,
        field: Option<&FieldSubject>,
        sky: Option<Gradient>,
        fog: f64,
        rounding: Rounding,
    ) -> Self {
        let mesh = Mesh::new_checked(&bytes).unwrap();
        let subject = MeshSubject {
            shading: Shading::Flat,
            ..MeshSubject::new(mesh)
        };
        let subject = match field {
            None => Subject::Mesh(subject),
            Some(&field) => Subject::MeshInField(subject, field),
        };
        let frame = Frame {
            clear: Rgb565(0x001F),
            sky,
            fog: U4_28::from_num(fog),
            rounding,
            lighting: MeshLighting {
                ambient: [0x60; 3],
                light: Light::at_camera([0xA0; 3]),
            },
            ..Frame::new(subject, view, size)
        };
        Self::of(&bytes, &frame, vec![])
    }

    /// A frame of the mesh with these `bytes`. With four samples a pixel, `before` is the content of the frame buffer.
    pub fn of(bytes: &[u8], frame: &Frame, mut before: Vec<u16>) -> Self {
        let mesh = Mesh::new_checked(bytes).unwrap();
        let window = frame.window();
        let rounding = frame.rounding;
        let mut constants = FrameConstants::default();
        constants.update(frame).unwrap();
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
        let light = constants.light();
        let light = light.map(|&light| -> &MeshLight { Box::leak(Box::new(light)) });
        let picture = Picture::of_frame(frame);
        let averages = (frame.samples == Samples::Four).then(|| Averages {
            size: frame.size.pixels().into(),
            quarter: window.quarter,
        });
        let colour = match averages {
            None => picture.colour,
            Some(_) => {
                frame.average(&picture.colour, &mut before, &mut || {});
                before
            }
        };
        let expected = Expected {
            size: window.size.pixels().into(),
            averages,
            frame: *constants.mesh().unwrap(),
            options: Options {
                clear: frame.clear.0,
                cull: true,
                light,
                ..Options::default()
            },
            sky: constants.sky().copied(),
            fog: constants.fog().copied(),
            rounding,
            colour,
            depth: picture.depth,
            clipped: vec![],
            stats: Stats::default(),
        };
        let bands = constants.field().map(|field| bands(field, rounding, 1));
        Self {
            mesh: bytes.to_vec(),
            expected,
            whole,
            clipped,
            bands: bands.unwrap_or_default(),
        }
    }
}

#[test]
fn frames_with_textures() {
    let (mut pixels, mut clocks, mut by_pass, mut orthographic) = (0, 0, 0, 0);
    let mut kinds = Kinds::default();
    for seed in 0..12 {
        let mut random = Pcg64Mcg::new(u128::from(seed) << 1 | 1);
        let mut bench = Bench::of("texture", seed, [0.0, 0.3, 0.7][seed as usize % 3]);
        for count in 0..4 {
            let repeats = [0.5, 1.0, 4.0, 30.0][random.random_range(0..4)];
            let layers = random.random_bool(0.5);
            let textures: Vec<_> = (0..random.random_range(1..=if layers { 4 } else { 2 }))
                .map(|_| encode(&kinds.add(texture(&mut random))).unwrap())
                .collect();
            let mesh = if layers {
                // With a gap of 0, all layers have equal depths, apart from rounding.
                let gap = [0.0, 0.1, 0.4][random.random_range(0..3)];
                textured_layers(&textures, repeats, gap)
            } else {
                textured_square(&textures, repeats)
            };
            // From afar no triangle is clipped.
            let distance = if random.random_bool(0.5) { 1.0 } else { 3.0 };
            let eye = [
                random.random_range(-1.0..1.0),
                distance * random.random_range(-2.0..-0.3),
                distance * random.random_range(0.05..1.5),
            ];
            let is_orthographic = random.random_bool(0.3);
            let rounding = Rounding::new(random.random());
            let shown = if is_orthographic {
                Shown::orthographic(mesh, eye, rounding)
            } else {
                Shown::before(mesh, eye, None, None, 0.0, rounding)
            };
            let expected = &shown.expected;
            orthographic += u32::from(is_orthographic);
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
    assert!(orthographic > 5, "{orthographic}");
    kinds.assert_complete();
}

/// Meshes are drawn over the field around them, and blended with it.
#[test]
fn frames_with_textures_in_a_field() {
    for (seed, stalls, text) in [(1, 0.0, "menger:2"), (2, 0.4, "box:0.3,1,0.3")] {
        let mut random = Pcg64Mcg::new(seed);
        let mut bench = Bench::of("texture_fields", seed as u32, stalls);
        for count in 0..2 {
            let textures: Vec<_> = (0..3)
                .map(|_| encode(&texture(&mut random)).unwrap())
                .collect();
            let mesh = textured_layers(&textures, 1.0, 0.3);
            let field = FieldSubject {
                field: &Field::parse(text).unwrap(),
                appearance: &Appearance {
                    fog: U4_28::from_num([0.0, 0.3][count]),
                    ..Appearance::default()
                },
                quality: Quality::default(),
            };
            // From afar no triangle is clipped, so the second set has them all.
            let eye = [0.4, random.random_range(-4.0..-3.0), 2.0];
            let rounding = Rounding::new(count == 0);
            let mut shown = Shown::before(mesh, eye, Some(&field), None, 0.0, rounding);
            let name = format!("frame {count} in {text}");
            let triangles = [shown.whole, shown.clipped].concat();
            bench.set("field_source.enable", 1);
            bench.set("field_source.compose", 0);
            bench.start_set(&shown.expected, &triangles, &textures);
            send_bands(&mut bench, &mut random, false, &mut shown.bands);
            bench.finish(&name, &shown.expected);
        }
    }
}

/// Frames of meshes with a sky behind them, with and without fog. If a mesh is blended with the sky, the sky is drawn first. Frames without
/// a sky follow.
#[test]
fn frames_with_textures_before_a_sky() {
    let mut firsts = [0; 2];
    for (seed, stalls) in [(1, 0.0), (2, 0.3), (3, 0.7)] {
        let mut random = Pcg64Mcg::new(seed);
        let mut bench = Bench::of("texture_fields", seed as u32, stalls);
        bench.set("field_source.enable", 0);
        for count in 0..6 {
            let sources: Vec<_> = (0..random.random_range(1..3))
                .map(|_| texture(&mut random))
                .collect();
            let is_first = sources.iter().any(|source| source.blend != Blend::Opaque);
            let textures: Vec<_> = sources
                .iter()
                .map(|source| encode(source).unwrap())
                .collect();
            let mesh = textured_layers(&textures, 1.0, 0.3);
            let eye = [0.4, random.random_range(-4.0..-1.0), 1.0];
            let sky = (count % 3 != 2).then(|| gradient(&mut random));
            if sky.is_some() {
                firsts[usize::from(is_first)] += 1;
            }
            let fog = [0.0, 0.1, 1.0][random.random_range(0..3)];
            let rounding = Rounding::new(random.random());
            let shown = Shown::before(mesh, eye, None, sky, fog, rounding);
            let triangles = [shown.whole, shown.clipped].concat();
            bench.slot = random.random_range(0..2);
            bench.set("raster_flags.sky_first", u64::from(is_first));
            let name = format!("frame {count} of seed {seed}");
            bench.draw_set(&name, &shown.expected, &triangles, &textures);
        }
    }
    assert!(firsts.iter().all(|&count| count > 2), "{firsts:?}");
}

/// A sphere with a texture around it, of noise with all mip levels.
fn sphere(filter: Filter, format: Format) -> Vec<u8> {
    let mut random = Pcg64Mcg::new(1);
    let most = ((1_u32 << format.bits()) - 1) as u16;
    let texture = encode(&Source {
        format,
        size_log2: [8, 8],
        palette: (0..format.colours())
            .map(|_| Rgb565(random.random()))
            .collect(),
        sampler: Sampler {
            filter,
            ..Sampler::default()
        },
        levels: (0..=8)
            .map(|level| {
                (0..1 << (16 - 2 * level))
                    .map(|_| random.random_range(0..=most))
                    .collect()
            })
            .collect(),
        ..Source::default()
    });
    let bytes = generated("icosphere:12");
    wrapped(&Mesh::new_checked(&bytes).unwrap(), texture.unwrap())
}

/// Checks the pixels drawn per clock of the raster pass on a sphere with a texture, for several memory latencies. The last case is in fog,
/// which adds its latency once in each band.
#[test]
fn a_sphere_with_a_texture_is_drawn_fast() {
    for (filter, format, latency, fog, least) in [
        (Filter::Nearest, Format::Rgb565, 12, 0.0, 2.96),
        (Filter::Nearest, Format::Rgb565, 30, 0.0, 2.93),
        (Filter::Nearest, Format::Rgb565, 100, 0.0, 2.83),
        (Filter::Nearest, Format::Palette16, 30, 0.0, 2.97),
        (Filter::Bilinear, Format::Rgb565, 12, 0.0, 1.76),
        (Filter::Bilinear, Format::Rgb565, 30, 0.0, 1.75),
        (Filter::Nearest, Format::Rgb565, 12, 0.3, 2.94),
    ] {
        let shown = Shown::seen(
            sphere(filter, format),
            ahead(0.4781, 0.5),
            Size::W1280,
            None,
            None,
            fog,
            Rounding::Dithered,
        );
        let pixels = shown
            .expected
            .depth
            .iter()
            .filter(|&&code| code != 0)
            .count();
        let mut bench = if fog > 0.0 {
            let mut bench = Bench::of("texture_fields", 9, 0.0);
            bench.set("field_source.enable", 0);
            bench
        } else {
            Bench::of("texture", 9, 0.0)
        };
        bench.with_depth = false;
        for read in &mut bench.reads {
            read.latency = latency;
        }
        let name = format!("{filter:?}, {format:?}, fog {fog}");
        bench.draw_textured(&name, &shown.expected, &shown.mesh, &shown.clipped);
        let [geometry, clocks] =
            bench.draw_textured(&name, &shown.expected, &shown.mesh, &shown.clipped);
        let rate = pixels as f64 / clocks as f64;
        println!(
            "{name}, latency {latency}: {pixels} pixels in {clocks} clocks, {geometry} for the geometry: {rate:.3}"
        );
        assert!(rate > least, "{name}: {rate}");
    }
}

/// Blended groups take the number of clocks that docs/textures.md states, and that the emulated board assumes.
#[test]
fn a_blended_group_takes_8_clocks_and_one_for_each_pixel() {
    for blend in [Blend::ALL[4], Blend::Additive] {
        let texture = encode(&Source {
            size_log2: [3, 3],
            blend,
            levels: vec![vec![0x8410; 64]],
            ..Source::default()
        });
        let mesh = textured_layers(&[texture.unwrap()], 1.0, 0.0);
        let shown = Shown::new(mesh, [0.0, -1.2, 1.0]);
        let mut bench = Bench::of("texture", 3, 0.0);
        // Without depths, because a band waits until the depths of the previous band are written.
        bench.with_depth = false;
        let name = format!("{blend:?}");
        let [_, clocks] = bench.draw_textured(&name, &shown.expected, &shown.mesh, &shown.clipped);
        let [groups, pixels] = ["groups", "pixels_drawn"].map(|counter| bench.count(counter));
        let stated = 8 * groups + pixels;
        println!("{pixels} pixels in {groups} groups: {clocks} clocks, {stated} stated");
        assert!(pixels > 5_000, "{pixels}");
        assert!(clocks.abs_diff(stated) < stated / 20, "{clocks}, {stated}");
    }
}

/// A cancelled frame does not change the next frame, whether its coordinates, its textures or its texels are being read.
#[test]
fn a_cancelled_frame_with_textures_leaves_a_working_engine() {
    let mut random = Pcg64Mcg::new(5);
    let textures = [(); 2].map(|()| encode(&texture(&mut random)).unwrap());
    let shown = Shown::new(textured_square(&textures, 1.0), [0.3, -3.0, 2.0]);
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
