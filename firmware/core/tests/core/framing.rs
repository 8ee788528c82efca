//! Tests of cameras that show whole meshes, against computations in f64.

use glint_core::camera::{HALF_WIDTH, View};
use glint_core::fixed::{Q8_24, Q32_32, Turns};
use glint_core::framing::{BoundingSphere, FramingError, fill};
use glint_core::matrix::{Axis, Matrix};
use glint_core::mesh::{IndexedTriangle, Mesh, Vertex, encode};
use proptest::prelude::*;

type Vector = [f64; 3];

fn mesh(points: &[[i16; 3]]) -> Vec<u8> {
    let vertices = points.iter().map(|&position| Vertex {
        position,
        ..Vertex::default()
    });
    // The encoder leaves out vertices without a triangle, so each vertex gets a triangle.
    let triangles = (0..points.len() as u32).map(|i| IndexedTriangle {
        indices: [i; 3],
        ..IndexedTriangle::default()
    });
    encode(
        &vertices.collect::<Vec<_>>(),
        &triangles.collect::<Vec<_>>(),
    )
    .expect("a mesh of points")
}

fn sphere(meshes: &[(&[u8], Matrix)]) -> Option<BoundingSphere> {
    let meshes = meshes
        .iter()
        .map(|(bytes, matrix)| (Mesh::new_checked(bytes).expect("a mesh"), *matrix));
    BoundingSphere::around(meshes)
}

fn length(v: Vector) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// The centre of the bounding box of points, and the distance of the farthest point from the centre.
fn exact(points: &[Vector]) -> (Vector, f64) {
    let centre = [0, 1, 2].map(|i| {
        let values = points.iter().map(|point| point[i]);
        (values.clone().fold(f64::INFINITY, f64::min) + values.fold(f64::NEG_INFINITY, f64::max))
            / 2.0
    });
    let distances = points
        .iter()
        .map(|point| length([0, 1, 2].map(|i| point[i] - centre[i])));
    (centre, distances.fold(0.0, f64::max))
}

/// Checks that the camera looks at the centre, with `up` up, and that the sphere fills 80 % of the height. Returns the distance of the eye
/// from the centre.
fn check(view: &View, (centre, radius): (Vector, f64), up: Axis) -> f64 {
    let eye = view.eye().map(|x| x.to_num::<f64>());
    let [u, v, n] = [view.u(), view.v(), view.n()].map(|row| row.map(|x| x.to_num::<f64>()));
    let to = [0, 1, 2].map(|i| centre[i] - eye[i]);
    let distance = length(to);
    assert!((dot(to, n) - distance).abs() < 1e-5 && length(eye) < 7.91);
    let axis = [Axis::X, Axis::Y, Axis::Z].map(|other| f64::from(u8::from(other == up)));
    assert!(dot(axis, u).abs() < 1e-6, "{u:?}");
    // The angle from the up axis is 60°.
    assert!((dot(axis, n) + 0.5).abs() < 1e-6 && dot(axis, v) < 0.0);
    let half_height = view.half_width().to_num::<f64>() * 9.0 / 16.0;
    let part = radius / (distance.powi(2) - radius.powi(2)).sqrt() / half_height;
    let is_limited = view.half_width() == HALF_WIDTH[0];
    assert!(is_limited || (part - 0.8).abs() < 1e-3, "{part}");
    distance
}

proptest! {
    #[test]
    fn the_sphere_takes_four_fifths_of_the_height(
        points in prop::collection::vec(prop::array::uniform3(-16_384_i16..=16_384), 2..20),
        place in prop::array::uniform3(-2.0..2.0),
        scale in 0.1..2.0,
        up in prop::sample::select(&[Axis::X, Axis::Y, Axis::Z][..]),
        turned: u32,
    ) {
        let matrix = Matrix::scale([Q8_24::from_num(scale); 3])
            .and_then(|matrix| matrix.then(&Matrix::translation(place.map(Q8_24::from_num))?))
            .expect("a matrix");
        let placed: Vec<Vector> = points
            .iter()
            .map(|point| [0, 1, 2].map(|i| f64::from(point[i]) / 16_384.0 * scale + place[i]))
            .collect();
        let bytes = mesh(&points);
        let sphere = sphere(&[(&bytes, matrix)]).expect("points");
        let exact = exact(&placed);
        let framed = sphere.framed(up, Turns(turned), None);
        // Some allowed position of the eye is outside of the sphere.
        let has_room = length(exact.0) + exact.1 + 0.2 < 7.899;
        prop_assert!(framed.is_ok() == has_room || (length(exact.0) + exact.1 - 7.7).abs() < 0.01);
        if let Ok(view) = framed {
            let distance = check(&view, exact, up);
            let wanted = (3.5 * exact.1).max(exact.1 + 0.2).min(7.9 - length(exact.0));
            prop_assert!((distance - wanted).abs() < 1e-4, "{} {}", distance, wanted);
        }
    }
}

/// Returns the largest distance of a point from the middle of a 16:9 picture, as a part of the half width or of the half height.
fn largest_part(view: &View, points: &[Vector]) -> f64 {
    let eye = view.eye().map(|x| x.to_num::<f64>());
    let axes = [view.u(), view.v(), view.n()].map(|row| row.map(|x| x.to_num::<f64>()));
    let half_width = view.half_width().to_num::<f64>();
    let parts = points.iter().map(|point| {
        let [right, down, forward] =
            axes.map(|axis| dot(axis, [0, 1, 2].map(|i| point[i] - eye[i])));
        (right.abs() / half_width).max(down.abs() / (half_width * 9.0 / 16.0)) / forward
    });
    parts.fold(0.0, f64::max)
}

proptest! {
    /// All cameras of a turn show all vertices in the middle 90 % of the picture, and one of them shows a vertex at its border.
    #[test]
    fn a_turn_of_cameras_is_filled(
        points in prop::collection::vec(prop::array::uniform3(-16_384_i16..=16_384), 2..20),
        scale in 0.01..2.0,
        cameras in 1_u32..5,
    ) {
        let matrix = Matrix::scale([Q8_24::from_num(scale); 3]).expect("a matrix");
        let placed: Vec<Vector> = points
            .iter()
            .map(|point| point.map(|x| f64::from(x) / 16_384.0 * scale))
            .collect();
        let bytes = mesh(&points);
        let sphere = sphere(&[(&bytes, matrix)]).expect("points");
        let turned = (0..cameras).map(|turn| Turns(turn * (u32::MAX / cameras)));
        let mut views: Vec<View> = turned
            .map(|turned| sphere.framed(Axis::Z, turned, None).expect("near the origin"))
            .collect();
        fill(&mut views, [(Mesh::new_checked(&bytes).expect("a mesh"), matrix)].into_iter())
            .expect("in range");
        let half_width = views[0].half_width();
        prop_assert!(views.iter().all(|view| view.half_width() == half_width));
        let parts = views.iter().map(|view| largest_part(view, &placed));
        let largest = parts.fold(0.0, f64::max);
        let is_limited = half_width == HALF_WIDTH[0];
        prop_assert!(largest < 0.9001 && (is_limited || largest > 0.899), "{}", largest);
    }
}

#[test]
fn the_eye_goes_around_the_axis() {
    let bytes = mesh(&[[16_384, 0, 0], [-16_384, 0, 0]]);
    let sphere = sphere(&[(&bytes, Matrix::IDENTITY)]).unwrap();
    let eye = |up, turned| {
        let view = sphere.framed(up, turned, None).unwrap();
        view.eye().map(|x| x.to_num::<f64>())
    };
    let at = |azimuth: f64| {
        let (sin, cos) = azimuth.to_radians().sin_cos();
        let across = 3.5 * 60_f64.to_radians().sin();
        [across * cos, across * sin, 3.5 / 2.0]
    };
    let close = |a: Vector, b: Vector| length([0, 1, 2].map(|i| a[i] - b[i])) < 1e-5;
    assert!(close(eye(Axis::Z, Turns(0)), at(30.0)));
    assert!(close(eye(Axis::Z, Turns::QUARTER), at(120.0)));
    let [x, y, z] = at(30.0);
    assert!(close(eye(Axis::Y, Turns(0)), [y, z, x]));
    assert!(close(eye(Axis::X, Turns(0)), [z, x, y]));
}

#[test]
fn a_field_of_view_moves_the_eye() {
    let bytes = mesh(&[[8_192, 0, 0], [-8_192, 0, 0]]);
    let sphere = sphere(&[(&bytes, Matrix::IDENTITY)]).unwrap();
    let angle = |degrees| Turns::from_degrees(Q32_32::from_num(degrees));
    for degrees in [20.0, 60.0, 100.0_f64] {
        let view = sphere.framed(Axis::Z, Turns(0), Some(angle(degrees)));
        let view = view.unwrap();
        let half_width = (degrees / 2.0).to_radians().tan();
        assert!((view.half_width().to_num::<f64>() - half_width).abs() < 1e-6);
        check(&view, ([0.0; 3], 0.5), Axis::Z);
    }
    // The eye stays outside of the sphere, and within the largest distance for meshes.
    for (degrees, expected) in [(170.0, 0.7), (1.0, 7.9)] {
        let view = sphere.framed(Axis::Z, Turns(0), Some(angle(degrees)));
        let eye = view.unwrap().eye().map(|x| x.to_num::<f64>());
        assert!((length(eye) - expected).abs() < 1e-4, "{degrees}");
    }
    for degrees in [0.0, 0.5, 180.0, 200.0, 359.0] {
        let error = sphere.framed(Axis::Z, Turns(0), Some(angle(degrees)));
        assert!(matches!(error, Err(FramingError::View(_))), "{degrees}");
    }
}

#[test]
fn all_meshes_are_within_the_sphere() {
    assert_eq!(sphere(&[]), None);
    let bytes = mesh(&[[0, 0, 0], [16_384, 0, 0]]);
    let moved = |x: i32| Matrix::translation([x, 0, 0].map(Q8_24::from_num)).unwrap();
    let both = sphere(&[(&bytes, moved(0)), (&bytes, moved(1))]);
    let one = sphere(&[(&mesh(&[[0, 0, 0], [32_767, 0, 0]]), Matrix::IDENTITY)]);
    let eye = |sphere: Option<BoundingSphere>| {
        let view = sphere.unwrap().framed(Axis::Z, Turns(0), None).unwrap();
        view.eye().map(|x| x.to_num::<f64>())
    };
    let (a, b) = (eye(both), eye(one));
    assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-3), "{a:?} {b:?}");
}
