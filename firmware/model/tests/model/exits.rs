//! Stiff cases of rays by exits, each with its stated outcome.
//!
//! Places are in units of 2^−12 field units, directions in units of 2^−24. A ray of the direction 0 along an axis leads up, one of −1 leads
//! down; a point on a border belongs to the interval that its ray leads to.

use glint_core::camera::View;
use glint_core::field::{Field, Surface};
use glint_core::fixed::{Q32_32, U4_28};
use glint_core::stereo::Stereo;
use glint_model::raymarch::State;
use glint_model::raymarch::exits::{CODE_BITS, Cones, End, Exits, Words};
use rand::RngExt as _;
use rand_pcg::Pcg64Mcg;

/// The largest component of a direction.
const ONE: i32 = (1 << 24) - 1;
/// A field unit.
const UNIT: i32 = 1 << 12;
/// Half the side of a sponge of at most four levels, the radius of `sphere:1`, and 13.5 field units, a sixth of the sponge's side.
const HALF: i32 = 81 << 11;
const SIXTH: i32 = HALF / 3;

/// A frame in which all rays start at `eye` and have one direction. The near plane is at the eye.
fn frame(field: &str, eye: [i32; 3], direction: [i32; 3]) -> Exits {
    let field = Field::parse(field).expect("a field");
    let old = View::spherical(Q32_32::from_num(4), Default::default(), Default::default())
        .expect("a camera");
    let exits =
        |view: &View| Exits::new(&field, view, (320, 180), None, Words::CHOSEN).expect("a frame");
    let scale = exits(&old).scale.to_num::<f64>();
    let place = eye.map(|x| Q32_32::from_num(f64::from(x) / 4096.0 / scale));
    let near = U4_28::from_num(0.01);
    let view = View::new_checked(place, old.u(), old.v(), old.n(), old.half_width(), near);
    let mut exits = exits(&view.expect("an eye within its range"));
    exits.near = 0;
    exits.aim(direction.map(|part| part << 6));
    exits
}

/// The end of the ray of a frame with a single ray.
fn end_of(exits: &Exits) -> End {
    exits.end(&exits.cones(), &exits.ray(0, 0, 0))
}

/// The surface that a ray meets and its parameter in units of 2^−12, or `miss`.
fn seen(exits: &Exits) -> String {
    let end = end_of(exits);
    let t = end.t >> (exits.words.parameter - 12);
    match end.state {
        State::Hit(Surface::Face { axis, positive }) => {
            let sign = if positive { '+' } else { '-' };
            format!("{sign}{} at {t}", ['x', 'y', 'z'][usize::from(axis)])
        }
        State::Hit(Surface::Octant { signs }) => format!("octant {signs:03b} at {t}"),
        State::Hit(Surface::Round { number }) => format!("sphere {number} at {t}"),
        State::Miss => "miss".into(),
        other => format!("{other:?}"),
    }
}

/// A field, the eye, the direction, what the ray sees, and why the case is stiff.
type Case = (&'static str, [i32; 3], [i32; 3], &'static str, &'static str);

#[test]
fn each_stiff_ray_has_its_outcome() {
    let cases: &[Case] = &[
        (
            "menger:1",
            [-2 * HALF, -HALF, 0],
            [ONE, 0, 0],
            "-x at 165888",
            "in the plane of the lower face, leading up into the solid",
        ),
        (
            "menger:1",
            [-2 * HALF, -HALF, 0],
            [ONE, -1, 0],
            "miss",
            "in the plane of the lower face, leading down by 1 ulp",
        ),
        (
            "menger:1",
            [-2 * HALF, HALF, 0],
            [ONE, 0, 0],
            "miss",
            "in the plane of the upper face, leading up",
        ),
        (
            "menger:1",
            [-2 * HALF, HALF, 0],
            [ONE, -1, 0],
            "-x at 165888",
            "in the plane of the upper face, leading down by 1 ulp",
        ),
        (
            "menger:1",
            [-2 * HALF, -2 * HALF, HALF - 1],
            [ONE, ONE, 0],
            "-y at 165888",
            "to an edge of the sponge: the last axis",
        ),
        (
            "menger:1",
            [-2 * HALF, -2 * HALF, -2 * HALF],
            [ONE, ONE, ONE],
            "-z at 165888",
            "to a corner of the sponge",
        ),
        (
            "menger:1",
            [2 * HALF, 2 * HALF, 2 * HALF],
            [!ONE, !ONE, !ONE],
            "+z at 165888",
            "to the opposite corner",
        ),
        (
            "menger:1",
            [0; 3],
            [ONE, ONE, 0],
            "-y at 55296",
            "from the middle to an edge of the grid: the second of equal exits",
        ),
        (
            "menger:1",
            [0; 3],
            [ONE, ONE, ONE],
            "-y at 55296",
            "from the middle to a corner of the grid: the second of three equal exits",
        ),
        (
            "menger:1",
            [0; 3],
            [ONE, ONE - 1, 0],
            "-y at 55296",
            "beside an edge of the grid by 1 ulp",
        ),
        (
            "menger:1",
            [0; 3],
            [ONE - 1, ONE, 0],
            "-y at 55296",
            "beside it on the other side: equal exits, as 1 ulp is below a reciprocal's",
        ),
        ("menger:1", [0; 3], [ONE, 0, 0], "miss", "along the tunnel"),
        (
            "menger:1",
            [0; 3],
            [ONE, -1, 0],
            "miss",
            "along the tunnel, leading down by 1 ulp",
        ),
        (
            "menger:1",
            [0, SIXTH, 0],
            [ONE, 0, 0],
            "-x at 55296",
            "on the tunnel's ceiling, leading up into the next cell",
        ),
        (
            "menger:1",
            [0, SIXTH, 0],
            [ONE, -1, 0],
            "miss",
            "on the tunnel's ceiling, leading down into the tunnel",
        ),
        (
            "menger:1",
            [0, SIXTH - 1, 0],
            [ONE, 0, 0],
            "miss",
            "below the ceiling by a unit",
        ),
        (
            "menger:1",
            [-HALF, 0, 0],
            [ONE, 0, 0],
            "miss",
            "on the opening of a tunnel, looking in",
        ),
        (
            "menger:1",
            [-HALF, -HALF, -HALF],
            [ONE, ONE, ONE],
            "-z at 0",
            "in a corner of the sponge, looking in",
        ),
        (
            "menger:1",
            [-HALF, -HALF, -HALF],
            [-1, -1, -1],
            "miss",
            "in a corner, looking out",
        ),
        (
            "menger:1",
            [-HALF, -HALF + 1, 0],
            [ONE, 0, 0],
            "-z at 0",
            "on a face, looking in",
        ),
        (
            "menger:1",
            [-HALF, -HALF + 1, 0],
            [-1, ONE, 0],
            "miss",
            "on a face, leading away by 1 ulp",
        ),
        (
            "menger:4",
            [UNIT / 2 - HALF, UNIT / 2 - HALF, UNIT / 2 - HALF],
            [ONE, 5, -7],
            "+z at 0",
            "in the solid",
        ),
        (
            "menger:4",
            [-2 * HALF, HALF - UNIT, HALF - UNIT],
            [ONE, 0, 0],
            "-x at 165888",
            "in a border of two smallest cells, leading into the solid one",
        ),
        (
            "menger:4",
            [-2 * HALF, HALF - UNIT, HALF - UNIT],
            [ONE, -1, -1],
            "miss",
            "in the same border, leading into the smallest tunnel",
        ),
        (
            "menger:6",
            [-2 * 186_624, 186_623, 186_623],
            [ONE, 0, 0],
            "-x at 186624",
            "depth 6: the outermost smallest cells",
        ),
        (
            "menger:6",
            [-2 * 186_624, 186_111, 186_111],
            [ONE, 0, 0],
            "miss",
            "depth 6: the smallest tunnel, of 512 units",
        ),
        (
            "menger:6",
            [-2 * 186_624, 186_112, 186_112],
            [ONE, 0, 0],
            "-x at 186624",
            "depth 6: the border of the smallest tunnel",
        ),
        (
            "box:1,1,1",
            [-2 * HALF, HALF - 1, HALF - 1],
            [ONE, 0, 0],
            "-x at 165888",
            "inside of an edge by a unit",
        ),
        (
            "box:1,1,1",
            [-2 * HALF, HALF, HALF - 1],
            [ONE, 0, 0],
            "miss",
            "on the edge",
        ),
        ("box:1,1,1", [0; 3], [ONE, 1, 1], "-z at 0", "in the box"),
        (
            "box:1,1,1",
            [2 * HALF, 0, 0],
            [ONE, 0, 0],
            "miss",
            "behind the box",
        ),
        (
            "planes:1",
            [0; 3],
            [ONE, 0, 0],
            "miss",
            "parallel to both planes",
        ),
        (
            "planes:1",
            [0, 0, -HALF],
            [ONE, 0, 0],
            "miss",
            "on the floor, parallel to it",
        ),
        (
            "planes:1",
            [0, 0, HALF],
            [ONE, 0, 0],
            "-z at 0",
            "on the ceiling, leading up",
        ),
        (
            "planes:1",
            [0, 0, HALF],
            [ONE, 0, -1],
            "miss",
            "on the ceiling, leading down by 1 ulp",
        ),
        (
            "planes:1",
            [0, 0, HALF - 1],
            [0, 0, ONE],
            "-z at 1",
            "a unit below the ceiling",
        ),
        (
            "planes:1",
            [0, 0, 2 * HALF],
            [0, 0, !ONE],
            "+z at 0",
            "in the solid above",
        ),
        (
            "cubes:2,0.25",
            [32 * UNIT, 32 * UNIT, 32 * UNIT],
            [ONE, 0, 0],
            "miss",
            "in a gap up to the far limit",
        ),
        (
            "cubes:2,0.25",
            [32 * UNIT, 8 * UNIT, 8 * UNIT],
            [ONE, 0, 0],
            "miss",
            "on the edges of a row of cubes, leading up",
        ),
        (
            "cubes:2,0.25",
            [32 * UNIT - 1, 8 * UNIT, 8 * UNIT],
            [ONE, -1, -1],
            "-x at 98305",
            "on the same edges, leading down by 1 ulp",
        ),
        (
            "cubes:2,0.25",
            [32 * UNIT - 1, 0, 0],
            [ONE, 0, 0],
            "-x at 98305",
            "along the axis of a row of cubes",
        ),
        (
            "cubes:2,0.25",
            [0, 32 * UNIT - 1, 32 * UNIT - 1],
            [ONE, ONE, ONE],
            "miss",
            "along a diagonal of gaps, up to the far limit",
        ),
        (
            "boxes:2,1,1,0.25",
            [0, 0, 32 * UNIT],
            [ONE, ONE, 0],
            "miss",
            "between two plates, along both",
        ),
        (
            "boxes:2,1,1,0.25",
            [0, 0, 8 * UNIT],
            [ONE, 0, 0],
            "miss",
            "on a plate, leading up",
        ),
        (
            "boxes:2,1,1,0.25",
            [0, 0, 8 * UNIT],
            [ONE, 0, -1],
            "+z at 0",
            "on a plate, leading down by 1 ulp",
        ),
        (
            "boxes:2,1,1,0.25",
            [0, 0, 32 * UNIT - 1],
            [ONE, ONE, ONE],
            "-z at 98305",
            "to a plate, through borders of cells without a gap",
        ),
        (
            "boxes:2,1,1,0.25",
            [32 * UNIT, 32 * UNIT, 32 * UNIT],
            [0, 0, !ONE],
            "+z at 98304",
            "to a plate, along the edge of cells",
        ),
        (
            "boxes:2,1,1,0.25",
            [0, 0, 32 * UNIT],
            [ONE, ONE, 1 << 18],
            "-z at 6291444",
            "to a plate at a distance of 24 cells",
        ),
        (
            "boxes:2,1,1,0.25",
            [0, 0, 32 * UNIT],
            [ONE, ONE, 1 << 17],
            "miss",
            "to a plate beyond the far limit",
        ),
        (
            "boxes:2,1,1,0.25",
            [3, 4, 5],
            [ONE, 0, 0],
            "-z at 0",
            "in a plate",
        ),
        (
            "boxes:2,0.25,0.25,1",
            [32 * UNIT, 32 * UNIT, 0],
            [0, 0, ONE],
            "miss",
            "along a shaft between pillars",
        ),
        (
            "boxes:2,0.25,0.25,1",
            [8 * UNIT, 32 * UNIT, 0],
            [-1, !ONE, ONE],
            "+y at 98304",
            "to the edge of a pillar",
        ),
        (
            "boxes:2,1,1,1",
            [7, 32 * UNIT, 0],
            [ONE, ONE, ONE],
            "-z at 0",
            "in a solid without gaps",
        ),
        (
            "boxes:2,0.25,0.25,0.25",
            [32 * UNIT - 1, 8 * UNIT, 8 * UNIT],
            [ONE, -1, -1],
            "-x at 98305",
            "a box with equal sides is a cube",
        ),
        (
            "octahedron:1",
            [4 * HALF, 0, 0],
            [!ONE, 0, 0],
            "octant 111 at 331776",
            "to a corner of the octahedron: the last of four slabs",
        ),
        (
            "octahedron:1",
            [0, 0, 0],
            [ONE, 0, 0],
            "octant 100 at 0",
            "in the octahedron",
        ),
        (
            "octahedron:1",
            [0, 4 * HALF, 1],
            [0, !ONE, 0],
            "octant 111 at 331776",
            "beside a corner by a unit",
        ),
        (
            "sphere:1",
            [-4 * HALF, HALF, 0],
            [ONE, 0, 0],
            "miss",
            "tangent",
        ),
        (
            "sphere:1",
            [-4 * HALF, HALF + 1, 0],
            [ONE, 0, 0],
            "miss",
            "outside of the tangent by a unit",
        ),
        (
            "sphere:1",
            [-4 * HALF, HALF - 1, 0],
            [ONE, 0, 0],
            "sphere 0 at 662988",
            "inside of the tangent by a unit; exactly 662976",
        ),
        (
            "sphere:1",
            [-4 * HALF, 0, 0],
            [ONE, 0, 0],
            "sphere 0 at 497664",
            "through the centre",
        ),
        (
            "sphere:1",
            [4 * HALF, 0, 0],
            [ONE, 0, 0],
            "miss",
            "behind the sphere",
        ),
        (
            "sphere:1",
            [0; 3],
            [ONE, 0, 0],
            "sphere 0 at 0",
            "in the centre",
        ),
        (
            "sphere:1",
            [HALF - 1, 0, 0],
            [ONE, 0, 0],
            "sphere 0 at 0",
            "in the sphere by a unit, looking out",
        ),
        (
            "sphere:1",
            [HALF, 0, 0],
            [ONE, 0, 0],
            "miss",
            "on the sphere, looking out",
        ),
        (
            "sphere:1",
            [HALF, 0, 0],
            [!ONE, 0, 0],
            "sphere 0 at 0",
            "on the sphere, looking in",
        ),
        (
            "sphere:1",
            [HALF, 0, 0],
            [0, ONE, 0],
            "miss",
            "on the sphere, tangent",
        ),
        (
            "sphere:0.01",
            [-4 * HALF, 0, 0],
            [ONE, 0, 0],
            "sphere 0 at 661891",
            "the smallest radius; exactly 661893.1",
        ),
        (
            "sphere:12",
            [-13 * HALF, 0, 0],
            [ONE, 0, 0],
            "sphere 0 at 165887",
            "the largest radius; exactly 165888",
        ),
        (
            "spheres:0,0,0,0.5;0,0,0,0.25;0,0,0,1;0,0,0,0.75;0,0,0,0.125;0,0,0,0.3;0,0,0,0.4;0,0,0,0.6",
            [-2 * HALF, 0, 0],
            [ONE, 0, 0],
            "sphere 2 at 165888",
            "eight spheres of one centre",
        ),
        (
            "spheres:0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1;0,0,0,1",
            [-2 * HALF, 0, 0],
            [ONE, 0, 0],
            "sphere 0 at 165888",
            "eight equal spheres",
        ),
        (
            "lattice:1,0.25",
            [32 * UNIT - 1, 0, 0],
            [ONE, 0, 0],
            "sphere 0 at 65537",
            "along a row of spheres",
        ),
        (
            "lattice:1,0.25",
            [32 * UNIT - 1, 16 * UNIT, 0],
            [ONE, 0, 0],
            "miss",
            "tangent to a row of spheres, to the far limit",
        ),
        (
            "lattice:1,0.25",
            [32 * UNIT - 1, 16 * UNIT - 1, 0],
            [ONE, 0, 0],
            "sphere 0 at 130668",
            "inside of the tangent by a unit; exactly 130711",
        ),
        (
            "lattice:1,0.25",
            [0; 3],
            [ONE, 0, 0],
            "sphere 0 at 0",
            "in a sphere",
        ),
        (
            "lattice:1,0.25",
            [16 * UNIT, 0, 0],
            [ONE, 0, 0],
            "sphere 0 at 131072",
            "on a sphere, looking out to the next one",
        ),
        (
            "union:box:1,1,1+sphere:1",
            [-2 * HALF, 0, 0],
            [ONE, 0, 0],
            "-x at 165888",
            "a sphere that touches a face: the face",
        ),
        (
            "union:menger:1+sphere:0.5",
            [0, HALF, 0],
            [0, !ONE, 0],
            "sphere 0 at 82944",
            "a sphere in the tunnel",
        ),
        (
            "union:cubes:2,0.25+sphere:1",
            [-200 * UNIT, 16 * UNIT, 16 * UNIT],
            [ONE, 0, 0],
            "sphere 0 at 726517",
            "a sphere three cells away, past cubes",
        ),
        (
            "union:cubes:2,0.25+sphere:1",
            [16 * UNIT; 3],
            [ONE, 0, 0],
            "sphere 0 at 0",
            "in the sphere, between cubes",
        ),
        (
            "union:cubes:2,0.25+sphere:0.3",
            [-32 * UNIT, 0, 0],
            [ONE, 0, 0],
            "sphere 0 at 91749",
            "a sphere that comes out of a face",
        ),
        (
            "union:cubes:2,0.25+sphere:0.3",
            [-32 * UNIT, 7 * UNIT, 7 * UNIT],
            [ONE, 0, 0],
            "-x at 98304",
            "a face beside the sphere",
        ),
        (
            "union:cubes:2,0.25+sphere:0.2",
            [-32 * UNIT, 0, 0],
            [ONE, 0, 0],
            "-x at 98304",
            "a sphere in a cube",
        ),
        (
            "union:cubes:2,0.25+sphere:0.25",
            [-32 * UNIT, 0, 0],
            [ONE, 0, 0],
            "-x at 98304",
            "a sphere that touches a face of its cube: the face",
        ),
        (
            "union:cubes:0.25,0.05+sphere:1",
            [-2100 * UNIT, 32 * UNIT, 32 * UNIT],
            [ONE, 0, 0],
            "sphere 0 at 7569531",
            "a sphere before the far limit, 29 cells away",
        ),
        (
            "union:cubes:0.25,0.05+sphere:1",
            [-5000 * UNIT, 32 * UNIT, 32 * UNIT],
            [ONE, 0, 0],
            "miss",
            "a sphere beyond the far limit",
        ),
        (
            "union:cubes:0.25,0.05+sphere:1",
            [-8191 * UNIT, 32 * UNIT, 32 * UNIT],
            [ONE, 0, 0],
            "miss",
            "from the farthest eye",
        ),
        (
            "union:boxes:2,1,1,0.25+sphere:0.5",
            [-200 * UNIT, 0, 12 * UNIT],
            [ONE, 0, 0],
            "sphere 0 at 775851",
            "a sphere that grows out of a plate",
        ),
        (
            "union:lattice:1,0.25+spheres:0.5,0.5,0.5,0.1",
            [-96 * UNIT, 32 * UNIT, 32 * UNIT],
            [ONE, 0, 0],
            "sphere 1 at 498076",
            "a sphere of the list between those of the lattice",
        ),
        (
            "union:lattice:1,0.25+sphere:0.27",
            [-32 * UNIT, 0, 0],
            [ONE, 0, 0],
            "sphere 1 at 60293",
            "a sphere of the list about one of the lattice",
        ),
        (
            "union:lattice:1,0.25+sphere:0.27",
            [-32 * UNIT, 10 * UNIT, 0],
            [ONE, 0, 0],
            "sphere 1 at 73349",
            "likewise, met within the box about the sphere of the lattice",
        ),
        (
            "union:lattice:1,0.25+sphere:0.27",
            [-32 * UNIT, 0, 64 * UNIT],
            [ONE, 0, 0],
            "sphere 0 at 65536",
            "the next sphere of the lattice",
        ),
        (
            "union:lattice:1,0.25+sphere:0.2",
            [-32 * UNIT, 0, 0],
            [ONE, 0, 0],
            "sphere 0 at 65536",
            "a sphere of the list in one of the lattice",
        ),
        (
            "union:planes:1+sphere:0.5",
            [-4 * HALF, 0, 0],
            [ONE, 0, 0],
            "sphere 0 at 580609",
            "a sphere between planes",
        ),
    ];
    let mut wrong = 0;
    for (field, eye, direction, expected, about) in cases {
        let found = seen(&frame(field, *eye, *direction));
        if found != *expected {
            wrong += 1;
            println!("{field} {eye:?} {direction:?}: {found}, expected {expected} ({about})");
        }
    }
    assert_eq!(wrong, 0);
}

/// A surface at the far limit is seen, and one beyond it is not.
#[test]
fn the_far_limit_is_the_last_parameter() {
    for (field, eye) in [
        ("menger:1", [-2 * HALF, -HALF, 0]),
        ("sphere:1", [-4 * HALF, 0, 0]),
        ("lattice:1,0.25", [32 * UNIT - 1, 0, 0]),
        ("cubes:2,0.25", [32 * UNIT - 1, 0, 0]),
    ] {
        let mut exits = frame(field, eye, [ONE, 0, 0]);
        let there = end_of(&exits);
        assert!(matches!(there.state, State::Hit(_)), "{field}");
        exits.far = there.t;
        assert_eq!(end_of(&exits).state, there.state, "{field}");
        exits.far -= 1;
        assert_eq!(end_of(&exits).state, State::Miss, "{field}");
    }
}

/// Random places and directions among the stiffest: on borders and beside them, with components of 0 and 1 ulp.
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

/// All solids are symmetric, so a mirrored ray has the mirrored end, bit for bit.
#[test]
fn mirrored_rays_have_mirrored_ends() {
    let mut random = Pcg64Mcg::new(1);
    let fields = [
        "menger:1",
        "menger:4",
        "menger:6",
        "box:1,0.5,0.25",
        "cubes:2,0.25",
        "cubes:2,0.5",
        "boxes:2,0.25,1,0.5",
        "boxes:2,1,1,0.25",
        "lattice:1,0.25",
        "planes:1",
    ];
    let mut steps = 0;
    for field in fields {
        for _ in 0..300 {
            let (eye, direction) = stiff(&mut random);
            let exits = frame(field, eye, direction);
            let end = end_of(&exits);
            steps = steps.max(end.steps);
            let axis = random.random_range(0..3);
            let (mut there, mut towards) = (eye, direction);
            (there[axis], towards[axis]) = (-eye[axis], !direction[axis]);
            // The place in the cell about the origin is from −32 to 32 units, without the upper end.
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
            let face = |state| match state {
                State::Hit(Surface::Face {
                    axis: hit,
                    positive,
                }) => Some((hit, positive)),
                _ => None,
            };
            let expected = face(end.state)
                .map(|(hit, positive)| (hit, positive != (usize::from(hit) == axis)));
            assert_eq!(
                face(mirrored.state),
                expected,
                "{field} {eye:?} {direction:?}"
            );
        }
    }
    assert!(steps <= 200, "{steps}");
}

/// After the prism around the eye, a ray is in an octahedron, or does not meet it.
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

/// A ray through a pixel outside of a sphere's rectangle does not meet the sphere.
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

/// Codes of intervals, and the coordinates that they stand for, in the order of both.
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
    // The digits of a cell of a sponge, from the first one, and the first digit above it.
    let sponge = frame("menger:4", eye, [ONE, 0, 0]).solid.expect("a solid");
    assert_eq!(sponge.code(27 + 2 * 9 + 1), 0b1_01_10_00_01_00_00);
    assert_eq!(sponge.code(81), 0b1_11_00_00_00_00_00);
}

/// A frame's constants for the rays of an eye, after a way through the words of a register block, make the same rays.
#[test]
fn a_start_in_codes_makes_the_same_rays() {
    let mut random = Pcg64Mcg::new(3);
    for round in 0..300 {
        let field = [
            "menger:4",
            "menger:6",
            "box:1,0.5,0.25",
            "cubes:2,0.4",
            "boxes:2,0.4,1,0.25",
            "planes:1",
            "lattice:1,0.3",
            "octahedron:1",
        ][round % 8];
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
            let direction = [0; 3].map(|_| random.random_range(-ONE..ONE) << 6);
            let [before, after] = [exits, coded].map(|mut exits| {
                exits.aim(direction);
                let beam = exits.ray(0, 0, 0);
                (beam, end_of(&exits))
            });
            assert_eq!(before, after, "{field} {eye:?}");
        }
    }
}
