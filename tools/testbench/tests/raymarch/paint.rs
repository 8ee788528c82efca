//! Tests of the module `ray_paint`, which computes colours and depths from the ends of rays.

use glint_core::colour::Rounding;
use glint_core::field::Surface;
use glint_model::raymarch::{FieldSetup, Palette, RayEnd, State};
use glint_model::triangle::descriptor::band_rows;
use glint_testbench::Pipe;

use crate::scenes::{FIELDS, setup};
use glint_testbench::raymarch::{Pixel, RayPlace, exit_end, pixel, set_paint};
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

/// Makes an end of a ray: the model's end, or a random end with a depth above 0, which need not be
/// possible in the scene.
fn ending(random: &mut Random, setup: &FieldSetup, place: RayPlace) -> RayEnd {
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

/// Sends ends of rays through a module.
fn check(name: &str, has_shadows: bool) {
    const COUNT: usize = 4_000;
    let mut random = Random(8);
    let (input, output) = (("in", &["end"][..]), ("out", &Pixel::PAYLOAD[..]));
    for frame in 0..24 {
        let share = [0.0, 0.5][frame as usize % 2];
        let mut pipe = Pipe::new(name, frame, input, output, [share; 2]);
        let layout = pipe.module.packed_type("raymarch_pkg::end_t").clone();
        let setup = setup(&mut random, &FIELDS);
        let palette = palette(&mut random);
        set_paint(&mut pipe.module, &setup, &palette);
        pipe.module.drive("stride", setup.width / 8);
        let (rounding, first_line) = (Rounding::new(random.coin()), random.integer(0, 3) as u32);
        pipe.module.drive("dither", rounding == Rounding::Dithered);
        pipe.module.drive("first_line", first_line);
        let expected: Vec<_> = (0..COUNT)
            .map(|_| {
                let lines = i64::from(band_rows(setup.width));
                let place = RayPlace {
                    odd: random.coin(),
                    line: random.integer(0, lines - 1) as u32,
                    column: random.integer(0, i64::from(setup.width) - 1) as u32,
                    eye: (random.bits() % 2) as usize,
                };
                let mut end = ending(&mut random, &setup, place);
                end.shadow &= has_shadows;
                pipe.source.push(vec![exit_end(&layout, place, &end)]);
                let row = first_line + place.line;
                let pixel = pixel(&setup, &palette, rounding, place, row, &end);
                (pixel, end)
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
fn ends_of_random_rays() {
    check("ray_paint", false);
    check("ray_paint_shadow", true);
}
