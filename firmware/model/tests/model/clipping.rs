//! Clipping of triangles that cross the near plane or leave the guard band.

use glint_model::triangle::clip::clip;
use glint_model::triangle::vertex::{CameraVertex, project, transform};
use glint_model::{MeshSetup, Projected, SIZES};
use glint_vectors::{Camera, Model, Picture, Random, math::world};

const SIZE: (u32, u32) = SIZES[0];

/// Radius of a mesh that may have vertices at all positions of the mesh format, 14 fraction bits.
const RADIUS: u32 = 56_756;

fn random_frame(random: &mut Random) -> MeshSetup {
    let (width, height) = SIZES[random.integer(0, 2) as usize];
    MeshSetup::new(&Camera::inside(random).rounded(), width, height, RADIUS).unwrap()
}

fn random_vertex(random: &mut Random, frame: &MeshSetup) -> CameraVertex {
    transform(frame, [0; 3].map(|_| random.integer(-32768, 32767) as i16))
}

/// Vertices inside the view volume are kept bit for bit, vertices outside are removed.
#[test]
fn what_is_inside_is_never_cut() {
    let mut random = Random(10);
    let (mut kept, mut at_the_limit) = (0, 0);
    for _ in 0..100_000 {
        let frame = random_frame(&mut random);
        let triangle = [0; 3].map(|_| random_vertex(&mut random, &frame));
        let polygon = clip(&frame, triangle);
        let vertices = polygon.vertices();
        assert!(vertices.len() <= 8);
        for vertex in &triangle {
            match project(&frame, vertex) {
                Projected::Visible(place) => {
                    assert!(vertices.contains(vertex));
                    kept += 1;
                    at_the_limit += u32::from(place.x.abs().max(place.y.abs()) > 2000 << 8);
                }
                Projected::Behind => assert!(!vertices.contains(vertex)),
                Projected::BeyondGuard(place) => {
                    assert!(
                        place.x.abs().max(place.y.abs()) < 2048 << 8 || !vertices.contains(vertex)
                    );
                }
            }
        }
        for vertex in vertices {
            let (Projected::Visible(place) | Projected::BeyondGuard(place)) =
                project(&frame, vertex)
            else {
                panic!("{vertex:?} is behind")
            };
            assert!(place.x.abs().max(place.y.abs()) < 2048 << 8);
        }
    }
    assert!(
        kept > 10_000 && at_the_limit > 100,
        "{kept}, {at_the_limit}"
    );
}

/// Two triangles with a common edge traverse the edge in opposite directions and cut it at the same vertices.
#[test]
fn neighbours_cut_their_edge_alike() {
    let mut random = Random(11);
    let mut cuts = 0;
    for _ in 0..100_000 {
        let frame = random_frame(&mut random);
        let [a, b, c, d] = [0; 4].map(|_| random_vertex(&mut random, &frame));
        // Clips the edge alone, as a degenerate triangle: both neighbours must contain its remaining vertices.
        let edge = clip(&frame, [a, b, b]);
        let (left, right) = (clip(&frame, [a, b, c]), clip(&frame, [b, a, d]));
        for end in edge.vertices() {
            assert!(
                left.vertices().contains(end) && right.vertices().contains(end),
                "{end:?}"
            );
            cuts += u32::from(*end != a && *end != b);
        }
    }
    assert!(cuts > 10_000, "{cuts}");
}

/// The picture of a clipped triangle does not depend on its first vertex.
#[test]
fn clipping_does_not_depend_on_the_first_vertex() {
    let mut random = Random(2);
    let mut clipped = 0;
    for _ in 0..100 {
        let view = Camera::inside(&mut random).rounded();
        let model = Model::random(&mut random, 6, 32768);
        let pictures =
            [0, 1, 2].map(|turns| Picture::of(&model.rotated(turns), &view, SIZE, false));
        clipped += pictures[0].stats.clipped;
        for other in &pictures[1..] {
            assert_eq!(other.coverage(), pictures[0].coverage());
            assert_eq!(other.stats.clipped, pictures[0].stats.clipped);
            let exceptions = |p: &Picture| {
                p.drawn
                    .iter()
                    .filter(|t| t.clipped)
                    .copied()
                    .collect::<Vec<_>>()
            };
            let (mine, others) = (exceptions(&pictures[0]), exceptions(other));
            // Colours are not compared, because the test computes normals in f64 and their rounding depends on the order of
            // the vertices.
            assert_eq!(mine.len(), others.len());
            assert!(
                mine.iter()
                    .zip(&others)
                    .all(|(a, b)| a.vertices == b.vertices && a.facing == b.facing)
            );
        }
    }
    assert!(clipped > 200, "{clipped}");
}

/// Inside a closed mesh, clipping leaves no pixel uncovered. Except at cut edges, no pixel is covered by two triangles.
#[test]
fn from_inside_every_pixel_is_covered() {
    let mut random = Random(3);
    let (mut clipped, mut twice, mut pixels) = (0, 0, 0);
    for round in 0..60 {
        let model = if round % 2 == 0 {
            Model::cube(32767)
        } else {
            Model::sphere(1.9, 7)
        };
        let mut camera = Camera::inside(&mut random);
        camera.eye = camera.eye.map(|x| x * 0.6);
        // The near plane must not reach the walls of the mesh, even in the corners of a wide picture.
        camera.near = 0.01;
        camera.half_width = camera.half_width.min(2.0);
        let size = SIZES[round % 3];
        let picture = Picture::of(&model.flipped(), &camera.rounded(), size, true);
        assert_eq!(picture.covered(), picture.depth.len(), "round {round}");
        clipped += picture.stats.clipped;
        twice += picture.stats.pixels_covered - picture.depth.len() as u64;
        pixels += picture.depth.len();
    }
    println!("{clipped} triangles clipped, {twice} of {pixels} pixels covered twice");
    assert!(clipped > 200);
    // The rounding of its new vertices bends a cut edge by up to half a subpixel; no other overlap is allowed.
    assert!(twice < pixels as u64 / 100_000, "{twice}");
}

/// A camera at the origin that looks along y.
fn level_camera(near: f64) -> Camera {
    Camera {
        eye: [0.0; 3],
        u: [1.0, 0.0, 0.0],
        v: [0.0, 0.0, -1.0],
        n: [0.0, 1.0, 0.0],
        half_width: 0.9,
        near,
    }
}

/// A square that crosses the near plane is cut at the right position: its picture ends at the expected lines and has the
/// expected depths.
#[test]
fn the_near_plane_cuts_where_it_is() {
    // The floor z = −0.25, seen by an eye that is above it and looks along it.
    let floor = Model {
        positions: vec![
            [-32768, -32768, -4096],
            [32767, -32768, -4096],
            [32767, 32767, -4096],
            [-32768, 32767, -4096],
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    for near in [0.01, 0.1, 0.5, 1.0] {
        for size in SIZES {
            let view = level_camera(near).rounded();
            let picture = Picture::of(&floor, &view, size, true);
            assert_eq!(picture.stats.clipped, 2);
            let frame = MeshSetup::new(&view, size.0, size.1, 56_756).unwrap();
            let (w, h) = (f64::from(size.0), f64::from(size.1));
            let scale = w / 2.0 / 0.9;
            let mut seen = 0;
            for (pixel, &code) in picture.depth.iter().enumerate() {
                let (x, y) = (
                    (pixel % size.0 as usize) as f64 + 0.5,
                    (pixel / size.0 as usize) as f64 + 0.5,
                );
                let z = 0.25 * scale / (y - h / 2.0);
                let across = (x - w / 2.0) / scale * z;
                // A pixel within half a subpixel of the border may be covered or not.
                let rows_off = (y - h / 2.0 - 0.25 * scale / near)
                    .abs()
                    .min((y - h / 2.0 - 0.125 * scale).abs());
                let border = rows_off < 0.01 || (across.abs() - 2.0).abs() < 0.01 * z / scale;
                let expected = y > h / 2.0 && z >= near && z <= 2.0 && across.abs() < 2.0;
                assert!(
                    border || expected == (code != 0),
                    "{x}, {y} at {near}: {code}"
                );
                if let Some(found) = frame.depth.distance(code) {
                    let (found, slope) =
                        (found.to_num::<f64>(), 0.25 * scale / (y - h / 2.0).powi(2));
                    // Tolerance: one code, plus half a subpixel along the slope.
                    let tolerance = z / f64::from(code) + slope / 256.0;
                    assert!((found - z).abs() <= tolerance, "{found} for {z}");
                    seen += 1;
                }
            }
            assert!(seen > 500, "{seen}");
        }
    }
}

/// Tests a vertex at the eye, a vertex on the near plane, and triangles seen edge-on.
#[test]
fn apex_at_the_eye() {
    let far = [
        [-8000, 16000, -6000],
        [8000, 16000, -6000],
        [0, 16000, 7000],
    ];
    // The three sides of a pyramid whose tip is at the eye are seen edge-on: they cover almost no pixels, whereas the
    // base of the pyramid covers many.
    let base = Picture::of(
        &Model::soup(&[far]),
        &level_camera(0.01).rounded(),
        SIZE,
        false,
    );
    let tip = [0, 0, 0];
    let sides: Vec<_> = (0..3).map(|i| [tip, far[i], far[(i + 1) % 3]]).collect();
    let edge_on = Picture::of(
        &Model::soup(&sides),
        &level_camera(0.01).rounded(),
        SIZE,
        false,
    );
    assert_eq!(edge_on.stats.clipped, 3);
    assert!(edge_on.covered() < 20, "{}", edge_on.covered());
    assert!(base.covered() > 2000);
    // A vertex exactly on the near plane counts as beyond it.
    let on = [[-8000, 8192, -6000], [8000, 8192, -6000], [0, 8192, 7000]];
    let [at, beyond] = [0.5, 0.500_01].map(|near| {
        Picture::of(
            &Model::soup(&[on]),
            &level_camera(near).rounded(),
            SIZE,
            false,
        )
    });
    assert_eq!((at.stats.drawn, at.stats.clipped), (1, 0));
    assert_eq!(
        (beyond.stats.drawn, beyond.stats.clipped, beyond.covered()),
        (0, 0, 0)
    );
    // This triangle is at the smallest possible depth, so its codes are the largest possible.
    assert!(
        at.depth
            .iter()
            .all(|&code| code == 0 || (262_139..=262_141).contains(&code))
    );
}

/// Triangles far beyond the guard band cover the same pixels as without clipping.
#[test]
fn the_guard_band_cuts_nothing_visible() {
    let mut random = Random(4);
    let mut clipped = 0;
    for _ in 0..40 {
        let mut camera = Camera::inside(&mut random);
        camera.eye = [0.0, -1.2, 0.0];
        (camera.u, camera.v, camera.n) = ([1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
        camera.half_width = 0.05;
        // One world unit is about 3,000 pixels wide, so most corners are thousands of pixels outside the picture.
        let mut triangle = [[0; 3]; 3].map(|_: [i16; 3]| {
            [0, 1, 2].map(|k| random.integer(-32768, 32767) as i16 / [1, 4, 1][k])
        });
        triangle[0] = [
            random.integer(-800, 800) as i16,
            0,
            random.integer(-400, 400) as i16,
        ];
        let view = camera.rounded();
        let picture = Picture::of(&Model::soup(&[triangle]), &view, SIZE, false);
        clipped += picture.stats.clipped;
        let corners = triangle.map(|p| Camera::of(&view).project(world(p), SIZE.0, SIZE.1));
        let area = |a: [f64; 3], b: [f64; 3], [x, y]: [f64; 2]| {
            (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
        };
        let sign = area(corners[0], corners[1], [corners[2][0], corners[2][1]]).signum();
        for (pixel, &code) in picture.depth.iter().enumerate() {
            let place = [(pixel % 320) as f64 + 0.5, (pixel / 320) as f64 + 0.5];
            let distance = (0..3)
                .map(|i| {
                    let (a, b) = (corners[i], corners[(i + 1) % 3]);
                    sign * area(a, b, place) / (b[0] - a[0]).hypot(b[1] - a[1])
                })
                .fold(f64::INFINITY, f64::min);
            assert!(
                distance.abs() < 3.0 / 256.0 || (distance > 0.0) == (code != 0),
                "{distance} at {place:?}"
            );
        }
    }
    assert!(clipped >= 30, "{clipped}");
}
