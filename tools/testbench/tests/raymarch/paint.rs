//! Tests of the module `ray_paint`, which computes colours and depths from the ends of rays.

use glint_core::field::Surface;
use glint_model::raymarch::{FieldSetup, Marching, Palette, Ray, RayEnd, RayResult, State};
use glint_model::triangle::descriptor::band_rows;
use glint_testbench::{Bits, Layout, Pipe};

use crate::scenes::{FIELDS, marching_setup, setup};
use glint_testbench::raymarch::{Pixel, RayPlace, end, exit_end, marching, pixel, set_paint};
use glint_vectors::Random;

fn palette(random: &mut Random) -> Palette {
    let mut colour = || [0; 3].map(|_| random.bits() as u8);
    let mut palette = Palette {
        faces: [0; 8].map(|_| colour()),
        shadows: [0; 3].map(|_| colour()),
        undecided: colour(),
        zenith: colour(),
        horizon: colour(),
        ..Palette::default()
    };
    palette.fog_shift = random.integer(0, 7) as u32;
    palette.fog = [0; 256].map(|_| random.bits() as u8);
    palette.occlusion = [0; 256].map(|_| random.bits() as u8);
    palette
}

/// Makes a result of the ray `start`: the model's, or a random result with `t` above 0, even if no ray of the scene can produce it.
fn ending(random: &mut Random, marching: &Marching, start: &Ray) -> RayResult {
    if random.coin() {
        return marching.march(start);
    }
    let state = match random.bits() % 8 {
        0 => State::Miss,
        1 => State::Undecided,
        number => State::Hit(Surface::Face {
            axis: (number % 3) as u8,
            positive: random.coin(),
        }),
    };
    let gap = match state {
        State::Hit(_) => random.integer(0, 4095) as u32,
        _ => 0,
    };
    RayResult {
        state,
        t: random.logarithmic(1.0, 8_388_608.0) as u32,
        gap,
        slope: random.integer(0, 1023) as u32,
        steps: random.integer(1, 255) as u32,
    }
}

/// Makes an end of a ray by exits: the model's, or a random end with a depth above 0, even if no ray of the scene can produce it.
fn exit_ending(random: &mut Random, setup: &FieldSetup, place: RayPlace) -> RayEnd {
    let end = setup.tracer().trace(place.eye, place.column, place.line);
    if random.coin() {
        return end;
    }
    let state = match random.bits() % 8 {
        0 => State::Miss,
        number => State::Hit(Surface::Face {
            axis: (number % 3) as u8,
            positive: random.coin(),
        }),
    };
    RayEnd {
        state,
        depth: (random.logarithmic(1.0, 268_435_456.0) as u64) << 7,
        steps: random.integer(1, 255) as u32,
        height: random.bits() as u8,
        shadow: random.coin() && matches!(state, State::Hit(_)),
        ..end
    }
}

/// Sends ends of rays through a module, in frames of `new_setup`. `ending` makes an end, and its bits.
fn check(
    name: &str,
    new_setup: impl Fn(&mut Random) -> FieldSetup,
    ending: impl Fn(&mut Random, &Layout, &FieldSetup, RayPlace) -> (Bits, RayEnd),
) {
    const COUNT: usize = 4_000;
    let mut random = Random(8);
    let (input, output) = (("in", &["end"][..]), ("out", &Pixel::PAYLOAD[..]));
    for frame in 0..24 {
        let share = [0.0, 0.5][frame as usize % 2];
        let mut pipe = Pipe::new(name, frame, input, output, [share; 2]);
        let layout = pipe.module.packed_type("raymarch_pkg::end_t").clone();
        let setup = new_setup(&mut random);
        let palette = palette(&mut random);
        set_paint(&mut pipe.module, &setup, &palette);
        pipe.module.drive("stride", setup.width / 8);
        let expected: Vec<_> = (0..COUNT)
            .map(|_| {
                let lines = i64::from(band_rows(setup.width));
                let place = RayPlace {
                    odd: random.coin(),
                    line: random.integer(0, lines - 1) as u32,
                    column: random.integer(0, i64::from(setup.width) - 1) as u32,
                    eye: (random.bits() % 2) as usize,
                };
                let (bits, end) = ending(&mut random, &layout, &setup, place);
                pipe.source.push(vec![bits]);
                (pixel(&setup, &palette, place, &end), end)
            })
            .collect();
        let limit = 20 * COUNT as u64;
        let clocks = pipe.run(limit, |pipe| pipe.sink.items().len() == COUNT);
        pipe.module.clock();
        assert!(share > 0.0 || clocks < COUNT as u64 + 40, "{clocks} clocks");
        for (item, (wanted, end)) in pipe.sink.take().iter().zip(&expected) {
            let found = Pixel::from(std::array::from_fn(|i| item[i].number()));
            assert_eq!(found, *wanted, "{end:?} in {setup:?}");
        }
    }
}

#[test]
fn ends_of_random_rays_by_exits() {
    for (name, has_shadows) in [
        ("ray_paint", false),
        ("ray_paint_march", false),
        ("ray_paint_shadow", true),
    ] {
        check(
            name,
            |random| setup(random, &FIELDS),
            |random, layout, setup, place| {
                let mut end = exit_ending(random, setup, place);
                end.shadow &= has_shadows;
                (exit_end(layout, place, &end), end)
            },
        );
    }
}

#[test]
fn ends_of_random_marching_rays() {
    check(
        "ray_paint_march",
        |random| marching_setup(random, &FIELDS),
        |random, layout, setup, place| {
            let marching = marching(setup);
            let start = marching.ray(place.eye, place.column, place.line);
            let outcome = ending(random, marching, &start);
            let bits = end(layout, place, &start, &outcome);
            (bits, marching.seen(&start, &outcome))
        },
    );
}
