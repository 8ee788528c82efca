//! Encoding of meshes (docs/formats/mesh.md, "Mesh in memory"), for hosts with a heap.

use alloc::vec::Vec;
use core::fmt;

use super::{
    Attribute, ChunkHeader, MAGIC, MAX_BYTES, MAX_CHUNK_VERTICES, MeshHeader, Rgb565, Triangle,
    Vertex, set_checksum,
};
use crate::records::{TEXTURES, WORD};

/// A triangle of an indexed mesh of any size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct IndexedTriangle {
    /// Indices of the vertices in the mesh, counter-clockwise seen from outside.
    pub indices: [u32; 3],
    /// Colour of the triangle.
    pub colour: Rgb565,
    /// Normal of the triangle, s2.14.
    pub normal: [i16; 3],
    /// Number of its texture, from 1; 0 for none.
    pub texture: u8,
}

/// Encodes an indexed mesh, divided into chunks of at most 65,535 vertices.
///
/// Triangles keep their order. A vertex is repeated in every chunk that uses it. A vertex that no triangle uses is left out. A
/// mesh without triangles keeps its first vertex, because a chunk has at least one vertex.
///
/// # Errors
/// The mesh has no vertex, a triangle uses a missing vertex, or the encoded mesh exceeds [`MAX_BYTES`].
pub fn encode(vertices: &[Vertex], triangles: &[IndexedTriangle]) -> Result<Vec<u8>, EncodeError> {
    encode_with(vertices, triangles, &[], &[])
}

/// Encodes an indexed mesh with optional attributes, in the order of their numbers, and with textures. Each attribute has one element
/// per vertex. Missing elements are 0. The bytes of textures are not checked.
///
/// # Errors
/// The errors of [`encode`].
pub fn encode_with(
    vertices: &[Vertex],
    triangles: &[IndexedTriangle],
    attributes: &[(Attribute, &[u8])],
    textures: &[Vec<u8>],
) -> Result<Vec<u8>, EncodeError> {
    let mut writer = Writer {
        textures,
        arrays: attributes
            .iter()
            .map(|&(attribute, elements)| (attribute, elements, Vec::new()))
            .collect(),
        ..Writer::default()
    };
    // For each vertex of the mesh: its index in the current chunk; `None` if the chunk does not have the vertex.
    let mut local = alloc::vec![None; vertices.len()];
    let mut used: Vec<u32> = Vec::new();
    let mut records: Vec<[u8; WORD]> = Vec::new();
    for (number, triangle) in triangles.iter().enumerate() {
        let new = triangle
            .indices
            .iter()
            .filter(|&&i| local.get(i as usize).is_some_and(Option::is_none))
            .count();
        if used.len() + new > MAX_CHUNK_VERTICES as usize {
            writer.chunk(vertices, &used, &records)?;
            used.drain(..).for_each(|i| local[i as usize] = None);
            records.clear();
        }
        let mut indices = [0; 3];
        for (index, &global) in indices.iter_mut().zip(&triangle.indices) {
            let place = local.get_mut(global as usize).ok_or(EncodeError::Index {
                triangle: number,
                index: global,
                vertices: vertices.len(),
            })?;
            *index = *place.get_or_insert_with(|| {
                used.push(global);
                // The conversion to 16 bits is exact, because the check above limits the index to 65,534.
                (used.len() - 1) as u16
            });
        }
        let record = Triangle {
            indices,
            colour: triangle.colour,
            normal: triangle.normal,
            texture: triangle.texture,
        };
        records.push(record.to_bytes());
    }
    if used.is_empty() {
        if vertices.is_empty() {
            return Err(EncodeError::NoVertex);
        }
        used.push(0);
    }
    writer.chunk(vertices, &used, &records)?;
    Ok(writer.finish())
}

/// The encoded chunks, and the sums over all chunks that the mesh's header needs.
#[derive(Default)]
struct Writer<'a> {
    records: Vec<[u8; WORD]>,
    /// For each attribute the elements of the mesh's vertices, and the elements of the chunks' vertices.
    arrays: Vec<(Attribute, &'a [u8], Vec<u8>)>,
    textures: &'a [Vec<u8>],
    chunks: u32,
    vertices: u32,
    triangles: u32,
    squared_radius: u32,
}

impl Writer<'_> {
    fn chunk(
        &mut self,
        vertices: &[Vertex],
        used: &[u32],
        triangles: &[[u8; WORD]],
    ) -> Result<(), EncodeError> {
        let records = self.records.len() + 1 + used.len() + triangles.len();
        let arrays: usize = (self.arrays.iter())
            .map(|(attribute, _, array)| array.len() + attribute.bytes() * used.len() + WORD)
            .sum();
        let textures: usize = self.textures.iter().map(Vec::len).sum();
        if MeshHeader::BYTES + WORD * records + arrays + textures > MAX_BYTES as usize {
            return Err(EncodeError::TooLarge);
        }
        let header = ChunkHeader {
            vertices: used.len() as u32,
            triangles: triangles.len() as u32,
        };
        self.records.push(header.to_bytes());
        for &index in used {
            let vertex = &vertices[index as usize];
            let squared = vertex
                .position
                .iter()
                .map(|&x| u32::from(x.unsigned_abs()).pow(2))
                .sum();
            self.squared_radius = self.squared_radius.max(squared);
            self.records.push(vertex.to_bytes());
            for (attribute, elements, array) in &mut self.arrays {
                let bytes = attribute.bytes();
                let element = elements.chunks_exact(bytes).nth(index as usize);
                match element {
                    Some(element) => array.extend(element),
                    None => array.resize(array.len() + bytes, 0),
                }
            }
        }
        self.records.extend(triangles);
        self.chunks += 1;
        self.vertices += header.vertices;
        self.triangles += header.triangles;
        Ok(())
    }

    fn finish(self) -> Vec<u8> {
        let floor = self.squared_radius.isqrt();
        let mut body = self.records.into_flattened();
        for (_, _, array) in &self.arrays {
            body.extend(array);
            body.resize(body.len().next_multiple_of(WORD), 0);
        }
        self.textures
            .iter()
            .for_each(|texture| body.extend(texture));
        let attributes = self
            .arrays
            .iter()
            .fold(0, |bits, (attribute, ..)| bits | attribute.bit());
        let header = MeshHeader {
            magic: MAGIC,
            length: (MeshHeader::BYTES + body.len()) as u32,
            chunks: self.chunks,
            vertices: self.vertices,
            triangles: self.triangles,
            radius: floor + u32::from(floor.pow(2) < self.squared_radius),
            checksum: 0,
            attributes: attributes
                | if self.textures.is_empty() {
                    0
                } else {
                    TEXTURES
                },
        };
        let mut bytes = header.to_bytes().to_vec();
        bytes.extend(body);
        set_checksum(&mut bytes);
        bytes
    }
}

/// Reason why a mesh cannot be encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncodeError {
    /// The mesh has no vertex.
    NoVertex,
    /// A triangle uses a missing vertex.
    Index {
        /// Number of the triangle.
        triangle: usize,
        /// The index of the missing vertex.
        index: u32,
        /// Number of vertices in the mesh.
        vertices: usize,
    },
    /// The mesh exceeds [`MAX_BYTES`].
    TooLarge,
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::NoVertex => f.write_str("mesh: expected at least 1 vertex, found none"),
            Self::Index {
                triangle,
                index,
                vertices,
            } => {
                write!(
                    f,
                    "triangle {triangle}: expected indices below {vertices}, found {index}"
                )
            }
            Self::TooLarge => write!(
                f,
                "mesh: expected at most {MAX_BYTES} bytes, found more vertices, triangles and textures than fit"
            ),
        }
    }
}

impl core::error::Error for EncodeError {}
