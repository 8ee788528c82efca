//! Frames in fog.

use glint_core::colour::Rounding;
use glint_model::{Options, Shading};
use glint_vectors::meshes::{self, ahead};
use glint_vectors::scenes::inside;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::bench::Bench;
use super::expected::{CLEAR, SIZES, expected_in_fog};
use super::generated;

/// Options of a frame.
fn options(shading: Shading) -> Options<'static> {
    Options {
        cull: false,
        clear: CLEAR,
        shading,
        ..Options::default()
    }
}

/// Random triangles, flat and smooth, some of them clipped, in fog of any density, and without fog.
#[test]
fn random_frames_in_fog() {
    let (mut foggy, mut clipped) = (0, 0);
    for seed in 0..6_u32 {
        let mut random = Pcg64Mcg::new(u128::from(seed) << 1 | 1);
        let mut bench = Bench::of("smooth_lines", seed, [0.0, 0.3, 0.7][seed as usize % 3]);
        for count in 0..4 {
            bench.with_depth = count == 0;
            bench.slot = random.random_range(0..2);
            let size = SIZES[if count == 3 { 1 } else { 0 }];
            let triangles = meshes::random(&mut random, 80, [0.05, 0.5, 2.0][count % 3]);
            let mesh = meshes::mesh(&triangles, 65_535);
            let density = [0.0, 0.02, 0.5, 15.9][random.random_range(0..4)];
            let shading = [Shading::Flat, Shading::Smooth][random.random_range(0..2)];
            let fog = (density, random.random());
            let rounding = Rounding::new(random.random());
            let options = options(shading);
            let expected = expected_in_fog(rounding, fog, options, &mesh, &inside(), size);
            foggy += u32::from(expected.fog.is_some());
            clipped += expected.clipped.len();
            bench.draw(&format!("frame {count} of seed {seed}"), &mesh, &expected);
        }
    }
    assert!(foggy > 8 && clipped > 50, "{foggy}, {clipped}");
}

/// A sphere in fog: one clock for each half of a group.
#[test]
fn a_sphere_in_fog_is_drawn_fast() {
    for (name, size, alone, overlapped) in [
        ("icosphere:6", SIZES[0], 1.6, 2.3),
        ("icosphere:12", SIZES[2], 2.6, 3.0),
    ] {
        let mesh = generated(name);
        let view = ahead(0.4781, 0.5);
        let fog = (0.3, [255; 3]);
        let options = Options {
            cull: true,
            ..options(Shading::Flat)
        };
        let expected = expected_in_fog(Rounding::Dithered, fog, options, &mesh, &view, size);
        let mut bench = Bench::of("smooth_lines", 9, 0.0);
        bench.with_depth = false;
        bench.draw("before it", &mesh, &expected);
        let clocks = bench.draw(name, &mesh, &expected);
        let pixels = expected.stats.pixels_covered as f64;
        let rates = [
            clocks.geometry + clocks.raster,
            clocks.geometry.max(clocks.raster),
        ]
        .map(|clocks| pixels / clocks as f64);
        println!(
            "{name} at {size:?} in fog: {} clocks for the raster, {:.2} pixels per clock alone, {:.2} overlapped",
            clocks.raster, rates[0], rates[1]
        );
        assert!(
            rates[0] >= alone && rates[1] >= overlapped,
            "{name}: {rates:?}"
        );
    }
}
