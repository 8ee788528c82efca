//! Compares the two reference methods for hits of rays on distance fields: hits computed from the geometry, and hits by sphere tracing.
//!
//! All rays are random with fixed seeds; a failure prints the ray. `--nocapture` shows the measured figures.

use glint_reference::camera::{Ray, Vector};
use glint_reference::raymarch::{Face, Field, Hit, Plane, Sphere};
use glint_vectors::math::dot;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Number of compared rays of each `Kind` in each field.
const RAYS: usize = 10_000;

/// Largest allowed distance between the two hits of a ray, in world units. Rays at a small angle to the surface have a larger
/// tolerance: see `apart`.
const TOLERANCE: f64 = 1e-6;

/// Distance from the surface at which a trace ends, in world units.
const TRACE: f64 = 1e-9;

/// Tolerance at edges, in world units. The two methods may disagree on a ray if the trace of the ray agrees with the geometry of the ray
/// moved by this distance.
const BESIDE: f64 = 1e-6;

fn ball(centre: Vector, radius: f64) -> Field {
    Field::Spheres(vec![Sphere { centre, radius }])
}

fn boxed(field: Field) -> Box<Field> {
    Box::new(field)
}

/// Returns a box with corners cut off by diagonal planes.
fn cut_box() -> Field {
    let planes = (0..6).map(|face| {
        let mut normal = [0.0; 3];
        normal[face / 2] = if face % 2 == 0 { -2.0 } else { 2.0 };
        Plane {
            normal,
            offset: 1.5,
        }
    });
    let diagonals = (0..8).map(|signs| Plane {
        normal: [0, 1, 2].map(|i| if signs >> i & 1 == 1 { 1.0 } else { -1.0 }),
        offset: 1.25,
    });
    Field::Convex(planes.chain(diagonals).collect())
}

/// Returns fields of all kinds with hits computed from geometry. Each has a name and the spacing of its faces or centres.
fn fields() -> Vec<(String, Field, f64)> {
    let mut random = Pcg64Mcg::new(2);
    let mut fields: Vec<_> = (1..=6)
        .map(|depth| {
            let spacing = 2.0 / 3f64.powi(depth as i32);
            (format!("Menger {depth}"), Field::Menger { depth }, spacing)
        })
        .collect();
    let spheres = (0..12).map(|_| Sphere {
        centre: [0; 3].map(|_| random.random_range(-2.0..2.0)),
        radius: random.random_range(0.1..0.8),
    });
    let spheres = Field::Spheres(spheres.collect());
    let lattice = |radius| Field::Lattice {
        period: 1.0,
        radius,
    };
    let boxes = |half| Field::Boxes { period: 0.75, half };
    let cubes = |half| boxes([half; 3]);
    let half = [0.5, 1.0, 1.5];
    let planes = Field::Planes { half: 1.25 };
    let menger = Field::Menger { depth: 3 };
    fields.extend([
        ("box".into(), Field::Box { half }, 0.5),
        ("spheres".into(), spheres.clone(), 0.5),
        ("lattice".into(), lattice(0.3), 0.5),
        ("lattice of balls that touch".into(), lattice(0.5), 0.5),
        ("lattice of balls that overlap".into(), lattice(0.6), 0.5),
        ("cubes".into(), cubes(0.1), 0.125),
        ("cubes close together".into(), cubes(0.35), 0.125),
        ("boxes".into(), boxes([0.1, 0.2, 0.3]), 0.1),
        ("pillars".into(), boxes([0.125, 0.25, f64::INFINITY]), 0.125),
        (
            "plates".into(),
            boxes([f64::INFINITY, 0.0625, f64::INFINITY]),
            0.125,
        ),
        ("planes".into(), planes.clone(), 0.25),
        ("a box with its corners cut".into(), cut_box(), 0.25),
        (
            "spheres between planes".into(),
            Field::Union(boxed(planes), boxed(spheres)),
            0.25,
        ),
        (
            "a ball in the sponge".into(),
            Field::Union(boxed(menger), boxed(ball([0.0; 3], 0.5))),
            2.0 / 27.0,
        ),
    ]);
    fields
}

/// Distribution of random rays.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// A random origin, and a direction towards a random point near the field's middle.
    Any,
    /// A random origin, and a direction along an axis.
    Parallel,
    /// A random origin, and a direction perpendicular to an axis.
    InPlane,
    /// An origin close to the planes of the field's faces (multiples of the field's spacing), and a direction along or nearly
    /// along an axis.
    Beside,
    /// An origin in the sponge's large tunnel along y.
    Tunnel,
}

const KINDS: [Kind; 5] = [
    Kind::Any,
    Kind::Parallel,
    Kind::InPlane,
    Kind::Beside,
    Kind::Tunnel,
];

fn draw(random: &mut Pcg64Mcg, kind: Kind, spacing: f64) -> Ray {
    let mut numbers = |reach: f64| [0; 3].map(|_| random.random_range(-reach..reach));
    let mut origin = numbers(3.0);
    let mut direction = numbers(2.0);
    // The offset from a face is at least 1e-4, because closer to a face a trace would need too many steps.
    let offset = numbers(1e-3).map(|c| c + 1e-4f64.copysign(c));
    let axis = random.random_range(0..3);
    match kind {
        Kind::Any => direction = [0, 1, 2].map(|i| direction[i] / 2.0 - origin[i]),
        Kind::Parallel => {
            let along = direction[axis];
            direction = [0.0; 3];
            direction[axis] = along;
        }
        Kind::InPlane => direction[axis] = 0.0,
        Kind::Beside => {
            let tilt = [0.0, 1e-3, 0.1][random.random_range(0..3)];
            for i in 0..3 {
                // Multiples of the spacing are counted from the sponge's corner at −1, because the sponge's origin is the middle
                // of a cell.
                origin[i] = ((origin[i] + 1.0) / spacing).round() * spacing - 1.0 + offset[i];
                if i != axis {
                    direction[i] *= tilt;
                }
            }
        }
        Kind::Tunnel => origin = [origin[0] / 9.1, origin[1] / 3.1, origin[2] / 9.1],
    }
    Ray { origin, direction }
}

fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// Smallest parameter of a counted hit.
const NEAR: f64 = 0.01;

/// Largest parameter of a counted hit.
const FAR: f64 = 20.0;

fn hit(field: &Field, ray: &Ray) -> Option<Hit> {
    field.hit(ray.origin, ray.direction, NEAR, FAR)
}

/// Returns the distance between two hits of a ray, and the largest allowed distance, in world units. A trace ends at a distance
/// from the surface, so a ray at a small angle to the surface has a larger tolerance.
fn apart(ray: &Ray, a: &Hit, b: &Hit) -> (f64, f64) {
    let speed = length(ray.direction);
    let cosine = dot(ray.direction, a.normal).abs() / speed;
    let allowed = if a.face == Face::Inside {
        0.0
    } else {
        TOLERANCE.max(2.0 * TRACE / cosine)
    };
    ((a.t - b.t).abs() * speed, allowed)
}

fn agree(ray: &Ray, a: Option<Hit>, b: Option<Hit>) -> bool {
    match (a, b) {
        (None, None) => true,
        (Some(a), Some(b)) => {
            let (apart, allowed) = apart(ray, &a, &b);
            let normals = length([0, 1, 2].map(|i| a.normal[i] - b.normal[i]));
            (a.face, a.member) == (b.face, b.member) && apart <= allowed && normals < 1e-5
        }
        _ => false,
    }
}

#[test]
fn hits_are_where_traces_end() {
    let mut random = Pcg64Mcg::new(1);
    for (name, field, spacing) in fields() {
        let (mut masks, mut others, mut endless) = (0, 0, 0);
        let (mut hits, mut inside) = (0, 0);
        let mut farthest: f64 = 0.0;
        for kind in KINDS {
            for i in 0..RAYS {
                let ray = draw(&mut random, kind, spacing);
                let exact = hit(&field, &ray);
                let Ok(traced) = field.traced(ray.origin, ray.direction, NEAR, FAR) else {
                    endless += 1;
                    continue;
                };
                hits += usize::from(exact.is_some());
                inside += usize::from(exact.is_some_and(|hit| hit.face == Face::Inside));
                if agree(&ray, exact, traced) {
                    if let (Some(a), Some(b)) = (exact, traced) {
                        farthest = farthest.max(apart(&ray, &a, &b).0);
                    }
                    continue;
                }
                if exact.is_some() == traced.is_some() {
                    others += 1;
                } else {
                    masks += 1;
                }
                let moved = (0..6).any(|side| {
                    let mut moved = ray;
                    moved.origin[side / 2] += if side % 2 == 0 { BESIDE } else { -BESIDE };
                    let seen = hit(&field, &moved);
                    match (seen, traced) {
                        (Some(a), Some(b)) => {
                            let (apart, allowed) = apart(&ray, &a, &b);
                            a.face == b.face && a.member == b.member && apart <= allowed.max(1e-2)
                        }
                        (a, b) => a.is_none() && b.is_none(),
                    }
                });
                assert!(
                    moved,
                    "{name}, {kind:?} {i}: {ray:?}\nexact {exact:?}\ntraced {traced:?}"
                );
            }
        }
        println!(
            "{name}: {hits} of {} rays hit, {inside} of them from inside; apart by at most {farthest:.1e}; \
             at edges {masks} masks and {others} hits differ; {endless} traces do not end",
            RAYS * KINDS.len()
        );
        assert!(hits > RAYS / 2, "{name}");
        assert!(masks + others <= 10 && endless <= 10, "{name}");
    }
}

/// Returns unions with a fillet, each with a name.
fn smooth_unions() -> Vec<(&'static str, Field)> {
    let smooth = |k, a, b| Field::SmoothUnion {
        k,
        a: boxed(a),
        b: boxed(b),
    };
    let half = [0.5, 0.75, 0.25];
    let floor = Field::Planes { half: 0.875 };
    vec![
        (
            "two balls",
            smooth(
                0.5,
                ball([-0.75, 0.0, 0.0], 0.75),
                ball([0.75, 0.25, 0.0], 0.5),
            ),
        ),
        (
            "a ball on a box",
            smooth(0.25, Field::Box { half }, ball([0.25, 0.0, 0.5], 0.5)),
        ),
        (
            "balls on the floor",
            smooth(
                0.5,
                floor,
                Field::Lattice {
                    period: 2.0,
                    radius: 0.75,
                },
            ),
        ),
    ]
}

/// Finds the first parameter between `from` and `to` with a distance of zero, by small steps and then by bisection.
fn bisected(field: &Field, ray: &Ray, from: f64, to: f64) -> Option<f64> {
    let step = 1e-3 / length(ray.direction);
    let solid = |t| field.distance(ray.at(t)) <= 0.0;
    let count = ((to - from) / step) as u32;
    let mut end = (1..count)
        .map(|i| from + f64::from(i) * step)
        .find(|&t| solid(t))?;
    let mut start = end - step;
    for _ in 0..50 {
        let middle = (start + end) / 2.0;
        if solid(middle) {
            end = middle;
        } else {
            start = middle;
        }
    }
    Some(end)
}

#[test]
fn smooth_unions_are_hit_where_their_distance_changes_its_sign() {
    let mut random = Pcg64Mcg::new(3);
    for (name, field) in smooth_unions() {
        let (mut hits, mut grazed) = (0, 0);
        let mut farthest: f64 = 0.0;
        for i in 0..1000 {
            let ray = draw(&mut random, Kind::Any, 1.0);
            let found = field.hit(ray.origin, ray.direction, NEAR, 5.0);
            if field.distance(ray.at(NEAR)) < 0.0 {
                assert_eq!(found.map(|hit| hit.face), Some(Face::Inside));
                continue;
            }
            let context = || format!("{name} {i}: {ray:?}: {found:?}");
            match (bisected(&field, &ray, NEAR, 5.0), found) {
                (Some(t), Some(hit)) => {
                    let a = Hit { t, ..hit };
                    let (apart, allowed) = apart(&ray, &a, &hit);
                    assert!(apart <= allowed, "{}", context());
                    assert!(dot(ray.direction, hit.normal) < 0.0, "{}", context());
                    farthest = farthest.max(apart);
                    hits += 1;
                }
                (None, None) => {}
                // `bisected` may miss a crossing that is shorter than a step.
                (None, Some(hit)) => {
                    let cosine = dot(ray.direction, hit.normal) / length(ray.direction);
                    assert!(cosine.abs() < 0.01, "{}", context());
                    grazed += 1;
                }
                (Some(_), None) => panic!("{}", context()),
            }
        }
        println!(
            "{name}: {hits} hits, apart by at most {farthest:.1e}; {grazed} only by the trace"
        );
        assert!(hits > 100 && grazed <= 2, "{name}");
    }
}

#[test]
fn a_smooth_union_of_no_reach_is_the_union() {
    let mut random = Pcg64Mcg::new(4);
    for (name, field) in smooth_unions() {
        let Field::SmoothUnion { a, b, .. } = field else {
            unreachable!("it is one");
        };
        let sharp = Field::Union(a.clone(), b.clone());
        let smooth = Field::SmoothUnion { k: 1e-9, a, b };
        for i in 0..2000 {
            let ray = draw(&mut random, Kind::Any, 1.0);
            let [exact, traced] = [&sharp, &smooth].map(|field| hit(field, &ray));
            let same = match (exact, traced) {
                (Some(a), Some(b)) => {
                    let (apart, allowed) = apart(&ray, &a, &b);
                    apart <= allowed && a.member == b.member
                }
                (a, b) => a.is_none() && b.is_none(),
            };
            assert!(same, "{name} {i}: {ray:?}\n{exact:?}\n{traced:?}");
        }
    }
}

#[test]
fn distances_change_by_no_more_than_the_step() {
    let mut random = Pcg64Mcg::new(5);
    let mut fields: Vec<_> = fields()
        .into_iter()
        .map(|(name, field, _)| (name, field))
        .collect();
    fields.extend(
        smooth_unions()
            .into_iter()
            .map(|(name, field)| (name.into(), field)),
    );
    for (name, field) in fields {
        for i in 0..10_000 {
            let p = [0; 3].map(|_| random.random_range(-2.0..2.0));
            let reach = [1e-3, 0.1, 1.0][i % 3];
            let step: Vector = [0; 3].map(|_| random.random_range(-reach..reach));
            let q = [0, 1, 2].map(|axis| p[axis] + step[axis]);
            let change = (field.distance(p) - field.distance(q)).abs();
            assert!(change <= length(step) + 1e-12, "{name}: {p:?} to {q:?}");
        }
    }
}
