//! Compares pictures of the model's raymarcher with the exact hits of the same rays. `--nocapture` shows the measured figures.

use glint_core::field::Field as Scene;
use glint_core::fixed::Q32_32;
use glint_model::raymarch::{FieldOptions, FieldSetup, Marching, Ray, State, Stereo, Tint};
use glint_reference::camera::{Camera, Vector};
use glint_reference::raymarch::metrics::{Accuracy, RayOutcome};
use glint_reference::raymarch::raymarched::{self, Measured, Subject, marching};
use glint_reference::raymarch::{Field, views};

const SIZE: (u32, u32) = (320, 180);

/// Errors and cost of a picture compared with the reference.
struct Seen {
    name: String,
    found: Accuracy,
    /// Mean number of evaluations of the field's distance per ray.
    cost: f64,
}

fn setup(scene: &str, camera: &Camera, options: &FieldOptions) -> FieldSetup {
    let scene = Scene::parse(scene).expect("a field");
    let view = camera.view().expect("a camera");
    FieldSetup::new(&scene, &view, SIZE, options).expect("a size")
}

/// The constants of rays that march.
fn marching_rays(setup: &FieldSetup) -> &Marching {
    setup.marching().expect("marching rays")
}

fn see(name: &str, scene: &str, camera: &Camera) -> Seen {
    let subject = Subject::new(name, scene, camera, SIZE);
    let picture = subject.picture(&FieldOptions::default());
    let measured = Measured::new(&subject.expected, &picture);
    println!(
        "{name}, {scene}: {} evaluations a ray, {measured:?}",
        measured.cost()
    );
    Seen {
        name: format!("{name}, {scene}"),
        found: measured.accuracy,
        cost: measured.cost(),
    }
}

impl Seen {
    /// Checks that at most `most` pixels have a false hit or a false miss.
    fn masked(self, most: usize) -> Self {
        let wrong = self.found.false_hit + self.found.false_miss;
        assert!(
            wrong <= most,
            "{}: {wrong} false hits and misses",
            self.name
        );
        self
    }

    /// Checks that at most `most` rays are undecided.
    fn decided(self, most: usize) -> Self {
        let given_up = self.found.undecided;
        assert!(given_up <= most, "{}: {given_up} undecided", self.name);
        self
    }

    /// Checks upper bounds of the median and the 99th percentile of the depth errors, in world units.
    fn near(self, median: f64, p99: f64) -> Self {
        let depth = self.found.depth.expect("a hit");
        assert!(
            depth.median <= median && depth.p99 <= p99,
            "{}: {depth:?}",
            self.name
        );
        self
    }

    /// Checks that the fraction of wrong faces is at most `most`.
    fn faced(self, most: f64) -> Self {
        let wrong = self.found.wrong_faces;
        assert!(wrong <= most, "{}: {wrong} wrong faces", self.name);
        self
    }

    /// Checks that the mean number of evaluations per ray is at most `most`.
    fn cheap(self, most: f64) -> Self {
        assert!(self.cost <= most, "{}: {}", self.name, self.cost);
        self
    }
}

/// Returns the camera at `eye` that looks at `target`, with the half width of the views.
fn at(eye: Vector, target: Vector) -> Camera {
    views::camera(eye, target)
}

#[test]
fn the_deepest_sponge_is_where_it_is() {
    for (name, eye, target) in views::views() {
        see(name, "menger:6", &at(eye, target))
            .masked(0)
            .decided(0)
            .near(4e-7, 2e-6)
            .faced(2e-4)
            .cheap(2.2);
    }
}

#[test]
fn a_camera_inside_the_solid_sees_it_at_the_near_plane() {
    // Eyes in the middle of a small cube at the sponge's corner, and deep inside a box.
    let corner = -80.0 / 81.0;
    let cases = [
        ("menger:4", [corner; 3], [corner, 1.0, corner]),
        ("box:1,1,1", [0.0; 3], [0.5, 1.0, 0.25]),
    ];
    for (scene, eye, target) in cases {
        see("inside", scene, &at(eye, target))
            .masked(0)
            .decided(0)
            .near(1e-6, 1e-6)
            .cheap(1.0);
    }
}

#[test]
fn a_camera_in_the_plane_of_a_face_sees_what_is_before_it() {
    let above = at([0.0, -3.0, 1.0], [0.0, 0.0, 1.0]);
    see("level with the top", "menger:4", &above)
        .masked(0)
        .decided(0)
        .near(1e-9, 2e-6)
        .faced(0.0)
        .cheap(0.7);
    // The eye is in the plane of the front face. Half of the rays go into the face, and the other half away from it.
    let on = at([0.9375, -1.0, 0.9375], [-0.5, -1.5, 0.5]);
    see("on the front", "menger:4", &on)
        .masked(0)
        .decided(0)
        .near(1e-6, 1e-6)
        .cheap(1.0);
}

#[test]
fn a_camera_just_beside_a_face_sees_it() {
    // The eye is 0.03 of a cell's side away from the face. For a deeper sponge, this distance would be less than the nearest
    // allowed near plane.
    let eye = [0.75, -1.0 - 0.03 * 2.0 / 3.0, 0.75];
    see("macro", "menger:1", &at(eye, [0.75, 0.0, 0.765_625]))
        .masked(0)
        .decided(0)
        .near(2e-6, 2e-6)
        .faced(0.0)
        .cheap(1.0);
    let over = at([-1.25, -1.125, 1.001_953_125], [1.0, 0.875, 1.0]);
    see("grazing", "box:1,1,1", &over)
        .masked(0)
        .decided(0)
        .near(1e-6, 4e-6)
        .faced(0.0)
        .cheap(0.6);
    // The eye is just below the ceiling and looks to the horizon. A third of the rays are already inside the ceiling at the near plane.
    let under = at([0.0, 0.0, 0.998_046_875], [4.0, 3.0, 0.998_046_875]);
    see("grazing", "planes:1", &under)
        .masked(0)
        .decided(0)
        .near(1e-6, 3e-5)
        .cheap(1.0);
}

#[test]
fn lenses_may_be_long_and_wide() {
    let (_, eye, target) = views::views()[0];
    let with = |half_width| {
        let mut camera = at(eye, target);
        camera.half_width = half_width;
        see(&format!("half width {half_width}"), "menger:4", &camera)
    };
    with(0.05)
        .masked(0)
        .decided(0)
        .near(1e-6, 2e-6)
        .faced(2e-4)
        .cheap(1.7);
    with(4.0)
        .masked(0)
        .decided(0)
        .near(1e-6, 1e-5)
        .faced(0.0)
        .cheap(1.0);
}

#[test]
fn a_camera_may_be_far_away() {
    let mut camera = at([0.0, -30.0, 0.0], [0.125, 0.0, 0.0625]);
    camera.half_width = 0.05;
    // The camera looks along the walls of the sponge's tunnels, so the picture shows mostly the depths of tunnels.
    see("far away", "menger:4", &camera)
        .masked(0)
        .decided(0)
        .near(5e-6, 2e-4)
        .faced(6e-4)
        .cheap(1.3);
}

/// Marching rays, the other form of a ray to a sponge, have errors at edges, and take more evaluations.
#[test]
fn marching_rays_see_the_sponge_but_for_edges() {
    for (name, eye, target) in views::views() {
        let subject = Subject::new(name, "menger:4", &at(eye, target), SIZE);
        let measured = Measured::new(&subject.expected, &subject.picture(&marching()));
        let seen = Seen {
            name: name.into(),
            found: measured.accuracy,
            cost: measured.cost(),
        };
        seen.masked(40)
            .decided(0)
            .near(2e-4, 5e-4)
            .faced(0.01)
            .cheap(14.4);
    }
}

/// Marches rays exactly along an axis, a direction that no pixel's ray has. Next to a wall, each step is only as long as the
/// distance to the wall, and the threshold of a hit doubles every 64 steps. So a ray may end at a wall at a distance of less than
/// an eighth of a cell. No other error may occur.
#[test]
fn rays_along_the_axes_end_at_the_walls() {
    let sponge = Field::Menger { depth: 4 };
    let places = || (-9..9).map(|i| f64::from(2 * i + 1) / 16.0);
    let (mut hits, mut passed, mut given_up, mut beside) = (0, 0, 0, 0);
    let mut most: f64 = 0.0;
    for (axis, side) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
        for (a, b) in places().flat_map(|a| places().map(move |b| (a, b))) {
            let mut eye = [0.0; 3];
            eye[axis] = f64::from(-2 * side);
            (eye[(axis + 1) % 3], eye[(axis + 2) % 3]) = (a, b);
            let setup = setup("menger:4", &at(eye, [3.0, 4.0, 0.0]), &marching());
            let rays = marching_rays(&setup);
            let mut direction = [0; 3];
            direction[axis] = ((1 << 17) - 1) * side;
            let ray = Ray {
                eye: 0,
                direction,
                length: 1023,
                start: 0,
            };
            let end = rays.march(&ray);
            let direction = direction.map(|x| f64::from(x) / f64::from(1 << 17));
            let exact = sponge.hit(eye, direction, 0.0, 100.0);
            let context = || format!("{eye:?}, {axis}, {side}: {end:?}, {exact:?}");
            match (
                raymarched::rendered_ray(&setup, &rays.seen(&ray, &end)).outcome,
                exact,
            ) {
                (RayOutcome::Hit { .. }, _) if end.steps > 64 && [0, 1023].contains(&end.slope) => {
                    beside += 1;
                }
                (RayOutcome::Hit { face, .. }, Some(exact)) => {
                    let t =
                        f64::from(end.reached()) / f64::from(1 << 12) / setup.scale.to_num::<f64>();
                    hits += 1;
                    most = most.max((t - exact.t).abs());
                    assert_eq!(face, exact.face, "{}", context());
                }
                (RayOutcome::Miss, None) => passed += 1,
                (RayOutcome::Undecided, _) => given_up += 1,
                _ => panic!("{}", context()),
            }
        }
    }
    println!(
        "{hits} hits, apart by at most {most:e}, {passed} misses, {given_up} undecided, {beside} beside a wall"
    );
    assert!(hits > 700 && given_up + beside <= 264 && most < 1e-5);
}

#[test]
fn the_first_step_is_the_last_where_there_is_but_one() {
    for (name, eye, target) in views::views() {
        let mut options = marching();
        let free = setup("menger:4", &at(eye, target), &options);
        options.tuning.cap = 1;
        let capped = setup("menger:4", &at(eye, target), &options);
        let [free, capped] = [&free, &capped].map(marching_rays);
        for (x, y) in pixels() {
            let ray = free.ray(0, x, y);
            let (end, first) = (free.march(&ray), capped.march(&ray));
            if end.steps == 1 {
                assert_eq!(first, end, "{name} {x} {y}");
            } else {
                let given_up = (first.state, first.steps) == (State::Undecided, 1);
                assert!(given_up, "{name} {x} {y}: {first:?}");
            }
        }
    }
}

#[test]
fn a_surface_at_the_end_of_a_ray_is_seen_and_none_behind_it() {
    let camera = at([0.0, -3.0, 0.0], [0.25, 0.0, 0.125]);
    let mut options = marching();
    let free = setup("menger:4", &camera, &options);
    let free = marching_rays(&free);
    let mut ends: Vec<u32> = pixels()
        .map(|(x, y)| free.march(&free.ray(0, x, y)))
        .filter(|end| matches!(end.state, State::Hit(_)))
        .map(|end| end.t + end.gap)
        .collect();
    ends.sort_unstable();
    options.tuning.far = ends[ends.len() / 2];
    let short = setup("menger:4", &camera, &options);
    let short = marching_rays(&short);
    let (mut seen, mut beyond) = (0, 0);
    for (x, y) in pixels() {
        let ray = free.ray(0, x, y);
        let (end, found) = (free.march(&ray), short.march(&ray));
        // A ray hits only if the end of its last step, t + gap, is not beyond the far limit.
        let reach = end.t + end.gap;
        if reach <= options.tuning.far {
            assert_eq!(found, end, "{x} {y}");
            seen += u32::from(reach == options.tuning.far);
        } else {
            assert_eq!(found.state, State::Miss, "{x} {y}");
            beyond += 1;
        }
    }
    assert!(
        seen > 0 && beyond > 1000,
        "{seen} at the end, {beyond} beyond"
    );
}

#[test]
fn two_eyes_in_one_place_see_what_one_eye_sees() {
    let stereo = Stereo {
        half_separation: Q32_32::ZERO,
        zero_parallax: Q32_32::ONE,
        tint: Tint::RedBlue,
    };
    let options = FieldOptions {
        stereo: Some(stereo),
        ..FieldOptions::default()
    };
    for (name, eye, target) in views::views() {
        let one = setup("menger:4", &at(eye, target), &FieldOptions::default());
        let two = setup("menger:4", &at(eye, target), &options);
        let picture = raymarched::picture(&one, 0);
        for eye in [0, 1] {
            assert!(raymarched::picture(&two, eye) == picture, "{name} {eye}");
        }
    }
}

fn pixels() -> impl Iterator<Item = (u32, u32)> {
    let (width, height) = SIZE;
    (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}
