//! Models for tests: a few simple shapes, and random triangles.

use glint_core::colour::Rgb565;
use glint_core::mesh::{IndexedTriangle, Vertex, encode};

use crate::math::{cross, dot, normalised, world};
use crate::random::Random;

/// A model: vertex positions, and triangles that refer to these positions.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Positions of the vertices, Q2.14.
    pub positions: Vec<[i16; 3]>,
    /// For each triangle, the indices of its corners in `positions`.
    pub triangles: Vec<[u32; 3]>,
}

impl Model {
    /// Makes a model of triangles that share no vertices.
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

    /// Random triangles in the cube with coordinates from −`reach` to `reach` − 1, in Q2.14. Seen from inside the cube, many
    /// of them cross the near plane or the guard band.
    pub fn random(random: &mut Random, triangles: usize, reach: i64) -> Self {
        let mut corner = || [0; 3].map(|_| random.integer(-reach, reach - 1) as i16);
        let triangles = (0..triangles).map(|_| [corner(), corner(), corner()]);
        Self::soup(&triangles.collect::<Vec<_>>())
    }

    /// A cube about the origin with half the edge length `half`, in Q2.14. Its triangles are counter-clockwise seen from
    /// outside.
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

    /// A closed sphere about the origin, made of `rings` rings; `radius` is in world units. Its triangles are
    /// counter-clockwise seen from outside.
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
                let (a, b) = (at(ring, i), at(ring + 1, i));
                let (c, d) = (at(ring + 1, i + 1), at(ring, i + 1));
                triangles.extend((ring + 1 < rings).then_some([a, b, c]));
                triangles.extend((ring > 0).then_some([a, c, d]));
            }
        }
        Self {
            positions,
            triangles,
        }
    }

    /// This model with the three corners of each triangle cyclically shifted by `turns` positions.
    pub fn rotated(&self, turns: usize) -> Self {
        let mut model = self.clone();
        model
            .triangles
            .iter_mut()
            .for_each(|t| t.rotate_left(turns));
        model
    }

    /// This model with each triangle's winding order reversed.
    pub fn flipped(&self) -> Self {
        let mut model = self.clone();
        model.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        model
    }

    /// Encodes the model as a mesh of one or more chunks; each triangle has its own colour and its geometric normal.
    ///
    /// # Panics
    /// If the model has no vertex, a triangle's position index is out of range, or the mesh would be too large.
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
                    texture: 0,
                }
            })
            .collect();
        encode(&vertices, &triangles).unwrap()
    }
}
