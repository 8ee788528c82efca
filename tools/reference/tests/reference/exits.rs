//! Compares the model's rays by exits with exact hits.

use glint_core::field::{Field as Scene, Surface};
use glint_core::fixed::Q32_32;
use glint_core::light::Light;
use glint_model::raymarch::exits::{Exits, Words};
use glint_model::raymarch::{FieldOptions, State, Stereo, Tint};
use glint_reference::camera::{self, Camera, Side, Size};
use glint_reference::raymarch::metrics::RayOutcome;
use glint_reference::raymarch::raymarched::Subject;
use glint_reference::raymarch::{Face, Field, Hit, exited};
use glint_reference::report::experiments::raymarch::requirements::SMALL;
use glint_reference::report::experiments::raymarch::words;
use glint_reference::report::table::read_csv;
use glint_reference::report::workspace;
use glint_vectors::Random;
use glint_vectors::math::{add_scaled, dot, length};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// Smallest distance in pixels between a ray and its four neighbours. Only a ray whose neighbours see the same surface is compared.
const BESIDE: f64 = 0.02;

/// A random camera: inside the field, or outside, looking at it.
fn random_camera(number: u32, random: &mut Pcg64Mcg, inside: &mut Random) -> Camera {
    if number.is_multiple_of(2) {
        return Camera::inside(inside);
    }
    let radius = random.random_range(1.0..30.0);
    let eye = inside.direction().map(|part| part * radius);
    let target = [0; 3].map(|_| random.random_range(-1.0..1.0));
    let (half_width, near) = (
        random.random_range(0.05..4.0),
        random.random_range(0.01..1.0),
    );
    Camera::looking(eye, target, half_width, near)
}

/// Compares rays of random cameras, with one eye or two, through random fields: away from edges, a ray sees the exact surface.
#[test]
fn rays_away_from_edges_see_the_exact_surface() {
    let (mut random, mut inside) = (Pcg64Mcg::new(7), Random(5));
    let (mut compared, mut steps) = (0, 0);
    for number in 0..400 {
        let scene = Scene::draw(|| random.random());
        let camera = random_camera(number, &mut random, &mut inside);
        let Ok(view) = camera.view() else { continue };
        if scene.to_string().starts_with("smooth") {
            continue;
        }
        let camera = Camera::of(&view);
        let stereo = number.is_multiple_of(3).then(|| Stereo {
            half_separation: Q32_32::from_num(random.random_range(0.0..0.2)),
            zero_parallax: Q32_32::from_num(random.random_range(1.0..4.0)),
            tint: Tint::RedBlue,
        });
        let sizes = glint_model::SIZES;
        let size = sizes[random.random_range(0..sizes.len())];
        let exits = Exits::new(&scene, &view, size, stereo, Words::CHOSEN).expect("a frame");
        let cones = exits.cones();
        let (width, height) = size;
        let ray = |eye: usize, pixel| match stereo {
            None => camera.ray(pixel, Size { width, height }),
            Some(stereo) => {
                let stereo = camera::Stereo {
                    offset: stereo.half_separation.to_num(),
                    zero: stereo.zero_parallax.to_num(),
                };
                let side = [Side::Left, Side::Right][eye];
                camera.stereo_ray(side, stereo, pixel, Size { width, height })
            }
        };
        let field = Field::of(&scene);
        let unit = 1.0 / 4096.0 / exits.scale.to_num::<f64>();
        for _ in 0..500 {
            let eye = if stereo.is_some() {
                random.random_range(0..2)
            } else {
                0
            };
            let (x, y) = (
                random.random_range(0..width),
                random.random_range(0..height),
            );
            let hit = |dx: f64, dy: f64| {
                let ray = ray(eye, [f64::from(x) + dx, f64::from(y) + dy]);
                let reach = exited::reach(&exits, eye, ray.direction);
                field.hit(ray.origin, ray.direction, camera.near, reach)
            };
            let surface = |hit: Option<Hit>| hit.map(|hit| (hit.face, hit.member));
            let exact = hit(0.0, 0.0);
            // Rounding of the eye moves a ray by up to a unit.
            let pixel = 2.0 * camera.half_width / f64::from(width);
            let step = BESIDE.max(2.0 * unit / (pixel * exact.map_or(1.0, |hit| hit.t)));
            let beside =
                [(-step, 0.0), (step, 0.0), (0.0, -step), (0.0, step)].map(|(x, y)| hit(x, y));
            let change = beside
                .iter()
                .flatten()
                .zip(exact)
                .map(|(hit, exact)| (hit.t - exact.t).abs())
                .fold(0.0, f64::max);
            // A ray that almost touches a sphere, or runs almost along a face, is as sensitive as a ray at an edge.
            let is_steady = exact.is_none_or(|exact| change < 0.02 * exact.t);
            if !is_steady || beside.iter().any(|&hit| surface(hit) != surface(exact)) {
                continue;
            }
            let beam = exits.ray(eye, x, y);
            let end = exits.end(&cones, &beam);
            compared += 1;
            steps = steps.max(end.steps);
            let is_right = match (exact, exited::outcome(&exits, &beam, &end)) {
                (None, RayOutcome::Miss) => true,
                (Some(exact), RayOutcome::Hit { t, face, .. }) => {
                    // Rounding moves the surface or the eye, which moves the hit farther if the ray meets the surface at a smaller
                    // angle. For wide cameras, directions in the middle are short, and so are the products with them.
                    let direction = ray(eye, [f64::from(x), f64::from(y)]).direction;
                    let angle = dot(exact.normal, direction).abs() / length(direction);
                    let unit = unit * f64::from(1 << exits.exponent);
                    let tolerance = 4.0 * unit / angle.clamp(0.01, 1.0)
                        + 4e-6 * exact.t * exact.t.max(1.0)
                        + change;
                    (exact.face == Face::Inside || face == exact.face)
                        && (t - exact.t).abs() <= tolerance
                }
                _ => false,
            };
            assert!(
                is_right,
                "{scene} {camera:?} {stereo:?} {x},{y} of {width}: {end:?}, exactly {exact:?}"
            );
        }
    }
    println!("{compared} rays, at most {steps} evaluations");
    assert!(compared > 150_000);
}

/// The pictures of the report meet the targets, and have the errors of the committed table.
#[test]
fn pictures_meet_the_targets() {
    let path = workspace::path("docs/report/raymarch-words.csv");
    let mut committed: Vec<words::Row> = read_csv(&path).expect("a committed table");
    committed.retain(|row| row.family == "chosen" && row.width == SMALL.0);
    let subjects = words::subjects(SMALL).expect("scenes");
    assert_eq!(subjects.len(), committed.len());
    for (subject, committed) in subjects.iter().zip(committed) {
        let row = words::row(subject, &("chosen", Words::CHOSEN));
        let name = format!("{} {}", row.scene, row.view);
        // A pixel of a small picture may differ at an edge, by less than a thousandth of a pixel.
        let differing = row.false_hits + row.false_misses;
        assert!(differing <= 1, "{name}: {differing}");
        assert!(row.wrong_faces <= 2e-4, "{name}: {}", row.wrong_faces);
        let p99 = row.depth_p99.unwrap_or_default();
        assert!(p99 <= 2e-4, "{name}: {p99}");
        let normal = row.normal_p99.unwrap_or_default();
        assert!(normal <= 0.1, "{name}: {normal}");
        let figures = |row: &words::Row| (row.iou, row.wrong_faces, row.evaluations, row.tests);
        assert_eq!(
            figures(&row),
            figures(&committed),
            "{name}: run `cargo xtask report raymarch --study words`"
        );
        assert!(
            (p99 - committed.depth_p99.unwrap_or_default()).abs() < 1e-9,
            "{name}: {p99}"
        );
    }
}

/// Compares shadows on the faces of sponges and repeated boxes with exact shadows, and bounds the fraction of hits whose shadow differs. A
/// shadow may differ where the ray to the light passes an edge at a distance below the rounding of the hit.
#[test]
fn shadows_are_where_they_are() {
    let sun = Light::parse("1,-2,3").expect("a light").direction();
    let towards = sun.map(|part| f64::from(part) / 16384.0);
    let options = FieldOptions {
        sun: Some(sun),
        ..FieldOptions::default()
    };
    for (scene, eye, target, limit) in [
        ("menger:4", [2.0, -2.2, 1.6], [0.0; 3], 0.0001),
        ("menger:6", [1.2, -1.3, 1.1], [0.2, -0.1, 0.3], 0.001),
        ("menger:2", [0.9, -0.1, 0.05], [-1.0, 0.2, 0.1], 0.0001),
        ("cubes:2,0.08", [1.0, -1.0, 1.0], [-1.0, 1.2, -1.5], 0.0001),
        (
            "boxes:2,0.7,0.3,0.12",
            [1.0, -1.0, 1.1],
            [-1.0, 1.2, -0.5],
            0.0001,
        ),
    ] {
        let camera = Camera::looking(eye, target, 0.7, 0.05);
        let subject = Subject::new("lit", scene, &camera, (640, 360));
        let setup = subject.setup(&options);
        let tracer = setup.tracer();
        let (mut compared, mut shaded, mut wrong) = (0, 0, 0);
        for (number, expected) in (0..).zip(&subject.expected) {
            let (x, y) = (number % 640, number / 640);
            let found = tracer.trace(0, x, y);
            let (Some(hit), State::Hit(Surface::Face { axis, positive })) =
                (expected.hit, found.state)
            else {
                continue;
            };
            let axis = usize::from(axis);
            let is_same = hit.face == Face::Axis { axis, positive };
            let is_lit = towards[axis] * if positive { 1.0 } else { -1.0 } > 0.0;
            if !is_same || !is_lit {
                assert!(is_lit || !found.shadow, "a face turned away");
                continue;
            }
            let ray = subject.camera.ray(
                [x, y].map(f64::from),
                Size {
                    width: 640,
                    height: 360,
                },
            );
            let mut from = add_scaled(ray.origin, ray.direction, hit.t);
            from[axis] += if positive { 1e-9 } else { -1e-9 };
            let is_shaded = subject.field.hit(from, towards, 0.0, 40.0).is_some();
            compared += 1;
            shaded += u32::from(is_shaded);
            wrong += u32::from(is_shaded != found.shadow);
        }
        let [wrong, shaded] = [wrong, shaded].map(|count| f64::from(count) / f64::from(compared));
        println!("{scene}: {compared} hits, {shaded:.3} in the shadow, {wrong:.5} wrong");
        assert!(
            compared > 1_000 && shaded > 0.01 && wrong <= limit,
            "{scene}: {wrong}"
        );
    }
}
