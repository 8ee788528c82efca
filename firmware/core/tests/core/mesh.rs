//! Tests of meshes: encoding, decoding and error messages.

use glint_core::mesh::{
    Attribute, EncodeError, IndexedTriangle, MAX_RADIUS, Mesh, MeshHeader, Rgb565, Triangle,
    Vertex, checksum, encode, encode_with, set_checksum, stated_checksum,
};
use glint_core::records::WORD;
use glint_core::texture::{self, Source};
use proptest::prelude::*;

fn vertex(i: u32) -> Vertex {
    let x = i.wrapping_mul(2_654_435_769);
    Vertex {
        position: [x >> 16, x >> 10, x >> 4].map(|x| (x as i16) >> 1),
        normal: [x >> 3, x >> 7, x >> 11].map(|x| x as i16),
        colour: Rgb565(x as u16),
        fine: (x >> 19) as u8,
    }
}

fn triangle(indices: [u32; 3]) -> IndexedTriangle {
    IndexedTriangle {
        indices,
        colour: Rgb565(indices[0] as u16),
        normal: indices.map(|x| !(x as i16)),
        texture: 0,
    }
}

/// Encodes a mesh of one chunk with four vertices and two triangles.
fn small() -> Vec<u8> {
    let vertices: Vec<Vertex> = (0..4).map(vertex).collect();
    encode(&vertices, &[triangle([0, 1, 2]), triangle([0, 2, 3])]).expect("a good mesh")
}

/// Returns the triangles of a mesh with vertices in place of indices.
fn triangles(mesh: &Mesh) -> Vec<([Vertex; 3], Rgb565, [i16; 3])> {
    let corner =
        |chunk: &glint_core::mesh::Chunk, i: u16| chunk.vertex(i.into()).expect("a checked index");
    mesh.chunks()
        .flat_map(|chunk| {
            chunk.triangles().map(move |triangle| {
                (
                    triangle.indices.map(|i| corner(&chunk, i)),
                    triangle.colour,
                    triangle.normal,
                )
            })
        })
        .collect()
}

/// A texture of 8×8 texels, RGB565, without mip levels.
fn texture(colour: u16) -> Vec<u8> {
    let levels = vec![vec![colour; 64]];
    let size_log2 = [3, 3];
    texture::encode(&Source {
        size_log2,
        levels,
        ..Source::default()
    })
    .expect("a good texture")
}

#[test]
fn textures_follow_the_arrays() {
    let vertices: Vec<Vertex> = (0..5).map(vertex).collect();
    let triangles = [triangle([4, 1, 2]), triangle([4, 2, 3])];
    let textured = triangles.map(|triangle| IndexedTriangle {
        texture: 2,
        ..triangle
    });
    let attributes = [(Attribute::TextureCoordinates, &[7; 40][..])];
    let textures = [texture(0x1234), texture(0x5678)];
    let encode =
        |textures| encode_with(&vertices, &textured, &attributes, textures).expect("a mesh");
    let bytes = encode(&textures);
    let mesh = Mesh::new_checked(&bytes).expect("a good mesh");
    let found: Vec<_> = mesh
        .textures()
        .map(|texture| texture.value(0, [5, 6]))
        .collect();
    assert_eq!(found, [0x1234, 0x5678]);
    let coordinates = mesh.attribute(Attribute::TextureCoordinates);
    assert_eq!(coordinates.map(<[u8]>::len), Some(4 * 8));
    let chunk = mesh.chunks().next().expect("a chunk");
    assert!(chunk.triangles().all(|triangle| triangle.texture == 2));

    // Vertices 4, 1, 2 and 3 are before the triangles.
    let number = MeshHeader::BYTES + WORD + 4 * WORD + Triangle::TEXTURE.start;
    let text = |bytes: &[u8]| Mesh::new_checked(bytes).map(drop).unwrap_err().to_string();
    for count in [0, 1] {
        let expected = format!("expected at most {count} (number of a texture), found 2");
        let expected = format!("mesh byte {}: {expected}", number + WORD);
        assert_eq!(text(&encode(&textures[..count])), expected);
    }
    let first = bytes.len() - 2 * textures[0].len();
    let mut wrong = bytes.clone();
    wrong[first + 12] = 1;
    assert_eq!(
        text(&wrong),
        format!(
            "mesh byte {}: texture byte 12: expected 3 to 10, the logarithm of a side, found 1",
            first + 12
        )
    );
    // The flag without textures.
    let mut wrong = encode_with(&vertices, &triangles, &[], &[]).expect("a mesh");
    wrong[MeshHeader::ATTRIBUTES.start + 3] = 0x80;
    let end = wrong.len();
    assert_eq!(
        text(&wrong),
        format!("mesh byte {end}: expected at least 16 bytes after the last chunk, found 0")
    );
}

/// An optional attribute is an array after the chunks: one element per vertex, in the order of the
/// chunks.
#[test]
fn an_optional_attribute_follows_the_chunks() {
    let vertices: Vec<Vertex> = (0..5).map(vertex).collect();
    let triangles = [triangle([4, 1, 2]), triangle([4, 2, 3])];
    let plain = encode(&vertices, &triangles).expect("a good mesh");
    let element = |vertex: u8| [vertex; 8];
    let elements = [0, 1, 2, 3, 4].map(element);
    let attributes = [(Attribute::TextureCoordinates, elements.as_flattened())];
    let bytes = encode_with(&vertices, &triangles, &attributes, &[]).expect("a good mesh");
    let mesh = Mesh::new_checked(&bytes).expect("a good mesh");
    let without = Mesh::new_checked(&plain).expect("a good mesh");
    assert_eq!(mesh.records(), without.records());
    assert_eq!(bytes.len(), plain.len() + 4 * 8);
    // Vertices are in the order of their first use; the first vertex of the input is unused and left out.
    let found = [4, 1, 2, 3].map(element);
    let attribute =
        |mesh: &Mesh| (mesh.attribute(Attribute::TextureCoordinates)).map(<[u8]>::to_vec);
    assert_eq!(attribute(&mesh), Some(found.as_flattened().to_vec()));
    assert_eq!(attribute(&without), None);

    let mut memory = vec![0; bytes.len()];
    let copy = mesh.copy_with_normals(&mut memory, &mut |normal| normal.map(|x| !x));
    let copy = copy.expect("enough memory");
    assert_eq!(Mesh::new_checked(copy.bytes()), Ok(copy));
    assert_eq!(attribute(&copy), attribute(&mesh));

    let mut short = bytes.clone();
    short.truncate(bytes.len() - 16);
    short[MeshHeader::LENGTH].copy_from_slice(&(bytes.len() as u32 - 16).to_le_bytes());
    let refused = Mesh::new_checked(&short).expect_err("an array that is too short");
    let expected = "expected 32 bytes after the last chunk, found 16";
    let expected = format!("mesh byte {}: {expected}", plain.len());
    assert_eq!(refused.to_string(), expected);
}

#[test]
fn a_small_mesh_comes_back() {
    let bytes = small();
    let mesh = Mesh::new_checked(&bytes).expect("a good mesh");
    let counts = (mesh.vertex_count(), mesh.triangle_count());
    assert_eq!((counts, mesh.chunks().count()), ((4, 2), 1));
    let chunk = mesh.chunks().next().expect("a chunk");
    assert_eq!((chunk.vertex_count(), chunk.triangle_count()), (4, 2));
    assert!(chunk.vertices().eq((0..4).map(vertex)));
    assert_eq!(chunk.vertex(3), Some(vertex(3)));
    assert_eq!(chunk.vertex(4), None);
    assert_eq!(
        chunk.triangle(1).map(|triangle| triangle.indices),
        Some([0, 2, 3])
    );
    assert_eq!(chunk.triangle(2), None);
    let squares = |i| vertex(i).position.map(|x| f64::from(x).powi(2));
    let lengths = (0..4).map(|i| squares(i).iter().sum::<f64>().sqrt());
    let farthest = lengths.fold(0.0, f64::max);
    assert_eq!(f64::from(mesh.radius()), farthest.ceil());
}

#[test]
fn the_layout_is_that_of_the_formats() {
    let vertices = [Vertex {
        position: [1, -2, 3],
        normal: [-4, 5, 0x4000],
        colour: Rgb565(0xF81F),
        fine: 0x42,
    }];
    let triangles = [IndexedTriangle {
        indices: [0; 3],
        colour: Rgb565(0x07E0),
        normal: [0x4000, 0, -1],
        texture: 0,
    }];
    #[rustfmt::skip]
    let expected = [
        b'G', b'L', b'M', b'2', 80, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0,
        1, 0, 0, 0, 4, 0, 0, 0, 25, 178, 99, 172, 0, 0, 0, 0,
        1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
        1, 0, 0xFE, 0xFF, 3, 0, 0xFC, 0xFF, 5, 0, 0, 0x40, 0x1F, 0xF8, 0x42, 0,
        0, 0, 0, 0, 0, 0, 0xE0, 0x07, 0, 0x40, 0, 0, 0xFF, 0xFF, 0, 0,
    ];
    assert_eq!(encode(&vertices, &triangles).unwrap(), expected);
}

/// A vertex keeps all 8 bits of each channel. A colour of RGB565, widened by bit replication, has the bytes of earlier meshes.
#[test]
fn colours_of_vertices_have_eight_bits() {
    for value in 0..=u8::MAX {
        for colour in [[value, 0xA5, 0], [255, value, 0x5A], [0x3C, 7, value]] {
            let vertex = vertex(3).with_rgb888(colour);
            let read = Vertex::from_bytes(&vertex.to_bytes());
            assert_eq!((read, read.rgb888()), (vertex, colour));
        }
    }
    for colour in (0..=u16::MAX).map(Rgb565) {
        let vertex = Vertex::default().with_rgb888(colour.to_rgb888());
        assert_eq!((vertex.colour, vertex.fine), (colour, 0));
    }
}

#[test]
fn a_large_mesh_is_cut_into_chunks_and_keeps_its_order() {
    let vertices: Vec<Vertex> = (0..150_000).map(vertex).collect();
    let list: Vec<IndexedTriangle> = (0..60_000)
        .map(|i: u32| triangle([0, 49_999, 100_003].map(|step| (i * 2 + step) % 150_000)))
        .collect();
    let bytes = encode(&vertices, &list).expect("a good mesh");
    let mesh = Mesh::new_checked(&bytes).expect("a good mesh");
    assert!(mesh.chunks().count() > 2);
    assert!(mesh.chunks().all(|chunk| chunk.vertex_count() <= 65_535));
    let expected: Vec<_> = list
        .iter()
        .map(|t| (t.indices.map(|i| vertices[i as usize]), t.colour, t.normal))
        .collect();
    assert!(triangles(&mesh) == expected);
}

#[test]
fn a_chunk_is_filled_to_the_last_vertex() {
    let vertices: Vec<Vertex> = (0..65_538).map(vertex).collect();
    let list: Vec<_> = (0..65_538 / 3)
        .map(|i| triangle([3 * i, 3 * i + 1, 3 * i + 2]))
        .collect();
    let counts = |list: &[_]| {
        let bytes = encode(&vertices, list).expect("a good mesh");
        let mesh = Mesh::new_checked(&bytes).expect("a good mesh");
        mesh.chunks()
            .map(|chunk| chunk.vertex_count())
            .collect::<Vec<_>>()
    };
    assert_eq!(counts(&list[..21_845]), [65_535]);
    assert_eq!(counts(&list), [65_535, 3]);
}

#[test]
fn what_cannot_be_written_is_refused() {
    assert_eq!(encode(&[], &[]), Err(EncodeError::NoVertex));
    let one = [vertex(1)];
    let triangles = [triangle([0; 3]), triangle([0, 1, 0])];
    for (vertices, number) in [(&[][..], 0), (&one, 1)] {
        let error = EncodeError::Index {
            triangle: number,
            index: number as u32,
            vertices: vertices.len(),
        };
        assert_eq!(encode(vertices, &triangles), Err(error));
    }
    let many = vec![triangle([0; 3]); 2 << 20];
    assert_eq!(encode(&one, &many), Err(EncodeError::TooLarge));
    let bytes = encode(&one, &[]).expect("a mesh without triangles");
    let mesh = Mesh::new_checked(&bytes).expect("a mesh");
    assert_eq!(mesh.triangle_count(), 0);
}

#[test]
fn the_largest_radius_holds_every_position() {
    let corner = Vertex {
        position: [i16::MIN; 3],
        ..Vertex::default()
    };
    let bytes = encode(&[corner], &[]).expect("a good mesh");
    assert_eq!(
        Mesh::new_checked(&bytes).map(|mesh| mesh.radius()),
        Ok(MAX_RADIUS)
    );
}

/// A flipped bit in any byte, including the checksum, is detected.
#[test]
fn the_checksum_covers_every_byte() {
    let good = small();
    assert_eq!(stated_checksum(&good), Some(checksum(&good)));
    for at in 0..good.len() {
        let mut bytes = good.clone();
        bytes[at] ^= 1 << (at % 8);
        assert_ne!(stated_checksum(&bytes), Some(checksum(&bytes)), "{at}");
        set_checksum(&mut bytes);
        assert_eq!(stated_checksum(&bytes), Some(checksum(&bytes)), "{at}");
    }
    let mut short = good[..31].to_vec();
    set_checksum(&mut short);
    assert_eq!((stated_checksum(&short), &short[..]), (None, &good[..31]));
}

/// The small mesh with one 32-bit word changed is refused with the stated message; `tools/reference/stiff` contains further cases.
#[test]
fn every_field_is_checked() {
    assert_eq!(small().len(), 144);
    let vertices = "at least 7 records for the chunk's vertices, found 6";
    let triangles = "at least 3 records for the chunk's triangles, found 2";
    for (at, word, place, expected) in [
        (16, 1, 16, "2 triangles, the sum of the chunks, found 1"),
        (32, 7, 32, vertices),
        (36, 3, 36, triangles),
        (36, 1, 128, "0 bytes after the last chunk, found 16"),
        (40, 9, 40, "0 (reserved), found 9"),
        (60, 1 << 24, 63, "0 (reserved), found 1"),
        (124, 1 << 24, 127, "0 (reserved), found 1"),
    ] {
        let mut bytes = small();
        let field = &mut bytes[at..at + 4];
        let found = u32::from_le_bytes([field[0], field[1], field[2], field[3]]);
        let word: u32 = if at < 48 { word } else { found | word };
        field.copy_from_slice(&word.to_le_bytes());
        let error = Mesh::new_checked(&bytes).expect_err(expected).to_string();
        assert_eq!(error, format!("mesh byte {place}: expected {expected}"));
    }
    let most = 32 << 20;
    let error = Mesh::new_checked(&vec![0; most + 16]).expect_err("too long");
    let expected = format!("expected at most {most} bytes, found {}", most + 16);
    assert_eq!(error.to_string(), format!("mesh byte 0: {expected}"));
}

#[test]
fn a_mesh_that_is_cut_off_is_refused_at_every_length() {
    let bytes = small();
    for length in 0..bytes.len() {
        assert!(Mesh::new_checked(&bytes[..length]).is_err(), "{length}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// An accepted mesh can be iterated to its end, and its counts are correct.
    #[test]
    fn no_bytes_upset_the_reader(changes in proptest::collection::vec((0..144_usize, any::<u8>()), 0..4), noise in any::<Vec<u8>>()) {
        let mut bytes = small();
        for (place, value) in changes {
            bytes[place] = value;
        }
        for bytes in [bytes, noise] {
            if let Ok(mesh) = Mesh::new_checked(&bytes) {
                prop_assert_eq!(triangles(&mesh).len(), mesh.triangle_count() as usize);
                prop_assert_eq!(mesh.chunks().map(|chunk| chunk.vertices().len()).sum::<usize>(), mesh.vertex_count() as usize);
            }
        }
    }
}
