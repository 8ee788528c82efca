//! The meshes of the built-in scenes, made in integers: the same bytes on the board and on the host.

use core::array;

use crate::choice::choices;
use crate::colour::Rgb565;
use crate::fixed::{Q2_14, Q2_30, Turns};
use crate::mesh::{ChunkHeader, MAGIC, MeshHeader, Triangle, Vertex};
use crate::records::WORD;
use crate::trig::sin_cos_q30;
use crate::vector::{cross, unit};

/// A built-in mesh. The round ones have 1,024 triangles each, and colours at their vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A sphere of radius 0.5.
    Sphere,
    /// A torus of radius 0.5 about the z axis. Its tube has a radius of 0.15.
    Torus,
    /// A cylinder of radius 0.3 and length 1 about the z axis.
    Cylinder,
    /// Six triangles about the origin, in no order of their vertices that a camera would see.
    Polygons,
}

choices!(Shape {
    Sphere: "sphere",
    Torus: "torus",
    Cylinder: "cylinder",
    Polygons: "polygons",
});

/// Number of bytes that is enough for every shape.
pub const MAX_BYTES: usize = MeshHeader::BYTES + WORD * (1 + 20 * AROUND as usize + 1024);

/// Number of vertices around the axis.
const AROUND: u32 = 32;
/// 1.0 in Q2.14.
const ONE: i16 = 1 << 14;
/// Bands of the sphere between its poles.
const BANDS: u32 = 17;

/// The triangles of [`Shape::Polygons`], in hundredths, and their colours.
const POLYGONS: [([[i16; 3]; 3], [u8; 3]); 6] = [
    // A floor, which begins behind the camera of the scene and leaves its picture on both sides.
    (
        [[-190, -190, -50], [190, -190, -50], [0, 190, -50]],
        [0x40, 0x80, 0xFF],
    ),
    // Walls on both sides.
    (
        [[-160, -80, -50], [-180, 70, 140], [-110, 190, -50]],
        [0xFF, 0x40, 0x40],
    ),
    (
        [[160, -80, -50], [180, 70, 140], [110, 190, -50]],
        [0x40, 0xD0, 0x40],
    ),
    // Two triangles that pierce each other.
    (
        [[-60, 30, -50], [60, 30, -50], [0, 30, 90]],
        [0xFF, 0xD0, 0x20],
    ),
    (
        [[-70, 70, 10], [10, 40, 120], [70, -10, 10]],
        [0xE0, 0x40, 0xE0],
    ),
    // A roof, whose far end is beyond the far plane of the scene.
    (
        [[-90, -60, 150], [0, 190, 60], [90, -60, 150]],
        [0x40, 0xE0, 0xE0],
    ),
];

/// Words before the first vertex: the headers of the mesh and of its chunk.
const HEADERS: usize = MeshHeader::BYTES / WORD + 1;

/// A circle about the axis, and the normals at it.
struct Ring {
    radius: i32,
    height: i32,
    /// Components of the normal away from the axis and along it, s2.14.
    normal: [i32; 2],
}

impl Shape {
    /// Writes the mesh into `memory` in the format of an upload. Returns its length in bytes; `None` if the memory is shorter, which
    /// a memory of [`MAX_BYTES`] is not.
    // Not inlined, as the firmware has one copy.
    #[inline(never)]
    pub fn write(self, memory: &mut [u8]) -> Option<usize> {
        let mut writer = Writer {
            records: memory.as_chunks_mut().0,
            vertices: 0,
            triangles: 0,
        };
        match self {
            Self::Polygons => writer.polygons()?,
            Self::Sphere | Self::Torus | Self::Cylinder => writer.surface(self)?,
        }
        writer.finish()
    }

    /// The ring with this number; `None` after the last.
    fn ring(self, number: u32) -> Option<Ring> {
        let turned = |angle: u32| {
            let (sin, cos) = sin_cos(Turns(angle));
            (i32::from(sin.to_bits()), i32::from(cos.to_bits()))
        };
        let one = i32::from(ONE);
        match self {
            Self::Sphere => {
                // From the lower pole to the upper one, half a turn.
                let angle = (u64::from(number) << 31) / u64::from(BANDS);
                let (sin, cos) = turned(angle as u32);
                (number <= BANDS).then_some(Ring {
                    radius: (sin + 1) >> 1,
                    height: -cos >> 1,
                    normal: [sin, -cos],
                })
            }
            Self::Torus => {
                let (sin, cos) = turned(number << 28);
                let tube = |x: i32| scaled(Q2_14::lit("0.15"), x);
                (number <= 16).then_some(Ring {
                    radius: i32::from(Q2_14::lit("0.35").to_bits()) + tube(cos),
                    height: tube(sin),
                    normal: [cos, sin],
                })
            }
            Self::Cylinder => {
                // The centres of both ends, their edges with two normals each, and 14 rings between them.
                let edge = i32::from(Q2_14::lit("0.3").to_bits());
                let half = one / 2;
                let (radius, height, normal) = match number {
                    0 => (0, -half, [0, -one]),
                    1 => (edge, -half, [0, -one]),
                    2..=17 => (edge, (number as i32 - 2) * one / 15 - half, [one, 0]),
                    18 => (edge, half, [0, one]),
                    19 => (0, half, [0, one]),
                    _ => return None,
                };
                Some(Ring {
                    radius,
                    height,
                    normal,
                })
            }
            Self::Polygons => None,
        }
    }
}

/// Appends the records of a mesh with one chunk.
struct Writer<'m> {
    records: &'m mut [[u8; WORD]],
    vertices: u16,
    triangles: u16,
}

impl Writer<'_> {
    /// A surface of revolution: rings from the lower end to the upper one, and two triangles between neighbouring vertices.
    fn surface(&mut self, shape: Shape) -> Option<()> {
        let rings = (0..).map_while(|number| shape.ring(number));
        let mut count = 0;
        for (number, ring) in (0_u32..).zip(rings) {
            for step in 0..AROUND {
                let (sin, cos) = sin_cos(Turns(step << 27));
                let [radius, outwards] = [ring.radius, ring.normal[0]]
                    .map(|length| [scaled(cos, length), scaled(sin, length)]);
                // One turn of the colours around the axis, and about one across it.
                let hue = (step << 27).wrapping_add(number << 28);
                self.vertex(
                    [radius[0], radius[1], ring.height],
                    [outwards[0], outwards[1], ring.normal[1]],
                    colour(Turns(hue)),
                )?;
            }
            count = number + 1;
        }
        for lower in 1..count {
            for step in 0..AROUND {
                let next = (step + 1) % AROUND;
                let at = |ring: u32, step: u32| (ring * AROUND + step) as u16;
                let [a, b] = [step, next].map(|step| at(lower - 1, step));
                let [d, c] = [step, next].map(|step| at(lower, step));
                self.triangle([a, b, c])?;
                self.triangle([a, c, d])?;
            }
        }
        Some(())
    }

    fn polygons(&mut self) -> Option<()> {
        for (corners, rgb) in POLYGONS {
            for corner in corners {
                // At most 1.9 in Q2.14; truncated.
                let position = corner.map(|x| i32::from(x) * i32::from(ONE) / 100);
                self.vertex(position, [0, 0, ONE.into()], Rgb565::from_rgb888(rgb))?;
            }
        }
        for first in (0..18).step_by(3) {
            self.triangle([first, first + 1, first + 2])?;
        }
        Some(())
    }

    fn vertex(&mut self, position: [i32; 3], normal: [i32; 3], colour: Rgb565) -> Option<()> {
        let [position, normal] = [position, normal].map(|vector| vector.map(|x| x as i16));
        let vertex = Vertex {
            position,
            normal,
            colour,
        };
        *self.records.get_mut(HEADERS + usize::from(self.vertices))? = vertex.to_bytes();
        self.vertices += 1;
        Some(())
    }

    /// Appends a triangle with the colour of its first vertex, unless it has no area. All vertices come before all triangles.
    fn triangle(&mut self, indices: [u16; 3]) -> Option<()> {
        let [a, b, c] = indices.map(|index| self.position(index));
        let [along, across] = [b, c].map(|end| array::from_fn(|i| end[i] - a[i]));
        let Some(normal) = unit::<14>(cross(along, across)) else {
            return Some(());
        };
        let triangle = Triangle {
            indices,
            colour: self.written(indices[0]).colour,
            normal: normal.map(|x| x as i16),
        };
        let place = HEADERS + usize::from(self.vertices) + usize::from(self.triangles);
        *self.records.get_mut(place)? = triangle.to_bytes();
        self.triangles += 1;
        Some(())
    }

    fn written(&self, vertex: u16) -> Vertex {
        let record = self.records.get(HEADERS + usize::from(vertex));
        record.map_or_else(Vertex::default, Vertex::from_bytes)
    }

    fn position(&self, vertex: u16) -> [i32; 3] {
        self.written(vertex).position.map(i32::from)
    }

    /// Writes the headers. Returns the length of the mesh in bytes.
    fn finish(self) -> Option<usize> {
        let squared = (0..self.vertices).map(|vertex| {
            let squares = self.position(vertex).map(|x| x.unsigned_abs().pow(2));
            // Each is below 2^30.
            squares.iter().sum::<u32>()
        });
        let squared = squared.max().unwrap_or(0);
        let root = squared.isqrt();
        let radius = root + u32::from(root * root < squared);
        let [vertices, triangles] = [self.vertices, self.triangles].map(u32::from);
        let length = WORD * (HEADERS + (vertices + triangles) as usize);
        let header = MeshHeader {
            magic: MAGIC,
            length: length as u32,
            chunks: 1,
            vertices,
            triangles,
            radius,
            checksum: 0,
            attributes: 0,
        };
        let chunk = ChunkHeader {
            vertices,
            triangles,
        };
        let (first, rest) = self.records.as_flattened_mut().split_first_chunk_mut()?;
        *first = header.to_bytes();
        *rest.first_chunk_mut()? = chunk.to_bytes();
        Some(length)
    }
}

/// Sine and cosine, rounded to nearest.
fn sin_cos(angle: Turns) -> (Q2_14, Q2_14) {
    let narrow = |x: Q2_30| Q2_14::from_bits(((x.to_bits() + (1 << 15)) >> 16) as i16);
    let (sin, cos) = sin_cos_q30(angle);
    (narrow(sin), narrow(cos))
}

/// The product of a factor and a length of at most 2 in Q2.14, rounded down.
fn scaled(factor: Q2_14, length: i32) -> i32 {
    (i32::from(factor.to_bits()) * length) >> 14
}

/// A bright colour of the colour wheel.
fn colour(hue: Turns) -> Rgb565 {
    let channel = |third: u32| {
        let (_, cos) = sin_cos(Turns(hue.0.wrapping_add(third * (u32::MAX / 3))));
        // From 65 to 255.
        (160 + scaled(cos, 95)) as u8
    };
    Rgb565::from_rgb888([channel(0), channel(1), channel(2)])
}
