//! Tests of whole frames of the raymarcher. Large frames are rare: they consist of more bands and groups of the same kinds, and take most of the
//! time.

use glint_model::raymarch::{FieldSetup, Lights, Palette, Shine, State};
use glint_testbench::{FrameCost, Raymarcher};
use glint_vectors::Random;

use crate::scenes::{
    ENDLESS_UNIONS, FIELDS, ROUND, SPONGES, UNIONS, further_kinds, lights, limit_steps,
    setup_of_width, unshaded_setup,
};

/// Number of lanes of the module `raymarcher_sponge`.
const LANES: u64 = 4;

/// The cost of a frame of the module `raymarcher_sponge`, as a text.
fn busy(taken: &FrameCost) -> String {
    let evaluations = taken.stats.evaluations as f64;
    format!(
        "{:.2} evaluations a ray, {:.4} a clock and lane, {} clocks, {} of lanes idle",
        evaluations / f64::from(taken.stats.rays),
        evaluations / (taken.clocks * LANES) as f64,
        taken.clocks,
        taken.idle
    )
}

#[test]
fn frames_of_all_fields_with_stalls() {
    let mut random = Random(9);
    let mut bench = Raymarcher::new("raymarcher", 1);
    for (width, fields) in [
        (320, &FIELDS[..]),
        (320, &FIELDS),
        (640, &FIELDS),
        (1280, &["union:planes:1+spheres:0,0,-0.7,0.5;2,1,1,0.4"]),
    ] {
        draw_in_short(&mut bench, &mut random, fields, width);
    }
    for text in further_kinds() {
        draw_in_short(&mut bench, &mut random, &[text], 320);
    }
    // Backpressure at the output of pixels blocks the ends of rays, which in turn block the rays.
    assert!(bench.stalled() > 0);
}

/// Draws a frame of a random field of `fields` with a low step limit, because an undecided ray, which takes all steps, costs as
/// much as 20 decided rays.
fn draw_in_short(bench: &mut Raymarcher, random: &mut Random, fields: &[&str], width: u32) {
    let mut setup = setup_of_width(random, fields, width);
    limit_steps(&mut setup, 40);
    let palette = match setup.stereo {
        Some(_) => Palette::default().grey(),
        None => Palette::default(),
    };
    bench.draw(Some(random), &setup, &palette);
}

#[test]
fn frames_of_sponges_with_stalls() {
    let mut random = Random(12);
    let mut bench = Raymarcher::new("raymarcher_sponge", 2);
    for _ in 0..3 {
        let mut setup = unshaded_setup(&mut random, &SPONGES);
        limit_steps(&mut setup, 20);
        bench.draw(Some(&mut random), &setup, &Palette::default());
    }
}

#[test]
fn frames_of_round_fields_in_all_lights() {
    let mut random = Random(12);
    let mut bench = Raymarcher::new("raymarcher", 1);
    for frame in 0..5 {
        let fields = [&ROUND[..], &UNIONS, &SPONGES][frame % 3];
        let width = if frame == 0 { 640 } else { 320 };
        let mut setup = setup_of_width(&mut random, fields, width);
        limit_steps(&mut setup, 20);
        let palette = Palette {
            shadows: [[10, 20, 30], [40, 50, 60], [70, 80, 90]],
            lights: lights(&mut random, setup.stereo.is_some()),
            ..Palette::default()
        };
        let stalls = (frame % 2 == 1).then_some(&mut random);
        bench.draw(stalls, &setup, &palette);
    }
}

/// A random frame of 320 columns of a field, and a palette with random lights.
fn small_and_lit(random: &mut Random, text: &str) -> (FieldSetup, Palette) {
    let setup = setup_of_width(random, &[text], 320);
    let palette = Palette {
        lights: lights(random, setup.stereo.is_some()),
        ..Palette::default()
    };
    (setup, palette)
}

/// Draws cones alone and in unions, with random lights. Fields with a cone follow fields without one, and vice versa.
#[test]
fn frames_of_cones_in_all_lights() {
    let mut random = Random(15);
    let mut bench = Raymarcher::new("raymarcher", 1);
    let fields = [
        "cone:0.8,1.6",
        "sphere:1",
        "cone:1.5,0.3",
        "union:box:1,0.5,0.25+cone:0.5,1.5",
        "spheres:0,0,0,0.5;1,0,0,0.5;0,1,0,0.5;0,0,1,0.5;-1,0,0,0.5;0,-1,0,0.5;0,0,-1,0.5;1,1,1,0.5",
        "union:cubes:2,0.4+cone:1,3",
        "cone:0.05,2",
    ];
    for (frame, text) in fields.into_iter().enumerate() {
        let (setup, palette) = small_and_lit(&mut random, text);
        let stalls = (frame % 2 == 1).then_some(&mut random);
        bench.draw(stalls, &setup, &palette);
    }
}

/// In a repeated field, spheres need the eye's position in the world, and the field needs the eye's
/// position in its cell.
#[test]
fn frames_of_spheres_in_endless_fields() {
    let mut random = Random(14);
    let mut bench = Raymarcher::new("raymarcher", 1);
    for text in ENDLESS_UNIONS {
        let (setup, palette) = small_and_lit(&mut random, text);
        bench.draw(None, &setup, &palette);
    }
}

/// Draws a sphere with one lighting pass and with eight passes. Each further pass may take one more
/// clock per pixel of the sphere.
#[test]
fn round_pixels_take_a_clock_a_pass() {
    let mut random = Random(13);
    let mut bench = Raymarcher::new("raymarcher", 1);
    let setup = loop {
        let setup = setup_of_width(&mut random, &["sphere:1"], 320);
        let end = setup.tracer().trace(0, setup.width / 2, setup.height / 2);
        if matches!(end.state, State::Hit(_)) {
            break setup;
        }
    };
    let normals = Some(Lights::components(setup.stereo.is_some()));
    let [one, eight] = [(1, None, None), (4, normals, Some(Shine::default()))].map(
        |(count, normals, highlight)| {
            let mut palette = Palette::default();
            palette.lights = Lights {
                count,
                normals,
                highlight,
                ..palette.lights
            };
            let taken = bench.draw(None, &setup, &palette);
            println!("{count} lights: {} clocks", taken.clocks);
            (taken.clocks, u64::from(taken.stats.hits))
        },
    );
    assert!(eight.0 <= one.0 + 7 * eight.1 + 100, "{one:?}, {eight:?}");
}

#[test]
fn sponges_keep_the_lanes_busy() {
    let mut random = Random(10);
    let mut bench = Raymarcher::new("raymarcher_sponge", 1);
    for frame in 0..2 {
        let setup = unshaded_setup(&mut random, &SPONGES);
        let taken = bench.draw(None, &setup, &Palette::default());
        println!("frame {frame}: {}", busy(&taken));
        // Below 8 evaluations per ray, the ray generator limits the speed, not the lanes.
        let share = taken.stats.evaluations as f64 / (taken.clocks * LANES) as f64;
        assert!(share >= 0.98 || taken.stats.evaluations < 8 * u64::from(taken.stats.rays));
    }
}

#[test]
fn a_cancelled_frame_leaves_nothing() {
    let mut random = Random(11);
    let mut bench = Raymarcher::new("raymarcher", 3);
    for clocks in [1, 20, 500, 20_000] {
        let setup = setup_of_width(&mut random, &["cubes:2,0.5"], 320);
        bench.cancel(&setup, clocks);
        let mut setup = setup;
        limit_steps(&mut setup, 8);
        bench.draw(Some(&mut random), &setup, &Palette::default());
    }
}
