//! Tests of frames of several objects: a geometry pass for each object continues the lists of the previous pass.

use glint_core::camera::View;
use glint_core::colour::Rgb565;
use glint_core::fixed::{Q8_24, Turns};
use glint_core::matrix::{Axis, Matrix};
use glint_core::mesh::Mesh;
use glint_model::triangle::setup::Setup;
use glint_model::triangle::textured::Textured;
use glint_model::{DrawnTriangle, MeshSetup, Options, Placement, Shading, clip_exceptions};
use glint_vectors::meshes::{self, ahead};
use glint_vectors::scenes::inside;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::bench::Bench;
use super::expected::{CLEAR, Expected, SIZES, expected_parts};
use super::generated;

/// A mesh with its model matrix and options.
struct Thing {
    mesh: Vec<u8>,
    placement: Placement,
    options: Options<'static>,
}

/// The frame constants of each object.
fn setups(things: &[Thing], view: &View, (width, height): (u32, u32)) -> Vec<MeshSetup> {
    let camera = MeshSetup::new(view, width, height, 0).unwrap();
    let placed = things.iter().map(|thing| {
        let radius = Mesh::new_checked(&thing.mesh).unwrap().radius();
        thing.placement.setup(view, &camera, radius).unwrap()
    });
    placed.collect()
}

/// Makes a random object: rotated and uniformly scaled, perhaps mirrored or recoloured.
fn some_thing(random: &mut Pcg64Mcg, shading: Shading) -> Thing {
    let mesh = match random.random_range(0..4) {
        0 => generated("icosphere:4"),
        1 => meshes::mesh(&[], 100),
        _ => {
            let (count, extent) = (
                random.random_range(1..60),
                [0.1, 0.5, 1.5][random.random_range(0..3)],
            );
            meshes::mesh(&meshes::random(random, count, extent), 65_535)
        }
    };
    let number = |x: f64| Q8_24::from_num(x);
    let sign = [1.0, -1.0][random.random_range(0..2)];
    let scale = number(sign * random.random_range(0.1..1.5));
    let place = [0; 3].map(|_| number(random.random_range(-0.5..0.5)));
    let matrix = Matrix::scale([scale; 3])
        .and_then(|matrix| matrix.then(&Matrix::rotation(Axis::Z, Turns(random.random()))))
        .and_then(|matrix| matrix.then(&Matrix::rotation(Axis::X, Turns(random.random()))))
        .and_then(|matrix| matrix.then(&Matrix::translation(place)?));
    Thing {
        mesh,
        placement: Placement::new(matrix.unwrap()),
        options: Options {
            cull: random.random(),
            clear: CLEAR,
            shading,
            colour: random.random::<bool>().then(|| Rgb565(random.random())),
            ..Options::default()
        },
    }
}

/// Draws a frame of objects; compares each object's exceptions, and the picture.
fn draw(bench: &mut Bench, name: &str, things: &[Thing], setups: &[MeshSetup]) -> Expected {
    let things: Vec<_> = things
        .iter()
        .zip(setups)
        .map(|(thing, setup)| {
            let mesh = Mesh::new_checked(&thing.mesh).unwrap();
            (&thing.mesh, (mesh, *setup, thing.options))
        })
        .collect();
    let parts: Vec<_> = things.iter().map(|(_, part)| *part).collect();
    let size = (setups[0].width, setups[0].height);
    let expected = expected_parts(size, &parts);
    let (mut clipped, mut geometry, mut listed) = (vec![], 0, 0);
    for (number, (bytes, (mesh, setup, options))) in things.iter().enumerate() {
        bench.configure_geometry(bytes, setup, options);
        bench.set("geometry_flags.append", u64::from(number > 0));
        geometry += bench.run_geometry();
        let counts = ["status.mesh_error", "status.full", "results.triangles"];
        let counts = counts.map(|path| bench.read(path));
        assert_eq!(counts, [0, 0, mesh.triangle_count().into()], "{name}");
        let exceptions = bench.exceptions();
        let mut numbers = exceptions[listed..].iter().copied();
        listed = exceptions.len();
        let mut put = |triangle: &DrawnTriangle, setup: &Setup, _: Option<&Textured>| {
            clipped.push((*setup, triangle.colour));
        };
        clip_exceptions(mesh, setup, options, &mut numbers, &mut put);
    }
    assert_eq!(listed, expected.stats.clipped as usize, "{name}");
    assert!(clipped == expected.clipped, "{name}: clipped triangles");
    bench.draw_lists(name, &expected, geometry);
    expected
}

/// Draws frames of random objects alternately with frames of one mesh, with and without memory stalls.
#[test]
fn frames_of_objects() {
    let (mut clipped, mut drawn, mut mirrored) = (0, 0, 0);
    for seed in 0..24_u32 {
        let mut random = Pcg64Mcg::new(u128::from(seed) + 500);
        let stalls = [0.0, 0.3, 0.6][seed as usize % 3];
        let shading = [Shading::Flat, Shading::Smooth][usize::from(seed % 4 == 0)];
        let mut bench = match shading {
            Shading::Flat => Bench::new(seed, stalls),
            Shading::Smooth => Bench::of("smooth", seed, stalls),
        };
        for frame in 0..3 {
            bench.slot = random.random_range(0..2);
            bench.with_depth = random.random_ratio(1, 4);
            let size = SIZES[[0, 0, 0, 0, 0, 1, 1, 2][random.random_range(0..8)]];
            let count = random.random_range(1..6);
            let things: Vec<_> = (0..count)
                .map(|_| some_thing(&mut random, shading))
                .collect();
            let view = [inside(), ahead(1.0, 0.1)][random.random_range(0..2)];
            let setups = setups(&things, &view, size);
            let name = format!("seed {seed}, frame {frame}");
            let expected = draw(&mut bench, &name, &things, &setups);
            clipped += expected.stats.clipped;
            drawn += expected.stats.drawn;
            mirrored += setups.iter().filter(|setup| setup.mirrors).count();
        }
    }
    println!("{drawn} triangles drawn, {clipped} clipped, {mirrored} objects mirrored");
    assert!(drawn > 5000 && clipped > 500 && mirrored > 20);
}

/// After a cancelled pass, an appending pass begins with empty lists instead of lists at unknown addresses.
#[test]
fn nothing_is_appended_to_a_cancelled_frame() {
    let mut random = Pcg64Mcg::new(600);
    let mut bench = Bench::new(3, 0.2);
    let things: Vec<_> = (0..3)
        .map(|_| some_thing(&mut random, Shading::Flat))
        .collect();
    let setups = setups(&things, &inside(), SIZES[0]);
    draw(&mut bench, "before", &things, &setups);
    for (thing, setup) in things.iter().zip(&setups) {
        bench.cancel_after("geometry_start", random.random_range(0..300));
        let mesh = Mesh::new_checked(&thing.mesh).unwrap();
        let expected = expected_parts(SIZES[0], &[(mesh, *setup, thing.options)]);
        bench.configure_geometry(&thing.mesh, setup, &thing.options);
        bench.set("geometry_flags.append", 1);
        let geometry = bench.run_geometry();
        bench.draw_lists("after", &expected, geometry);
    }
}
