//! Frames of meshes.

use glint_core::camera::{Projection, View};
use glint_core::colour::{Rgb565, Rounding, Shading};
use glint_core::fixed::{Q8_24, Turns};
use glint_core::matrix::{Axis, Matrix};
use glint_core::picture::Size;
use glint_model::triangle::vertex_cache;
use glint_model::triangle::{PreparedMesh, draw_parts};
use glint_model::{MeshLight, MeshSetup, Placement, Projected, Stats};
use glint_vectors::meshes::{self, ahead, at};
use glint_vectors::picture::CLEAR;
use glint_vectors::scenes::{inside, scenes};
use glint_vectors::{Model, Picture};
use litex_pac::register::Value;
use litex_pac::triangle::{Caps, Error, offset};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::bench::{Bench, Kind, UNTOUCHED, alone};

/// Returns a simple mesh in place of a model that `glint` generates.
fn shape(name: &str) -> Vec<u8> {
    let model = match name {
        "sponge:1" => Model::cube(8192),
        _ => Model::sphere(0.5, 16),
    };
    model.encoded()
}

fn by_model(rounding: Rounding, size: Size, parts: &[PreparedMesh]) -> Picture {
    let mut picture = Picture::blank(size.pixels().into());
    let vertices = parts.iter().map(|part| part.mesh.largest_chunk()).max();
    let mut scratch = vec![Projected::Behind; vertices.unwrap_or(0)];
    let mut part = |number: usize| parts.get(number).copied();
    let mut target = picture.target();
    target.rounding = rounding;
    picture.stats = draw_parts(
        &mut part,
        Some(CLEAR),
        None,
        &mut target,
        &mut scratch,
        &mut |_| {},
    )
    .unwrap();
    picture
}

/// Draws parts with the engine and with the model, and compares the pictures and counts.
fn check(bench: &mut Bench, name: &str, size: Size, parts: &[PreparedMesh]) -> Stats {
    let expected = by_model(bench.rounding, size, parts);
    let counters = [
        offset::VERTICES,
        offset::PIXELS_COVERED,
        offset::PIXELS_DRAWN,
    ];
    let before = counters.map(|counter| bench.read(counter));
    let left_out = bench.draw(size, false, parts);
    bench.compare(name, size, false, &expected);
    let stats = expected.stats;
    let grown = [0, 1, 2].map(|i| bench.read(counters[i]).wrapping_sub(before[i]));
    let fetches = parts.iter().map(|part| vertex_cache::fetches(&part.mesh));
    let expected = [
        fetches.sum(),
        stats.pixels_covered as u32,
        stats.pixels_drawn as u32,
    ];
    assert_eq!(
        grown, expected,
        "{name}: vertices, pixels covered and drawn"
    );
    let [drawn, listed] =
        [offset::DESCRIPTOR_COUNT, offset::EXCEPTION_COUNT].map(|at| bench.read(at));
    assert_eq!(listed, stats.clipped, "{name}: exceptions");
    let whole: u32 = left_out.iter().sum::<u32>() + drawn + listed;
    assert_eq!(whole, stats.triangles_in, "{name}: triangles");
    stats
}

#[test]
fn scenes_of_all_sizes() {
    let mut bench = Bench::new();
    let (mut pixels, mut clipped) = (0, 0);
    for size in Size::ALL {
        for (name, mesh, view, cull) in scenes(shape) {
            for projection in Projection::ALL {
                let view = view.with_projection(projection);
                let name = format!("{name}, {size}, {projection}");
                let part = alone(&mesh, &view, size, cull);
                let stats = check(&mut bench, &name, size, &[part]);
                pixels += stats.pixels_covered;
                clipped += stats.clipped;
            }
        }
    }
    println!("{pixels} pixels, {clipped} clipped");
    assert!(pixels > 1_000_000 && clipped > 100);
}

/// Alternates flat and smooth frames, also in changing light. A smooth pass takes longer.
#[test]
fn frames_with_smooth_shading() {
    let mut random = Pcg64Mcg::new(22);
    let mut bench = Bench::new();
    let (mut pixels, mut clipped, mut cycles) = (0, 0, [0; 2]);
    for size in [Size::W320, Size::W640] {
        for (name, mesh, view, cull) in scenes(shape) {
            let mut light = some_light(&mut random, &view);
            if !cull {
                // The engine stores the light of one side only.
                light.ambient = [0; 3];
            }
            for (kind, shading) in [Shading::Flat, Shading::Smooth].into_iter().enumerate() {
                let mut part = alone(&mesh, &view, size, cull);
                part.options.shading = shading;
                bench.rounding = Rounding::new(random.random());
                part.options.light = random.random::<bool>().then_some(&light);
                if let Some(light) = part.options.light {
                    part.frame.light = light.row;
                }
                let name = format!("{name}, {size}, {shading}");
                let start = bench.now;
                let stats = check(&mut bench, &name, size, &[part]);
                cycles[kind] += bench.now - start;
                pixels += stats.pixels_covered;
                clipped += stats.clipped;
            }
        }
    }
    println!("{pixels} pixels, {clipped} clipped, {cycles:?} cycles");
    assert!(pixels > 1_000_000 && clipped > 100);
    assert!(cycles[1] > cycles[0]);
}

/// In an engine without smooth shading, the flag `smooth` has no effect, and a descriptor is half
/// as long.
#[test]
fn an_engine_without_smooth_shading() {
    let mut bench = Bench::new();
    let caps = |bench: &mut Bench| Caps::from_bits(bench.read(offset::CAPS));
    assert!(caps(&mut bench).gouraud());
    bench.engine.set_shading(Shading::Flat);
    assert!(!caps(&mut bench).gouraud());
    let mesh = shape("icosphere:4");
    let flat = alone(&mesh, &ahead(1.0, 0.1), Size::W320, true);
    let mut smooth = flat;
    smooth.options.shading = Shading::Smooth;
    bench.draw(Size::W320, false, &[smooth]);
    let expected = by_model(bench.rounding, Size::W320, &[flat]);
    bench.compare("flat", Size::W320, false, &expected);
}

/// Draws objects that are rotated, scaled, mirrored, recoloured or lit.
#[test]
fn frames_of_several_objects() {
    let mut random = Pcg64Mcg::new(21);
    let mut bench = Bench::new();
    let mut counts = [0; 3];
    for number in 0..40 {
        let meshes: Vec<Vec<u8>> = (0..random.random_range(1..6))
            .map(|_| match random.random_range(0..3) {
                0 => shape("icosphere:4"),
                1 => meshes::mesh(&[], 100),
                _ => meshes::mesh(&meshes::random(&mut random, 40, 0.7), 65_535),
            })
            .collect();
        let size = Size::ALL[number % 2];
        let [width, height] = size.pixels();
        let view = [inside(), ahead(1.0, 0.1)][number / 2 % 2];
        let camera = MeshSetup::new(&view, width, height, 0).unwrap();
        let light = random
            .random::<bool>()
            .then(|| some_light(&mut random, &view));
        let parts: Vec<PreparedMesh> = meshes
            .iter()
            .map(|mesh| {
                let placement = some_place(&mut random);
                let mut part = alone(mesh, &view, size, random.random());
                let radius = part.mesh.radius();
                part.frame = placement.setup(&view, &camera, radius).unwrap();
                if let Some(light) = &light {
                    part.frame.light = light.row;
                }
                part.options.colour = random.random::<bool>().then(|| Rgb565(random.random()));
                part.options.light = light.as_ref();
                part
            })
            .collect();
        let stats = check(&mut bench, &format!("frame {number}"), size, &parts);
        counts[0] += stats.drawn;
        counts[1] += stats.clipped;
        counts[2] += parts.iter().filter(|part| part.frame.mirrors).count() as u32;
    }
    println!("{counts:?} drawn, clipped, mirrored");
    assert!(counts.iter().all(|&count| count > 20), "{counts:?}");
}

fn some_place(random: &mut Pcg64Mcg) -> Placement {
    let number = |x: f64| Q8_24::from_num(x);
    let sign = [1.0, -1.0][random.random_range(0..2)];
    let scale = number(sign * random.random_range(0.1..1.5));
    let place = [0; 3].map(|_| number(random.random_range(-0.5..0.5)));
    let matrix = Matrix::scale([scale; 3])
        .and_then(|matrix| matrix.then(&Matrix::rotation(Axis::Z, Turns(random.random()))))
        .and_then(|matrix| matrix.then(&Matrix::translation(place)?));
    Placement::new(matrix.unwrap())
}

fn some_light(random: &mut Pcg64Mcg, view: &View) -> MeshLight {
    let mut part = || random.random_range(0..=256);
    MeshLight {
        row: [3 << 20, -5 << 20, 4 << 20],
        forward: view.n().map(|part| part.to_bits()),
        colour: [part(), part(), part()],
        ambient: [part(), part(), part()],
    }
}

/// After each frame, the frame buffer must contain the frame, although the engine writes only words
/// that can differ.
#[test]
fn nothing_new_is_not_written() {
    let mut bench = Bench::new();
    let nothing = meshes::mesh(&[], 100);
    // At 1280x720, a square covers 160 pixels (20 or 21 words) in each of about 90 lines.
    let square = |x: f64| {
        let [left, right, top, bottom] = [x, x + 0.5, -0.14, 0.14];
        let corner = |x, z| at(x, 0.0, z);
        let corners = [
            [corner(left, top), corner(right, top), corner(right, bottom)],
            [
                corner(left, top),
                corner(right, bottom),
                corner(left, bottom),
            ],
        ];
        meshes::mesh(&corners.map(|corners| (corners, 0xf800)), 100)
    };
    let size = Size::W1280;
    for (name, mesh, slot, words) in [
        ("fresh", &nothing, false, 115_200..=115_200),
        ("nothing again", &nothing, false, 0..=0),
        ("a square", &square(0.0), false, 1600..=1932),
        ("the other slot", &square(0.0), true, 115_200..=115_200),
        ("the same square", &square(0.0), false, 1600..=1932),
        ("the next square", &square(0.5), false, 3200..=3864),
        ("nothing left", &nothing, false, 1600..=1932),
        ("and nothing new", &nothing, false, 0..=0),
    ] {
        let part = alone(mesh, &ahead(1.0, 0.1), size, false);
        let flags = bench.prepare(&part);
        assert_eq!(bench.pass(Kind::Geometry, flags.bits()), Error::None);
        let flags = bench.prepare_raster(size, slot, &[]).with_depth(false);
        let before = bench.read(offset::ITEMS_OUT);
        assert_eq!(bench.pass(Kind::Raster, flags.bits()), Error::None);
        let written = bench.read(offset::ITEMS_OUT) - before;
        assert!(words.contains(&written), "{name}: {written} words");
        let expected = by_model(bench.rounding, size, &[part]);
        assert!(bench.picture(size, slot).0 == expected.colour, "{name}");
    }
}

/// A frame after a cancelled frame, or in a buffer with unknown contents, is written completely.
#[test]
fn a_frame_is_whole_after_a_cancelled_one() {
    let mut bench = Bench::new();
    let mesh = shape("icosphere:4");
    let part = alone(&mesh, &ahead(1.0, 0.1), Size::W320, true);
    let expected = by_model(bench.rounding, Size::W320, &[part]);
    let untouched = UNTOUCHED.to_le_bytes().repeat(320 * 180);
    for is_cancelled in [true, false] {
        bench.draw(Size::W320, false, &[part]);
        bench.write(crate::bench::FRAMES[0], &untouched);
        let flags = bench
            .prepare_raster(Size::W320, false, &[])
            .with_depth(false);
        if is_cancelled {
            bench.set(offset::RASTER, flags.bits());
            bench.now += 50;
            bench.cancel();
            assert_eq!(bench.finish(Kind::Raster), Error::Cancelled);
            bench.pass(Kind::Raster, flags.bits());
        } else {
            bench.pass(Kind::Raster, flags.with_whole(true).bits());
        }
        let (colour, _) = bench.picture(Size::W320, false);
        assert!(colour == expected.colour, "cancelled {is_cancelled}");
    }
}

/// A pass takes about as many cycles as a pass of the gateware for icosphere:6
/// (docs/report/triangle.md), a similar sphere. Counters increase during the pass.
#[test]
fn passes_take_about_the_time_of_the_gateware() {
    let mut bench = Bench::new();
    let mesh = Model::sphere(0.5, 14).encoded();
    let part = alone(&mesh, &ahead(0.4781, 0.5), Size::W320, true);
    bench.draw(Size::W320, false, &[part]);
    let flags = bench.prepare(&part);
    bench.set(offset::GEOMETRY, flags.bits());
    let start = bench.now;
    bench.now += 1000;
    let half = bench.read(offset::ITEMS_IN);
    bench.finish(Kind::Geometry);
    let geometry = bench.now - start;
    assert!(half < bench.read(offset::ITEMS_IN));
    let flags = bench
        .prepare_raster(Size::W320, false, &[])
        .with_depth(false);
    let counters = [
        offset::CYCLES_RASTER,
        offset::CYCLES_BUSY,
        offset::CYCLES_GEOMETRY,
    ];
    let before = counters.map(|counter| bench.read(counter));
    let start = bench.now;
    bench.pass(Kind::Raster, flags.bits());
    let raster = bench.now - start;
    let grown = [0, 1, 2].map(|i| u64::from(bench.read(counters[i]) - before[i]));
    assert_eq!(grown, [raster, raster, 0]);
    println!("{geometry} and {raster} cycles");
    assert!((3_500..5_500).contains(&geometry), "{geometry} cycles");
    assert!((6_500..9_500).contains(&raster), "{raster} cycles");
}
