//! Tests of the sphere unit: each ray has the model's sphere and parameter, in order, under any back-pressure, and takes no more clocks than
//! its cones.

use glint_core::camera::View;
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, U4_28};
use glint_model::raymarch::exits::{Beam, Cone, Exits, Words};
use glint_testbench::{Bits, Pipe};
use glint_vectors::Random;

use crate::scenes::{ROUND, UNIONS, camera, size, stereo};

/// The largest component of a direction.
const ONE: i32 = (1 << 24) - 1;
/// The radius of `sphere:1`, with 12 fraction bits.
const RADIUS: i32 = 81 << 11;

/// Fields with a list of spheres.
fn fields() -> Vec<&'static str> {
    let is_list = |field: &&str| !field.starts_with("lattice");
    ROUND.into_iter().chain(UNIONS).filter(is_list).collect()
}

/// A pixel of an eye.
type Pixel = (usize, u32, u32);

/// The values of a cone's constants, in the order of `sphere_unit`.
fn constants(cone: &Cone) -> [i64; 15] {
    let [columns, rows] =
        [&cone.rectangle.columns, &cone.rectangle.rows].map(|pair| pair.map(i64::from));
    let [a, b] = cone.sides;
    let forward = cone.forward;
    let low = |x: i64| x & 0xFFFF_FFFF;
    let (mantissa, exponent) = cone.distance;
    let kind = i64::from(cone.number) | i64::from(cone.shift) << 2;
    assert_eq!((b.across, cone.shift % 2), (0, 0));
    assert!([a, b].iter().all(|side| side.first.abs() < 1 << 45));
    assert!(forward.first.abs() < 1 << 31 && mantissa < 1 << 24 && exponent < 16);
    [
        columns[0] >> 3 | columns[1] >> 3 << 8,
        rows[0] | rows[1] << 10,
        a.across,
        a.down,
        b.down,
        forward.across,
        forward.down,
        low(a.first),
        a.first >> 32,
        low(b.first),
        b.first >> 32,
        low(forward.first),
        cone.share,
        mantissa | i64::from(exponent) << 24,
        kind,
    ]
}

struct Bench(Pipe);

impl Bench {
    fn new(name: &str, seed: u32, stalls: [f64; 2]) -> Self {
        let rays = ("in", &["eye", "column", "row", "payload"][..]);
        let spheres = ("out", &["met", "number", "t", "payload"][..]);
        Self(Pipe::new(name, seed, rays, spheres, stalls))
    }

    fn write(&mut self, address: usize, value: i64) {
        let module = &mut self.0.module;
        module.drive("write", 1);
        module.drive("address", address as i64);
        module.drive("value", value & 0xFFFF_FFFF);
        module.settle();
        module.clock();
        module.drive("write", 0);
        module.settle();
    }

    fn set(&mut self, exits: &Exits) {
        let module = &mut self.0.module;
        module.drive("near_limit", exits.near);
        module.drive("far_limit", exits.far);
        let last = |eye: usize| exits.cones[eye].list().len().saturating_sub(1) as i64;
        module.drive_all("last_cone", [last(0), last(1)]);
        for (eye, cones) in exits.cones.iter().enumerate() {
            // The columns of a cone that no pixel sees.
            self.write(eye << 8, 1);
            for (number, cone) in cones.list().iter().enumerate() {
                for (constant, value) in constants(cone).into_iter().enumerate() {
                    self.write(eye << 8 | number << 4 | constant, value);
                }
            }
        }
    }

    /// Sends the rays of some pixels, and compares the spheres that they meet. Returns the number of clocks, of cones, and of hits, and of
    /// hits at the near plane.
    fn check(&mut self, exits: &Exits, pixels: &[Pixel]) -> [u64; 4] {
        self.set(exits);
        let rays = pixels.iter().map(|&(eye, x, y)| exits.ray(eye, x, y));
        let rays: Vec<Beam> = rays.collect();
        let Self(pipe) = self;
        for (i, ray) in rays.iter().enumerate() {
            let item = [
                ray.eye as u64,
                ray.column.into(),
                ray.row.into(),
                i as u64 & 0xFFFF,
            ];
            pipe.source.push(item.map(Bits::from).to_vec());
        }
        let count = rays.len();
        let clocks = pipe.run(1_000_000 + 400 * count as u64, |pipe| {
            pipe.sink.items().len() == count
        });
        pipe.module.clock();
        let (mut cones, mut hits, mut discs) = (0, 0, 0);
        for (i, (ray, item)) in rays.iter().zip(pipe.sink.take()).enumerate() {
            let (met, tests) = exits.meet(ray);
            let met = met.filter(|met| met.t <= exits.far);
            let [is_met, number, t, payload] = [0, 1, 2, 3].map(|part| item[part].number());
            let found = (is_met == 1).then_some(number);
            let expected = (
                met.map(|met| met.number.into()),
                met.map_or(exits.far, |met| met.t),
            );
            assert_eq!(
                (found, t as i64),
                expected,
                "{:?}, {ray:?} in {exits:?}",
                pixels[i]
            );
            assert_eq!(payload, i as u64 & 0xFFFF);
            cones += u64::from(tests.max(1));
            hits += is_met;
            discs += u64::from(t as i64 <= exits.near + (exits.near >> 15));
        }
        [clocks, cones, hits, discs]
    }
}

/// Pixels at random, of which most are close to the rectangle of some cone.
fn some_pixels(random: &mut Random, exits: &Exits, eyes: usize) -> Vec<Pixel> {
    let (width, height) = (i64::from(exits.width), i64::from(exits.height));
    let mut pixels = Vec::new();
    for _ in 0..600 {
        let eye = random.bits() as usize % eyes;
        let list = exits.cones[eye].list();
        let [columns, rows] = match list.len() {
            count if count > 0 && random.bits() % 4 > 0 => {
                let rectangle = &list[random.bits() as usize % count].rectangle;
                [rectangle.columns, rectangle.rows].map(|range| range.map(i64::from))
            }
            _ => [[0, width - 1], [0, height - 1]],
        };
        let mut within = |[first, last]: [i64; 2], size: i64| {
            random.integer(first - 2, last + 2).clamp(0, size - 1) as u32
        };
        pixels.push((eye, within(columns, width), within(rows, height)));
    }
    pixels
}

/// Some lines of a picture, each of the left eye first.
fn lines(random: &mut Random, exits: &Exits, eyes: usize) -> Vec<Pixel> {
    let first = random.integer(0, i64::from(exits.height) - 2) as u32;
    let lines = (first..first + 2).flat_map(|y| (0..eyes).map(move |eye| (eye, y)));
    lines
        .flat_map(|(eye, y)| (0..exits.width).map(move |x| (eye, x, y)))
        .collect()
}

/// Number of frames: the environment variable `GLINT_RTL_RAYS` counts their rays, by default 150,000.
fn frames() -> usize {
    std::env::var("GLINT_RTL_RAYS").map_or(150_000, |text| text.parse().unwrap()) / 600
}

#[test]
fn random_rays() {
    let mut random = Random(11);
    let shares = [[0.0, 0.0], [0.5, 0.5], [0.0, 0.95], [0.9, 0.0]];
    let mut benches: Vec<Bench> = (1..)
        .zip(shares)
        .map(|(seed, stalls)| Bench::new("sphere_unit", seed, stalls))
        .collect();
    let mut one_eye = Bench::new("sphere_unit_one_eye", 9, [0.2, 0.2]);
    let fields = fields();
    let (mut all_hits, mut all_discs) = (0, 0);
    for frame in 0..frames() {
        let field = Field::parse(fields[frame % fields.len()]).expect("a field");
        let stereo = random.coin().then(|| stereo(&mut random));
        let (view, size) = (camera(&mut random), size(&mut random));
        let exits = Exits::new(&field, &view, size, stereo, Words::CHOSEN).expect("a frame");
        let eyes = if stereo.is_some() { 2 } else { 1 };
        let pixels = some_pixels(&mut random, &exits, eyes);
        let bench = match eyes {
            1 if random.coin() => &mut one_eye,
            _ => &mut benches[frame / fields.len() % 4],
        };
        let [_, _, hits, discs] = bench.check(&exits, &pixels);
        all_hits += hits;
        all_discs += discs;
    }
    let frames = frames() as u64;
    assert!(
        all_hits > 100 * frames && all_discs > 10 * frames,
        "{all_hits}, {all_discs}"
    );
}

#[test]
fn lines_take_a_clock_for_each_cone() {
    let mut random = Random(12);
    let mut bench = Bench::new("sphere_unit", 1, [0.0, 0.0]);
    for frame in 0..40 {
        let field = Field::parse(fields()[frame % fields().len()]).expect("a field");
        let stereo = random.coin().then(|| stereo(&mut random));
        let (view, size) = (camera(&mut random), size(&mut random));
        let exits = Exits::new(&field, &view, size, stereo, Words::CHOSEN).expect("a frame");
        let eyes = if stereo.is_some() { 2 } else { 1 };
        let [clocks, cones, ..] = bench.check(&exits, &lines(&mut random, &exits, eyes));
        let most = (0..eyes).map(|eye| exits.cones[eye].list().len()).max();
        // Latency, and rays that wait for the longer walks of more than 8 cones.
        if most.is_some_and(|most| most <= 8) {
            assert!(clocks < cones + 80, "{clocks} clocks, {cones} cones");
        }
    }
}

/// A frame in which all rays start at `eye` and have one direction. The near plane is at the parameter `near`, with 14 fraction bits.
fn frame(field: &str, eye: [i32; 3], direction: [i32; 3], near: i64) -> Exits {
    let field = Field::parse(field).expect("a field");
    let old = View::spherical(Q32_32::from_num(4), Default::default(), Default::default())
        .expect("a camera");
    let exits =
        |view: &View| Exits::new(&field, view, (320, 180), None, Words::CHOSEN).expect("a frame");
    let scale = exits(&old).scale.to_num::<f64>();
    let place = eye.map(|x| Q32_32::from_num(f64::from(x) / 4096.0 / scale));
    let lens = (old.half_width(), U4_28::from_num(0.01));
    let view = View::new_checked(place, old.u(), old.v(), old.n(), lens.0, lens.1);
    let mut exits = exits(&view.expect("an eye within its range"));
    exits.near = near;
    exits.aim(direction.map(|part| part << 6));
    exits
}

#[test]
fn directed_rays() {
    let along = [ONE, 0, 0];
    let same =
        "spheres:0,0,0,0.5;0,0,0,0.25;0,0,0,1;0,0,0,0.75;0,0,0,0.125;0,0,0,0.3;0,0,0,0.4;0,0,0,0.6";
    let equal = "spheres:0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1";
    let unit = 1 << 14;
    // A field, the eye, the direction, the near plane, and whether a sphere is met.
    let cases: [(&str, [i32; 3], [i32; 3], i64, bool); 16] = [
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
        // Between the eye and the near plane, and cut by it on the front and on the back.
        ("sphere:1", [-2 * RADIUS, 0, 0], along, 125 * unit, false),
        ("sphere:1", [-2 * RADIUS, 0, 0], along, 50 * unit, true),
        ("sphere:1", [-2 * RADIUS, 0, 0], along, 120 * unit, true),
        // The direction is short, so that T is beyond the far limit.
        ("sphere:1", [-4 * RADIUS, 0, 0], [ONE >> 8, 0, 0], 0, false),
    ];
    let mut bench = Bench::new("sphere_unit", 3, [0.3, 0.3]);
    for (field, eye, direction, near, is_met) in cases {
        let exits = frame(field, eye, direction, near);
        let [_, _, hits, _] = bench.check(&exits, &[(0, 0, 0), (0, 319, 179)]);
        assert_eq!(
            hits,
            2 * u64::from(is_met),
            "{field} {eye:?} {direction:?} {near}"
        );
    }
    // A list without a radius.
    let mut exits = frame("sphere:1", [-4 * RADIUS, 0, 0], along, 0);
    exits.balls[0].radius = 0;
    exits.aim(along.map(|part| part << 6));
    bench.check(&exits, &[(0, 0, 0)]);
}
