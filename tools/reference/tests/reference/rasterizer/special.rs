//! Hand-made edge cases for the rasterizer. Each case must pass all checks of `coverage`.

use glint_reference::camera::{Camera, Vector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::cameras::looking_at;
use super::coverage::check;
use super::scenes::{Case, LARGE, MIDDLE, ONE, SMALL, Scene};

/// One step of a coordinate in Q2.14.
const STEP: f64 = 1.0 / ONE;

fn case(name: &str, camera: Camera, triangles: &[[Vector; 3]]) -> Case {
    let mut scene = Scene::default();
    triangles
        .iter()
        .for_each(|&triangle| scene.triangle(triangle));
    Case {
        name: name.to_owned(),
        scene,
        camera,
        size: SMALL,
        cull: false,
    }
}

/// Returns the camera at (0, −2, 0) that looks along +y. On the screen, x points right and z up.
fn ahead() -> Camera {
    looking_at([0.0, -2.0, 0.0], [0.0; 3], 0.0, 0.5, 0.1)
}

/// Checks a case at all sizes, with and without culling, and returns the number of pixels covered at 320x180 without culling.
fn check_all(case: Case) -> usize {
    let mut case = case;
    for (size, cull) in [
        (LARGE, false),
        (MIDDLE, false),
        (SMALL, true),
        (SMALL, false),
    ] {
        (case.size, case.cull) = (size, cull);
        check(&case);
    }
    covered(&case)
}

/// Counts the pixels covered by all triangles of a case drawn together.
fn covered(case: &Case) -> usize {
    let picture = case
        .scene
        .draw(&case.camera.rounded(), case.size, case.cull);
    picture.covered()
}

#[test]
fn triangles_without_area_draw_nothing() {
    let point = [0.1, 0.2, 0.3];
    let triangles = [
        // Degenerate triangles: a point, a line back and forth, three points of a line, and a triangle seen edge-on.
        [point; 3],
        [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.25], [-0.5, 0.0, 0.0]],
        [[-0.5, 0.0, 0.0], [0.0, 0.0, 0.0], [0.5, 0.0, 0.0]],
        [[0.0, -1.0, 0.0], [0.0, 1.0, 0.25], [0.0, 0.5, -0.5]],
    ];
    assert_eq!(check_all(case("no area", ahead(), &triangles)), 0);
}

#[test]
fn slivers_a_thousand_times_longer_than_wide() {
    let mut triangles = Vec::new();
    for i in (1..40).step_by(3) {
        let along = [0.9, 0.0, 0.02 * f64::from(i) - 0.4];
        let back = along.map(|x: f64| -x);
        // In x and z alone, the third corner is 1 to 37 steps of Q2.14 above the long edge, at its middle or one of its ends.
        for (place, depth) in [(0.0, 0.0), (0.9, 1.0), (-0.9, -1.0)] {
            let off = [place, depth, place * along[2] / 0.9 + f64::from(i) * STEP];
            triangles.push([along, back, off]);
        }
    }
    let covered = check_all(case("slivers", ahead(), &triangles));
    assert!(covered > 100, "only {covered} pixels");
}

#[test]
fn off_the_screen_on_every_side() {
    let mut triangles = Vec::new();
    // Triangles beside the picture, some of them beyond the guard band and therefore clipped. The last added triangle is between
    // the eye and the near plane.
    for far in [1.2, 1.9] {
        for [x, z] in [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [1.0, 1.0]] {
            let middle = [x * far, -0.5, z * far];
            triangles.push([
                [middle[0] + 0.05, middle[1], middle[2] + 0.05],
                [middle[0] - 0.05, middle[1], middle[2] + 0.05],
                [middle[0], middle[1], middle[2] - 0.05],
            ]);
        }
    }
    triangles.push([[0.1, -1.95, 0.1], [0.1, -1.99, -0.1], [-0.1, -1.97, 0.0]]);
    assert_eq!(check_all(case("off screen", ahead(), &triangles)), 0);
}

#[test]
fn one_triangle_over_the_whole_screen() {
    let whole = [[-1.9, 0.5, -1.5], [1.9, 0.5, -1.5], [0.0, 0.5, 1.9]];
    let camera = Camera {
        half_width: 0.3,
        ..ahead()
    };
    assert_eq!(check_all(case("full screen", camera, &[whole])), 320 * 180);
    let tilted = [[-1.9, -1.0, -1.9], [1.9, -0.5, -1.9], [0.0, 1.9, 1.9]];
    let near = looking_at([0.0, -1.0, 0.0], [0.0, 0.0, -0.1], 0.3, 0.05, 0.01);
    assert_eq!(
        check_all(case("full screen, narrow", near, &[tilted])),
        320 * 180
    );
}

#[test]
fn an_apex_at_the_eye() {
    let eye = [0.25, -0.5, 0.125];
    let mut triangles = Vec::new();
    for i in 0..12 {
        let (sin, cos) = (f64::from(i) * 0.55).sin_cos();
        triangles.push([eye, [cos, 1.0, sin], [0.7 * sin, 1.5, 0.7 * cos]]);
        // A triangle with a corner close to the eye: one step of Q2.14 from the eye in x, and 0 to 352 steps in y.
        let beside = [eye[0] + STEP, eye[1] + f64::from(i) * STEP * 32.0, eye[2]];
        triangles.push([beside, [sin, 0.5, cos], [-cos, 1.5, sin]]);
    }
    for near in [0.01, 0.1, 2.0] {
        let camera = looking_at(eye, [0.0, 1.0, 0.0], 0.7, 1.0, near);
        let covered = check_all(case("apex at the eye", camera, &triangles));
        assert!(
            near > 1.0 || covered > 1000,
            "near {near}: only {covered} pixels"
        );
    }
}

#[test]
fn inside_a_cube_everything_is_covered() {
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -0.5 } else { 0.5 });
    let quads = [
        [0, 1, 3, 2],
        [4, 6, 7, 5],
        [0, 4, 5, 1],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 5, 7, 3],
    ];
    let triangles: Vec<[Vector; 3]> = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c].map(corner), [a, c, d].map(corner)])
        .collect();
    for (i, half_width) in [0.05, 0.9, 4.0].into_iter().enumerate() {
        for (j, target) in [
            [0.5, 0.4, 0.3],
            [-0.2, 0.5, -0.5],
            [0.0, 0.0, 0.5],
            [0.5, 0.5, 0.5],
        ]
        .into_iter()
        .enumerate()
        {
            let eye = [0.1 * i as f64 - 0.1, 0.05 * j as f64, -0.1];
            let camera = looking_at(eye, target, 0.5 + i as f64, half_width, 0.01);
            let case = case("inside a cube", camera, &triangles);
            check(&case);
            assert_eq!(
                covered(&case),
                320 * 180,
                "half_width {half_width}, towards {target:?}: a hole in the wall"
            );
        }
    }
}

#[test]
fn half_pixel_grid_where_many_centres_lie_on_edges() {
    // At distance 1 and with half_width 0.625, a pixel of a picture of 320x180 is 1/256 wide. So vertices at multiples of 1/512
    // fall on the centres and borders of pixels.
    let camera = Camera {
        eye: [0.0, 0.0, 0.0],
        u: [1.0, 0.0, 0.0],
        v: [0.0, 0.0, -1.0],
        n: [0.0, 1.0, 0.0],
        half_width: 0.625,
        near: 0.1,
    };
    let half_pixel = 1.0 / 512.0;
    let mut random = Pcg64::seed_from_u64(1);
    let mut triangles = Vec::new();
    for _ in 0..150 {
        let middle = [
            random.random_range(-250..250),
            random.random_range(-130..130),
        ];
        triangles.push([(); 3].map(|()| {
            let [x, z] =
                middle.map(|from| f64::from(from + random.random_range(-40..40)) * half_pixel);
            [x, 1.0, z]
        }));
    }
    let case = case("half-pixel grid", camera, &triangles);
    let picture = case.scene.draw(&camera.rounded(), SMALL, false);
    let mut vertices = picture.drawn.iter().flat_map(|drawn| drawn.vertices);
    assert!(
        vertices.all(|vertex| vertex.x % 128 == 0 && vertex.y % 128 == 0),
        "off the half-pixel grid"
    );
    let covered = check_all(case);
    assert!(covered > 3000, "only {covered} pixels");
}
