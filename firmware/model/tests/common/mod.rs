//! What the tests share: random numbers, cameras in f64, meshes and pictures.
#![allow(dead_code)] // Each test uses a part.

pub mod triangles;

use glint_core::camera::View;
use glint_core::colour::Rgb565;
use glint_core::fixed::{Q2_23, Q32_32, U4_28};
use glint_core::mesh::{IndexedTriangle, Mesh, Vertex, encode};
use glint_model::{DrawnTriangle, FrameBuffer, Options, Projected, Stats, trace};

/// SplitMix64.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    pub fn coin(&mut self) -> bool {
        self.bits() & 1 == 0
    }

    /// In `low`…`high`, both included.
    pub fn integer(&mut self, low: i64, high: i64) -> i64 {
        low + (self.bits() % (high - low + 1) as u64) as i64
    }

    /// In [low, high).
    pub fn real(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In [low, high), evenly in the logarithm.
    pub fn logarithmic(&mut self, low: f64, high: f64) -> f64 {
        self.real(low.ln(), high.ln()).exp()
    }

    pub fn direction(&mut self) -> [f64; 3] {
        loop {
            let v = [0; 3].map(|_| self.real(-1.0, 1.0));
            if (0.01..1.0).contains(&dot(v, v)) {
                return normalised(v);
            }
        }
    }
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn normalised(v: [f64; 3]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    v.map(|x| x / length)
}

/// A camera before it is rounded.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    pub eye: [f64; 3],
    pub u: [f64; 3],
    pub v: [f64; 3],
    pub n: [f64; 3],
    pub half_width: f64,
    pub near: f64,
}

impl Camera {
    /// Looks from `eye` so that the direction `towards` is at (a, b) on the image plane at distance 1.
    pub fn aimed(
        random: &mut Random,
        eye: [f64; 3],
        towards: [f64; 3],
        [a, b]: [f64; 2],
        half_width: f64,
        near: f64,
    ) -> Self {
        let frame = |first: [f64; 3], other: [f64; 3]| {
            let second = normalised(cross(first, other));
            [first, second, cross(first, second)]
        };
        let world = frame(normalised(towards), random.direction());
        let camera = frame(normalised([a, b, 1.0]), [0.6, -0.64, 0.48]);
        // The rotation that takes one frame to the other, applied to the camera's axes.
        let [u, v, n] = [0, 1, 2]
            .map(|axis| [0, 1, 2].map(|i| (0..3).map(|k| world[k][i] * camera[k][axis]).sum()));
        Self {
            eye,
            u,
            v,
            n,
            half_width,
            near,
        }
    }

    /// Somewhere within 1 of the origin, looking anywhere.
    pub fn inside(random: &mut Random) -> Self {
        let eye = [0; 3].map(|_| random.real(-1.0, 1.0));
        let (half_width, near) = (random.logarithmic(0.05, 4.0), random.logarithmic(0.01, 0.5));
        let towards = random.direction();
        Self::aimed(random, eye, towards, [0.0; 2], half_width, near)
    }

    /// Looks from `eye` at `target`, with v as near to −z as can be.
    pub fn looking(eye: [f64; 3], target: [f64; 3], half_width: f64, near: f64) -> Self {
        let n = normalised([0, 1, 2].map(|i| target[i] - eye[i]));
        let u = normalised(cross(n, [0.0, 0.0, 1.0]));
        Self {
            eye,
            u,
            v: cross(n, u),
            n,
            half_width,
            near,
        }
    }

    pub fn rounded(&self) -> View {
        let basis = |row: [f64; 3]| row.map(|x| Q2_23::from_num(x));
        View::new_checked(
            self.eye.map(|x| Q32_32::from_num(x)),
            basis(self.u),
            basis(self.v),
            basis(self.n),
            U4_28::from_num(self.half_width),
            U4_28::from_num(self.near),
        )
        .unwrap()
    }

    pub fn of(view: &View) -> Self {
        let basis = |row: [Q2_23; 3]| row.map(|x| x.to_num::<f64>());
        Self {
            eye: view.eye().map(|x| x.to_num::<f64>()),
            u: basis(view.u()),
            v: basis(view.v()),
            n: basis(view.n()),
            half_width: view.half_width().to_num(),
            near: view.near().to_num(),
        }
    }

    /// x and y in pixels, and z.
    pub fn project(&self, position: [f64; 3], width: u32, height: u32) -> [f64; 3] {
        let d = [0, 1, 2].map(|i| position[i] - self.eye[i]);
        let (half, z) = (f64::from(width) / 2.0, dot(self.n, d));
        let scale = half / self.half_width / z;
        [
            half + dot(self.u, d) * scale,
            f64::from(height) / 2.0 + dot(self.v, d) * scale,
            z,
        ]
    }
}

pub fn world(position: [i16; 3]) -> [f64; 3] {
    position.map(|x| f64::from(x) / 16384.0)
}

/// A triangle soup or an indexed mesh.
#[derive(Clone, Debug, Default)]
pub struct Model {
    pub positions: Vec<[i16; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

impl Model {
    pub fn soup(triangles: &[[[i16; 3]; 3]]) -> Self {
        let positions = triangles.concat();
        let triangles = (0..triangles.len() as u32)
            .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
            .collect();
        Self {
            positions,
            triangles,
        }
    }

    /// Triangles all over a cube: cameras inside it see them cross the near plane and the guard band.
    pub fn random(random: &mut Random, triangles: usize, reach: i64) -> Self {
        let mut corner = || [0; 3].map(|_| random.integer(-reach, reach - 1) as i16);
        Self::soup(
            &(0..triangles)
                .map(|_| [corner(), corner(), corner()])
                .collect::<Vec<_>>(),
        )
    }

    /// A box of the given half size about the origin, counter-clockwise from outside.
    pub fn cube(half: i16) -> Self {
        let positions = (0..8)
            .map(|i| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { half } else { -half }))
            .collect();
        let triangles = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ]
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
        Self {
            positions,
            triangles,
        }
    }

    /// A sphere of `rings` rings about the origin, closed and counter-clockwise from outside.
    pub fn sphere(radius: f64, rings: u32) -> Self {
        let around = 2 * rings;
        let quantised = |x: f64| (x * radius * 16384.0).round() as i16;
        let mut positions = vec![[0, 0, quantised(1.0)], [0, 0, quantised(-1.0)]];
        for ring in 1..rings {
            let (sp, cp) = (std::f64::consts::PI * f64::from(ring) / f64::from(rings)).sin_cos();
            for i in 0..around {
                let (st, ct) = (std::f64::consts::TAU * f64::from(i) / f64::from(around)).sin_cos();
                positions.push([sp * ct, sp * st, cp].map(quantised));
            }
        }
        let at = |ring: u32, i: u32| match ring {
            0 => 0,
            _ if ring == rings => 1,
            _ => 2 + (ring - 1) * around + i % around,
        };
        let mut triangles = Vec::new();
        for ring in 0..rings {
            for i in 0..around {
                let (a, b, c, d) = (
                    at(ring, i),
                    at(ring + 1, i),
                    at(ring + 1, i + 1),
                    at(ring, i + 1),
                );
                triangles.extend((ring + 1 < rings).then_some([a, b, c]));
                triangles.extend((ring > 0).then_some([a, c, d]));
            }
        }
        Self {
            positions,
            triangles,
        }
    }

    /// The same triangles, each starting with another vertex.
    pub fn rotated(&self, turns: usize) -> Self {
        let mut model = self.clone();
        model
            .triangles
            .iter_mut()
            .for_each(|t| t.rotate_left(turns));
        model
    }

    pub fn flipped(&self) -> Self {
        let mut model = self.clone();
        model.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        model
    }

    /// The bytes of the mesh; each triangle has a colour of its own and its geometric normal.
    pub fn encoded(&self) -> Vec<u8> {
        let vertices: Vec<Vertex> = self
            .positions
            .iter()
            .map(|&position| Vertex {
                position,
                ..Default::default()
            })
            .collect();
        let triangles: Vec<IndexedTriangle> = self
            .triangles
            .iter()
            .enumerate()
            .map(|(i, &indices)| {
                let [a, b, c] = indices.map(|i| world(self.positions[i as usize]));
                let edge = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] - a[i]);
                let normal = cross(edge(b), edge(c));
                let normal = if dot(normal, normal) > 0.0 {
                    normalised(normal)
                } else {
                    [0.0; 3]
                };
                IndexedTriangle {
                    indices,
                    colour: Rgb565((i as u16).wrapping_mul(0x9E37) | 0x8410),
                    normal: normal.map(|x| (x * 16384.0).round() as i16),
                }
            })
            .collect();
        encode(&vertices, &triangles).unwrap()
    }
}

/// A rendered picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub colour: Vec<u16>,
    pub depth: Vec<u32>,
    pub stats: Stats,
    pub drawn: Vec<DrawnTriangle>,
}

pub const CLEAR: u16 = 0x0841;

impl Picture {
    pub fn blank((width, height): (u32, u32)) -> Self {
        let pixels = (width * height) as usize;
        Self {
            width,
            height,
            colour: vec![CLEAR; pixels],
            depth: vec![0; pixels],
            stats: Stats::default(),
            drawn: vec![],
        }
    }

    pub fn target(&mut self) -> FrameBuffer<'_> {
        FrameBuffer {
            width: self.width,
            height: self.height,
            colour: &mut self.colour,
            depth: &mut self.depth,
        }
    }

    pub fn of_bytes(bytes: &[u8], view: &View, size: (u32, u32), cull: bool) -> Self {
        let mesh = Mesh::new_checked(bytes).unwrap();
        let mut scratch =
            vec![Projected::Behind; mesh.chunks().map(|c| c.vertex_count()).max().unwrap()];
        let mut picture = Self::blank(size);
        // What is not drawn must be cleared.
        picture.colour.fill(0xDEAD);
        picture.depth.fill(0xDEAD);
        let mut drawn = Vec::new();
        let options = Options {
            cull,
            clear: CLEAR,
            ..Options::default()
        };
        let stats = trace(
            &mesh,
            view,
            &mut picture.target(),
            &mut scratch,
            &options,
            |t| drawn.push(*t),
        )
        .unwrap();
        assert_eq!(stats.triangles_in, mesh.triangle_count());
        assert_eq!(stats.culled + stats.drawn, stats.triangles_in);
        assert!(
            stats.pixels_tested >= stats.pixels_covered
                && stats.pixels_covered >= stats.pixels_drawn
        );
        picture.stats = stats;
        picture.drawn = drawn;
        picture
    }

    pub fn of(model: &Model, view: &View, size: (u32, u32), cull: bool) -> Self {
        Self::of_bytes(&model.encoded(), view, size, cull)
    }

    /// Where something was drawn.
    pub fn coverage(&self) -> Vec<bool> {
        self.depth.iter().map(|&code| code != 0).collect()
    }

    pub fn covered(&self) -> usize {
        self.depth.iter().filter(|&&code| code != 0).count()
    }
}
