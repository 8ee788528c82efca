//! Tests of the modules for rays by exits: the reciprocal, and the lane. Every ray must end exactly
//! once, with the model's result, under any backpressure.

use std::collections::HashMap;

use glint_core::camera::View;
use glint_core::field::{Field, Surface};
use glint_core::fixed::{Q32_32, U4_28};
use glint_model::raymarch::State;
use glint_model::raymarch::exits::{Exits, Inverse, Rule, Words};
use glint_testbench::raymarch::{RayPlace, exit_ray, rule};
use glint_testbench::{Bits, Layout, Module, Pipe, Record};
use glint_vectors::Random;

use crate::scenes::{ENDLESS_UNIONS, FIELDS, SPONGES, STALLS, UNIONS, camera, exits, rays};

/// Number of rays in a frame.
const RAYS: usize = 2_000;

/// Fields of a lane that draws sponges up to depth 4.
fn fields() -> Vec<&'static str> {
    let is_sponge = |field: &&str| field.starts_with("menger:");
    let others = FIELDS.into_iter().filter(|field| !is_sponge(field));
    SPONGES.into_iter().chain(others).collect()
}

/// Fields of a lane that draws sponges up to depth 6, and whose rays may meet spheres.
fn all_fields() -> Vec<&'static str> {
    let is_union = |field: &&str| field.starts_with("union:");
    let unions = UNIONS.into_iter().chain(ENDLESS_UNIONS).filter(is_union);
    [&SPONGES[..], &FIELDS, &LATTICES, &OCTAHEDRA]
        .concat()
        .into_iter()
        .chain(unions)
        .collect()
}

/// Lattices of spheres: typical radii, and the smallest and the largest radius.
const LATTICES: [&str; 6] = [
    "lattice:1,0.3",
    "lattice:2,0.5",
    "lattice:0.25,0.124",
    "lattice:16,0.01",
    "lattice:16,7.9999",
    "lattice:1,0.01",
];

/// Fields of repeated boxes; in some of them, the boxes touch along some axes.
const BOXES: [&str; 6] = [
    "boxes:2,0.7,0.3,0.12",
    "boxes:2,0.25,1,0.15",
    "boxes:1,0.5,0.5,0.05",
    "boxes:1,0.499996185,0.5,0.499996185",
    "boxes:2,0.5,0.5,0.5",
    "boxes:2,1,1,1",
];

/// Octahedra: the smallest, the largest, and two of typical sizes.
const OCTAHEDRA: [&str; 4] = [
    "octahedron:1",
    "octahedron:0.01",
    "octahedron:12",
    "octahedron:2.7",
];

/// The surface that a ray hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Seen {
    /// A face perpendicular to an axis, and whether its normal is positive.
    Face(u64, bool),
    /// A face of an octahedron: bit i is set if component i of the normal is positive.
    Octant(u64),
    /// A sphere of a list or of a lattice, with the ray's direction.
    Sphere(u64, [i32; 3]),
}

impl Seen {
    /// The surface of a hit in a solid.
    fn of(record: &Record, rule: Rule) -> Self {
        let (axis, is_positive) = (record.get("axis"), record.is_set("positive"));
        match rule {
            Rule::Octahedron => {
                // The same computation as the function `octant` of exit_pkg.
                let negative = [1, 2, 4, 0][axis as usize];
                Self::Octant(if is_positive { !negative & 7 } else { negative })
            }
            _ => Self::Face(axis, is_positive),
        }
    }
}

/// End of a ray. A miss has no surface; its parameter is the limit of the ray: the far limit, or
/// the parameter at a sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct End {
    t: u64,
    surface: Option<Seen>,
    steps: u64,
    height: u64,
}

/// Drives the constants of a frame.
fn set_lane(module: &mut Module, exits: &Exits) {
    let solid = exits.solid.unwrap_or_default();
    let (name, _, levels) = rule(solid.rule);
    let mut record = module.record("solid").with("levels", levels);
    record.set_name("rule", name);
    record.set_all("half", solid.half());
    record.set_all("border", solid.borders());
    module.drive_bits("solid", record.bits());
    module.drive("far_t", exits.far);
    for (number, eye) in exits.eyes.iter().enumerate() {
        module.drive_all(&format!("origins[{number}]"), eye.place());
    }
}

/// A sent ray and its expected end.
struct Sent {
    item: Bits,
    end: End,
}

/// Makes a frame in which all rays have the same start and direction, both difficult: the start is
/// on a border of the solid or next to one, and components of the direction are 0 or 1 ulp. The
/// near plane is at the eye.
fn stiff_frame(random: &mut Random, text: &str) -> Exits {
    const ONE: i64 = (1 << 27) - 1;
    let field = Field::parse(text).expect("a field");
    let exits = |view: &View| {
        let words = Words::CHOSEN;
        Exits::new(&field, view, (320, 180), None, words).expect("a frame")
    };
    let old = camera(random);
    let before = exits(&old);
    let half = before.solid.expect("a solid").half();
    let place = half.map(|half| {
        let steps = [1 << 17, half.into(), 1 << 12];
        let border = random.integer(-2, 2) * steps[random.bits() as usize % 3];
        (border + random.integer(-1, 1)) as f64 / 4096.0 / before.scale.to_num::<f64>()
    });
    let place = place.map(Q32_32::from_num);
    let near = U4_28::from_num(0.01);
    let view = View::new_checked(place, old.u(), old.v(), old.n(), old.half_width(), near);
    let mut exits = exits(&view.expect("an eye within its range"));
    let mut direction = [0; 3].map(|_| match random.bits() % 4 {
        0 => random.integer(-2, 1),
        1 => [ONE, !ONE, ONE - 1, ONE / 3][random.bits() as usize % 4],
        _ => random.integer(!ONE, ONE),
    });
    // No direction of a camera is shorter than 1/8.
    let axis = random.bits() as usize % 3;
    let least = random.integer(1 << 24, ONE);
    if direction[axis].abs() < 1 << 24 {
        direction[axis] = if random.coin() { least } else { !least };
    }
    exits.near = 0;
    exits.aim(direction.map(|part| (part << 3) as i32));
    exits
}

/// Makes random rays of a frame, with their expected ends, by place.
fn some_rays(
    random: &mut Random,
    layout: &Layout,
    exits: &Exits,
    eyes: usize,
    round: bool,
    count: usize,
) -> HashMap<u32, Sent> {
    let mut all = HashMap::new();
    let cones = exits.cones();
    while all.len() < count {
        let x = random.integer(0, i64::from(exits.width) - 1) as u32;
        let y = random.integer(0, i64::from(exits.height) - 1) as u32;
        let eye = random.bits() as usize % eyes;
        let place = RayPlace {
            odd: y / 64 % 2 == 1,
            line: y % 64,
            column: x,
            eye,
        };
        let beam = exits.ray(eye, x, y);
        let found = exits.end(&cones, &beam);
        let (surface, t) = match found.state {
            State::Hit(Surface::Face { axis, positive }) => {
                (Some(Seen::Face(axis.into(), positive)), found.t)
            }
            State::Hit(Surface::Octant { signs }) => (Some(Seen::Octant(signs.into())), found.t),
            State::Hit(surface) => {
                let number = surface.number().unwrap_or_default();
                (Some(Seen::Sphere(number.into(), beam.direction())), found.t)
            }
            _ => (None, exits.far),
        };
        let end = End {
            t: t as u64,
            surface,
            steps: found.steps.into(),
            height: beam.height().into(),
        };
        let item = exit_ray(layout, exits, place, &beam, Some(&cones).filter(|_| round));
        all.insert(place.bits(), Sent { item, end });
    }
    all
}

struct Bench {
    pipe: Pipe,
    /// The unit after the lane that computes the parameters of hits on spheres of a lattice.
    landing: Option<Pipe>,
    /// Whether each ray has its own limit; otherwise the parameter of a miss has no meaning.
    has_limits: bool,
}

/// A build of the lane with all kinds of solids.
const ALL: &str = "exit_lane_all";

impl Bench {
    fn new(name: &str, seed: u32, stalls: [f64; 2]) -> Self {
        let (rays, ends) = (("in", &["ray"][..]), ("out", &["end"][..]));
        Self {
            pipe: Pipe::new(name, seed, rays, ends, stalls),
            landing: match name {
                ALL => Some("exit_landing_round"),
                "exit_lane_lattice" => Some("exit_landing"),
                _ => None,
            }
            .map(|landing| Pipe::new(landing, seed, ("in", &["end"]), ends, stalls)),
            has_limits: name == ALL,
        }
    }

    /// Sends rays of a frame through the lane, and compares their ends with the expected ends.
    fn check(&mut self, exits: &Exits, mut expected: HashMap<u32, Sent>) {
        let Self {
            pipe,
            landing,
            has_limits,
        } = self;
        set_lane(&mut pipe.module, exits);
        let layout = pipe.module.packed_type("exit_pkg::end_t").clone();
        let rule = exits.solid.expect("a solid").rule;
        let count = expected.len();
        let evaluations: u64 = expected.values().map(|sent| sent.end.steps).sum();
        for sent in expected.values() {
            pipe.source.push(vec![sent.item]);
        }
        pipe.run(100_000 + 100 * evaluations, |pipe| {
            pipe.sink.items().len() == count
        });
        pipe.module.clock();
        let mut ends = pipe.sink.take();
        if let Some(landing) = landing {
            landing.module.drive("far_t", exits.far);
            for end in ends {
                landing.source.push(end);
            }
            landing.run(100_000, |landing| landing.sink.items().len() == count);
            landing.module.clock();
            ends = landing.sink.take();
        }
        for item in ends {
            let record = layout.record_of(item[0]);
            let place = record.get("place") as u32;
            let is_hit = record.is_set("hit");
            let has_t = is_hit || *has_limits;
            let direction = || {
                let part = |axis| record.signed(&format!("direction[{axis}]")) as i32;
                [0, 1, 2].map(part)
            };
            let surface = match (is_hit, record.is_set("round"), record.is_set("met")) {
                (true, true, _) => Some(Seen::Sphere(0, direction())),
                (true, false, _) => Some(Seen::of(&record, rule)),
                (false, _, true) => Some(Seen::Sphere(record.get("number"), direction())),
                (false, _, false) => None,
            };
            let found = End {
                t: if has_t {
                    record.get("t")
                } else {
                    exits.far as u64
                },
                surface,
                steps: record.get("steps"),
                height: record.get("height"),
            };
            let sent = expected
                .remove(&place)
                .unwrap_or_else(|| panic!("{place:?} ended twice, or was never sent: {exits:?}"));
            assert_eq!(found, sent.end, "{place:?}, {:?} in {exits:?}", sent.item);
        }
    }
}

#[test]
fn reciprocals() {
    const LATENCY: usize = 12;
    let mut random = Random(5);
    // The ends of the ranges, powers of two and their neighbours, and numbers of all lengths.
    let powers = (0..27).map(|i| 1_u32 << i);
    let near = powers.flat_map(|power| [power - 1, power, power + 1]);
    let thirds = (89_478_400..89_478_600).chain([(1 << 27) - 1]);
    let drawn = (0..200_000).map(|_| (random.bits() as u32 & 0x7FF_FFFF) >> (random.bits() % 27));
    let numbers: Vec<u32> = near.chain(thirds).chain(drawn).collect();
    let mut module = Module::load("exit_reciprocal", 1);
    let [clk, magnitude, inverse] = ["clk", "magnitude", "inverse"].map(|name| module.port(name));
    module.settle();
    for clock in 0..numbers.len() + LATENCY {
        if let Some(&number) = clock.checked_sub(LATENCY).and_then(|i| numbers.get(i)) {
            let expected = Inverse::of(2 * number + 1, &Words::CHOSEN).word();
            assert_eq!(
                module.value(inverse),
                u64::from(expected),
                "reciprocal of {number:#x}"
            );
        }
        let number = numbers.get(clock).copied().unwrap_or_default();
        module.set(magnitude, u64::from(number));
        for level in [1_u64, 0] {
            module.set(clk, level);
            module.settle();
        }
    }
}

fn random_rays(name: &str, fields: &[&str]) {
    let mut random = Random(7);
    let mut benches: Vec<Bench> = (1..)
        .zip(STALLS)
        .map(|(seed, stalls)| Bench::new(name, seed, stalls))
        .collect();
    let layout = benches[0]
        .pipe
        .module
        .packed_type("exit_pkg::ray_t")
        .clone();
    for frame in 0..rays() / RAYS {
        let (exits, eyes) = exits(&mut random, fields[frame % fields.len()]);
        let rays = some_rays(&mut random, &layout, &exits, eyes, name == ALL, RAYS);
        benches[frame / fields.len() % 4].check(&exits, rays);
    }
}

#[test]
fn random_rays_in_flat_solids() {
    random_rays("exit_lane", &fields());
}

#[test]
fn random_rays_in_all_solids() {
    random_rays(ALL, &all_fields());
}

#[test]
fn random_rays_in_lattices() {
    random_rays("exit_lane_lattice", &LATTICES);
}

fn stiff_rays(name: &str, fields: &[&str]) {
    let mut random = Random(9);
    let mut bench = Bench::new(name, 1, [0.0, 0.0]);
    let layout = bench.pipe.module.packed_type("exit_pkg::ray_t").clone();
    for frame in 0..20 * (rays() / RAYS) {
        let exits = stiff_frame(&mut random, fields[frame % fields.len()]);
        let rays = some_rays(&mut random, &layout, &exits, 1, name == ALL, 1);
        bench.check(&exits, rays);
    }
}

#[test]
fn stiff_rays_in_boxes() {
    stiff_rays("exit_lane", &BOXES);
}

#[test]
fn stiff_rays_in_lattices() {
    stiff_rays("exit_lane_lattice", &LATTICES);
}

#[test]
fn random_rays_to_octahedra() {
    random_rays("exit_lane_octahedron", &OCTAHEDRA);
}

#[test]
fn stiff_rays_to_octahedra() {
    stiff_rays("exit_lane_octahedron", &OCTAHEDRA);
}
