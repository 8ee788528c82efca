//! Tests of rays by exits with difficult origins and directions.
//!
//! Origins are in units of 2^−12 field units, directions in units of 2^−27. Single rays with their expected results are in
//! tools/reference/stiff/rays.toml.

use glint_core::camera::View;
use glint_core::field::{Field, Surface};
use glint_core::fixed::Q32_32;
use glint_core::stereo::Stereo;
use glint_model::raymarch::State;
use glint_model::raymarch::exits::{CODE_BITS, Cones, End, Exits, Words};
use glint_vectors::rays::{ONE, frame};
use rand::RngExt as _;
use rand_pcg::Pcg64Mcg;

/// One field unit.
const UNIT: i32 = 1 << 12;
/// Half the side of a sponge of at most four levels, which is also the radius of `sphere:1`; and a sixth of the sponge's side, 13.5 field
/// units.
const HALF: i32 = 81 << 11;
const SIXTH: i32 = HALF / 3;

/// The end of the ray of a frame with a single ray.
fn end_of(exits: &Exits) -> End {
    exits.end(&exits.cones(), &exits.ray(0, 0, 0))
}

/// A random difficult origin and direction: coordinates on or next to borders, and components of 0 or 1 ulp.
fn stiff(random: &mut Pcg64Mcg) -> ([i32; 3], [i32; 3]) {
    let place = [0; 3].map(|_| {
        let border = random.random_range(-60..60)
            * [UNIT, UNIT / 2, 32 * UNIT, SIXTH, HALF][random.random_range(0..5)];
        (border + random.random_range(-1..=1)).clamp(-2_000_000, 2_000_000)
    });
    let direction = [0; 3].map(|_| match random.random_range(0..4) {
        0 => random.random_range(-2..=1),
        1 => [ONE, !ONE, ONE - 1, ONE / 3][random.random_range(0..4)],
        _ => random.random_range(!ONE..=ONE),
    });
    (place, direction)
}

/// All solids are symmetric, so mirroring a ray mirrors its end, bit for bit.
#[test]
fn mirrored_rays_have_mirrored_ends() {
    let mut random = Pcg64Mcg::new(1);
    let fields = "menger:1 menger:4 menger:6 box:1,0.5,0.25 cubes:2,0.25 cubes:2,0.5 boxes:2,0.25,1,0.5 boxes:2,1,1,0.25 \
                  lattice:1,0.25 planes:1";
    let mut steps = 0;
    for field in fields.split(' ') {
        for _ in 0..300 {
            let (eye, direction) = stiff(&mut random);
            let exits = frame(field, eye, direction);
            let end = end_of(&exits);
            steps = steps.max(end.steps);
            let axis = random.random_range(0..3);
            let (mut there, mut towards) = (eye, direction);
            (there[axis], towards[axis]) = (-eye[axis], !direction[axis]);
            // A position in the cell around the origin is in [−32, 32) field units, so −32 has no mirror image.
            if field.contains(',') && there.map(|x| x.abs() & 0x3FFFF).contains(&0x20000) {
                continue;
            }
            let exits = frame(field, there, towards);
            let mirrored = end_of(&exits);
            assert_eq!(
                (mirrored.t, mirrored.steps),
                (end.t, end.steps),
                "{field} {eye:?} {direction:?}"
            );
            let expected = match end.state {
                State::Hit(Surface::Face {
                    axis: hit,
                    positive,
                }) => State::Hit(Surface::Face {
                    axis: hit,
                    positive: positive != (usize::from(hit) == axis),
                }),
                other => other,
            };
            assert_eq!(mirrored.state, expected, "{field} {eye:?} {direction:?}");
        }
    }
    assert!(steps <= 200, "{steps}");
}

/// A ray that leaves the prism around the eye is in the octahedron, or does not meet the octahedron.
#[test]
fn an_octahedron_takes_one_evaluation() {
    let mut random = Pcg64Mcg::new(4);
    let mut hits = 0;
    for _ in 0..3000 {
        let (eye, direction) = stiff(&mut random);
        let exits = frame("octahedron:1", eye, direction);
        let end = end_of(&exits);
        assert!(end.steps <= 1, "{eye:?} {direction:?}: {end:?}");
        hits += u32::from(end.state != State::Miss);
    }
    assert!(hits > 200, "{hits}");
}

#[test]
fn rectangles_hold_all_pixels_that_see_a_sphere() {
    let mut random = Pcg64Mcg::new(2);
    let field = Field::parse(
        "spheres:0,0,0,0.75;1,0.25,0.5,0.5;-0.75,-0.5,0.75,0.25;2,-2,1,0.01;-3,0,0,2.5",
    )
    .expect("a field");
    let mut met = 0;
    for frame in 0..60 {
        let number = |low: f64, high: f64, random: &mut Pcg64Mcg| {
            Q32_32::from_num(random.random_range(low..high))
        };
        let eye = [0; 3].map(|_| number(-4.0, 4.0, &mut random));
        let target = [0; 3].map(|_| number(-1.0, 1.0, &mut random));
        let gaze = [0, 1, 2].map(|i: usize| target[i] - eye[i]);
        let view = View::towards(eye, gaze, glint_core::camera::UP).expect("a camera");
        let half_width = glint_core::fixed::U8_28::from_num(random.random_range(0.05..4.0));
        let view = view.with_half_width(half_width).expect("a half width");
        let stereo = (frame % 3 == 0).then(|| Stereo::parse("0.2,2").expect("two eyes"));
        let exits = Exits::new(&field, &view, (320, 180), stereo, Words::CHOSEN).expect("a frame");
        let cones = exits.cones();
        let wide = cones.each_ref().map(|cones| {
            Cones::of(cones.list().iter().map(|cone| {
                let mut cone = *cone;
                cone.rectangle.columns = [0, 319];
                cone.rectangle.rows = [0, 179];
                cone
            }))
        });
        for _ in 0..4000 {
            let eye = usize::from(stereo.is_some() && random.random());
            let ray = exits.ray(
                eye,
                random.random_range(0..320),
                random.random_range(0..180),
            );
            let [end, all] = [&cones, &wide].map(|cones| exits.end(cones, &ray));
            assert_eq!(
                (end.state, end.t),
                (all.state, all.t),
                "{view:?} {} {}",
                ray.column,
                ray.row
            );
            met += u32::from(end.state != State::Miss);
        }
    }
    assert!(met > 10_000, "{met}");
}

/// Codes of intervals, and the coordinates that these codes represent, both in ascending order.
#[test]
fn codes_of_intervals_increase_and_return() {
    let eye = [1 << 20; 3];
    for (field, intervals) in [
        ("menger:4", 0..=81),
        ("menger:1", 0..=81),
        ("menger:6", 0..=729),
        ("box:1,0.5,0.25", 0..=1),
        ("planes:1", 0..=1),
        ("cubes:2,0.4", -2..=64),
        ("boxes:2,0.4,1,0.5", -2..=64),
        ("lattice:1,0.3", -2..=64),
        ("octahedron:1", 0..=1),
    ] {
        let solid = frame(field, eye, [ONE, 0, 0]).solid.expect("a solid");
        assert_eq!((solid.code(i32::MIN), solid.interval(0)), (0, i32::MIN));
        let mut before = 0;
        for interval in intervals {
            let code = solid.code(interval);
            assert!(before < code && code >> CODE_BITS == 0, "{field}: {code:b}");
            assert_eq!(solid.interval(code), interval, "{field}: {code:b}");
            before = code;
        }
    }
    // The digits of a sponge's cell, the most significant digit first, and the first digit above the sponge.
    let sponge = frame("menger:4", eye, [ONE, 0, 0]).solid.expect("a solid");
    assert_eq!(sponge.code(27 + 2 * 9 + 1), 0b1_01_10_00_01_00_00);
    assert_eq!(sponge.code(81), 0b1_11_00_00_00_00_00);
}

/// The constants of an eye give the same rays after conversion to the register format and back.
#[test]
fn a_start_in_codes_makes_the_same_rays() {
    let mut random = Pcg64Mcg::new(3);
    let fields = "menger:4 menger:6 box:1,0.5,0.25 cubes:2,0.4 boxes:2,0.4,1,0.25 planes:1 lattice:1,0.3 octahedron:1";
    let fields: Vec<&str> = fields.split(' ').collect();
    for round in 0..300 {
        let field = fields[round % fields.len()];
        let eye = [0; 3].map(|_| random.random_range(-4 * HALF..4 * HALF));
        let exits = frame(field, eye, [0; 3]);
        let solid = exits.solid.expect("a solid");
        let mut coded = exits;
        for eye in &mut coded.eyes {
            for side in eye.start.sides.as_flattened_mut() {
                assert!((0..1 << 25).contains(&side.distance), "{side:?}");
                if side.is_bounded {
                    side.next = solid.interval(solid.code(side.next));
                }
            }
        }
        for _ in 0..20 {
            let direction = [0; 3].map(|_| random.random_range(-ONE..ONE) << 3);
            let [before, after] = [exits, coded].map(|mut exits| {
                exits.aim(direction);
                let beam = exits.ray(0, 0, 0);
                (beam, end_of(&exits))
            });
            assert_eq!(before, after, "{field} {eye:?}");
        }
    }
}
