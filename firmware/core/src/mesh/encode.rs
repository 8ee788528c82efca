//! Encoding of meshes (docs/formats/mesh.md, "Mesh in memory"), for hosts with a heap.

use alloc::vec::Vec;
use core::fmt;

use super::{HEADER, MAGIC, MAX_BYTES, MAX_CHUNK_VERTICES, RECORD, Rgb565, Vertex, set_checksum};

/// A triangle of an indexed mesh of any size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct IndexedTriangle {
    /// Indices of the vertices in the mesh, counter-clockwise seen from outside.
    pub indices: [u32; 3],
    /// Colour of the triangle.
    pub colour: Rgb565,
    /// Normal of the triangle, s2.14.
    pub normal: [i16; 3],
}

/// Encodes an indexed mesh, divided into chunks of at most 65,535 vertices.
///
/// Triangles keep their order. A vertex is repeated in every chunk that uses it. A vertex that no triangle uses is left out. A
/// mesh without triangles keeps its first vertex, because a chunk has at least one vertex.
///
/// # Errors
/// The mesh has no vertex, a triangle uses a missing vertex, or the encoded mesh exceeds [`MAX_BYTES`].
pub fn encode(vertices: &[Vertex], triangles: &[IndexedTriangle]) -> Result<Vec<u8>, EncodeError> {
    let mut writer = Writer::default();
    // For each vertex of the mesh: its index in the present chunk; `None` if the chunk does not have the vertex.
    let mut local = alloc::vec![None; vertices.len()];
    let mut used: Vec<u32> = Vec::new();
    let mut records: Vec<[u8; RECORD]> = Vec::new();
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
        let normal = triangle.normal.map(|x| x as u16);
        records.push(record(
            indices.into_iter().chain([triangle.colour.0]).chain(normal),
        ));
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

/// Makes a record of little-endian 16-bit half words, padded with zeros.
fn record(halves: impl IntoIterator<Item = u16>) -> [u8; RECORD] {
    let mut record = [0; RECORD];
    for (bytes, half) in record.as_chunks_mut().0.iter_mut().zip(halves) {
        *bytes = half.to_le_bytes();
    }
    record
}

/// The encoded chunks, and the sums over all chunks that the mesh's header needs.
#[derive(Default)]
struct Writer {
    records: Vec<[u8; RECORD]>,
    chunks: u32,
    vertices: u32,
    triangles: u32,
    squared_radius: u32,
}

impl Writer {
    fn chunk(
        &mut self,
        vertices: &[Vertex],
        used: &[u32],
        triangles: &[[u8; RECORD]],
    ) -> Result<(), EncodeError> {
        let records = self.records.len() + 1 + used.len() + triangles.len();
        let bytes = HEADER + RECORD * records;
        if bytes > MAX_BYTES as usize {
            return Err(EncodeError::TooLarge);
        }
        let mut header = [0; RECORD];
        header[..4].copy_from_slice(&(used.len() as u32).to_le_bytes());
        header[4..8].copy_from_slice(&(triangles.len() as u32).to_le_bytes());
        self.records.push(header);
        for &index in used {
            let vertex = &vertices[index as usize];
            let squared = vertex
                .position
                .iter()
                .map(|&x| u32::from(x.unsigned_abs()).pow(2))
                .sum();
            self.squared_radius = self.squared_radius.max(squared);
            let vectors = [vertex.position, vertex.normal];
            let halves = vectors.into_iter().flatten().map(|x| x as u16);
            self.records.push(record(halves.chain([vertex.colour.0])));
        }
        self.records.extend(triangles);
        self.chunks += 1;
        self.vertices += used.len() as u32;
        self.triangles += triangles.len() as u32;
        Ok(())
    }

    fn finish(self) -> Vec<u8> {
        let floor = self.squared_radius.isqrt();
        let radius = floor + u32::from(floor.pow(2) < self.squared_radius);
        let length = (HEADER + RECORD * self.records.len()) as u32;
        let header = [
            length,
            self.chunks,
            self.vertices,
            self.triangles,
            radius,
            0,
            0,
        ];
        let mut bytes = Vec::with_capacity(length as usize);
        bytes.extend(MAGIC);
        bytes.extend(header.into_iter().flat_map(u32::to_le_bytes));
        bytes.extend(self.records.as_flattened());
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
        /// The index.
        index: u32,
        /// Number of vertices.
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
                "mesh: expected at most {MAX_BYTES} bytes, found more vertices and triangles than fit"
            ),
        }
    }
}

impl core::error::Error for EncodeError {}
