//! Meshes in memory, files and uploads (docs/formats/mesh.md, "Mesh in memory").
//!
//! [`Mesh::new_checked`] checks the bytes of a mesh once, and returns a view whose accessors do not fail.

mod checksum;
#[cfg(feature = "alloc")]
mod encode;
mod turned;

use core::ops::Range;

pub use crate::colour::Rgb565;
use crate::deviation::Expected::{AtLeast, AtMost, Below, Exactly, Magic, MultipleOf};
use crate::deviation::{Deviation, Expected, Format};
use crate::feature::TEXTURE;
pub use crate::records::{Attribute, ChunkHeader, MeshHeader, Triangle, Vertex};
use crate::records::{TEXTURES, WORD};
use crate::texture::Texture;
pub use checksum::{checksum, set_checksum, stated_checksum};
#[cfg(feature = "alloc")]
pub use encode::{EncodeError, IndexedTriangle, encode, encode_with};

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

/// The content of reserved fields.
const RESERVED: Expected = Exactly("(reserved)", 0);

/// Whether a text is a valid name of a mesh: 1 to [`MAX_NAME`] visible characters of ASCII.
pub fn is_name(text: &str) -> bool {
    (1..=MAX_NAME).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_graphic())
}

/// A checked mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mesh<'a> {
    bytes: &'a [u8],
    /// The records of all chunks.
    records: &'a [[u8; WORD]],
    /// The arrays of the optional attributes, after the chunks.
    arrays: &'a [[u8; WORD]],
    /// The textures, after the arrays.
    textures: &'a [[u8; WORD]],
    attributes: u32,
    vertices: u32,
    triangles: u32,
    radius: u32,
}

impl<'a> Mesh<'a> {
    /// Checks every length, count, index and reserved field of a mesh, and that the sphere about the origin with the radius in
    /// the header contains all vertices. This does not check the checksum, which protects files; [`checksum()`] computes it.
    ///
    /// # Errors
    /// The first deviation from the format, with its position.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, Deviation> {
        // A length of more than 32 bits is reported as the largest 32-bit number.
        let found = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        let Some((header, records)) = bytes.split_first_chunk() else {
            let least = AtLeast("bytes of header", MeshHeader::BYTES as u32);
            return Err(deviation(0, least, found));
        };
        expect(0, AtMost("bytes", MAX_BYTES), found)?;
        let (records, []) = records.as_chunks() else {
            return Err(deviation(0, MultipleOf("bytes", WORD as u32), found));
        };
        let header = MeshHeader::from_bytes(header);
        let magic = u32::from_le_bytes(header.magic);
        expect(start(MeshHeader::MAGIC), Magic(MAGIC), magic)?;
        let length = Exactly("bytes in all", found);
        expect(start(MeshHeader::LENGTH), length, header.length)?;
        let least = AtLeast("chunks", 1);
        expect(start(MeshHeader::CHUNKS), least, header.chunks)?;
        let most = AtMost("radius in 2^-14", MAX_RADIUS);
        expect(start(MeshHeader::RADIUS), most, header.radius)?;
        let known = Attribute::ALL
            .iter()
            .fold(TEXTURES, |bits, one| bits | one.bit());
        let unknown = header.attributes & !known;
        expect(start(MeshHeader::ATTRIBUTES), RESERVED, unknown)?;

        let mut walk = Walk::new(records);
        let (mut seen_vertices, mut seen_triangles) = (0, 0);
        // The largest texture number of all triangles, and its offset.
        let mut largest_texture = (0, 0);
        for _ in 0..header.chunks {
            let (offset, chunk) = walk.chunk()?;
            chunk.check(offset, header.radius)?;
            if TEXTURE.is_built {
                largest_texture = largest_texture.max(chunk.largest_texture(offset));
            }
            seen_vertices += chunk.vertices.len() as u32;
            seen_triangles += chunk.triangles.len() as u32;
        }
        let rest = walk.rest;
        let words = array_words(header.attributes, seen_vertices);
        let (arrays, textures) = rest.split_at_checked(words).unwrap_or((rest, &[]));
        let has_textures = header.attributes & TEXTURES != 0;
        let [expected, found] = [words, rest.len()].map(|words| (words * WORD) as u32);
        let count = if has_textures {
            AtLeast("bytes after the last chunk", expected + WORD as u32)
        } else {
            Exactly("bytes after the last chunk", expected)
        };
        expect(walk.offset, count, found)?;
        let textures_offset = walk.offset + expected;
        // A build that draws no textures does not read them.
        let texture_count = if TEXTURE.is_built {
            check_textures(textures, textures_offset)?
        } else {
            u32::MAX
        };
        let (number, offset) = largest_texture;
        expect(
            offset,
            AtMost("(number of a texture)", texture_count),
            number,
        )?;
        let vertices = Exactly("vertices, the sum of the chunks", seen_vertices);
        expect(start(MeshHeader::VERTICES), vertices, header.vertices)?;
        let triangles = Exactly("triangles, the sum of the chunks", seen_triangles);
        expect(start(MeshHeader::TRIANGLES), triangles, header.triangles)?;
        let (records, _) = records
            .split_at_checked(records.len() - rest.len())
            .unwrap_or_default();
        Ok(Self {
            bytes,
            records,
            arrays,
            textures,
            attributes: header.attributes,
            vertices: header.vertices,
            triangles: header.triangles,
            radius: header.radius,
        })
    }

    /// A mesh of constant bytes without optional attributes. Only lengths are checked, so a test must compare it with the result of
    /// [`new_checked`](Self::new_checked); a program then needs no check when it starts. `None` for bytes that are not a whole number of
    /// records after a header.
    pub const fn from_constant(bytes: &'static [u8]) -> Option<Self> {
        let Some((header, records)) = bytes.split_first_chunk() else {
            return None;
        };
        let (records, []) = records.as_chunks() else {
            return None;
        };
        let header = MeshHeader::from_bytes(header);
        Some(Self {
            bytes,
            records,
            arrays: &[],
            textures: &[],
            attributes: 0,
            vertices: header.vertices,
            triangles: header.triangles,
            radius: header.radius,
        })
    }

    /// The mesh, if it has at most `limit` triangles.
    ///
    /// # Errors
    /// The mesh has more triangles.
    pub fn with_at_most(self, limit: u32) -> Result<Self, Deviation> {
        let most = AtMost("triangles, which this board can draw", limit);
        expect(start(MeshHeader::TRIANGLES), most, self.triangles)?;
        Ok(self)
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

    /// The records that the triangle engine reads: all chunks with their headers, without the optional attributes.
    pub const fn records(&self) -> &'a [[u8; WORD]] {
        self.records
    }

    /// The elements of an optional attribute, one for each vertex of all chunks in order; `None` if the mesh lacks the attribute.
    pub fn attribute(&self, attribute: Attribute) -> Option<&'a [u8]> {
        let before = self.attributes & (attribute.bit() - 1);
        let at = array_words(before, self.vertices);
        let elements = self.arrays.get(at..)?.as_flattened();
        (self.attributes & attribute.bit() != 0)
            .then(|| elements.get(..self.vertices as usize * attribute.bytes()))?
    }

    /// Whether the mesh has textures.
    pub const fn has_textures(&self) -> bool {
        !self.textures.is_empty()
    }

    /// The textures in order. The texture with number n, as in triangles, has index n − 1.
    pub fn textures(&self) -> impl Iterator<Item = Texture<'a>> + Clone + use<'a> {
        let mut rest = self.textures.as_flattened();
        core::iter::from_fn(move || {
            // In a checked mesh an error means the end of the textures.
            let texture = Texture::new_checked(rest).ok()?;
            rest = rest.get(texture.bytes().len()..).unwrap_or_default();
            Some(texture)
        })
    }

    /// The chunks in order.
    pub fn chunks(&self) -> impl Iterator<Item = Chunk<'a>> + Clone + use<'a> {
        Chunks(Walk::new(self.records))
    }
}

impl Vertex {
    /// The colour: red, green and blue of 8 bits each.
    pub const fn rgb888(&self) -> [u8; 3] {
        let [r, g, b] = self.colour.to_rgb888();
        [
            r ^ self.fine >> 5,
            g ^ (self.fine >> 3 & 3),
            b ^ (self.fine & 7),
        ]
    }

    /// The vertex with another colour: red, green and blue of 8 bits each.
    #[must_use]
    pub const fn with_rgb888(self, [r, g, b]: [u8; 3]) -> Self {
        let colour = Rgb565((r as u16 >> 3) << 11 | (g as u16 >> 2) << 5 | b as u16 >> 3);
        let [red, green, blue] = colour.to_rgb888();
        Self {
            colour,
            fine: (r ^ red) << 5 | (g ^ green) << 3 | (b ^ blue),
            ..self
        }
    }
}

/// A part of a mesh: vertices, and triangles that use these vertices by their indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chunk<'a> {
    vertices: &'a [[u8; WORD]],
    triangles: &'a [[u8; WORD]],
}

impl<'a> Chunk<'a> {
    /// Number of vertices, 1 to 65,535.
    pub const fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// Number of triangles in the chunk.
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

    /// The largest texture number of the chunk's triangles, and its offset in the mesh. The chunk's header
    /// is at byte `offset`.
    fn largest_texture(&self, offset: u32) -> (u32, u32) {
        let first = offset as usize + WORD * (1 + self.vertices.len()) + Triangle::TEXTURE.start;
        let numbers = self.triangles().map(|triangle| u32::from(triangle.texture));
        let places = (first as u32..).step_by(WORD);
        numbers.zip(places).max().unwrap_or((0, 0))
    }

    /// Checks the records of the chunk, whose header is at byte `offset` of a mesh with the given radius.
    fn check(&self, offset: u32, radius: u32) -> Result<(), Deviation> {
        let count = self.vertices.len() as u32;
        let mut offset = offset + WORD as u32;
        for record in self.vertices {
            let [x, y, z] = Vertex::from_bytes(record).position;
            // Each square is at most 2^30.
            let squared: u32 = [x, y, z]
                .map(|x| u32::from(x.unsigned_abs()).pow(2))
                .iter()
                .sum();
            if squared > radius.pow(2) {
                let radius_needed = squared.isqrt() + u32::from(squared.isqrt().pow(2) < squared);
                let most = AtMost("(radius) from the origin", radius);
                return Err(deviation(offset, most, radius_needed));
            }
            expect_reserved(offset, record, Vertex::RESERVED)?;
            offset += WORD as u32;
        }
        for record in self.triangles {
            let places = Triangle::INDICES.step_by(2);
            for (place, index) in places.zip(Triangle::from_bytes(record).indices) {
                let below = Below("vertices in the chunk", count);
                expect(offset + place as u32, below, index.into())?;
            }
            expect_reserved(offset, record, Triangle::RESERVED)?;
            offset += WORD as u32;
        }
        Ok(())
    }
}

/// Checks the textures of a mesh, which begin at byte `offset`. Returns their number.
fn check_textures(textures: &[[u8; WORD]], mut offset: u32) -> Result<u32, Deviation> {
    let mut rest = textures.as_flattened();
    let mut count = 0;
    while !rest.is_empty() {
        let texture = Texture::new_checked(rest).map_err(|error| Deviation {
            format: Format::TextureAt(offset),
            offset: offset + error.offset,
            ..error
        })?;
        let length = texture.bytes().len();
        rest = rest.get(length..).unwrap_or_default();
        offset += length as u32;
        count += 1;
    }
    Ok(count)
}

/// Divides the records after the mesh's header into chunks.
#[derive(Clone)]
struct Walk<'a> {
    rest: &'a [[u8; WORD]],
    /// Offset of `rest` from the start of the mesh, in bytes.
    offset: u32,
}

impl<'a> Walk<'a> {
    /// Starts at the first record after the mesh's header.
    const fn new(records: &'a [[u8; WORD]]) -> Self {
        Self {
            rest: records,
            offset: MeshHeader::BYTES as u32,
        }
    }

    /// Returns the next chunk, and the offset of its header in the mesh.
    fn chunk(&mut self) -> Result<(u32, Chunk<'a>), Deviation> {
        let offset = self.offset;
        let Some((header, rest)) = self.rest.split_first() else {
            let least = AtLeast("bytes for a chunk's header", WORD as u32);
            return Err(deviation(offset, least, 0));
        };
        let ChunkHeader {
            vertices,
            triangles,
        } = ChunkHeader::from_bytes(header);
        expect(offset, AtLeast("vertices in a chunk", 1), vertices)?;
        let most = AtMost("vertices in a chunk", MAX_CHUNK_VERTICES);
        expect(offset, most, vertices)?;
        expect_reserved(offset, header, ChunkHeader::RESERVED)?;
        let least = AtLeast("records for the chunk's vertices", vertices);
        let (vertices, rest) = rest.split_at_checked(vertices as usize).ok_or(deviation(
            offset,
            least,
            rest.len() as u32,
        ))?;
        let least = AtLeast("records for the chunk's triangles", triangles);
        let place = offset + start(ChunkHeader::TRIANGLES);
        let (triangles, rest) = rest.split_at_checked(triangles as usize).ok_or(deviation(
            place,
            least,
            rest.len() as u32,
        ))?;
        self.offset += (WORD * (1 + vertices.len() + triangles.len())) as u32;
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
        // In a checked mesh an error means the end of the chunks.
        self.0.chunk().ok().map(|(_, chunk)| chunk)
    }
}

/// Number of words that the arrays of the attributes set in `bits` take for `vertices` vertices. Each array starts at a word boundary.
fn array_words(bits: u32, vertices: u32) -> usize {
    let present = Attribute::ALL.iter().filter(|one| bits & one.bit() != 0);
    present
        .map(|one| (vertices as usize * one.bytes()).div_ceil(WORD))
        .sum()
}

/// Offset of a field in its record.
const fn start(field: Range<usize>) -> u32 {
    field.start as u32
}

fn expect(offset: u32, expected: Expected, found: u32) -> Result<(), Deviation> {
    Format::Mesh.expect(offset, expected, found)
}

fn deviation(offset: u32, expected: Expected, found: u32) -> Deviation {
    Format::Mesh.deviation(offset, expected, found)
}

/// Checks the reserved field of a record at byte `offset` of the mesh.
fn expect_reserved(offset: u32, record: &[u8; WORD], field: Range<usize>) -> Result<(), Deviation> {
    let offset = offset + field.start as u32;
    let words = record.get(field).unwrap_or_default().chunks(4);
    let little_endian = |bytes: &[u8]| {
        let digits = bytes.iter().rev();
        digits.fold(0, |word, &byte| word << 8 | u32::from(byte))
    };
    let found = words.map(little_endian).find(|&word| word != 0);
    let found = found.unwrap_or(0);
    expect(offset, RESERVED, found)
}
