//! Meshes in memory, files and uploads (docs/formats/mesh.md, "Mesh in memory").
//!
//! [`Mesh::new_checked`] checks every byte once and returns a view whose accessors do not fail.

mod checksum;
#[cfg(feature = "alloc")]
mod encode;
mod turned;

use core::fmt;

pub use crate::colour::Rgb565;
pub use checksum::{checksum, set_checksum, stated_checksum};
#[cfg(feature = "alloc")]
pub use encode::{EncodeError, IndexedTriangle, encode};

/// The first four bytes of a mesh.
pub const MAGIC: [u8; 4] = *b"GLM2";
/// Largest length of a mesh in bytes.
pub const MAX_BYTES: u32 = 32 << 20;
/// Largest length of a mesh's name in bytes.
pub const MAX_NAME: usize = 24;
/// Largest number of vertices of a chunk.
pub const MAX_CHUNK_VERTICES: u32 = u16::MAX as u32;
/// The largest radius, in units of 2^−14: 2·√3, the distance of the farthest position from the origin, rounded up.
pub const MAX_RADIUS: u32 = 56_756;

/// Bytes of a record: a chunk's header, a vertex or a triangle. The mesh's header is as long as two records.
pub(crate) const RECORD: usize = 16;
/// Bytes of the mesh's header.
pub(crate) const HEADER: usize = 2 * RECORD;

/// Whether a text may be the name of a mesh: 1 to [`MAX_NAME`] visible characters of ASCII.
pub fn is_name(text: &str) -> bool {
    (1..=MAX_NAME).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_graphic())
}

/// A checked mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mesh<'a> {
    bytes: &'a [u8],
    /// The bytes after the header.
    records: &'a [[u8; RECORD]],
    vertices: u32,
    triangles: u32,
    radius: u32,
}

impl<'a> Mesh<'a> {
    /// Checks every length, count, index and reserved field of a mesh, and that the sphere about the origin with the radius in
    /// the header contains all vertices. The checksum is not checked: it protects files, and [`checksum()`] computes it.
    ///
    /// # Errors
    /// The first deviation from the format, with its position.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, MeshError> {
        let found = bytes.len();
        // A length of more than 32 bits is reported as the largest 32-bit number.
        let wrong_length = |expected| MeshError {
            offset: 0,
            expected,
            found: u32::try_from(found).unwrap_or(u32::MAX),
        };
        let Some((header, records)) = bytes.split_at_checked(HEADER) else {
            return Err(wrong_length(Expected::AtLeast(
                "bytes of header",
                HEADER as u32,
            )));
        };
        let length = match u32::try_from(found) {
            Ok(length) if length <= MAX_BYTES => length,
            _ => return Err(wrong_length(Expected::AtMost("bytes", MAX_BYTES))),
        };
        let (records, []) = records.as_chunks() else {
            return Err(wrong_length(Expected::MultipleOf("bytes", RECORD as u32)));
        };
        let [
            magic,
            stated_length,
            chunks,
            vertices,
            triangles,
            radius,
            _,
            reserved,
        ] = words::<8>(header);
        expect(
            0,
            Expected::Magic,
            magic,
            magic == u32::from_le_bytes(MAGIC),
        )?;
        expect(
            4,
            Expected::Exactly("bytes in all", length),
            stated_length,
            stated_length == length,
        )?;
        expect(8, Expected::AtLeast("chunks", 1), chunks, chunks >= 1)?;
        expect(
            20,
            Expected::AtMost("radius in 2^-14", MAX_RADIUS),
            radius,
            radius <= MAX_RADIUS,
        )?;
        expect_zeros(28, [reserved])?;

        let mut walk = Walk {
            rest: records,
            offset: HEADER as u32,
        };
        let (mut seen_vertices, mut seen_triangles) = (0, 0);
        for _ in 0..chunks {
            let (offset, chunk) = walk.chunk()?;
            chunk.check(offset, radius)?;
            seen_vertices += chunk.vertices.len() as u32;
            seen_triangles += chunk.triangles.len() as u32;
        }
        let rest = walk.rest.len() as u32 * RECORD as u32;
        expect(
            walk.offset,
            Expected::Exactly("bytes after the last chunk", 0),
            rest,
            rest == 0,
        )?;
        expect(
            12,
            Expected::Exactly("vertices, as the chunks have", seen_vertices),
            vertices,
            vertices == seen_vertices,
        )?;
        expect(
            16,
            Expected::Exactly("triangles, as the chunks have", seen_triangles),
            triangles,
            triangles == seen_triangles,
        )?;
        Ok(Self {
            bytes,
            records,
            vertices,
            triangles,
            radius,
        })
    }

    /// All bytes of the mesh, including its header.
    pub const fn bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// Number of vertices of the largest chunk.
    pub fn largest_chunk(&self) -> usize {
        let counts = self.chunks().map(|chunk| chunk.vertex_count());
        counts.max().unwrap_or(0)
    }

    /// Number of vertices in all chunks.
    pub const fn vertex_count(&self) -> u32 {
        self.vertices
    }

    /// Number of triangles in all chunks.
    pub const fn triangle_count(&self) -> u32 {
        self.triangles
    }

    /// Radius of a sphere about the origin that contains all vertices, in units of 2^−14; at most [`MAX_RADIUS`].
    pub const fn radius(&self) -> u32 {
        self.radius
    }

    /// The records of all chunks, including the chunks' headers.
    pub const fn records(&self) -> &'a [[u8; RECORD]] {
        self.records
    }

    /// The chunks in order.
    pub fn chunks(&self) -> impl Iterator<Item = Chunk<'a>> + Clone + use<'a> {
        Chunks(Walk {
            rest: self.records,
            offset: HEADER as u32,
        })
    }
}

/// A part of a mesh: vertices, and triangles that use these vertices by their indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chunk<'a> {
    vertices: &'a [[u8; RECORD]],
    triangles: &'a [[u8; RECORD]],
}

impl<'a> Chunk<'a> {
    /// Number of vertices, 1 to 65,535.
    pub const fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// Number of triangles.
    pub const fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Returns the vertex with this index in the chunk; `None` beyond the last.
    pub fn vertex(&self, index: usize) -> Option<Vertex> {
        self.vertices.get(index).map(Vertex::from_bytes)
    }

    /// Returns the triangle with this index in the chunk; `None` beyond the last.
    pub fn triangle(&self, index: usize) -> Option<Triangle> {
        self.triangles.get(index).map(Triangle::from_bytes)
    }

    /// The vertices in order.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = Vertex> + Clone + use<'a> {
        self.vertices.iter().map(Vertex::from_bytes)
    }

    /// The triangles in order.
    pub fn triangles(&self) -> impl ExactSizeIterator<Item = Triangle> + Clone + use<'a> {
        self.triangles.iter().map(Triangle::from_bytes)
    }

    /// Checks the records of the chunk. Its header is at byte `offset` of the mesh, whose radius is `radius`.
    fn check(&self, offset: u32, radius: u32) -> Result<(), MeshError> {
        let count = self.vertices.len() as u32;
        let mut offset = offset + RECORD as u32;
        for record in self.vertices {
            let [px, py, pz, .., reserved] = halves(record);
            // Each square is at most 2^30.
            let squared: u32 = [px, py, pz]
                .map(|x| u32::from((x as i16).unsigned_abs()).pow(2))
                .iter()
                .sum();
            if squared > radius.pow(2) {
                let radius_needed = squared.isqrt() + u32::from(squared.isqrt().pow(2) < squared);
                return Err(MeshError {
                    offset,
                    expected: Expected::AtMost("(radius) from the origin", radius),
                    found: radius_needed,
                });
            }
            expect_zeros(offset + 14, [reserved.into()])?;
            offset += RECORD as u32;
        }
        for record in self.triangles {
            let [a, b, c, .., flags] = halves(record);
            for (place, index) in [(0, a), (2, b), (4, c)] {
                let index = u32::from(index);
                expect(
                    offset + place,
                    Expected::Below("vertices of the chunk, as an index", count),
                    index,
                    index < count,
                )?;
            }
            expect_zeros(offset + 14, [flags.into()])?;
            offset += RECORD as u32;
        }
        Ok(())
    }
}

/// A vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Vertex {
    /// Position, s2.14.
    pub position: [i16; 3],
    /// Normal, s2.14.
    pub normal: [i16; 3],
    /// Colour in RGB565.
    pub colour: Rgb565,
}

impl Vertex {
    /// The vertex with this record in memory.
    pub fn from_bytes(bytes: &[u8; RECORD]) -> Self {
        let [px, py, pz, nx, ny, nz, colour, _] = halves(bytes);
        Self {
            position: [px, py, pz].map(|x| x as i16),
            normal: [nx, ny, nz].map(|x| x as i16),
            colour: Rgb565(colour),
        }
    }
}

/// A triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triangle {
    /// Indices of the vertices in the chunk, counter-clockwise seen from outside.
    pub indices: [u16; 3],
    /// Colour in RGB565.
    pub colour: Rgb565,
    /// Normal of the triangle, s2.14.
    pub normal: [i16; 3],
    /// Reserved, 0.
    pub flags: u16,
}

impl Triangle {
    /// The triangle with this record in memory.
    pub fn from_bytes(bytes: &[u8; RECORD]) -> Self {
        let [a, b, c, colour, nx, ny, nz, flags] = halves(bytes);
        Self {
            indices: [a, b, c],
            colour: Rgb565(colour),
            normal: [nx, ny, nz].map(|x| x as i16),
            flags,
        }
    }
}

/// Divides the records after the mesh's header into chunks.
#[derive(Clone)]
struct Walk<'a> {
    rest: &'a [[u8; RECORD]],
    /// Offset of `rest` in bytes from the start of the mesh.
    offset: u32,
}

impl<'a> Walk<'a> {
    /// Takes the next chunk. Returns the offset of its header in the mesh, and the chunk.
    fn chunk(&mut self) -> Result<(u32, Chunk<'a>), MeshError> {
        let offset = self.offset;
        let Some((header, rest)) = self.rest.split_first() else {
            return Err(MeshError {
                offset,
                expected: Expected::AtLeast("bytes for a chunk's header", RECORD as u32),
                found: 0,
            });
        };
        let [vertices, triangles, reserved @ ..] = words::<4>(header);
        expect(
            offset,
            Expected::AtLeast("vertices in a chunk", 1),
            vertices,
            vertices >= 1,
        )?;
        expect(
            offset,
            Expected::AtMost("vertices in a chunk", MAX_CHUNK_VERTICES),
            vertices,
            vertices <= MAX_CHUNK_VERTICES,
        )?;
        expect_zeros(offset + 8, reserved)?;
        let left = rest.len() as u32;
        let too_short = |at, what, needed, found| MeshError {
            offset: at,
            expected: Expected::AtLeast(what, needed),
            found,
        };
        let (vertices, rest) = rest.split_at_checked(vertices as usize).ok_or(too_short(
            offset,
            "records for the chunk's vertices",
            vertices,
            left,
        ))?;
        let left = rest.len() as u32;
        let (triangles, rest) = rest.split_at_checked(triangles as usize).ok_or(too_short(
            offset + 4,
            "records for the chunk's triangles",
            triangles,
            left,
        ))?;
        self.offset += (RECORD * (1 + vertices.len() + triangles.len())) as u32;
        self.rest = rest;
        Ok((
            offset,
            Chunk {
                vertices,
                triangles,
            },
        ))
    }
}

/// The chunks of a checked mesh.
#[derive(Clone)]
struct Chunks<'a>(Walk<'a>);

impl<'a> Iterator for Chunks<'a> {
    type Item = Chunk<'a>;

    fn next(&mut self) -> Option<Self::Item> {
        // In a checked mesh this is an error only at the end, where no chunk is left.
        self.0.chunk().ok().map(|(_, chunk)| chunk)
    }
}

/// Returns the first `N` little-endian 32-bit words of `bytes`; words beyond the end are 0.
fn words<const N: usize>(bytes: &[u8]) -> [u32; N] {
    let mut words = [0; N];
    for (word, bytes) in words.iter_mut().zip(bytes.as_chunks().0) {
        *word = u32::from_le_bytes(*bytes);
    }
    words
}

/// Returns the eight little-endian 16-bit half words of a record.
fn halves(record: &[u8; RECORD]) -> [u16; RECORD / 2] {
    let mut halves = [0; RECORD / 2];
    for (half, bytes) in halves.iter_mut().zip(record.as_chunks().0) {
        *half = u16::from_le_bytes(*bytes);
    }
    halves
}

fn expect(offset: u32, expected: Expected, found: u32, holds: bool) -> Result<(), MeshError> {
    if holds {
        Ok(())
    } else {
        Err(MeshError {
            offset,
            expected,
            found,
        })
    }
}

fn expect_zeros<const N: usize>(offset: u32, reserved: [u32; N]) -> Result<(), MeshError> {
    match reserved.into_iter().find(|&word| word != 0) {
        Some(found) => Err(MeshError {
            offset,
            expected: Expected::Exactly("(reserved)", 0),
            found,
        }),
        None => Ok(()),
    }
}

/// Reason why bytes are not a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshError {
    /// Offset of the error in bytes from the start of the mesh.
    pub offset: u32,
    /// The number or value that was expected at this position.
    pub expected: Expected,
    /// The number that was found instead.
    pub found: u32,
}

/// Expectation that a mesh violates. A variant with a count also holds the name of the counted items.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// The four bytes [`MAGIC`].
    Magic,
    /// Exactly this number of items.
    Exactly(&'static str, u32),
    /// At least this number of items.
    AtLeast(&'static str, u32),
    /// At most this number of items.
    AtMost(&'static str, u32),
    /// An index below this number of items.
    Below(&'static str, u32),
    /// A multiple of this number of items.
    MultipleOf(&'static str, u32),
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "mesh byte {}: expected {}, found ",
            self.offset, self.expected
        )?;
        match self.expected {
            Expected::Magic => write!(f, "\"{}\"", self.found.to_le_bytes().escape_ascii()),
            _ => write!(f, "{}", self.found),
        }
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Magic => write!(f, "\"{}\"", MAGIC.escape_ascii()),
            Self::Exactly(what, count) => write!(f, "{count} {what}"),
            Self::AtLeast(what, count) => write!(f, "at least {count} {what}"),
            Self::AtMost(what, count) => write!(f, "at most {count} {what}"),
            Self::Below(what, count) => write!(f, "less than the {count} {what}"),
            Self::MultipleOf(what, count) => write!(f, "a multiple of {count} {what}"),
        }
    }
}

impl core::error::Error for MeshError {}
