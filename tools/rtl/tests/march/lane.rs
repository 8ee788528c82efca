//! A lane on its own: every ray that goes in comes out, as the model says, whatever the other side does.

use std::collections::HashMap;

use glint_model::march::{Outcome, Ray, Setup};
use glint_rtl::{Module, Sink, Source, Stalls};

use crate::common::Random;
use crate::ports::{End, Place, direction, ray, set_lane};
use crate::scenes::{FIELDS, ROUND, SPONGES, UNIONS, setup};

/// Rays of a frame.
const RAYS: usize = 2_000;

struct Bench {
    module: Module,
    source: Source,
    sink: Sink,
    /// Clocks in which the field was asked, and those in which a ray had to wait for a place.
    evaluated: u64,
    waited: u64,
}

impl Bench {
    fn new(name: &str, seed: u32, source_stalls: f64, sink_stalls: f64) -> Self {
        let module = Module::new(name, seed);
        let stalls = |number, share| Stalls::new(u64::from(seed) + number, share);
        Self {
            source: Source::new(&module, "in", &["ray"], stalls(1, source_stalls)),
            sink: Sink::new(&module, "out", &["end"], stalls(2, sink_stalls)),
            module,
            evaluated: 0,
            waited: 0,
        }
    }

    /// Sends random rays of a frame through the lane. Returns clocks, and evaluations by the model.
    fn check(&mut self, random: &mut Random, setup: &Setup, count: usize) -> (u64, u64) {
        set_lane(&mut self.module, setup);
        let [evaluates, waits] = ["evaluates", "waits"].map(|name| self.module.port(name));
        let eyes = if setup.stereo.is_some() { 2 } else { 1 };
        let mut expected: HashMap<Place, (Ray, Outcome)> = HashMap::new();
        let mut evaluations = 0;
        while expected.len() < count {
            let x = random.integer(0, i64::from(setup.width) - 1) as u32;
            let y = random.integer(0, i64::from(setup.height) - 1) as u32;
            let place = Place {
                odd: y / 64 % 2 == 1,
                line: y % 64,
                column: x,
                eye: random.bits() as usize % eyes,
            };
            // Lines of several bands have the same place.
            if expected.contains_key(&place) {
                continue;
            }
            let start = setup.ray(place.eye, x, y);
            let outcome = setup.march(&start);
            evaluations += u64::from(outcome.steps * setup.passes());
            self.source.push(vec![ray(place, &start)]);
            expected.insert(place, (start, outcome));
        }
        let start = self.module.cycles();
        while self.sink.items().len() < count {
            let cycles = self.module.cycles() - start;
            assert!(
                cycles < 100_000 + 100 * evaluations,
                "the lane stands still in {setup:?}"
            );
            self.source.drive(&mut self.module);
            self.sink.drive(&mut self.module);
            self.module.settle();
            self.source.sample(&self.module);
            self.sink.sample(&self.module);
            self.module.clock();
            self.evaluated += u64::from(self.module.is_high(evaluates));
            self.waited += u64::from(self.module.is_high(waits));
        }
        for item in self.sink.take() {
            let (place, end) = End::of(&item[0]);
            let (ray, outcome) = expected
                .remove(&place)
                .unwrap_or_else(|| panic!("{place:?} came twice, or was never sent: {setup:?}"));
            let wanted = End::expected(&ray, &outcome);
            assert_eq!(end, wanted, "{place:?}, {ray:?} in {setup:?}");
            if wanted.round {
                assert_eq!(direction(&item[0]), ray.direction, "{place:?} in {setup:?}");
            }
        }
        (self.module.cycles() - start, evaluations)
    }
}

/// Rays of each test: 300,000, or `GLINT_RTL_RAYS`.
fn rays() -> usize {
    std::env::var("GLINT_RTL_RAYS").map_or(300_000, |text| text.parse().unwrap())
}

fn random_rays(name: &str, fields: &[&str]) {
    let mut random = Random(3);
    let shares = [(0.0, 0.0), (0.5, 0.5), (0.0, 0.95), (0.9, 0.0)];
    let mut benches: Vec<Bench> = (1..)
        .zip(shares)
        .map(|(seed, (source, sink))| Bench::new(name, seed, source, sink))
        .collect();
    for frame in 0..rays() / RAYS {
        let setup = setup(&mut random, fields);
        let bench = frame % benches.len();
        benches[bench].check(&mut random, &setup, RAYS);
    }
}

#[test]
fn random_rays_in_sponges() {
    random_rays("ring_lane", &SPONGES);
}

#[test]
fn random_rays_in_all_fields() {
    random_rays(
        "ring_lane_all",
        &[
            &FIELDS[..],
            &ROUND,
            &UNIONS,
            &[
                "union:box:1,0.5,0.25+moving:0.25,1",
                "smooth:0.2,box:1,0.5,0.25+moving:0.25,1",
            ],
        ]
        .concat(),
    );
}
