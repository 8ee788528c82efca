//! The ray generator: all rays of a frame, as the model has them, in their order.

use glint_model::march::Setup;
use glint_rtl::{Bits, Module, Sink, Stalls};

use crate::common::Random;
use crate::ports::{Place, ray, set_generator};
use crate::scenes::{FIELDS, ROUND, band_lines, setup};

/// As it is built for all fields.
const GENERATOR: &str = "ray_generator_round";

/// The rays of the first `lines` lines.
fn expected(setup: &Setup, lines: u32) -> Vec<Bits> {
    let eyes = if setup.stereo.is_some() { 2 } else { 1 };
    let band_lines = band_lines(setup.width);
    let places = (0..lines).flat_map(move |y| {
        (0..eyes).flat_map(move |eye| {
            (0..setup.width).map(move |x| {
                let place = Place {
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
        .map(|(place, y)| ray(place, &setup.ray(place.eye, place.column, y)))
        .collect()
}

/// Runs a frame, all of it or its beginning, and returns the clocks until its last ray.
fn check(module: &mut Module, setup: &Setup, lines: u32, stalls: Stalls) -> u64 {
    set_generator(module, setup, band_lines(setup.width));
    let round = module.port("round");
    module.set(round, u64::from(setup.is_round()));
    let mut sink = Sink::new(module, "out", &["ray"], stalls);
    let [start, rst, busy] = ["start", "rst", "busy"].map(|name| module.port(name));
    let expected = expected(setup, lines);
    module.set(start, 1);
    module.clock();
    module.set(start, 0);
    let begun = module.cycles();
    while sink.items().len() < expected.len() {
        assert!(
            module.cycles() - begun < 1000 + 100 * expected.len() as u64,
            "the generator stands still"
        );
        sink.drive(module);
        module.settle();
        sink.sample(module);
        module.clock();
    }
    let clocks = module.cycles() - begun;
    for (number, (item, wanted)) in sink.take().iter().zip(&expected).enumerate() {
        assert_eq!(item[0], *wanted, "ray {number} of {setup:?}");
    }
    module.settle();
    if lines == setup.height {
        assert!(!module.is_high(busy), "busy after the last ray");
    } else {
        module.set(rst, 1);
        module.clock();
        module.set(rst, 0);
        module.clock();
    }
    clocks
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
        assert!(clocks <= rays + 30, "{clocks} clocks for {rays} rays");
    }
}
