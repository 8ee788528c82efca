//! Tests of the built-in meshes.

use glint_core::mesh::Mesh;
use glint_core::shape::{MAX_BYTES, Shape};

fn bytes(shape: Shape) -> Vec<u8> {
    let mut memory = vec![0xA5; MAX_BYTES];
    let length = shape.write(&mut memory).expect("enough memory");
    memory.truncate(length);
    memory
}

#[test]
fn shapes_are_meshes() {
    for (shape, vertices, triangles) in [
        (Shape::Sphere, 576, 1024),
        (Shape::Torus, 544, 1024),
        (Shape::Cylinder, 640, 1024),
        (Shape::Polygons, 18, 6),
    ] {
        let bytes = bytes(shape);
        let mesh = Mesh::new_checked(&bytes).expect("a mesh");
        let counts = (mesh.vertex_count(), mesh.triangle_count());
        assert_eq!(counts, (vertices, triangles), "{shape}");
    }
}

/// Faces of round shapes point outwards by their vertex order and by their normals, and vertices have the normals of the surface.
#[test]
fn round_shapes_are_closed_and_look_outwards() {
    for shape in [Shape::Sphere, Shape::Torus, Shape::Cylinder] {
        let bytes = bytes(shape);
        let mesh = Mesh::new_checked(&bytes).expect("a mesh");
        let chunk = mesh.chunks().next().expect("a chunk");
        let mut volume = 0.0;
        let mut edges = std::collections::HashMap::new();
        for triangle in chunk.triangles() {
            let corners = triangle
                .indices
                .map(|index| chunk.vertex(index.into()).expect("a vertex"));
            let [a, b, c] = corners.map(|vertex| vertex.position.map(|x| f64::from(x) / 16384.0));
            volume += (a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
                / 6.0;
            for vertex in corners {
                let along: f64 = (0..3)
                    .map(|i| f64::from(vertex.normal[i]) * f64::from(triangle.normal[i]))
                    .sum::<f64>()
                    / f64::from(1 << 28);
                assert!(along > 0.9, "{shape}: {along}");
            }
            for i in 0..3 {
                let [from, to] = [i, (i + 1) % 3].map(|i| corners[i].position);
                *edges.entry((from.min(to), from.max(to))).or_insert(0) +=
                    if from < to { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|&sides| sides == 0), "{shape}");
        let expected = match shape {
            Shape::Sphere => 4.0 / 3.0 * std::f64::consts::PI / 8.0,
            Shape::Torus => 2.0 * std::f64::consts::PI.powi(2) * 0.35 * 0.15 * 0.15,
            _ => std::f64::consts::PI * 0.09,
        };
        // Flat faces lie inside the round surface.
        let ratio = volume / expected;
        assert!((0.95..1.0).contains(&ratio), "{shape}: {ratio}");
    }
}

#[test]
fn short_memory_is_refused() {
    for length in [0, 47, 48, 1000, 20_000] {
        assert_eq!(Shape::Sphere.write(&mut vec![0; length]), None, "{length}");
    }
}
