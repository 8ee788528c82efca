//! The built-in model: a cube of edge length 1 with one colour per side.

/// Number of vertices of the cube.
const VERTICES: usize = 8;
/// Number of triangles of the cube.
const TRIANGLES: usize = 12;
/// Length of a record in bytes (docs/formats/mesh.md, "Mesh in memory"); the header is as long as two records.
const RECORD: usize = 16;
/// 1.0 in Q2.14.
const ONE: i16 = 1 << 14;
/// Distance of a corner from the centre, √3/2: 14 fraction bits, rounded up.
const RADIUS: u32 = 14_189;
/// 1/√3 in Q2.14: the magnitude of each component of a corner's normal.
const DIAGONAL: i16 = 9_459;

/// For each of the three pairs of sides: the axis, the colour of its positive side and the colour of its negative side.
const SIDES: [(usize, u16, u16); 3] = [
    (0, 0xf9c7, 0x0733),
    (1, 0xfe60, 0x2b9f),
    (2, 0xffff, 0xc2bf),
];

/// The mesh in the format of an upload.
pub static BYTES: Aligned = Aligned(bytes());

/// The bytes of the mesh, aligned to 16 bytes.
#[repr(align(16))]
pub struct Aligned([u8; LENGTH]);

impl core::ops::Deref for Aligned {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.0
    }
}

const LENGTH: usize = (2 + 1 + VERTICES + TRIANGLES) * RECORD;

const fn bytes() -> [u8; LENGTH] {
    let mut writer = Writer {
        bytes: [0; LENGTH],
        at: 0,
    };
    writer = writer
        .word(u32::from_le_bytes(*b"GLM2"))
        .word(LENGTH as u32)
        .word(1);
    writer = writer
        .word(VERTICES as u32)
        .word(TRIANGLES as u32)
        .word(RADIUS)
        .word(0)
        .word(0);
    writer = writer
        .word(VERTICES as u32)
        .word(TRIANGLES as u32)
        .word(0)
        .word(0);
    let mut corner = 0;
    while corner < VERTICES {
        writer = writer
            .triple(corner_at(corner, ONE / 2))
            .triple(corner_at(corner, DIAGONAL));
        writer = writer.half(0xffff).half(0);
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

/// Writer that appends little-endian numbers to the bytes of the mesh.
struct Writer {
    bytes: [u8; LENGTH],
    at: usize,
}

impl Writer {
    const fn half(mut self, value: u16) -> Self {
        [self.bytes[self.at], self.bytes[self.at + 1]] = value.to_le_bytes();
        self.at += 2;
        self
    }

    const fn word(self, value: u32) -> Self {
        self.half(value as u16).half((value >> 16) as u16)
    }

    const fn triple(self, [x, y, z]: [i16; 3]) -> Self {
        self.half(x as u16).half(y as u16).half(z as u16)
    }

    /// Appends the two triangles of a side of the cube, counter-clockwise seen from outside. The side is perpendicular to
    /// `axis`, at its positive end if `plus` is true.
    const fn side(mut self, axis: usize, plus: bool, colour: u16) -> Self {
        let (base, b, c) = (
            (plus as usize) << axis,
            1 << ((axis + 1) % 3),
            1 << ((axis + 2) % 3),
        );
        // Seen from the positive side the axes b and c turn counter-clockwise; seen from the negative side they turn
        // clockwise, so b and c change places.
        let (b, c) = if plus { (b, c) } else { (c, b) };
        let mut normal = [0; 3];
        normal[axis] = if plus { ONE } else { -ONE };
        let quad = [base, base + b, base + b + c, base + c];
        let mut triangle = 0;
        while triangle < 2 {
            self = self
                .half(quad[0] as u16)
                .half(quad[1 + triangle] as u16)
                .half(quad[2 + triangle] as u16);
            self = self.half(colour).triple(normal).half(0);
            triangle += 1;
        }
        self
    }
}
