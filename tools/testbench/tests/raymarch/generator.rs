//! Tests of the ray generator: its rays equal the model's rays of a frame, in order.

use glint_model::raymarch::FieldSetup;
use glint_model::triangle::descriptor::band_rows;
use glint_testbench::{Bits, Layout, Module, Sink, Stalls, step};

use crate::scenes::{FIELDS, ROUND, setup};
use glint_testbench::raymarch::{RayPlace, ray, set_generator};
use glint_vectors::Random;

/// Name of the module variant with all fields.
const GENERATOR: &str = "ray_generator_all";

/// Returns the type of a ray at the module's output.
fn ray_type(module: &Module) -> Layout {
    module.packed_type("raymarch_pkg::ray_t").clone()
}

/// Returns the model's rays of the first `lines` lines of a frame, in the order of the generator.
fn expected(layout: &Layout, setup: &FieldSetup, lines: u32) -> Vec<Bits> {
    let eyes = if setup.stereo.is_some() { 2 } else { 1 };
    let band_lines = band_rows(setup.width);
    let places = (0..lines).flat_map(move |y| {
        (0..eyes).flat_map(move |eye| {
            (0..setup.width).map(move |x| {
                let place = RayPlace {
                    odd: y / band_lines % 2 == 1,
                    line: y % band_lines,
                    column: x,
                    eye,
                };
                (place, y)
            })
        })
    });
    places
        .map(|(place, y)| ray(layout, place, &setup.ray(place.eye, place.column, y)))
        .collect()
}

/// Compares the rays of the first `lines` lines of a frame with the model's; returns the clocks up to the last ray.
fn check(module: &mut Module, setup: &FieldSetup, lines: u32, stalls: Stalls) -> u64 {
    set_generator(module, setup, band_rows(setup.width));
    module.drive("round", setup.is_round());
    let rays = expected(&ray_type(module), setup, lines);
    let clocks = run(module, setup, &rays, stalls);
    end(module, lines == setup.height);
    clocks
}

/// Starts the generator and compares its rays with all of `expected`; returns the number of clocks.
fn run(module: &mut Module, setup: &FieldSetup, expected: &[Bits], stalls: Stalls) -> u64 {
    let mut sink = Sink::new(module, "out", &["ray"], stalls);
    let start = module.port("start");
    module.set(start, 1);
    module.clock();
    module.set(start, 0);
    let begun = module.cycles();
    while sink.items().len() < expected.len() {
        assert!(
            module.cycles() - begun < 1000 + 100 * expected.len() as u64,
            "the generator stalls"
        );
        step(module, &mut [], &mut [&mut sink]);
    }
    let clocks = module.cycles() - begun;
    for (number, (item, wanted)) in sink.take().iter().zip(expected).enumerate() {
        assert_eq!(item[0], *wanted, "ray {number} of {setup:?}");
    }
    clocks
}

/// Ends a frame: checks that the generator is idle after a whole frame, resets it after a part of a frame.
fn end(module: &mut Module, whole: bool) {
    let [rst, busy] = ["rst", "busy"].map(|name| module.port(name));
    if whole {
        // `busy` falls two clocks after the last ray.
        module.clock();
        module.clock();
        module.settle();
        assert!(!module.is_high(busy), "busy after the last ray");
    } else {
        module.set(rst, 1);
        module.clock();
        module.set(rst, 0);
        module.clock();
    }
}

#[test]
fn beginnings_of_random_frames() {
    let fields = [&FIELDS[..], &ROUND].concat();
    let mut random = Random(5);
    let mut module = Module::new(GENERATOR, 1);
    for number in 0..60 {
        let setup = setup(&mut random, &fields);
        let share = [0.0, 0.5, 0.9][number as usize % 3];
        check(&mut module, &setup, 3, Stalls::new(number, share));
    }
}

#[test]
fn whole_frames_and_one_ray_a_clock() {
    let mut random = Random(6);
    let mut module = Module::new(GENERATOR, 2);
    for number in 0..3 {
        let setup = setup(&mut random, &FIELDS);
        let eyes = if setup.stereo.is_some() { 2 } else { 1 };
        let rays = u64::from(eyes * setup.width * setup.height);
        let clocks = check(&mut module, &setup, setup.height, Stalls::new(number, 0.0));
        assert!(clocks <= rays + 35, "{clocks} clocks for {rays} rays");
    }
}
