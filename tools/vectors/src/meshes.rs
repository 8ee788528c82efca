//! Meshes of triangles that share no vertices, and a square with a texture, as bytes of the mesh format (docs/formats/mesh.md, "Mesh in
//! memory").

use std::f64::consts::{PI, TAU};

use glint_core::camera::View;
use glint_core::mesh::{self, Attribute, ChunkHeader, IndexedTriangle, MeshHeader, Rgb565, Vertex};
use glint_core::records::TextureCoordinates;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::camera::Camera;

/// One world unit in mesh coordinates (Q2.14).
pub const ONE: i32 = 1 << 14;

/// A triangle: the positions of its corners in Q2.14, and its RGB565 colour.
pub type Triangle = ([[i16; 3]; 3], u16);

/// Encodes a mesh of `triangles`, each with its own three vertices, in chunks of at most `most` vertices.
pub fn mesh(triangles: &[Triangle], most: usize) -> Vec<u8> {
    let mut body = Vec::new();
    let per_chunk = most / 3;
    let chunks: Vec<&[Triangle]> = match triangles {
        [] => vec![&[]],
        some => some.chunks(per_chunk).collect(),
    };
    let mut vertices = 0;
    for chunk in &chunks {
        // A chunk needs at least one vertex, so a chunk without triangles gets an unused vertex.
        let count = (3 * chunk.len()).max(1);
        vertices += count;
        let header = ChunkHeader {
            vertices: count as u32,
            triangles: chunk.len() as u32,
        };
        body.extend(header.to_bytes());
        let corners = chunk.iter().flat_map(|(corners, _)| *corners);
        // Vertices get random normals of any length and random colours, which only smooth shading uses.
        let mut random = Pcg64Mcg::new(count as u128);
        for position in corners.chain(std::iter::repeat([0; 3])).take(count) {
            let reach = [1 << 7, 1 << 13, i16::MAX][random.random_range(0..3)];
            let vertex = Vertex {
                position,
                normal: [(); 3].map(|()| random.random_range(-reach..=reach)),
                colour: Rgb565(random.random()),
                fine: random.random(),
            };
            body.extend(vertex.to_bytes());
        }
        for (number, (corners, colour)) in (0_u16..).zip(*chunk) {
            let triangle = mesh::Triangle {
                texture: 0,
                indices: [0, 1, 2].map(|corner| 3 * number + corner),
                colour: Rgb565(*colour),
                // A triangle's normal only dims its colour, so any vector can be used: here the position of a corner.
                normal: corners[0],
            };
            body.extend(triangle.to_bytes());
        }
    }
    let radius = triangles
        .iter()
        .flat_map(|(corners, _)| *corners)
        .map(|corner| corner.map(|c| f64::from(c).powi(2)).iter().sum::<f64>())
        .fold(0.0, f64::max)
        .sqrt()
        .ceil();
    let header = MeshHeader {
        magic: mesh::MAGIC,
        length: (MeshHeader::BYTES + body.len()) as u32,
        chunks: chunks.len() as u32,
        vertices: vertices as u32,
        triangles: triangles.len() as u32,
        radius: radius as u32,
        checksum: 0,
        attributes: 0,
    };
    [header.to_bytes().to_vec(), body].concat()
}

/// Camera at (0, -2, 0) that looks along +y: a point (x, y, z) has depth y + 2; larger x is farther right, larger z is higher.
pub fn ahead(half_width: f64, near: f64) -> View {
    let camera = Camera {
        eye: [0.0, -2.0, 0.0],
        u: [1.0, 0.0, 0.0],
        v: [0.0, 0.0, -1.0],
        n: [0.0, 1.0, 0.0],
        half_width,
        near,
    };
    camera.rounded()
}

/// Converts a point from world units to mesh coordinates.
pub fn at(x: f64, y: f64, z: f64) -> [i16; 3] {
    [x, y, z].map(|c| (c * f64::from(ONE)).round() as i16)
}

/// Makes `count` random triangles of about `size` world units each at random positions.
pub fn random(random: &mut Pcg64Mcg, count: usize, size: f64) -> Vec<Triangle> {
    let reach = (size * f64::from(ONE)) as i32;
    (0..count)
        .map(|_| {
            let centre: [i32; 3] = std::array::from_fn(|_| random.random_range(-ONE..ONE));
            let corners = [(); 3].map(|()| {
                centre.map(|c| {
                    (c + random.random_range(-reach..=reach)).clamp(-2 * ONE, 2 * ONE - 1) as i16
                })
            });
            (corners, random.random())
        })
        .collect()
}

/// A white square from (−2, −2, 0) to (2, 2, 0) with one texture, or with a texture for each of its halves. A texture has `repeats` repeats
/// per world unit.
///
/// # Panics
/// If the textures are too large for a mesh.
pub fn textured_square(textures: &[Vec<u8>], repeats: f64) -> Vec<u8> {
    squares(&[(0.0, [1, textures.len() as u8])], textures, repeats)
}

/// A square like [`textured_square`] for each texture. The first texture has the lowest square; the squares are `gap` world units apart.
///
/// # Panics
/// If the textures are too large for a mesh, or a square is above 2 world units.
pub fn textured_layers(textures: &[Vec<u8>], repeats: f64, gap: f64) -> Vec<u8> {
    let numbers = 1..=textures.len() as u8;
    let layers: Vec<_> = numbers
        .map(|number| (gap * f64::from(number - 1), [number; 2]))
        .collect();
    squares(&layers, textures, repeats)
}

/// A mesh of squares. Each layer is the height of a square, and the texture numbers of its two halves.
fn squares(layers: &[(f64, [u8; 2])], textures: &[Vec<u8>], repeats: f64) -> Vec<u8> {
    let corners = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let up = [0, 0, 1 << 14];
    let (mut vertices, mut elements, mut triangles) = (vec![], vec![], vec![]);
    for &(height, numbers) in layers {
        let first = vertices.len() as u32;
        vertices.extend(corners.map(|[x, y]: [f64; 2]| Vertex {
            position: [x, y, height].map(|c| (c * 16_383.0) as i16),
            normal: up,
            colour: Rgb565::WHITE,
            fine: 0,
        }));
        elements.extend(corners.map(|corner| {
            let [s, t] = corner.map(|c| (c * repeats * 65_536.0) as i32);
            TextureCoordinates { s, t }.to_bytes()
        }));
        let halves = [[0, 1, 2], [0, 2, 3]].into_iter().zip(numbers);
        triangles.extend(halves.map(|(indices, texture)| IndexedTriangle {
            indices: indices.map(|index| first + index),
            colour: Rgb565::WHITE,
            normal: up,
            texture,
        }));
    }
    let attributes = [(Attribute::TextureCoordinates, elements.as_flattened())];
    mesh::encode_with(&vertices, &triangles, &attributes, textures).unwrap()
}

/// A mesh about the origin with a texture wrapped around it. Seen from -y, the seam of the texture is at the back.
///
/// # Panics
/// If the texture is too large for a mesh.
pub fn wrapped(mesh: &mesh::Mesh, texture: Vec<u8>) -> Vec<u8> {
    let (mut vertices, mut triangles) = (vec![], vec![]);
    for chunk in mesh.chunks() {
        let first = vertices.len() as u32;
        vertices.extend(chunk.vertices());
        triangles.extend(chunk.triangles().map(|triangle| IndexedTriangle {
            indices: triangle.indices.map(|index| first + u32::from(index)),
            colour: Rgb565::WHITE,
            normal: triangle.normal,
            texture: 1,
        }));
    }
    let elements: Vec<_> = (vertices.iter())
        .map(|vertex| {
            let [x, y, z] = vertex.position.map(f64::from);
            let (longitude, latitude) = (x.atan2(-y), z.atan2(x.hypot(y)));
            let [s, t] = [longitude / TAU + 0.5, 0.5 - latitude / PI];
            let [s, t] = [s, t].map(|c| (c * 65_536.0) as i32);
            TextureCoordinates { s, t }.to_bytes()
        })
        .collect();
    let attributes = [(Attribute::TextureCoordinates, elements.as_flattened())];
    mesh::encode_with(&vertices, &triangles, &attributes, &[texture]).unwrap()
}
