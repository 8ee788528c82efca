//! The camera in f64: projection, clipping against the near plane, and the scale of depth.

/// A point or direction in world or camera coordinates.
pub type Vector = [f64; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn subtract(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A pinhole camera: an eye, an orthonormal basis with u × v = n, and its picture's plane at distance 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The centre of projection, in world units.
    pub eye: Vector,
    /// To the right on the screen.
    pub u: Vector,
    /// Down the screen.
    pub v: Vector,
    /// Forward, into the scene.
    pub n: Vector,
    /// Half the width of the picture in the plane at distance 1.
    pub half_width: f64,
    /// Distance of the near plane along n, in world units.
    pub near: f64,
}

impl From<&glint_core::camera::View> for Camera {
    /// The camera with the view's own numbers, which f64 holds exactly.
    fn from(view: &glint_core::camera::View) -> Self {
        Self {
            eye: view.eye().map(|c| c.to_num()),
            u: view.u().map(|c| c.to_num()),
            v: view.v().map(|c| c.to_num()),
            n: view.n().map(|c| c.to_num()),
            half_width: view.half_width().to_num(),
            near: view.near().to_num(),
        }
    }
}

/// The size of a picture in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Camera {
    /// The camera coordinates of a point of the world: right, down and forward of the eye, in world units.
    pub fn coordinates(&self, point: Vector) -> Vector {
        let d = subtract(point, self.eye);
        [dot(d, self.u), dot(d, self.v), dot(d, self.n)]
    }

    /// Where a point in camera coordinates, in front of the eye, falls on the screen, in pixels from the top left.
    pub fn screen(&self, point: Vector, size: Size) -> [f64; 2] {
        let scale = self.pixels_per_unit(size);
        [
            f64::from(size.width) / 2.0 + point[0] / point[2] * scale,
            f64::from(size.height) / 2.0 + point[1] / point[2] * scale,
        ]
    }

    /// Pixels for one unit in the plane at distance 1; pixels are square.
    pub fn pixels_per_unit(&self, size: Size) -> f64 {
        f64::from(size.width) / 2.0 / self.half_width
    }

    /// The part of a convex polygon in camera coordinates that lies on or beyond the near plane
    /// (Sutherland and Hodgman 1974, in homogeneous coordinates: z is the divisor of the projection).
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
                kept.push([
                    a[0] + (b[0] - a[0]) * t,
                    a[1] + (b[1] - a[1]) * t,
                    self.near,
                ]);
            }
        }
        kept
    }

    /// K of the depth codes, code = K/z: (2^18 − 4)·max(near, −eye·n − radius·(1 + 2^-13)), cut to 17 significant bits. The
    /// radius grows a little because n may be a little longer than 1.
    ///
    /// `radius` is that of the scene about the origin, in world units.
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
    fn clipping_cuts_at_the_near_plane_and_keeps_what_touches_it() {
        let inside = [[0.0, 0.0, 1.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]];
        assert_eq!(CAMERA.clip_near(&inside), inside);
        let one_out = [[0.0, 0.0, 0.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]];
        let cut = CAMERA.clip_near(&one_out);
        assert_eq!(
            cut,
            [
                [0.5, 0.0, 1.0],
                [1.0, 0.0, 2.0],
                [0.0, 1.0, 2.0],
                [0.0, 0.5, 1.0]
            ]
        );
        assert!(
            CAMERA
                .clip_near(&[[0.0, 0.0, 0.5], [1.0, 0.0, -2.0], [0.0, 1.0, 0.0]])
                .is_empty()
        );
    }

    #[test]
    fn depth_scale_leaves_four_codes_at_the_nearest_depth() {
        // 3·262140 has 20 bits, of which the lowest three are cut.
        assert_eq!(CAMERA.depth_scale(0.0), 786_416.0);
        // (2 − 2^-13)·262140 = 524248.0 has 19 bits and ends in two zeros.
        assert_eq!(CAMERA.depth_scale(1.0), 524_248.0);
        assert_eq!(CAMERA.depth_scale(9.0), 262_140.0);
    }
}
