//! Tests of a lane of marching rays: every ray must end exactly once, with the model's result,
//! under any backpressure.

use std::collections::HashMap;

use glint_model::raymarch::FieldSetup;
use glint_testbench::{Bits, Layout, Pipe};

use crate::scenes::{STALLS, marching_setup, rays};
use glint_testbench::raymarch::{End, RayPlace, ray, set_lane};
use glint_vectors::Random;

/// Number of rays in a frame.
const RAYS: usize = 2_000;

/// A sent ray, its expected end, and its number of evaluations of the field.
struct Sent {
    item: Bits,
    end: End,
    steps: u32,
}

/// Makes random rays of a frame, with their expected ends, by place.
fn some_rays(random: &mut Random, layout: &Layout, setup: &FieldSetup) -> HashMap<RayPlace, Sent> {
    let eyes = if setup.stereo.is_some() { 2 } else { 1 };
    let marching = setup.marching().expect("marching rays");
    let mut all = HashMap::new();
    // A place has only the parity of the band, so rays of different bands can have equal places; one ray per place is kept.
    while all.len() < RAYS {
        let x = random.integer(0, i64::from(setup.width) - 1) as u32;
        let y = random.integer(0, i64::from(setup.height) - 1) as u32;
        let place = RayPlace {
            odd: y / 64 % 2 == 1,
            line: y % 64,
            column: x,
            eye: random.bits() as usize % eyes,
        };
        let start = marching.ray(place.eye, x, y);
        let outcome = marching.march(&start);
        let sent = Sent {
            item: ray(layout, place, &start),
            end: End::expected(&start, &outcome),
            steps: outcome.steps * marching.passes(),
        };
        all.insert(place, sent);
    }
    all
}

struct Bench(Pipe);

impl Bench {
    fn new(name: &str, seed: u32, stalls: [f64; 2]) -> Self {
        Self(Pipe::new(
            name,
            seed,
            ("in", &["ray"]),
            ("out", &["end"]),
            stalls,
        ))
    }

    /// Returns the type of a ray at the module's input.
    fn ray(&self) -> Layout {
        self.0.module.packed_type("raymarch_pkg::ray_t").clone()
    }

    /// Sends rays of a frame through the lane, and compares their ends with the expected ends.
    fn check(&mut self, setup: &FieldSetup, mut expected: HashMap<RayPlace, Sent>) {
        let Self(pipe) = self;
        set_lane(&mut pipe.module, setup);
        let end = pipe.module.packed_type("raymarch_pkg::end_t").clone();
        let count = expected.len();
        let evaluations: u64 = expected.values().map(|sent| u64::from(sent.steps)).sum();
        for sent in expected.values() {
            pipe.source.push(vec![sent.item]);
        }
        let limit = 100_000 + 100 * evaluations;
        pipe.run(limit, |pipe| pipe.sink.items().len() == count);
        pipe.module.clock();
        for item in pipe.sink.take() {
            let record = end.record_of(item[0]);
            let (place, found) = End::of(&record);
            let sent = expected
                .remove(&place)
                .unwrap_or_else(|| panic!("{place:?} ended twice, or was never sent: {setup:?}"));
            assert_eq!(found, sent.end, "{place:?}, {:?} in {setup:?}", sent.item);
        }
    }
}

#[test]
fn random_rays_in_smooth_unions() {
    let mut random = Random(3);
    let mut benches: Vec<_> = ["ring_lane", "ring_lane_all"]
        .into_iter()
        .flat_map(|name| {
            (1..)
                .zip(STALLS)
                .map(move |(seed, stalls)| Bench::new(name, seed, stalls))
        })
        .collect();
    for frame in 0..rays() / RAYS {
        let setup = marching_setup(&mut random);
        let bench = frame % benches.len();
        let rays = some_rays(&mut random, &benches[bench].ray(), &setup);
        benches[bench].check(&setup, rays);
    }
}
