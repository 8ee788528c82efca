//! Records in memory (docs/formats/records.md).
// Generated from gateware/glint_soc/records.py by `cargo xtask pac`. Do not edit.

use core::ops::Range;

use crate::bits::Bits;
use crate::colour::Rgb565;

/// Size of a memory word in bytes. Every record begins at a multiple of this size, or of its own size if that is smaller.
pub const WORD: usize = 16;

/// Value of `mark` in a piece of a line, which is stored in place of a descriptor.
pub const PIECE_MARK: u64 = 3;

/// The bit in [`MeshHeader::attributes`] of a mesh with textures, which follow the arrays of its attributes.
pub const TEXTURES: u32 = 1 << 31;

/// An optional attribute of a mesh's vertices. The discriminant is the number of its bit in [`MeshHeader::attributes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attribute {
    /// Texture coordinates of a vertex.
    TextureCoordinates = 4,
}

impl Attribute {
    /// All attributes, by their numbers.
    pub const ALL: [Self; 1] = [Self::TextureCoordinates];

    /// Returns the attribute's bit in the header, as a mask.
    pub const fn bit(self) -> u32 {
        1 << self as u32
    }

    /// Returns the size in bytes of an element, the attribute of one vertex.
    pub const fn bytes(self) -> usize {
        match self {
            Self::TextureCoordinates => TextureCoordinates::BYTES,
        }
    }
}

/// Returns the bytes of the field at byte `at` of a record.
// Reads an array, because the compiler generates more instructions for single bytes.
const fn field<const N: usize>(record: &[u8], at: usize) -> [u8; N] {
    match record.split_at(at).1.first_chunk() {
        Some(bytes) => *bytes,
        None => [0; N],
    }
}

/// Header of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshHeader {
    /// `GLM2`.
    pub magic: [u8; 4],
    /// Length of the whole mesh in bytes.
    pub length: u32,
    /// Number of chunks, at least 1.
    pub chunks: u32,
    /// Number of vertices in all chunks.
    pub vertices: u32,
    /// Number of triangles in all chunks.
    pub triangles: u32,
    /// Radius about the origin, u.14, rounded up.
    pub radius: u32,
    /// CRC-32 of all other bytes.
    pub checksum: u32,
    /// A bit for each optional attribute that the mesh has.
    pub attributes: u32,
}

impl MeshHeader {
    /// Size of the record in bytes.
    pub const BYTES: usize = 32;
    /// Byte range of the field `magic`.
    pub const MAGIC: Range<usize> = 0..4;
    /// Byte range of the field `length`.
    pub const LENGTH: Range<usize> = 4..8;
    /// Byte range of the field `chunks`.
    pub const CHUNKS: Range<usize> = 8..12;
    /// Byte range of the field `vertices`.
    pub const VERTICES: Range<usize> = 12..16;
    /// Byte range of the field `triangles`.
    pub const TRIANGLES: Range<usize> = 16..20;
    /// Byte range of the field `radius`.
    pub const RADIUS: Range<usize> = 20..24;
    /// Byte range of the field `checksum`.
    pub const CHECKSUM: Range<usize> = 24..28;
    /// Byte range of the field `attributes`.
    pub const ATTRIBUTES: Range<usize> = 28..32;

    /// Returns the record with these bytes in memory.
    pub const fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {
        Self {
            magic: field(bytes, 0),
            length: u32::from_le_bytes(field(bytes, 4)),
            chunks: u32::from_le_bytes(field(bytes, 8)),
            vertices: u32::from_le_bytes(field(bytes, 12)),
            triangles: u32::from_le_bytes(field(bytes, 16)),
            radius: u32::from_le_bytes(field(bytes, 20)),
            checksum: u32::from_le_bytes(field(bytes, 24)),
            attributes: u32::from_le_bytes(field(bytes, 28)),
        }
    }

    /// Returns the bytes of the record in memory.
    pub const fn to_bytes(self) -> [u8; Self::BYTES] {
        let b0 = self.magic[0];
        let b1 = self.magic[1];
        let b2 = self.magic[2];
        let b3 = self.magic[3];
        let [b4, b5, b6, b7] = self.length.to_le_bytes();
        let [b8, b9, b10, b11] = self.chunks.to_le_bytes();
        let [b12, b13, b14, b15] = self.vertices.to_le_bytes();
        let [b16, b17, b18, b19] = self.triangles.to_le_bytes();
        let [b20, b21, b22, b23] = self.radius.to_le_bytes();
        let [b24, b25, b26, b27] = self.checksum.to_le_bytes();
        let [b28, b29, b30, b31] = self.attributes.to_le_bytes();
        [b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, b12, b13, b14, b15, b16, b17, b18, b19, b20, b21, b22, b23, b24, b25, b26, b27, b28, b29, b30, b31]
    }
}

/// Header of a chunk of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChunkHeader {
    /// Number of vertices, 1 to 65,535.
    pub vertices: u32,
    /// Number of triangles.
    pub triangles: u32,
}

impl ChunkHeader {
    /// Size of the record in bytes.
    pub const BYTES: usize = 16;
    /// Byte range of the field `vertices`.
    pub const VERTICES: Range<usize> = 0..4;
    /// Byte range of the field `triangles`.
    pub const TRIANGLES: Range<usize> = 4..8;
    /// Byte range of the field `reserved`.
    pub const RESERVED: Range<usize> = 8..16;

    /// Returns the record with these bytes in memory.
    pub const fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {
        Self {
            vertices: u32::from_le_bytes(field(bytes, 0)),
            triangles: u32::from_le_bytes(field(bytes, 4)),
        }
    }

    /// Returns the bytes of the record in memory.
    pub const fn to_bytes(self) -> [u8; Self::BYTES] {
        let [b0, b1, b2, b3] = self.vertices.to_le_bytes();
        let [b4, b5, b6, b7] = self.triangles.to_le_bytes();
        [b0, b1, b2, b3, b4, b5, b6, b7, 0, 0, 0, 0, 0, 0, 0, 0]
    }
}

/// Vertex of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Vertex {
    /// Place, s2.14.
    pub position: [i16; 3],
    /// Normal of the surface, s2.14.
    pub normal: [i16; 3],
    /// The highest 5, 6 and 5 bits of red, green and blue: RGB565.
    pub colour: Rgb565,
    /// The lowest 3, 2 and 3 bits of red, green and blue, XOR the highest bits of the channel; 0 for a colour of RGB565.
    pub fine: u8,
}

impl Vertex {
    /// Size of the record in bytes.
    pub const BYTES: usize = 16;
    /// Byte range of the field `position`.
    pub const POSITION: Range<usize> = 0..6;
    /// Byte range of the field `normal`.
    pub const NORMAL: Range<usize> = 6..12;
    /// Byte range of the field `colour`.
    pub const COLOUR: Range<usize> = 12..14;
    /// Byte range of the field `fine`.
    pub const FINE: Range<usize> = 14..15;
    /// Byte range of the field `reserved`.
    pub const RESERVED: Range<usize> = 15..16;

    /// Returns the record with these bytes in memory.
    pub const fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {
        Self {
            position: [i16::from_le_bytes(field(bytes, 0)), i16::from_le_bytes(field(bytes, 2)), i16::from_le_bytes(field(bytes, 4))],
            normal: [i16::from_le_bytes(field(bytes, 6)), i16::from_le_bytes(field(bytes, 8)), i16::from_le_bytes(field(bytes, 10))],
            colour: Rgb565(u16::from_le_bytes(field(bytes, 12))),
            fine: u8::from_le_bytes(field(bytes, 14)),
        }
    }

    /// Returns the bytes of the record in memory.
    pub const fn to_bytes(self) -> [u8; Self::BYTES] {
        let [b0, b1] = self.position[0].to_le_bytes();
        let [b2, b3] = self.position[1].to_le_bytes();
        let [b4, b5] = self.position[2].to_le_bytes();
        let [b6, b7] = self.normal[0].to_le_bytes();
        let [b8, b9] = self.normal[1].to_le_bytes();
        let [b10, b11] = self.normal[2].to_le_bytes();
        let [b12, b13] = self.colour.0.to_le_bytes();
        let b14 = self.fine;
        [b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, b12, b13, b14, 0]
    }
}

/// Triangle of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triangle {
    /// Numbers of the vertices in the chunk, counter-clockwise seen from outside.
    pub indices: [u16; 3],
    /// RGB565.
    pub colour: Rgb565,
    /// Normal of the face, s2.14.
    pub normal: [i16; 3],
    /// Number of its texture in the mesh, from 1; 0: none.
    pub texture: u8,
}

impl Triangle {
    /// Size of the record in bytes.
    pub const BYTES: usize = 16;
    /// Byte range of the field `indices`.
    pub const INDICES: Range<usize> = 0..6;
    /// Byte range of the field `colour`.
    pub const COLOUR: Range<usize> = 6..8;
    /// Byte range of the field `normal`.
    pub const NORMAL: Range<usize> = 8..14;
    /// Byte range of the field `texture`.
    pub const TEXTURE: Range<usize> = 14..15;
    /// Byte range of the field `reserved`.
    pub const RESERVED: Range<usize> = 15..16;

    /// Returns the record with these bytes in memory.
    pub const fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {
        Self {
            indices: [u16::from_le_bytes(field(bytes, 0)), u16::from_le_bytes(field(bytes, 2)), u16::from_le_bytes(field(bytes, 4))],
            colour: Rgb565(u16::from_le_bytes(field(bytes, 6))),
            normal: [i16::from_le_bytes(field(bytes, 8)), i16::from_le_bytes(field(bytes, 10)), i16::from_le_bytes(field(bytes, 12))],
            texture: u8::from_le_bytes(field(bytes, 14)),
        }
    }

    /// Returns the bytes of the record in memory.
    pub const fn to_bytes(self) -> [u8; Self::BYTES] {
        let [b0, b1] = self.indices[0].to_le_bytes();
        let [b2, b3] = self.indices[1].to_le_bytes();
        let [b4, b5] = self.indices[2].to_le_bytes();
        let [b6, b7] = self.colour.0.to_le_bytes();
        let [b8, b9] = self.normal[0].to_le_bytes();
        let [b10, b11] = self.normal[1].to_le_bytes();
        let [b12, b13] = self.normal[2].to_le_bytes();
        let b14 = self.texture;
        [b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, b12, b13, b14, 0]
    }
}

/// Texture coordinates of a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TextureCoordinates {
    /// Across, 1 is the width of the texture, s16.16.
    pub s: i32,
    /// Down, 1 is the height of the texture, s16.16.
    pub t: i32,
}

impl TextureCoordinates {
    /// Size of the record in bytes.
    pub const BYTES: usize = 8;
    /// Byte range of the field `s`.
    pub const S: Range<usize> = 0..4;
    /// Byte range of the field `t`.
    pub const T: Range<usize> = 4..8;

    /// Returns the record with these bytes in memory.
    pub const fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {
        Self {
            s: i32::from_le_bytes(field(bytes, 0)),
            t: i32::from_le_bytes(field(bytes, 4)),
        }
    }

    /// Returns the bytes of the record in memory.
    pub const fn to_bytes(self) -> [u8; Self::BYTES] {
        let [b0, b1, b2, b3] = self.s.to_le_bytes();
        let [b4, b5, b6, b7] = self.t.to_le_bytes();
        [b0, b1, b2, b3, b4, b5, b6, b7]
    }
}

/// Header of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TextureHeader {
    /// `GLT1`.
    pub magic: [u8; 4],
    /// Length of the whole texture in bytes.
    pub length: u32,
    /// CRC-32 of all other bytes.
    pub checksum: u32,
    /// Base-2 logarithm of the width, 3 to 10.
    pub width_log2: u8,
    /// Base-2 logarithm of the height, 3 to 10.
    pub height_log2: u8,
    /// Number of mip levels: 1, or down to a side of 1 in both directions.
    pub levels: u8,
    /// Texels: 0 RGB565, 1 indices of 256 colours, 2 indices of 16 colours.
    pub format: u8,
    /// Wrapping across and down: 0 repeat, 1 mirror, 2 clamp.
    pub wrap: [u8; 2],
    /// 0: the nearest texel; 1: bilinear.
    pub filter: u8,
    /// 1: texels with the value of `key` are transparent.
    pub cut_out: u8,
    /// Value of a transparent texel: a colour or an index.
    pub key: u16,
    /// 0 opaque; 1 to 7 opacity in eighths; 8 added to the picture behind it.
    pub blend: u8,
}

impl TextureHeader {
    /// Size of the record in bytes.
    pub const BYTES: usize = 32;
    /// Byte range of the field `magic`.
    pub const MAGIC: Range<usize> = 0..4;
    /// Byte range of the field `length`.
    pub const LENGTH: Range<usize> = 4..8;
    /// Byte range of the field `checksum`.
    pub const CHECKSUM: Range<usize> = 8..12;
    /// Byte range of the field `width_log2`.
    pub const WIDTH_LOG2: Range<usize> = 12..13;
    /// Byte range of the field `height_log2`.
    pub const HEIGHT_LOG2: Range<usize> = 13..14;
    /// Byte range of the field `levels`.
    pub const LEVELS: Range<usize> = 14..15;
    /// Byte range of the field `format`.
    pub const FORMAT: Range<usize> = 15..16;
    /// Byte range of the field `wrap`.
    pub const WRAP: Range<usize> = 16..18;
    /// Byte range of the field `filter`.
    pub const FILTER: Range<usize> = 18..19;
    /// Byte range of the field `cut_out`.
    pub const CUT_OUT: Range<usize> = 19..20;
    /// Byte range of the field `key`.
    pub const KEY: Range<usize> = 20..22;
    /// Byte range of the field `blend`.
    pub const BLEND: Range<usize> = 22..23;
    /// Byte range of the field `reserved`.
    pub const RESERVED: Range<usize> = 23..32;

    /// Returns the record with these bytes in memory.
    pub const fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {
        Self {
            magic: field(bytes, 0),
            length: u32::from_le_bytes(field(bytes, 4)),
            checksum: u32::from_le_bytes(field(bytes, 8)),
            width_log2: u8::from_le_bytes(field(bytes, 12)),
            height_log2: u8::from_le_bytes(field(bytes, 13)),
            levels: u8::from_le_bytes(field(bytes, 14)),
            format: u8::from_le_bytes(field(bytes, 15)),
            wrap: field(bytes, 16),
            filter: u8::from_le_bytes(field(bytes, 18)),
            cut_out: u8::from_le_bytes(field(bytes, 19)),
            key: u16::from_le_bytes(field(bytes, 20)),
            blend: u8::from_le_bytes(field(bytes, 22)),
        }
    }

    /// Returns the bytes of the record in memory.
    pub const fn to_bytes(self) -> [u8; Self::BYTES] {
        let b0 = self.magic[0];
        let b1 = self.magic[1];
        let b2 = self.magic[2];
        let b3 = self.magic[3];
        let [b4, b5, b6, b7] = self.length.to_le_bytes();
        let [b8, b9, b10, b11] = self.checksum.to_le_bytes();
        let b12 = self.width_log2;
        let b13 = self.height_log2;
        let b14 = self.levels;
        let b15 = self.format;
        let b16 = self.wrap[0];
        let b17 = self.wrap[1];
        let b18 = self.filter;
        let b19 = self.cut_out;
        let [b20, b21] = self.key.to_le_bytes();
        let b22 = self.blend;
        [b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, b12, b13, b14, b15, b16, b17, b18, b19, b20, b21, b22, 0, 0, 0, 0, 0, 0, 0, 0, 0]
    }
}

/// End point of a segment.
pub mod segment_end {
    use super::Bits;

    /// Size of the record in bits.
    pub const BITS: usize = 128;
    /// X, s12.8.
    pub const X: Bits = Bits::new(0, 20, 20);
    /// Y, s12.8.
    pub const Y: Bits = Bits::new(32, 20, 20);
    /// Depth code before its rounding, u18.6.
    pub const W: Bits = Bits::new(64, 24, 24);
    /// Colour, RGB565, in the first end; bias in the second end.
    pub const SIDE: Bits = Bits::new(96, 16, 16);
}

/// Increments of an edge function.
pub mod steps {
    use super::Bits;

    /// Size of the record in bits.
    pub const BITS: usize = 42;
    /// Increment of E' for one pixel to the right, s21.
    pub const X: Bits = Bits::new(0, 21, 21);
    /// Increment of E' for one pixel down, s21.
    pub const Y: Bits = Bits::new(21, 21, 21);
}

/// Triangle after the setup, three words of 16 bytes.
pub mod descriptor {
    use super::Bits;

    /// Size of the record in bits.
    pub const BITS: usize = 384;
    /// E' of each edge at the start, s34.
    pub const START: Bits = Bits::new(0, 34, 34);
    /// Depth accumulator at the start, 18.14, modulo 2^32.
    pub const DEPTH_START: Bits = Bits::new(102, 32, 32);
    /// Gx: its increment for one pixel to the right.
    pub const DEPTH_STEP_X: Bits = Bits::new(134, 32, 32);
    /// Gy: its increment for one pixel down.
    pub const DEPTH_STEP_Y: Bits = Bits::new(166, 32, 32);
    /// Increment of E' for one pixel to the right, s21, of each edge.
    pub const STEPS_X: Bits = Bits::new(198, 21, 42);
    /// Increment of E' for one pixel down, s21, of each edge.
    pub const STEPS_Y: Bits = Bits::new(219, 21, 42);
    /// First row.
    pub const TOP: Bits = Bits::new(324, 10, 10);
    /// One past the last row.
    pub const BOTTOM: Bits = Bits::new(334, 10, 10);
    /// First group of eight columns in the bounds.
    pub const GROUP_LEFT: Bits = Bits::new(344, 8, 8);
    /// Last group in the bounds.
    pub const GROUP_RIGHT: Bits = Bits::new(352, 8, 8);
    /// Group of the start.
    pub const GROUP_START: Bits = Bits::new(360, 8, 8);
    /// Colour, RGB565, after shading.
    pub const COLOUR: Bits = Bits::new(368, 16, 16);
}

/// Plane of a depth or of a channel of light.
pub mod plane {
    use super::Bits;

    /// Size of the record in bits.
    pub const BITS: usize = 96;
    /// Accumulator at the start of the triangle, 18.14, modulo 2^32.
    pub const START: Bits = Bits::new(0, 32, 32);
    /// Its increment for one pixel to the right.
    pub const STEP_X: Bits = Bits::new(32, 32, 32);
    /// Its increment for one pixel down.
    pub const STEP_Y: Bits = Bits::new(64, 32, 32);
}

/// Planes of light of a triangle, in the three words after its descriptor.
pub mod planes {
    use super::Bits;

    /// Size of the record in bits.
    pub const BITS: usize = 289;
    /// Accumulator at the start of the triangle, 18.14, modulo 2^32, of red, green and blue.
    pub const LIGHT_START: Bits = Bits::new(0, 32, 96);
    /// Its increment for one pixel to the right, of red, green and blue.
    pub const LIGHT_STEP_X: Bits = Bits::new(32, 32, 96);
    /// Its increment for one pixel down, of red, green and blue.
    pub const LIGHT_STEP_Y: Bits = Bits::new(64, 32, 96);
    /// 1: smooth; 0: flat, in the colour of the descriptor.
    pub const SMOOTH: Bits = Bits::new(288, 1, 1);
}

/// Texture of a triangle, in the two words after its descriptor.
pub mod texture_planes {
    use super::Bits;

    /// Size of the record in bits.
    pub const BITS: usize = 241;
    /// Accumulator at the start of the triangle, 18.14, modulo 2^32, of s and t.
    pub const PLANES_START: Bits = Bits::new(0, 32, 96);
    /// Its increment for one pixel to the right, of s and t.
    pub const PLANES_STEP_X: Bits = Bits::new(32, 32, 96);
    /// Its increment for one pixel down, of s and t.
    pub const PLANES_STEP_Y: Bits = Bits::new(64, 32, 96);
    /// Of red, green and blue under flat shading, u0.8.
    pub const LIGHT: Bits = Bits::new(192, 8, 8);
    /// Base-2 logarithms of the ranges of s and t, in repeats.
    pub const RANGE: Bits = Bits::new(216, 4, 4);
    /// Base of clamped coordinates s and t, s4, in units of two repeats.
    pub const PERIODS: Bits = Bits::new(224, 4, 4);
    /// Number of its texture in the frame's table, from 1; 0: none.
    pub const TEXTURE: Bits = Bits::new(232, 8, 8);
    /// 1: orthographic projection.
    pub const LINEAR: Bits = Bits::new(240, 1, 1);
}

/// Piece of a line.
pub mod piece {
    use super::Bits;

    /// Size of the record in bits.
    pub const BITS: usize = 182;
    /// 1: a pixel in each column, otherwise in each row.
    pub const X_MAJOR: Bits = Bits::new(0, 1, 1);
    /// Towards lower columns.
    pub const LEFT: Bits = Bits::new(1, 1, 1);
    /// Towards lower rows.
    pub const UP: Bits = Bits::new(2, 1, 1);
    /// Column of the first pixel.
    pub const COLUMN: Bits = Bits::new(3, 11, 11);
    /// Row of the first pixel.
    pub const ROW: Bits = Bits::new(14, 10, 10);
    /// Pixels to the end of the line.
    pub const COUNT: Bits = Bits::new(24, 12, 12);
    /// Error of the second pixel, s21; if at least 0, the step to this pixel also moves along the minor axis.
    pub const ERROR: Bits = Bits::new(36, 21, 21);
    /// Increment of the error for a pixel without a step along the minor axis.
    pub const MINOR: Bits = Bits::new(57, 20, 20);
    /// Increment of the error for a pixel with such a step, s21: minor − major.
    pub const FALL: Bits = Bits::new(77, 21, 21);
    /// Depth accumulator of the first pixel, with the bias and half a code, s20.14.
    pub const DEPTH: Bits = Bits::new(98, 34, 34);
    /// Increment of the depth for one pixel, s20.14.
    pub const DEPTH_STEP: Bits = Bits::new(132, 34, 34);
    /// RGB565.
    pub const COLOUR: Bits = Bits::new(166, 16, 16);
}

/// Piece in memory, in the place of a descriptor.
pub mod stored_piece {
    use super::Bits;

    /// Size of the record in bits.
    pub const BITS: usize = 384;
    /// Bits 0 to 127 of the piece again.
    pub const REPEATS: Bits = Bits::new(0, 128, 128);
    /// Bits 0 to 127 of the piece.
    pub const LOW: Bits = Bits::new(128, 128, 128);
    /// Bits 0 to 63 of the piece again.
    pub const REPEATS_LOW: Bits = Bits::new(256, 64, 64);
    /// Bits 128 to 165 of the piece.
    pub const HIGH: Bits = Bits::new(320, 38, 38);
    /// 3; in a triangle at most 2, because no picture has 192 groups of columns.
    pub const MARK: Bits = Bits::new(366, 2, 2);
    /// RGB565.
    pub const COLOUR: Bits = Bits::new(368, 16, 16);
}

/// Header of the contents of a flash image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlashHeader {
    /// `GFC1`.
    pub magic: [u8; 4],
    /// Length of the contents in bytes.
    pub length: u32,
    /// Number of items.
    pub items: u32,
    /// CRC-32 of header and list, without this word.
    pub checksum: u32,
}

impl FlashHeader {
    /// Size of the record in bytes.
    pub const BYTES: usize = 16;
    /// Byte range of the field `magic`.
    pub const MAGIC: Range<usize> = 0..4;
    /// Byte range of the field `length`.
    pub const LENGTH: Range<usize> = 4..8;
    /// Byte range of the field `items`.
    pub const ITEMS: Range<usize> = 8..12;
    /// Byte range of the field `checksum`.
    pub const CHECKSUM: Range<usize> = 12..16;

    /// Returns the record with these bytes in memory.
    pub const fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {
        Self {
            magic: field(bytes, 0),
            length: u32::from_le_bytes(field(bytes, 4)),
            items: u32::from_le_bytes(field(bytes, 8)),
            checksum: u32::from_le_bytes(field(bytes, 12)),
        }
    }

    /// Returns the bytes of the record in memory.
    pub const fn to_bytes(self) -> [u8; Self::BYTES] {
        let b0 = self.magic[0];
        let b1 = self.magic[1];
        let b2 = self.magic[2];
        let b3 = self.magic[3];
        let [b4, b5, b6, b7] = self.length.to_le_bytes();
        let [b8, b9, b10, b11] = self.items.to_le_bytes();
        let [b12, b13, b14, b15] = self.checksum.to_le_bytes();
        [b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, b12, b13, b14, b15]
    }
}

/// Entry of the list of items of a flash image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlashEntry {
    /// Kind: 1 mesh, 2 scene, 3 list, 4 texture, 5 program.
    pub kind: u32,
    /// Length of the item in bytes.
    pub length: u32,
    /// CRC-32 of the item.
    pub checksum: u32,
    /// Name: 1 to 24 visible characters of ASCII, then zeros.
    pub name: [u8; 32],
}

impl FlashEntry {
    /// Size of the record in bytes.
    pub const BYTES: usize = 48;
    /// Byte range of the field `kind`.
    pub const KIND: Range<usize> = 0..4;
    /// Byte range of the field `length`.
    pub const LENGTH: Range<usize> = 4..8;
    /// Byte range of the field `checksum`.
    pub const CHECKSUM: Range<usize> = 8..12;
    /// Byte range of the field `reserved`.
    pub const RESERVED: Range<usize> = 12..16;
    /// Byte range of the field `name`.
    pub const NAME: Range<usize> = 16..48;

    /// Returns the record with these bytes in memory.
    pub const fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {
        Self {
            kind: u32::from_le_bytes(field(bytes, 0)),
            length: u32::from_le_bytes(field(bytes, 4)),
            checksum: u32::from_le_bytes(field(bytes, 8)),
            name: field(bytes, 16),
        }
    }

    /// Returns the bytes of the record in memory.
    pub const fn to_bytes(self) -> [u8; Self::BYTES] {
        let [b0, b1, b2, b3] = self.kind.to_le_bytes();
        let [b4, b5, b6, b7] = self.length.to_le_bytes();
        let [b8, b9, b10, b11] = self.checksum.to_le_bytes();
        let b16 = self.name[0];
        let b17 = self.name[1];
        let b18 = self.name[2];
        let b19 = self.name[3];
        let b20 = self.name[4];
        let b21 = self.name[5];
        let b22 = self.name[6];
        let b23 = self.name[7];
        let b24 = self.name[8];
        let b25 = self.name[9];
        let b26 = self.name[10];
        let b27 = self.name[11];
        let b28 = self.name[12];
        let b29 = self.name[13];
        let b30 = self.name[14];
        let b31 = self.name[15];
        let b32 = self.name[16];
        let b33 = self.name[17];
        let b34 = self.name[18];
        let b35 = self.name[19];
        let b36 = self.name[20];
        let b37 = self.name[21];
        let b38 = self.name[22];
        let b39 = self.name[23];
        let b40 = self.name[24];
        let b41 = self.name[25];
        let b42 = self.name[26];
        let b43 = self.name[27];
        let b44 = self.name[28];
        let b45 = self.name[29];
        let b46 = self.name[30];
        let b47 = self.name[31];
        [b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11, 0, 0, 0, 0, b16, b17, b18, b19, b20, b21, b22, b23, b24, b25, b26, b27, b28, b29, b30, b31, b32, b33, b34, b35, b36, b37, b38, b39, b40, b41, b42, b43, b44, b45, b46, b47]
    }
}

/// Header of the firmware in a flash image: that of LiteX's flash boot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FirmwareHeader {
    /// Length of the program in bytes.
    pub length: u32,
    /// CRC-32 of the program.
    pub checksum: u32,
}

impl FirmwareHeader {
    /// Size of the record in bytes.
    pub const BYTES: usize = 8;
    /// Byte range of the field `length`.
    pub const LENGTH: Range<usize> = 0..4;
    /// Byte range of the field `checksum`.
    pub const CHECKSUM: Range<usize> = 4..8;

    /// Returns the record with these bytes in memory.
    pub const fn from_bytes(bytes: &[u8; Self::BYTES]) -> Self {
        Self {
            length: u32::from_le_bytes(field(bytes, 0)),
            checksum: u32::from_le_bytes(field(bytes, 4)),
        }
    }

    /// Returns the bytes of the record in memory.
    pub const fn to_bytes(self) -> [u8; Self::BYTES] {
        let [b0, b1, b2, b3] = self.length.to_le_bytes();
        let [b4, b5, b6, b7] = self.checksum.to_le_bytes();
        [b0, b1, b2, b3, b4, b5, b6, b7]
    }
}
