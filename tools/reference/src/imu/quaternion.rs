//! Hamilton quaternions in f64 that rotate from body to world axes.

use glint_core::orientation;

use crate::camera::{Vector, cross, dot};

/// A quaternion as its components w, x, y and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion(pub [f64; 4]);

impl From<orientation::Quaternion> for Quaternion {
    fn from(quaternion: orientation::Quaternion) -> Self {
        Self(quaternion.parts().map(|part| part.to_num()))
    }
}

impl Quaternion {
    /// The identity rotation.
    pub const IDENTITY: Self = Self([1.0, 0.0, 0.0, 0.0]);

    /// Returns the quaternion exponential of `half`: the rotation whose rotation vector is twice `half`, in radians.
    pub fn exp(half: Vector) -> Self {
        let angle = dot(half, half).sqrt();
        // Below 1e-8 the sine equals the angle in f64.
        let scale = if angle > 1e-8 {
            angle.sin() / angle
        } else {
            1.0
        };
        let [x, y, z] = half.map(|c| c * scale);
        Self([angle.cos(), x, y, z])
    }

    /// Returns the rotation by yaw about z, then by pitch about the rotated y axis, then by roll about the rotated x axis. The
    /// angles are in radians.
    pub fn of_angles([yaw, pitch, roll]: Vector) -> Self {
        let about = |axis: usize, angle: f64| {
            let mut half = [0.0; 3];
            half[axis] = angle / 2.0;
            Self::exp(half)
        };
        about(2, yaw).times(about(1, pitch)).times(about(0, roll))
    }

    /// Returns the product of two quaternions: the rotation `other` followed by this rotation.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        let ([aw, ax, ay, az], [bw, bx, by, bz]) = (self.0, other.0);
        Self([
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ])
    }

    /// Returns the inverse of this quaternion, which must have length 1.
    #[must_use]
    pub fn inverse(self) -> Self {
        let [w, x, y, z] = self.0;
        Self([w, -x, -y, -z])
    }

    /// Returns the length of the quaternion.
    pub fn norm(self) -> f64 {
        self.0.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    /// This quaternion scaled to length 1.
    #[must_use]
    pub fn normalised(self) -> Self {
        let norm = self.norm();
        Self(self.0.map(|x| x / norm))
    }

    /// Rotates a vector from body axes to world axes.
    pub fn rotate(self, v: Vector) -> Vector {
        let [w, x, y, z] = self.0;
        let twice = cross([x, y, z], v).map(|c| 2.0 * c);
        let again = cross([x, y, z], twice);
        [0, 1, 2].map(|i| v[i] + w * twice[i] + again[i])
    }

    /// Returns the world's z axis in coordinates of the body.
    pub fn up(self) -> Vector {
        self.inverse().rotate([0.0, 0.0, 1.0])
    }

    /// Returns the rotation angle between two attitudes, in degrees.
    pub fn angle_to(self, other: Self) -> f64 {
        let [w, x, y, z] = self.inverse().times(other).0;
        2.0 * (x * x + y * y + z * z).sqrt().atan2(w.abs()).to_degrees()
    }

    /// Returns the angle between the up directions of two attitudes, in degrees. The angle does not depend on yaw.
    pub fn inclination_to(self, other: Self) -> f64 {
        let (a, b) = (self.up(), other.up());
        let sine = cross(a, b);
        dot(sine, sine).sqrt().atan2(dot(a, b)).to_degrees()
    }

    /// Returns yaw, pitch and roll in radians: the inverse of [`Self::of_angles`].
    pub fn angles(self) -> Vector {
        let [w, x, y, z] = self.0;
        let level = [w * w + x * x - y * y - z * z, 2.0 * (x * y + w * z)];
        let pitch = (2.0 * (w * y - x * z)).atan2(level[0].hypot(level[1]));
        let roll = (2.0 * (y * z + w * x)).atan2(w * w - x * x - y * y + z * z);
        [level[1].atan2(level[0]), pitch, roll]
    }
}
