//! The built-in model: a cube of edge length 1 with one colour per side.

use glint_core::colour::Rgb565;
use glint_core::mesh::{ChunkHeader, MAGIC, Mesh, MeshHeader, Triangle, Vertex};

use crate::aligned::Aligned;

/// Number of vertices of the cube.
const VERTICES: usize = 8;
/// Number of triangles of the cube.
const TRIANGLES: usize = 12;
/// 1.0 in Q2.14.
const ONE: i16 = 1 << 14;
/// Distance of a corner from the centre, √3/2: 14 fraction bits, rounded up.
const RADIUS: u32 = 14_189;
/// 1/√3 in Q2.14: the magnitude of each component of a corner's normal.
const DIAGONAL: i16 = 9_459;

/// For each of the three pairs of sides: the axis, the colour of the side at the positive end, and the colour of the side at the negative
/// end.
const SIDES: [(usize, u16, u16); 3] = [
    (0, 0xf9c7, 0x0733),
    (1, 0xfe60, 0x2b9f),
    (2, 0xffff, 0xc2bf),
];

/// The mesh.
pub const CUBE: Mesh<'static> = Mesh::from_constant(&BYTES.0).expect("a cube has whole records");

/// The mesh in the format of an upload.
static BYTES: Aligned<[u8; LENGTH]> = Aligned(bytes());

const LENGTH: usize =
    MeshHeader::BYTES + ChunkHeader::BYTES + VERTICES * Vertex::BYTES + TRIANGLES * Triangle::BYTES;

const fn bytes() -> [u8; LENGTH] {
    let header = MeshHeader {
        magic: MAGIC,
        length: LENGTH as u32,
        chunks: 1,
        vertices: VERTICES as u32,
        triangles: TRIANGLES as u32,
        radius: RADIUS,
        checksum: 0,
        attributes: 0,
    };
    let chunk = ChunkHeader {
        vertices: VERTICES as u32,
        triangles: TRIANGLES as u32,
    };
    let writer = Writer {
        bytes: [0; LENGTH],
        at: 0,
    };
    let mut writer = writer.put(&header.to_bytes()).put(&chunk.to_bytes());
    let mut corner = 0;
    while corner < VERTICES {
        let vertex = Vertex {
            position: corner_at(corner, ONE / 2),
            normal: corner_at(corner, DIAGONAL),
            colour: Rgb565(0xffff),
            fine: 0,
        };
        writer = writer.put(&vertex.to_bytes());
        corner += 1;
    }
    let mut side = 0;
    while side < SIDES.len() {
        writer = writer.side(SIDES[side].0, true, SIDES[side].1);
        writer = writer.side(SIDES[side].0, false, SIDES[side].2);
        side += 1;
    }
    writer.bytes
}

/// Vector from the centre to the corner `index`, with coordinates of magnitude `size`. Coordinate k is positive if bit k of
/// the index is 1.
const fn corner_at(index: usize, size: i16) -> [i16; 3] {
    let mut position = [-size; 3];
    let mut axis = 0;
    while axis < 3 {
        if index >> axis & 1 == 1 {
            position[axis] = size;
        }
        axis += 1;
    }
    position
}

/// Writes records to the bytes of the mesh.
struct Writer {
    bytes: [u8; LENGTH],
    at: usize,
}

impl Writer {
    const fn put(mut self, record: &[u8]) -> Self {
        let mut byte = 0;
        while byte < record.len() {
            self.bytes[self.at] = record[byte];
            self.at += 1;
            byte += 1;
        }
        self
    }

    /// Appends the two triangles of a side of the cube, counter-clockwise seen from outside. The side is perpendicular to `axis`, at the
    /// positive end if `plus` is true.
    const fn side(mut self, axis: usize, plus: bool, colour: u16) -> Self {
        let (base, b, c) = (
            (plus as usize) << axis,
            1 << ((axis + 1) % 3),
            1 << ((axis + 2) % 3),
        );
        // The rotation from axis b to axis c is counter-clockwise seen from the positive side, and clockwise seen from the negative side,
        // for which b and c are therefore exchanged.
        let (b, c) = if plus { (b, c) } else { (c, b) };
        let mut normal = [0; 3];
        normal[axis] = if plus { ONE } else { -ONE };
        let quad = [base, base + b, base + b + c, base + c];
        let mut triangle = 0;
        while triangle < 2 {
            let record = Triangle {
                texture: 0,
                indices: [
                    quad[0] as u16,
                    quad[1 + triangle] as u16,
                    quad[2 + triangle] as u16,
                ],
                colour: Rgb565(colour),
                normal,
            };
            self = self.put(&record.to_bytes());
            triangle += 1;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cube_is_a_mesh() {
        assert_eq!(Mesh::new_checked(&BYTES.0), Ok(CUBE));
    }
}
