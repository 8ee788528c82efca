//! Tests of the ray generator: its rays equal the model's rays of a frame, in order.

use glint_model::raymarch::{FieldSetup, Form};
use glint_model::triangle::descriptor::band_rows;
use glint_testbench::{Bits, Layout, Module, Sink, Stalls, step};

use crate::scenes::{FIELDS, ROUND, marching_setup, setup};
use glint_model::raymarch::exits::Exits;
use glint_testbench::raymarch::{
    RayPlace, exit_ray, marching_part, marching_ray, set_generator, with_meaning,
};
use glint_vectors::Random;

/// The module with rays by exits, and its variant with all kinds of rays.
const GENERATORS: [&str; 2] = ["ray_generator", "ray_generator_all"];

struct Bench {
    module: Module,
    /// Whether the generator has spheres.
    round: bool,
}

impl Bench {
    fn new(name: &str, seed: u32) -> Self {
        Self {
            module: Module::new(name, seed),
            round: name == GENERATORS[1],
        }
    }
}

/// Returns the model's rays of the first `lines` lines of a frame, in the order of the generator.
fn expected(layout: &Layout, setup: &FieldSetup, lines: u32, round: bool) -> Vec<Bits> {
    let cones = setup.exits().filter(|_| round).map(Exits::cones);
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
        .map(|(place, y)| match &setup.form {
            Form::Exits(exits) => {
                let beam = exits.ray(place.eye, place.column, y);
                exit_ray(layout, exits, place, &beam, cones.as_ref())
            }
            Form::Marching(marching) => {
                marching_ray(layout, place, &marching.ray(place.eye, place.column, y))
            }
        })
        .collect()
}

/// Compares the rays of the first `lines` lines of a frame with the model's; returns the clocks up to the last ray.
fn check(bench: &mut Bench, setup: &FieldSetup, lines: u32, stalls: Stalls) -> u64 {
    let Bench { module, round } = bench;
    set_generator(module, setup, band_rows(setup.width));
    let layout = module.packed_type("exit_pkg::ray_t").clone();
    let rays = expected(&layout, setup, lines, *round);
    let (taken, clocks) = run(module, rays.len(), stalls);
    for (number, (item, wanted)) in taken.iter().zip(rays).enumerate() {
        let found = match &setup.form {
            Form::Exits(exits) => with_meaning(&layout.record_of(*item), exits),
            Form::Marching(_) => marching_part(&layout, &layout.record_of(*item)),
        };
        assert_eq!(found, wanted, "ray {number} of {setup:?}");
    }
    end(module, lines == setup.height);
    clocks
}

/// Starts the generator and takes `count` rays; returns them, and the number of clocks.
fn run(module: &mut Module, count: usize, stalls: Stalls) -> (Vec<Bits>, u64) {
    let mut sink = Sink::new(module, "out", &["ray"], stalls);
    let start = module.port("start");
    module.set(start, 1);
    module.clock();
    module.set(start, 0);
    let begun = module.cycles();
    while sink.items().len() < count {
        assert!(
            module.cycles() - begun < 1000 + 100 * count as u64,
            "the generator stalls"
        );
        step(module, &mut [], &mut [&mut sink]);
    }
    let clocks = module.cycles() - begun;
    (sink.take().iter().map(|item| item[0]).collect(), clocks)
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
    let fields = [&FIELDS[..], &ROUND, &["octahedron:1", "octahedron:0.01"]].concat();
    let mut random = Random(5);
    let mut modules = GENERATORS.map(|name| Bench::new(name, 1));
    for number in 0..60 {
        let share = [0.0, 0.5, 0.9][number as usize % 3];
        let stalls = Stalls::new(number, share);
        let [exits, all] = &mut modules;
        match number % 4 {
            0 => check(exits, &setup(&mut random, &FIELDS), 3, stalls),
            1 => check(all, &marching_setup(&mut random), 3, stalls),
            _ => check(all, &setup(&mut random, &fields), 3, stalls),
        };
    }
}

#[test]
fn whole_frames_and_one_ray_a_clock() {
    let mut random = Random(6);
    for (number, name) in (0..).zip([GENERATORS[1], GENERATORS[0], GENERATORS[1]]) {
        let mut bench = Bench::new(name, 2);
        let setup = match number {
            0 => marching_setup(&mut random),
            _ => setup(&mut random, &FIELDS),
        };
        let eyes = if setup.stereo.is_some() { 2 } else { 1 };
        let rays = u64::from(eyes * setup.width * setup.height);
        let clocks = check(&mut bench, &setup, setup.height, Stalls::new(number, 0.0));
        let latency = if bench.round { 60 } else { 35 };
        assert!(clocks <= rays + latency, "{clocks} clocks for {rays} rays");
    }
}
