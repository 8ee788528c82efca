//! Tests of the built-in meshes.

use glint_core::mesh::{Attribute, Mesh, Rgb565};
use glint_core::records::TextureCoordinates;
use glint_core::shape::{MAX_BYTES, Shape};
use glint_core::texture::Blend;

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
        (Shape::Crate, 24, 12),
        (Shape::Atrium, 544, 270),
    ] {
        let bytes = bytes(shape);
        let mesh = Mesh::new_checked(&bytes).expect("a mesh");
        let counts = (mesh.vertex_count(), mesh.triangle_count());
        assert_eq!(counts, (vertices, triangles), "{shape}");
    }
}

/// Faces of closed shapes point outwards by their vertex order and by their normals, and vertices have the normals of the surface.
#[test]
fn closed_shapes_look_outwards() {
    for shape in [Shape::Sphere, Shape::Torus, Shape::Cylinder, Shape::Crate] {
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
            Shape::Crate => 0.84_f64.powi(3),
            _ => std::f64::consts::PI * 0.09,
        };
        // Flat faces lie inside the round surface.
        let ratio = volume / expected;
        assert!((0.95..1.0).contains(&ratio), "{shape}: {ratio}");
    }
}

/// The pictures on the sides of the crate are upright, and smaller mip levels have about the brightness of larger ones.
#[test]
fn the_crate_has_a_texture() {
    let bytes = bytes(Shape::Crate);
    let mesh = Mesh::new_checked(&bytes).expect("a mesh");
    let places = mesh.attribute(Attribute::TextureCoordinates);
    let places = places.expect("coordinates").as_chunks().0;
    let chunk = mesh.chunks().next().expect("a chunk");
    for (place, vertex) in places.iter().zip(chunk.vertices()) {
        let TextureCoordinates { s, t } = TextureCoordinates::from_bytes(place);
        let [x, _, z] = vertex.position;
        if vertex.normal[2] == 0 {
            assert_eq!(t, if z > 0 { 0 } else { 1 << 16 });
        }
        // The sides perpendicular to the x axis have the star, which is in the right half of the texture.
        let half = if vertex.normal[0] == 0 { 0 } else { 1 << 15 };
        assert!(s == half || s == half + (1 << 15), "{x} {s}");
    }
    assert!(chunk.triangles().all(|triangle| triangle.texture == 1));
    let textures: Vec<_> = mesh.textures().collect();
    let [texture] = textures[..] else {
        panic!("one texture");
    };
    assert_eq!((texture.size_log2(), texture.levels()), ([7, 6], 8));
    let green = |level: u32| {
        let [width, height] = texture.level_log2(level).map(|side| 1 << side);
        let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let colours = places.map(|place| texture.colour(level, place).expect("opaque"));
        let light = colours.map(|Rgb565(colour)| f64::from(colour >> 5 & 63).powi(2));
        (light.sum::<f64>() / f64::from(width * height)).sqrt()
    };
    for level in 1..8 {
        assert!((green(level) - green(0)).abs() < 4.0, "{level}");
    }
}

/// The atrium has opaque, cut-out and blended textures. Blended faces come last, and each level of the cut-out texture has transparent
/// and opaque texels.
#[test]
fn the_atrium_has_textures() {
    let bytes = bytes(Shape::Atrium);
    let mesh = Mesh::new_checked(&bytes).expect("a mesh");
    let textures: Vec<_> = mesh.textures().collect();
    let blended: Vec<_> = (1..)
        .zip(&textures)
        .filter(|(_, texture)| texture.blend() != Blend::Opaque)
        .map(|(number, _)| number)
        .collect();
    assert_eq!((textures.len(), &blended[..]), (6, &[6_u8][..]));
    let chunk = mesh.chunks().next().expect("a chunk");
    let used: Vec<_> = chunk.triangles().map(|triangle| triangle.texture).collect();
    let first = used.iter().position(|number| blended.contains(number));
    let first = first.expect("glass");
    assert!(used[first..].iter().all(|number| blended.contains(number)));
    assert!((1..=6).all(|number| used.contains(&number)));
    for (number, texture) in textures.iter().enumerate() {
        for level in 0..4 {
            let [width, height] = texture.level_log2(level).map(|side| 1 << side);
            let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
            let opaque = places.filter(|&place| texture.colour(level, place).is_some());
            let share = opaque.count() as f64 / f64::from(width * height);
            // The leaves cover less than half of their picture, with about the same share in smaller levels.
            let expected = if number == 3 { 0.2..0.45 } else { 1.0..1.1 };
            assert!(expected.contains(&share), "{number} {level}: {share}");
        }
    }
}

#[test]
fn short_memory_is_refused() {
    for length in [0, 47, 48, 1000, 20_000] {
        for shape in [Shape::Sphere, Shape::Crate, Shape::Atrium] {
            assert_eq!(shape.write(&mut vec![0; length]), None, "{length}");
        }
    }
}
