//! Cameras with `f64` coordinates, for tests.

use glint_core::camera::View;
use glint_core::fixed::{Q2_23, Q32_32, U4_28, U8_28};

use crate::math::{cross, dot, normalised};
use crate::random::Random;

/// A camera before rounding to the fixed-point formats of a `View`.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Position in the world.
    pub eye: [f64; 3],
    /// Unit vector to the right of the picture.
    pub u: [f64; 3],
    /// Unit vector downwards in the picture.
    pub v: [f64; 3],
    /// Unit vector in the viewing direction.
    pub n: [f64; 3],
    /// Half the width of the picture at distance 1.
    pub half_width: f64,
    /// Distance of the near plane.
    pub near: f64,
}

impl Camera {
    /// Camera at `eye` that sees the direction `towards` at the point (a, b) of the image plane at distance 1. The rotation of
    /// the camera about this direction is random.
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
        // Rotates the three unit vectors by the rotation that maps the vectors of `camera` to the vectors of `world`.
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

    /// Random camera: eye coordinates between −1 and 1, random viewing direction.
    pub fn inside(random: &mut Random) -> Self {
        let eye = [0; 3].map(|_| random.real(-1.0, 1.0));
        let (half_width, near) = (random.logarithmic(0.05, 4.0), random.logarithmic(0.01, 0.5));
        let towards = random.direction();
        Self::aimed(random, eye, towards, [0.0; 2], half_width, near)
    }

    /// Camera at `eye` that looks at `target`, turned so that the picture's downward vector `v` is as near to −z as possible.
    #[must_use]
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

    /// Rounds the camera to the fixed-point formats of a `View`.
    ///
    /// # Panics
    /// If a `View` cannot represent the camera.
    #[must_use]
    pub fn rounded(&self) -> View {
        let basis = |row: [f64; 3]| row.map(|x| Q2_23::from_num(x));
        View::new_checked(
            self.eye.map(|x| Q32_32::from_num(x)),
            basis(self.u),
            basis(self.v),
            basis(self.n),
            U8_28::from_num(self.half_width),
            U4_28::from_num(self.near),
        )
        .unwrap()
    }

    /// Converts a fixed-point view to a camera.
    #[must_use]
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

    /// Projects a position onto a picture of this size: returns x and y in pixels, and the distance z along the viewing direction.
    #[must_use]
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
