//! Tests of the sphere unit: each pixel has the model's sphere and parameter, in order, under any
//! backpressure, and takes at most one clock per cone.

use glint_model::raymarch::exits::{Cone, Exits, Linear};
use glint_testbench::raymarch::set_cones;
use glint_testbench::{Module, Sink, Stalls, step};
use glint_vectors::Random;
use glint_vectors::rays::{self, ONE};

use crate::scenes::{self, ENDLESS_UNIONS, ROUND, UNIONS};

/// The radius of `sphere:1`, with 12 fraction bits.
const RADIUS: i32 = 81 << 11;

/// Fields with a list of spheres.
fn fields() -> Vec<&'static str> {
    let is_list = |field: &&str| !field.starts_with("lattice");
    ROUND
        .into_iter()
        .chain(UNIONS)
        .chain(ENDLESS_UNIONS)
        .filter(is_list)
        .collect()
}

/// A part of a picture, of whole groups of 8 columns.
#[derive(Clone, Copy, Debug)]
struct Window {
    /// First column and row.
    first: [u32; 2],
    /// Number of columns and rows.
    size: [u32; 2],
}

impl Window {
    /// A window of whole lines.
    fn lines(exits: &Exits, row: u32, rows: u32) -> Self {
        Self {
            first: [0, row],
            size: [exits.width, rows],
        }
    }

    /// A small random window, in most cases close to the rectangle of a cone.
    fn draw(random: &mut Random, exits: &Exits, eyes: usize) -> Self {
        let cones = exits.cones();
        let list = cones[random.bits() as usize % eyes].list();
        let whole = [[0, exits.width - 1], [0, exits.height - 1]];
        let [columns, rows] = match list.len() {
            count if count > 0 && !random.bits().is_multiple_of(4) => {
                let rectangle = &list[random.bits() as usize % count].rectangle;
                [rectangle.columns, rectangle.rows]
            }
            _ => whole,
        };
        let mut within = |[first, last]: [u32; 2], size: u32| {
            let place = random.integer(i64::from(first) - 9, i64::from(last) + 2);
            place.clamp(0, i64::from(size) - 1) as u32
        };
        let [column, row] = [
            within(columns, exits.width) / 8 * 8,
            within(rows, exits.height),
        ];
        let most = [exits.width - column, exits.height - row];
        let size = [8 * random.integer(1, 6), random.integer(1, 6)].map(|size| size as u32);
        Self {
            first: [column, row],
            size: [size[0].min(most[0]), size[1].min(most[1])],
        }
    }

    /// A cone relative to the window's first pixel: its functions are linear, so their values at each pixel do not change.
    fn shifted(&self, cone: &Cone) -> Cone {
        let [column, row] = self.first;
        let moved = |linear: Linear, shift: u32| {
            let way = i64::from(column) * linear.across + i64::from(row) * linear.down;
            Linear {
                first: linear.first + (way << shift),
                ..linear
            }
        };
        let mut cone = *cone;
        cone.forward = moved(cone.forward, 0);
        // Only the lowest 32 bits are used.
        cone.forward.first = i64::from(cone.forward.first as i32);
        cone.sides = cone.sides.map(|side| moved(side, cone.shift));
        let rectangle = &mut cone.rectangle;
        if rectangle.columns[1] < column || rectangle.rows[1] < row {
            rectangle.columns = [8, 7];
        } else {
            rectangle.columns = rectangle.columns.map(|x| x.saturating_sub(column));
            rectangle.rows = rectangle.rows.map(|y| y.saturating_sub(row));
        }
        cone
    }

    /// The eye, column and row of each pixel, in the order of the unit.
    fn pixels(&self, eyes: usize) -> impl Iterator<Item = (usize, u32, u32)> {
        let [columns, rows] = [0, 1].map(|i: usize| self.first[i]..self.first[i] + self.size[i]);
        let lines = rows.flat_map(move |y| (0..eyes).map(move |eye| (eye, y)));
        lines.flat_map(move |(eye, y)| columns.clone().map(move |x| (eye, x, y)))
    }
}

struct Bench {
    module: Module,
    /// Share of the clocks in which the output stalls.
    stalls: f64,
}

impl Bench {
    fn new(name: &str, seed: u32, stalls: f64) -> Self {
        Self {
            module: Module::new(name, seed),
            stalls,
        }
    }

    /// Compares the outputs (`meeting_t`) for the pixels of a window with the model's. Returns the
    /// numbers of clocks, of tested cones, of spheres met, and of spheres met at the near plane.
    fn check(&mut self, exits: &Exits, window: Window, eyes: usize) -> [u64; 4] {
        let Self { module, stalls } = self;
        module.drive("near_limit", exits.near);
        module.drive("far_limit", exits.far);
        module.drive("last_group", window.size[0] / 8 - 1);
        module.drive("last_row", window.size[1] - 1);
        module.drive("stereo", eyes == 2);
        set_cones(module, "", exits, eyes, |cone| window.shifted(cone));
        let mut sink = Sink::new(
            module,
            "out",
            &["meeting"],
            Stalls::new(window.first[0].into(), *stalls),
        );
        let layout = module.packed_type("exit_pkg::meeting_t").clone();
        module.drive("start", 1);
        module.clock();
        module.drive("start", 0);
        let begun = module.cycles();
        let all = exits.cones();
        let pixels: Vec<_> = window.pixels(eyes).collect();
        let limit = 1000 + 400 * pixels.len() as u64;
        while sink.items().len() < pixels.len() {
            assert!(module.cycles() - begun < limit, "the unit stalls");
            step(module, &mut [], &mut [&mut sink]);
        }
        let clocks = module.cycles() - begun;
        let (mut cones, mut hits, mut discs) = (0, 0, 0);
        for (&(eye, x, y), item) in pixels.iter().zip(sink.take()) {
            let (met, tests) = exits.meet(&all, &exits.ray(eye, x, y));
            let record = layout.record_of(item[0]);
            let (is_met, t) = (record.is_set("met"), record.get("t") as i64);
            let found = (is_met.then(|| record.get("number")), t);
            let expected = (
                met.map(|met| met.number.into()),
                met.map_or(exits.far, |met| met.t),
            );
            assert_eq!(found, expected, "{eye} {x} {y}, {window:?} in {exits:?}");
            cones += u64::from(tests.max(1));
            hits += u64::from(is_met);
            discs += u64::from(t <= exits.near + (exits.near >> 15));
        }
        // A frame has no more meetings than pixels.
        for _ in 0..100 {
            step(module, &mut [], &mut [&mut sink]);
        }
        assert!(sink.items().is_empty(), "{window:?}");
        [clocks, cones, hits, discs]
    }
}

#[test]
fn random_rays() {
    let one_eye = Bench::new("sphere_unit_one_eye", 9, 0.2);
    random_frames("sphere_unit", one_eye, &fields());
}

#[test]
fn random_rays_with_a_solid_cone() {
    let fields = [
        "cone:0.8,1.6",
        "cone:1,1",
        "cone:0.02,2",
        "cone:2,0.02",
        "union:box:1,0.5,0.25+cone:0.5,1.5",
        "sphere:1",
        "union:lattice:1,0.3+cone:0.25,1",
        "cone:12,12",
        "cone:0.01,0.01",
        "union:cubes:2,0.4+cone:1,3",
    ];
    let one_eye = Bench::new("sphere_unit_cone", 9, 0.2);
    random_frames("sphere_unit_cone", one_eye, &fields);
}

fn random_frames(name: &str, mut one_eye: Bench, fields: &[&str]) {
    let mut random = Random(11);
    let mut benches: Vec<Bench> = (1..)
        .zip([0.0, 0.5, 0.95])
        .map(|(seed, stalls)| Bench::new(name, seed, stalls))
        .collect();
    let (mut all_hits, mut all_discs) = (0, 0);
    let frames = scenes::rays() / 150;
    for frame in 0..frames {
        let (exits, eyes) = scenes::exits(&mut random, fields[frame % fields.len()]);
        let window = Window::draw(&mut random, &exits, eyes);
        let bench = match eyes {
            1 if random.coin() => &mut one_eye,
            _ => &mut benches[frame / fields.len() % 3],
        };
        let [_, _, hits, discs] = bench.check(&exits, window, eyes);
        all_hits += hits;
        all_discs += discs;
    }
    let frames = frames as u64;
    assert!(
        all_hits > 10 * frames && all_discs > frames,
        "{all_hits}, {all_discs}"
    );
}

#[test]
fn lines_take_a_clock_for_each_cone() {
    let mut random = Random(12);
    let mut bench = Bench::new("sphere_unit", 1, 0.0);
    for frame in 0..40 {
        let (exits, eyes) = scenes::exits(&mut random, fields()[frame % fields().len()]);
        let row = random.integer(0, i64::from(exits.height) - 2) as u32;
        let [clocks, cones, ..] = bench.check(&exits, Window::lines(&exits, row, 2), eyes);
        let cones_of = exits.cones();
        let most = (0..eyes).map(|eye| cones_of[eye].list().len()).max();
        // The bound includes the latency. With more than 8 cones, rays also wait for longer walks.
        if most.is_some_and(|most| most <= 8) {
            assert!(clocks < cones + 80, "{clocks} clocks, {cones} cones");
        }
    }
}

#[test]
fn directed_rays() {
    let along = [ONE, 0, 0];
    let same =
        "spheres:0,0,0,0.5;0,0,0,0.25;0,0,0,1;0,0,0,0.75;0,0,0,0.125;0,0,0,0.3;0,0,0,0.4;0,0,0,0.6";
    let equal = "spheres:0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1";
    let unit = 1 << 14;
    // A field, the eye, the direction, the near plane, and whether a sphere is met.
    type Case = (&'static str, [i32; 3], [i32; 3], i64, bool);
    let cases: [Case; 16] = [
        ("sphere:1", [-4 * RADIUS, RADIUS, 0], along, 0, false),
        ("sphere:1", [-4 * RADIUS, RADIUS + 1, 0], along, 0, false),
        ("sphere:1", [-4 * RADIUS, RADIUS - 1, 0], along, 0, true),
        ("sphere:1", [0; 3], along, 0, true),
        ("sphere:1", [RADIUS - 1, 0, 0], along, 0, true),
        ("sphere:1", [RADIUS, 0, 0], along, 0, false),
        ("sphere:1", [RADIUS, 0, 0], [!ONE, 0, 0], 0, true),
        ("sphere:0.01", [-4 * RADIUS, 0, 0], along, 0, true),
        ("sphere:12", [-13 * RADIUS, 0, 0], along, 0, true),
        (same, [-2 * RADIUS, 0, 0], along, 0, true),
        (equal, [-2 * RADIUS, 0, 0], along, 0, true),
        // Eight discs in the near plane.
        (equal, [-2 * RADIUS, 0, 0], along, 60 * unit, true),
        // Spheres between the eye and the near plane, and spheres that the near plane cuts in their
        // front half and in their back half.
        ("sphere:1", [-2 * RADIUS, 0, 0], along, 125 * unit, false),
        ("sphere:1", [-2 * RADIUS, 0, 0], along, 50 * unit, true),
        ("sphere:1", [-2 * RADIUS, 0, 0], along, 120 * unit, true),
        // The direction is short, so that T is beyond the far limit.
        ("sphere:1", [-4 * RADIUS, 0, 0], [ONE >> 8, 0, 0], 0, false),
    ];
    let mut bench = Bench::new("sphere_unit", 3, 0.3);
    let window = Window {
        first: [0, 0],
        size: [8, 1],
    };
    for (field, eye, direction, near, is_met) in cases {
        let mut exits = rays::frame(field, eye, direction);
        exits.near = near;
        let [_, _, hits, _] = bench.check(&exits, window, 1);
        assert_eq!(
            hits,
            8 * u64::from(is_met),
            "{field} {eye:?} {direction:?} {near}"
        );
    }
    // A list without a radius.
    let mut exits = rays::frame("sphere:1", [-4 * RADIUS, 0, 0], along);
    exits.spheres.list[0].radius = 0;
    exits.aim(along.map(|part| part << 3));
    bench.check(&exits, window, 1);
}
