//! Objects: meshes with a place in the world (docs/formats.md, "Objects").

use glint_core::camera::View;
use glint_core::fixed::{Q2_23, Q8_24, U4_28};
use glint_core::matrix::{Matrix, Normals};

use crate::depth::DepthScale;
use crate::error::RenderError;
use crate::triangle::mesh_setup::MeshSetup;
use crate::triangle::volume::Volume;

/// A model matrix, and what follows from it for every camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    matrix: Matrix,
    /// The matrix for normals; `None` if normals stay as they are and the light is turned by `rotation`.
    normals: Option<Normals>,
    /// The rotation or reflection of the matrix, without its scale, Q2.30; the identity if there are `normals`.
    rotation: [[i32; 3]; 3],
    /// A length that no vector of length 1 exceeds after the matrix, 24 fraction bits: the scale, if there is one, otherwise the
    /// root of the sum of the squares of all entries.
    stretch: i64,
}

impl Placement {
    /// Prepares a model matrix.
    pub fn new(matrix: Matrix) -> Self {
        const ONE: i32 = 1 << 30;
        let entries = matrix.linear().map(|row| row.map(Q8_24::to_bits));
        let square = |row: [i32; 3]| row.iter().map(|&x| i64::from(x).pow(2)).sum::<i64>();
        let [a, b, c] = entries.map(square);
        let normals = matrix.normals();
        let (kept, rotation, squared) = match normals.rotation() {
            // The squares of the rows differ by at most a part of 2^−12 from the first one.
            Some(rotation) => (None, *rotation, a.max(b).max(c)),
            None => (
                Some(normals),
                [[ONE, 0, 0], [0, ONE, 0], [0, 0, ONE]],
                a + b + c,
            ),
        };
        let root = squared.unsigned_abs().isqrt() as i64;
        Self {
            matrix,
            normals: kept,
            rotation,
            stretch: root + i64::from(root * root < squared),
        }
    }

    /// The model matrix.
    pub const fn matrix(&self) -> &Matrix {
        &self.matrix
    }

    /// Returns the largest distance of a vertex from the origin of a mesh with the given `radius` (14 fraction bits), in world
    /// units with 38 fraction bits; below 2^46.
    fn reach(&self, radius: u32) -> i64 {
        i64::from(radius) * self.stretch
    }

    /// Returns the smallest depth of a mesh at this place, with 37 fraction bits, in the camera's frame constants `camera`. As the
    /// axis n may be 10^−4 longer than 1, the radius is enlarged by a part of 2^−13.
    pub fn nearest(&self, camera: &MeshSetup, radius: u32) -> i64 {
        let [.., z] = self.origin(camera);
        let reach = self.reach(radius);
        z - (reach >> 1) - (reach >> 14) - 2
    }

    /// The origin of the mesh in camera coordinates, in the formats of the translation.
    fn origin(&self, camera: &MeshSetup) -> [i64; 3] {
        let place = self.matrix.place().map(Q8_24::to_bits);
        let along = |row: &[i32; 3], translation: i64| {
            // A row is shorter than 2^24.5 and a place at most √3·2^29, so the product is below 2^55.
            let product: i64 = core::iter::zip(row, place)
                .map(|(&r, p)| i64::from(r) * i64::from(p))
                .sum();
            translation + ((product + (1 << 9)) >> 10)
        };
        let [x, y, z] = camera.translation;
        [
            along(&camera.u, x),
            along(&camera.v, y),
            along(&camera.n, z),
        ]
    }

    /// Computes the frame constants of a mesh at this place from those of the camera, whose depth scale serves all objects of a
    /// frame.
    ///
    /// All homogeneous coordinates are multiplied by 2^−k, with the smallest k for which the row n and the farthest vertex fit
    /// the formats of the vertex stage; positions and depth codes do not change by this.
    ///
    /// # Errors
    /// [`RenderError::Near`] if the near plane is too near for the size and the distance of the object.
    pub fn setup(
        &self,
        view: &View,
        camera: &MeshSetup,
        radius: u32,
    ) -> Result<MeshSetup, RenderError> {
        // Products of a row and the matrix: below 3·2^24·2^28, with 24 more fraction bits.
        let [a, b, c] = self.matrix.linear().map(|row| row.map(Q8_24::to_bits));
        let product = |row: &[i32; 3]| {
            let [x, y, z] = row.map(i64::from);
            [0, 1, 2].map(|j| x * i64::from(a[j]) + y * i64::from(b[j]) + z * i64::from(c[j]))
        };
        let (u, v, n) = (product(&camera.u), product(&camera.v), product(&camera.n));
        let [x, y, z] = self.origin(camera);
        let reach = self.reach(radius);
        // A part of 2^−12 covers the errors of the camera's axes.
        let reach = reach + (reach >> 12);
        let farthest = z.abs() + (reach >> 1);
        let k = (0..=MOST_HALVINGS)
            .find(|&k| fits(&n, 24 + k) && farthest >> k < 1 << 41)
            .unwrap_or(MOST_HALVINGS);
        // The rows u and v get as many fraction bits as fit: f + k − cut.
        let widest = x.abs().max(y.abs()) + reach;
        let f = camera.scale_shift;
        let cut = ((f + k).saturating_sub(18)..f + k)
            .find(|&cut| fits(&u, 24 + cut) && fits(&v, 24 + cut) && widest >> cut < (1 << 43) - 1)
            .unwrap_or(f + k);
        let scale_shift = f + k - cut;

        // The leading bit of the near plane has at least the number 30, and 40 − f after the change of f.
        let least = (1 << 30).max(1 << (40_u32.saturating_sub(scale_shift)));
        if camera.near >> k < least || k == MOST_HALVINGS {
            return Err(RenderError::Near {
                near: view.near(),
                least: U4_28::from_bits(u32::try_from((least << k) >> 9).unwrap_or(u32::MAX)),
            });
        }
        let row = |row: [i64; 3], shift: u32| row.map(|x| shifted(x, shift) as i32);
        Ok(MeshSetup {
            scale_shift,
            u: row(u, 24 + cut),
            v: row(v, 24 + cut),
            n: row(n, 24 + k),
            translation: [shifted(x, cut), shifted(y, cut), shifted(z, k)],
            near: camera.near >> k,
            depth: DepthScale {
                exponent: camera.depth.exponent - k as i32,
                ..camera.depth
            },
            volume: match camera.volume {
                Volume::Guard => Volume::Guard,
                Volume::View { far } => Volume::View { far: far >> k },
            },
            light: self.light(view),
            normals: self.normals,
            mirrors: self.matrix.mirrors(),
            ..*camera
        })
    }

    /// The camera's forward axis, turned to the axes of the mesh, s2.23; unchanged if the normals are turned to the world.
    fn light(&self, view: &View) -> [i32; 3] {
        let n = view.n().map(Q2_23::to_bits);
        if self.normals.is_some() {
            return n;
        }
        // The sum is at most √3·2^54.
        [0, 1, 2].map(|j| {
            let sum: i64 = (0..3)
                .map(|i: usize| i64::from(self.rotation[i][j]) * i64::from(n[i]))
                .sum();
            shifted(sum, 30) as i32
        })
    }
}

/// Largest number of halvings of the homogeneous coordinates: with near at most 2, no more leave it at 2^−7.
const MOST_HALVINGS: u32 = 8;

/// Whether all numbers, divided by 2^`shift` and rounded, are less than 2^24 in magnitude.
fn fits(row: &[i64; 3], shift: u32) -> bool {
    row.iter()
        .all(|&x| shifted(x, shift).unsigned_abs() < 1 << 24)
}

/// Divides by 2^`shift`, rounded to nearest; `shift` may be 0.
const fn shifted(x: i64, shift: u32) -> i64 {
    (x + ((1 << shift) >> 1)) >> shift
}
