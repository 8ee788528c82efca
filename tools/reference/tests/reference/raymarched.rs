//! Compares pictures of the model's raymarcher with the exact hits of the same rays. `--nocapture` shows the measured figures.

use glint_core::field::Field as Scene;
use glint_core::fixed::Q32_32;
use glint_model::raymarch::{FieldOptions, FieldSetup, Stereo, Tint};
use glint_reference::camera::Camera;
use glint_reference::raymarch::metrics::Accuracy;
use glint_reference::raymarch::raymarched::{self, Measured, Subject};
use glint_reference::raymarch::views::{self, camera as at};

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

/// Draws a picture, and checks that hits and misses are at the same pixels as in the reference.
fn see(name: &str, scene: &str, camera: &Camera) -> Seen {
    let subject = Subject::new(name, scene, camera, SIZE);
    let picture = subject.picture(&FieldOptions::default());
    let measured = Measured::new(&subject.expected, &picture);
    println!(
        "{name}, {scene}: {} evaluations a ray, {measured:?}",
        measured.cost()
    );
    let found = measured.accuracy;
    let wrong = found.false_hit + found.false_miss + found.undecided;
    assert_eq!(wrong, 0, "{name}, {scene}: wrong or undecided pixels");
    Seen {
        name: format!("{name}, {scene}"),
        found,
        cost: measured.cost(),
    }
}

impl Seen {
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

#[test]
fn the_deepest_sponge_is_where_it_is() {
    for (name, eye, target) in views::views() {
        see(name, "menger:6", &at(eye, target))
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
            .near(1e-6, 1e-6)
            .cheap(1.0);
    }
}

#[test]
fn a_camera_in_the_plane_of_a_face_sees_what_is_before_it() {
    let above = at([0.0, -3.0, 1.0], [0.0, 0.0, 1.0]);
    see("level with the top", "menger:4", &above)
        .near(1e-9, 2e-6)
        .faced(0.0)
        .cheap(0.7);
    // The eye is in the plane of the front face. Half of the rays enter the face, and half of the rays leave it.
    let on = at([0.9375, -1.0, 0.9375], [-0.5, -1.5, 0.5]);
    see("on the front", "menger:4", &on)
        .near(1e-6, 1e-6)
        .cheap(1.0);
}

#[test]
fn a_camera_just_beside_a_face_sees_it() {
    // The eye is 0.03 of a cell's side away from the face. For a deeper sponge, this distance would be less than the nearest
    // allowed near plane.
    let eye = [0.75, -1.0 - 0.03 * 2.0 / 3.0, 0.75];
    see("macro", "menger:1", &at(eye, [0.75, 0.0, 0.765_625]))
        .near(2e-6, 2e-6)
        .faced(0.0)
        .cheap(1.0);
    let over = at([-1.25, -1.125, 1.001_953_125], [1.0, 0.875, 1.0]);
    see("grazing", "box:1,1,1", &over)
        .near(1e-6, 4e-6)
        .faced(0.0)
        .cheap(0.6);
    // The eye is just below the ceiling and looks to the horizon. A third of the rays are already inside the ceiling at the near plane.
    let under = at([0.0, 0.0, 0.998_046_875], [4.0, 3.0, 0.998_046_875]);
    see("grazing", "planes:1", &under)
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
    with(0.05).near(1e-6, 2e-6).faced(2e-4).cheap(1.7);
    // Of 1,218 faces, one is wrong: its ray passes an edge at a distance below the rounding of the ray's direction.
    with(4.0).near(1e-6, 1e-5).faced(1e-3).cheap(1.0);
}

#[test]
fn a_camera_may_be_far_away() {
    let mut camera = at([0.0, -30.0, 0.0], [0.125, 0.0, 0.0625]);
    camera.half_width = 0.05;
    // The camera looks along the walls of the sponge's tunnels, so the picture shows mostly the depths of tunnels.
    see("far away", "menger:4", &camera)
        .near(5e-6, 2e-4)
        .faced(6e-4)
        .cheap(1.3);
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
