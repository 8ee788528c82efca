//! Tests of clipping to the six planes of the view volume, compared with a clipper in f64.

use glint_core::camera::Projection;
use glint_core::fixed::U8_28;
use glint_core::picture::Size;
use glint_model::triangle::clip::Plane;
use glint_model::triangle::vertex::{CameraVertex, snap, transform};
use glint_model::triangle::volume::Volume;
use glint_model::{Clip, Frame, MeshSetup, MeshSubject, SIZES, Subject};
use glint_vectors::{Camera, Model, Picture, Random};

use crate::{RADII, clipped, mesh_of, random_vertex};

/// A vertex: pixels from the middle of the picture (in perspective at distance 1), and depth in world units.
type Point = [f64; 3];

fn view_of(far: f64) -> Clip {
    Clip::View {
        far: U8_28::from_num(far),
    }
}

fn random_frame(random: &mut Random) -> MeshSetup {
    let (width, height) = SIZES[random.integer(0, 2) as usize];
    let projection = Projection::ALL[random.integer(0, 1) as usize];
    let view = Camera::inside(random).rounded().with_projection(projection);
    let far = view.near().to_num::<f64>() + random.logarithmic(0.05, 4.0);
    let frame = MeshSetup::new(&view, width, height, RADII[1]).unwrap();
    frame.with_clip(view_of(far)).unwrap()
}

fn point(frame: &MeshSetup, vertex: &CameraVertex) -> Point {
    let unit = 0.5f64.powi(14 + frame.scale_shift as i32);
    [
        vertex.x as f64 * unit,
        vertex.y as f64 * unit,
        vertex.z as f64 * 0.5f64.powi(37),
    ]
}

/// The homogeneous coordinate w of a vertex.
fn divisor(frame: &MeshSetup, [_, _, z]: Point) -> f64 {
    match frame.projection {
        Projection::Perspective => z,
        Projection::Orthographic => 1.0,
    }
}

/// Clips a polygon to −w ≤ x, y ≤ w and near ≤ z ≤ far in homogeneous coordinates.
fn reference(frame: &MeshSetup, far: f64, triangle: [Point; 3]) -> Vec<Point> {
    let near = frame.near as f64 * 0.5f64.powi(37);
    let [half_width, half_height] = [frame.width, frame.height].map(|size| f64::from(size) / 2.0);
    let distances: [&dyn Fn(Point) -> f64; 6] = [
        &|[_, _, z]| z - near,
        &|[_, _, z]| far - z,
        &|p| half_width * divisor(frame, p) + p[0],
        &|p| half_width * divisor(frame, p) - p[0],
        &|p| half_height * divisor(frame, p) + p[1],
        &|p| half_height * divisor(frame, p) - p[1],
    ];
    let mut polygon = triangle.to_vec();
    for distance in distances {
        let mut left = Vec::new();
        for (i, &to) in polygon.iter().enumerate() {
            let from = polygon[(i + polygon.len() - 1) % polygon.len()];
            let (a, b) = (distance(from), distance(to));
            if (a >= 0.0) != (b >= 0.0) {
                left.push([0, 1, 2].map(|k| from[k] + (to[k] - from[k]) * a / (a - b)));
            }
            if b >= 0.0 {
                left.push(to);
            }
        }
        polygon = left;
    }
    polygon
}

/// On the screen, vertices of clipped polygons are within 1/256 pixel of the vertices of a clipper in f64.
#[test]
fn vertices_against_f64() {
    let mut random = Random(20);
    let (mut worst, mut vertices, mut most, mut unlike) = (0.0_f64, 0, 0, 0);
    for _ in 0..100_000 {
        let frame = random_frame(&mut random);
        let far = match frame.volume {
            Volume::View { far } => far as f64 * 0.5f64.powi(37),
            other => panic!("{other:?}"),
        };
        let triangle = [0; 3].map(|_| random_vertex(&mut random, &frame));
        let polygon = clipped(&frame, triangle);
        let expected = reference(&frame, far, triangle.each_ref().map(|v| point(&frame, v)));
        most = most.max(polygon.len());
        // If a vertex is closer to a plane than the rounding error of f64, the clippers may disagree whether the vertex is inside.
        if polygon.len() != expected.len() {
            unlike += 1;
            continue;
        }
        let pixels = |point: Point| {
            let w = divisor(&frame, point);
            [
                f64::from(frame.width) / 2.0 + point[0] / w,
                f64::from(frame.height) / 2.0 + point[1] / w,
            ]
        };
        let expected: Vec<_> = expected.into_iter().map(pixels).collect();
        for vertex in &polygon {
            let place = snap(&frame, vertex);
            let distance = |at: &[f64; 2]| {
                let [x, y] = [place.x, place.y].map(f64::from);
                (x - 256.0 * at[0]).abs().max((y - 256.0 * at[1]).abs())
            };
            let nearest = expected.iter().map(distance).fold(f64::INFINITY, f64::min);
            worst = worst.max(nearest);
            vertices += 1;
        }
    }
    println!(
        "{vertices} vertices, largest error {worst:.3}/256 pixel, polygons of up to {most} vertices, {unlike} unlike polygons"
    );
    assert!(vertices > 60_000 && most <= 9 && unlike == 0);
    assert!(worst <= 1.0, "{worst}");
}

/// Clipping two triangles that share an edge leaves the same part of the edge, with the same end vertices, so no pixel on the edge is
/// missing or drawn twice.
///
/// The environment variable `GLINT_PAIRS` sets the number of pairs.
#[test]
fn neighbours_have_no_cracks() {
    let pairs = std::env::var("GLINT_PAIRS").map_or(50_000, |text| text.parse().expect("a number"));
    let mut random = Random(21);
    let (mut cut, mut cracks) = (0, 0);
    for round in 0..pairs {
        let frame = match random_frame(&mut random) {
            frame if round % 2 == 0 => frame,
            frame => frame.with_clip(Clip::Guard).unwrap(),
        };
        let [a, b, c, d] = [0; 4].map(|_| random_vertex(&mut random, &frame));
        let ends = clipped(&frame, [a, b, b]);
        let (left, right) = (clipped(&frame, [a, b, c]), clipped(&frame, [b, a, d]));
        let distinct: Vec<_> = (0..ends.len())
            .filter(|&i| !ends[..i].contains(&ends[i]))
            .map(|i| ends[i])
            .collect();
        let &[p, q] = distinct.as_slice() else {
            // At most one point of the edge is inside the volume.
            assert!(distinct.len() < 2);
            continue;
        };
        cut += u32::from([p, q].iter().any(|end| *end != a && *end != b));
        let has = |vertices: &[CameraVertex], p: CameraVertex, q: CameraVertex| {
            (0..vertices.len()).any(|i| vertices[i] == p && vertices[(i + 1) % vertices.len()] == q)
        };
        let forward = |vertices: &[CameraVertex]| has(vertices, p, q);
        let backward = |vertices: &[CameraVertex]| has(vertices, q, p);
        let fits = forward(&left) && backward(&right) || backward(&left) && forward(&right);
        cracks += u32::from(!fits);
    }
    println!("{pairs} pairs of triangles, {cut} with a clipped edge, {cracks} cracks");
    assert!(cracks == 0 && cut > pairs / 10);
}

/// A camera at the origin that looks along y. At the distance 1, the left and the right side of the view volume are at ±0.9.
fn level_frame() -> MeshSetup {
    let camera = Camera {
        eye: [0.0; 3],
        u: [1.0, 0.0, 0.0],
        v: [0.0, 0.0, -1.0],
        n: [0.0, 1.0, 0.0],
        half_width: 0.9,
        near: 0.1,
    };
    let frame = MeshSetup::new(&camera.rounded(), 320, 180, RADII[1]).unwrap();
    frame.with_clip(view_of(1.5)).unwrap()
}

#[test]
fn nothing_is_left_outside_a_plane() {
    let frame = level_frame();
    let at = |[x, y, z]: [f64; 3]| transform(&frame, [x, y, z].map(|c| (c * 16384.0) as i16));
    let triangle = |offset: [f64; 3]| {
        [[0.0, 0.0, 0.0], [0.2, 0.1, 0.0], [0.0, 0.1, 0.2]]
            .map(|p: [f64; 3]| at([0, 1, 2].map(|i| p[i] + offset[i])))
    };
    assert_eq!(clipped(&frame, triangle([0.0, 0.7, 0.0])).len(), 3);
    for (plane, offset) in [
        (Plane::Near, [0.0, -0.15, 0.0]),
        (Plane::Far, [0.0, 1.6, 0.0]),
        (Plane::Left, [-1.2, 0.7, 0.0]),
        (Plane::Right, [1.0, 0.7, 0.0]),
        (Plane::Top, [0.0, 0.7, 0.8]),
        (Plane::Bottom, [0.0, 0.7, -0.9]),
    ] {
        let vertices = triangle(offset);
        assert!(vertices.iter().all(|v| plane.distance(&frame, v) < 0));
        assert!(clipped(&frame, vertices).is_empty(), "{plane:?}");
    }
}

/// Clipping to the six planes and to the guard band give the same picture, except for pixels at edges cut by the picture's sides.
#[test]
fn both_clips_draw_the_same_picture() {
    let mut random = Random(22);
    let (mut differing, mut pixels, mut clipped) = (0, 0, 0);
    for _ in 0..40 {
        let view = Camera::inside(&mut random).rounded();
        let mesh = mesh_of(&Model::random(&mut random, 20, 32768));
        let [guard, volume] = [Clip::Guard, view_of(100.0)].map(|clip| {
            let subject = Subject::Mesh(MeshSubject {
                cull: false,
                clip,
                ..MeshSubject::new(mesh)
            });
            Picture::of_frame(&Frame::new(subject, view, Size::W320))
        });
        differing += (0..guard.depth.len())
            .filter(|&i| (guard.depth[i] == 0) != (volume.depth[i] == 0))
            .count();
        pixels += guard.depth.len();
        clipped += volume.stats.clipped;
    }
    println!("{differing} of {pixels} pixels differ in coverage, {clipped} triangles clipped");
    assert!(clipped > 300 && differing < pixels / 10_000, "{differing}");
}
