//! The camera in f64: projection, rays, clipping against the near plane, and the scale of depth.

use glint_core::camera::{View, ViewError};
use glint_core::fixed::{Q2_23, Q32_32, U4_28, U8_28};

pub use crate::math::{add_scaled, cross, dot, length, normalised, subtract};
use crate::random::Random;

/// A point or direction in world or camera coordinates.
pub type Vector = [f64; 3];

/// A ray: the points origin + t·direction for all t ≥ 0. t is the parameter of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point with the parameter 0, in world units.
    pub origin: Vector,
    /// Change of the point per unit of the parameter, in world units. Must not be zero.
    pub direction: Vector,
}

impl Ray {
    /// Returns the point with the parameter `t`.
    pub fn at(&self, t: f64) -> Vector {
        add_scaled(self.origin, self.direction, t)
    }
}

/// An eye of a stereo picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The left eye, at eye − offset·u, where `eye` and `u` are fields of `Camera`, and `offset` of `Stereo`.
    Left,
    /// The right eye, at eye + offset·u.
    Right,
}

/// Parameters of a stereo picture: two eyes side by side with parallel viewing directions, and pictures shifted horizontally
/// (off-axis projection).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stereo {
    /// Distance of each of the two eyes from the camera's `eye`, along the camera's direction `u`, in world units.
    pub offset: f64,
    /// Depth of the zero-parallax plane, in world units: both eyes see a point of the plane in the same pixel.
    pub zero: f64,
}

/// A pinhole camera: an eye and an orthonormal basis with u × v = n. The image plane is at distance 1 from the eye along n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The centre of projection, in world units.
    pub eye: Vector,
    /// Direction to the right on the screen.
    pub u: Vector,
    /// Direction down the screen.
    pub v: Vector,
    /// Direction forward, into the scene.
    pub n: Vector,
    /// Half the width of the picture, in world units in the plane at distance 1.
    pub half_width: f64,
    /// Distance of the near plane from the eye along n, in world units.
    pub near: f64,
}

/// The size of a picture in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
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

    /// Makes a camera at `eye` that looks at `target`, with +z up.
    ///
    /// If the line of sight is parallel to z, u and v are NaN.
    pub fn looking(eye: Vector, target: Vector, half_width: f64, near: f64) -> Self {
        let n = normalised(subtract(target, eye));
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

    /// Returns this camera rotated about its eye, as [`View::look`] rotates a view. `angles` are in degrees and apply in this
    /// order: yaw to the right, pitch downwards, roll.
    pub fn turned(&self, angles: Vector) -> Self {
        let [(sy, cy), (sp, cp), (sr, cr)] = angles.map(|angle| angle.to_radians().sin_cos());
        // The right, up and forward axes of the rotated camera before the roll, in coordinates of this camera.
        let right = [cy, 0.0, -sy];
        let up = [sp * sy, cp, sp * cy];
        let forward = [cp * sy, -sp, cp * cy];
        let rolled = |a: f64, b: f64| [0, 1, 2].map(|i: usize| a * right[i] + b * up[i]);
        let world = |[x, y, z]: Vector| {
            [0, 1, 2].map(|i: usize| x * self.u[i] - y * self.v[i] + z * self.n[i])
        };
        Self {
            u: world(rolled(cr, sr)),
            v: world(rolled(sr, -cr)),
            n: world(forward),
            ..*self
        }
    }

    /// Converts the camera to a view. Each number is rounded to nearest in its fixed-point format.
    ///
    /// # Errors
    /// The errors of [`View::new_checked`].
    ///
    /// # Panics
    /// If a number is outside the range of its format.
    pub fn view(&self) -> Result<View, ViewError> {
        let row = |row: Vector| row.map(Q2_23::from_num);
        View::new_checked(
            self.eye.map(Q32_32::from_num),
            row(self.u),
            row(self.v),
            row(self.n),
            U8_28::from_num(self.half_width),
            U4_28::from_num(self.near),
        )
    }

    /// Converts the camera as [`Self::view`] does.
    ///
    /// # Panics
    /// If a `View` cannot represent the camera.
    pub fn rounded(&self) -> View {
        let view = self.view();
        view.unwrap_or_else(|error| panic!("{self:?}: {error}"))
    }

    /// Converts the fixed-point numbers of a view to f64, exactly.
    pub fn of(view: &View) -> Self {
        Self {
            eye: view.eye().map(|c| c.to_num()),
            u: view.u().map(|c| c.to_num()),
            v: view.v().map(|c| c.to_num()),
            n: view.n().map(|c| c.to_num()),
            half_width: view.half_width().to_num(),
            near: view.near().to_num(),
        }
    }

    /// Returns the ray from the eye through a point of the picture. `x` is the column and `y` the row of the point, from 0.
    /// Integers are pixel centres.
    ///
    /// The ray's direction has a component of 1 along n, so the parameter t of a point of the ray is the point's depth.
    pub fn ray(&self, [x, y]: [f64; 2], size: Size) -> Ray {
        let width = f64::from(size.width);
        let right = (2.0 * x + 1.0 - width) / width * self.half_width;
        let down = (2.0 * y + 1.0 - f64::from(size.height)) / width * self.half_width;
        let direction = add_scaled(add_scaled(self.n, self.u, right), self.v, down);
        Ray {
            origin: self.eye,
            direction,
        }
    }

    /// Returns the ray from one eye of a stereo pair through a point of the picture. `pixel` is the column and
    /// the row of the point, as in [`Self::ray`].
    pub fn stereo_ray(&self, side: Side, stereo: Stereo, pixel: [f64; 2], size: Size) -> Ray {
        let offset = match side {
            Side::Left => -stereo.offset,
            Side::Right => stereo.offset,
        };
        let middle = self.ray(pixel, size);
        Ray {
            origin: add_scaled(middle.origin, self.u, offset),
            direction: add_scaled(middle.direction, self.u, -offset / stereo.zero),
        }
    }

    /// Converts a point from world to camera coordinates: right of, below and in front of the eye, in world units.
    pub fn coordinates(&self, point: Vector) -> Vector {
        let d = subtract(point, self.eye);
        [dot(d, self.u), dot(d, self.v), dot(d, self.n)]
    }

    /// Projects a point in camera coordinates, in front of the eye, to a screen position in pixels from the top left.
    pub fn screen(&self, point: Vector, size: Size) -> [f64; 2] {
        let scale = self.pixels_per_unit(size);
        [
            f64::from(size.width) / 2.0 + point[0] / point[2] * scale,
            f64::from(size.height) / 2.0 + point[1] / point[2] * scale,
        ]
    }

    /// Number of pixels per world unit in the image plane, horizontally and vertically.
    pub fn pixels_per_unit(&self, size: Size) -> f64 {
        f64::from(size.width) / 2.0 / self.half_width
    }

    /// Clips a convex polygon in camera coordinates: returns its part on or beyond the near plane. The method of Sutherland and
    /// Hodgman (1974), applied before the division by z.
    pub fn clip_near(&self, polygon: &[Vector]) -> Vec<Vector> {
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (i, &a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            let (da, db) = (a[2] - self.near, b[2] - self.near);
            if da >= 0.0 {
                kept.push(a);
            }
            if (da >= 0.0) != (db >= 0.0) {
                let t = da / (da - db);
                let [x, y] = [0, 1].map(|i: usize| a[i] + (b[i] - a[i]) * t);
                kept.push([x, y, self.near]);
            }
        }
        kept
    }

    /// Projects a position onto a picture of this size: returns x and y in pixels, and the distance z along the viewing direction.
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

    /// Computes the factor K of depth codes, with code = K/z: (2^18 − 4)·max(near, −eye·n − radius·(1 + 2^-13)), truncated to 17
    /// significant bits. The factor 1 + 2^-13 covers lengths of n slightly above 1.
    ///
    /// `radius` is the radius of a sphere about the origin that contains the scene, in world units.
    pub fn depth_scale(&self, radius: f64) -> f64 {
        let nearest = (-dot(self.eye, self.n) - radius * (1.0 + 1.0 / 8192.0)).max(self.near);
        let full = f64::from((1 << 18) - 4) * nearest;
        let unit = (full.log2().floor() - 16.0).exp2();
        (full / unit).floor() * unit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera {
        eye: [0.0, 0.0, -3.0],
        u: [1.0, 0.0, 0.0],
        v: [0.0, 1.0, 0.0],
        n: [0.0, 0.0, 1.0],
        half_width: 0.5,
        near: 1.0,
    };
    const SIZE: Size = Size {
        width: 320,
        height: 180,
    };

    #[test]
    fn the_middle_of_the_picture_is_straight_ahead_and_its_border_at_half_width() {
        let ahead = CAMERA.coordinates([0.0, 0.0, 7.0]);
        assert_eq!(CAMERA.screen(ahead, SIZE), [160.0, 90.0]);
        let border = CAMERA.coordinates([1.0, -0.5, -1.0]);
        assert_eq!(CAMERA.screen(border, SIZE), [320.0, 10.0]);
    }

    #[test]
    fn a_ray_goes_through_its_pixel_and_its_parameter_is_the_depth() {
        for pixel in [[0.0, 0.0], [319.0, 179.0], [17.25, 140.5]] {
            let point = CAMERA.coordinates(CAMERA.ray(pixel, SIZE).at(6.0));
            assert!((point[2] - 6.0).abs() < 1e-12);
            let [x, y] = CAMERA.screen(point, SIZE);
            assert!((x - pixel[0] - 0.5).abs() < 1e-9 && (y - pixel[1] - 0.5).abs() < 1e-9);
        }
    }

    #[test]
    fn both_eyes_meet_in_the_plane_of_no_parallax() {
        let stereo = Stereo {
            offset: 0.1,
            zero: 4.0,
        };
        let pixel = [100.0, 20.0];
        let [left, right] =
            [Side::Left, Side::Right].map(|side| CAMERA.stereo_ray(side, stereo, pixel, SIZE));
        assert_eq!([left.origin[0], right.origin[0]], [-0.1, 0.1]);
        let meeting = CAMERA.ray(pixel, SIZE).at(stereo.zero);
        for ray in [left, right] {
            assert!(length(subtract(ray.at(stereo.zero), meeting)) < 1e-12);
        }
        // In front of the zero-parallax plane, the left eye's ray through a pixel is to the left of the right eye's ray. So a
        // near point appears farther right in the left eye's picture.
        assert!(left.at(1.0)[0] < right.at(1.0)[0]);
    }

    #[test]
    fn looking_at_makes_a_right_handed_basis_with_z_up() {
        let camera = Camera::looking([0.0, -3.0, 0.0], [0.0, 5.0, 0.0], 0.9, 0.1);
        assert_eq!(
            [camera.u, camera.v, camera.n],
            [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]
        );
        let tilted = Camera::looking([2.0, 1.0, 1.5], [0.0, 0.5, -0.25], 0.9, 0.1);
        assert!(length(subtract(cross(tilted.u, tilted.v), tilted.n)) < 1e-12);
        assert!(tilted.v[2] < 0.0);
    }

    #[test]
    fn clipping_cuts_at_the_near_plane_and_keeps_what_touches_it() {
        let inside = [[0.0, 0.0, 1.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]];
        assert_eq!(CAMERA.clip_near(&inside), inside);
        let one_out = [[0.0, 0.0, 0.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]];
        let [_, b, c] = one_out;
        let cut = [[0.5, 0.0, 1.0], b, c, [0.0, 0.5, 1.0]];
        assert_eq!(CAMERA.clip_near(&one_out), cut);
        let behind = [[0.0, 0.0, 0.5], [1.0, 0.0, -2.0], [0.0, 1.0, 0.0]];
        assert!(CAMERA.clip_near(&behind).is_empty());
    }

    #[test]
    fn depth_scale_leaves_four_codes_at_the_nearest_depth() {
        // The nearest depth is 3: 3·262140 has 20 bits, the lowest three of which are truncated.
        assert_eq!(CAMERA.depth_scale(0.0), 786_416.0);
        // The nearest depth is 2 − 2^-13: (2 − 2^-13)·262140 = 524248.0005 has 19 integer bits, the lowest two of them 0. So only
        // the fraction is truncated.
        assert_eq!(CAMERA.depth_scale(1.0), 524_248.0);
        assert_eq!(CAMERA.depth_scale(9.0), 262_140.0);
    }
}
