//! Compares the vertices that the model snaps to the subpixel grid, and their depths, with the projection in f64.

use std::fmt;

use glint_core::mesh::MAX_RADIUS;
use glint_model::triangle::vertex::{project, transform};
use glint_model::{MeshSetup, Projected, ScreenVertex};
use glint_reference::camera::{Camera, Size, Vector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::cameras::{around, log_range, view};
use super::renderer::Renderer;
use super::scenes::{LARGE, ONE, SMALL, Scene};

/// Number of compared vertices, largest distances of these snapped vertices from their projection in f64, in steps of 1/256
/// pixel, and the largest error of their depth, in steps of 1/64 depth code.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    vertices: u64,
    across: f64,
    distance: f64,
    /// Largest distance from the projection through the camera as it was before its numbers were rounded to a view.
    unrounded_distance: f64,
    depth: f64,
}

impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{} vertices: {:.3}/256 px across, {:.3}/256 px in distance ({:.3}/256 from the unrounded camera), depth {:.3}/64 code",
            self.vertices, self.across, self.distance, self.unrounded_distance, self.depth
        )
    }
}

/// Returns the distance along x and y from a point of the screen, in
/// pixels, to a snapped vertex. The result is in steps of 1/256 pixel.
fn offset(snapped: ScreenVertex, exact: [f64; 2]) -> [f64; 2] {
    [
        f64::from(snapped.x) - exact[0] * 256.0,
        f64::from(snapped.y) - exact[1] * 256.0,
    ]
}

/// Projects random vertices through random cameras, by the model and in f64, and compares the vertices that are in the guard
/// band (the positions that need no clipping).
///
/// `limit` is the largest allowed distance from the projection through the unrounded camera, in steps of 1/256 pixel.
fn compare(size: Size, seeds: std::ops::Range<u64>, limit: f64) -> Worst {
    let mut worst = Worst::default();
    for seed in seeds {
        let mut random = Pcg64::seed_from_u64(seed);
        let half_width = log_range(&mut random, 0.05, 4.0);
        let near = log_range(&mut random, 0.01, 2.0);
        let distance = log_range(&mut random, 0.1, 7.0);
        let asked = around(&mut random, distance, half_width, near);
        let view = view(&asked);
        let camera = Camera::from(&view);
        // The constants are those of a mesh with the largest radius, so the scale of depth is valid for every vertex.
        let setup = MeshSetup::new(&view, size.width, size.height, MAX_RADIUS).expect("a size");
        let depth_scale = camera.depth_scale(f64::from(MAX_RADIUS) / ONE);
        for _ in 0..400 {
            let Some(position) = somewhere_in_view(&mut random, &camera, size) else {
                continue;
            };
            let Projected::Visible(snapped) = project(&setup, &transform(&setup, position)) else {
                continue;
            };
            let point = position.map(|x| f64::from(x) / ONE);
            let seen = camera.coordinates(point);
            let [dx, dy] = offset(snapped, camera.screen(seen, size));
            let [ux, uy] = offset(snapped, asked.screen(asked.coordinates(point), size));
            let depth = f64::from(snapped.w) - depth_scale / seen[2] * 64.0;
            worst.vertices += 1;
            worst.across = worst.across.max(dx.abs()).max(dy.abs());
            worst.distance = worst.distance.max(dx.hypot(dy));
            worst.unrounded_distance = worst.unrounded_distance.max(ux.hypot(uy));
            worst.depth = worst.depth.max(depth.abs());
            assert!(
                ux.hypot(uy) <= limit,
                "seed {seed}: {position:?} is {:.3}/256 px off: {snapped:?} for {:?}\n{asked:?}",
                ux.hypot(uy),
                asked.screen(asked.coordinates(point), size),
            );
            // The last rounding of w has an error of up to half a step, and the roundings before it contribute
            // less than that. So half a depth code (32 steps) is a generous bound.
            assert!(
                depth.abs() <= 32.0,
                "seed {seed}: depth of {position:?} is {depth:.2}/64 codes off\n{asked:?}"
            );
        }
    }
    worst
}

/// Returns a random vertex in Q2.14 that is in the picture or close to it. Returns `None` if the random point in view is outside
/// the range of Q2.14.
fn somewhere_in_view(random: &mut Pcg64, camera: &Camera, size: Size) -> Option<[i16; 3]> {
    let z = log_range(random, camera.near, 10.0);
    let scale = camera.pixels_per_unit(size);
    let mut place = |pixels: u32| (random.random_range(-0.7..0.7) * f64::from(pixels)) / scale * z;
    let (x, y) = (place(size.width), place(size.height));
    let world: Vector =
        [0, 1, 2].map(|i| camera.eye[i] + x * camera.u[i] + y * camera.v[i] + z * camera.n[i]);
    let inside = world.iter().all(|x| x.abs() < 1.9999);
    inside.then(|| world.map(|x| (x * ONE).round() as i16))
}

#[test]
fn snapped_vertices_are_within_a_step_of_the_projection_at_320x180() {
    let worst = compare(SMALL, 0..600, 1.0);
    println!("320x180: {worst}");
    assert!(worst.vertices > 20_000, "{worst}");
}

#[test]
fn snapped_vertices_are_within_two_steps_of_the_projection_at_1280x720() {
    let worst = compare(LARGE, 0..600, 2.0);
    println!("1280x720: {worst}");
    assert!(worst.vertices > 20_000, "{worst}");
}

/// The model's trace of an unclipped triangle must have the triangle's snapped vertices, in any order.
#[test]
fn drawn_triangles_have_the_snapped_vertices() {
    let mut renderer = Renderer::default();
    let mut random = Pcg64::seed_from_u64(7);
    let camera = around(&mut random, 3.0, 0.9, 0.1);
    let view = view(&camera);
    let mut scene = Scene::default();
    scene.triangle([[0.5, 0.5, 0.5], [-0.5, 0.5, -0.5], [0.5, -0.5, 0.0]]);
    renderer.draw(&scene, &view, SMALL, false);
    let exact = Camera::from(&view);
    let drawn = renderer
        .drawn
        .first()
        .expect("a triangle in the middle of the picture");
    for corner in scene.corners(0) {
        let point = exact.screen(exact.coordinates(corner), SMALL);
        let near = drawn.vertices.iter().any(|&vertex| {
            let [dx, dy] = offset(vertex, point);
            dx.hypot(dy) <= 1.0
        });
        assert!(
            near,
            "{corner:?} at {point:?} is none of {:?}",
            drawn.vertices
        );
    }
}
