//! Attitudes as quaternions of length 1.

use crate::cordic::to_polar;
use crate::fixed::{Q2_30, Turns, wide};
use crate::trig::sin_cos_q30;

/// An attitude: a Hamilton quaternion that maps body to world, of length 1 within 2^−28.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Quaternion {
    /// The components w, x, y, z in units of 2^−30.
    pub(super) parts: [i32; 4],
}

/// 1 in the units of a component.
const ONE: i32 = 1 << 30;
/// If the cosine of the pitch is below this limit, roll is defined as 0. The limit is 2^−16 with 60 fraction bits, which is
/// reached within 0.00088° of the pole.
const POLE: i64 = 1 << 44;

impl Quaternion {
    /// The identity: the axes of body and world coincide.
    pub const IDENTITY: Self = Self {
        parts: [ONE, 0, 0, 0],
    };

    /// Scales four numbers (w, x, y, z) to a quaternion of length 1; `None` if all are 0.
    pub fn new(parts: [Q2_30; 4]) -> Option<Self> {
        let largest = parts.iter().map(|part| part.to_bits().unsigned_abs()).max();
        let up = largest?.checked_ilog2().map(|lead| 30 - lead.min(30))?;
        // The largest component has 30 bits, so the sum of squares has at most 62 bits.
        let wide = parts.map(|part| (i64::from(part.to_bits()) << up) >> 1);
        let length = wide.iter().map(|x| (x * x) as u64).sum::<u64>().isqrt() as i64;
        let parts = wide.map(|x| ((x << 30) / length) as i32);
        Some(Self { parts }.renormalised())
    }

    /// Returns the quaternion with exactly these components (w, x, y, z in units of 2^−30); `None` unless the
    /// length is 1 within 2^−28, the range in which the integrator's correction of the length converges.
    pub(crate) fn exact(parts: [i32; 4]) -> Option<Self> {
        // Each square is at most 2^62, so the sum fits u64; a sum beyond i64 is far too long.
        let square = parts
            .iter()
            .map(|&x| i64::from(x) * i64::from(x))
            .try_fold(0_i64, i64::checked_add)?;
        // The relative error of the squared length is twice the relative error of the length.
        (square - (1 << 60))
            .unsigned_abs()
            .lt(&(1 << 33))
            .then_some(Self { parts })
    }

    /// Returns the rotation by `angle` about one of the axes: 0, 1, 2 for x, y, z (larger numbers count as 2).
    pub fn about_axis(axis: usize, angle: Turns) -> Self {
        // The angle is reduced to −½ to ½ turns before it is halved, so that small angles of both signs give a quaternion near
        // the identity.
        let half = Turns((angle.0 as i32 >> 1) as u32);
        let (sin, cos) = sin_cos_q30(half);
        let mut parts = [cos.to_bits(), 0, 0, 0];
        parts[1 + axis.min(2)] = sin.to_bits();
        Self { parts }.renormalised()
    }

    /// Returns the attitude with these angles: the inverse of [`Quaternion::angles`].
    pub fn from_angles(angles: Angles) -> Self {
        let pitched = Self::about_axis(2, angles.yaw).times(Self::about_axis(1, angles.pitch));
        pitched.times(Self::about_axis(0, angles.roll))
    }

    /// The components w, x, y, z.
    pub const fn parts(self) -> [Q2_30; 4] {
        let [w, x, y, z] = self.parts;
        [
            Q2_30::from_bits(w),
            Q2_30::from_bits(x),
            Q2_30::from_bits(y),
            Q2_30::from_bits(z),
        ]
    }

    /// The inverse rotation, from world to body.
    #[must_use]
    pub const fn inverse(self) -> Self {
        let [w, x, y, z] = self.parts;
        Self {
            parts: [w, -x, -y, -z],
        }
    }

    /// Computes the product of two rotations: first `other`, then this rotation. The result is rounded to nearest and normalised.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        let products = product(&self.parts, other.parts);
        let parts = products.map(|x| ((x + (1 << 29)) >> 30) as i32);
        Self { parts }.renormalised()
    }

    /// Returns the quaternion with w ≥ 0 for the same attitude: this quaternion or its negative. For an attitude with w = 0 there
    /// are two such quaternions.
    #[must_use]
    pub fn canonical(self) -> Self {
        if self.parts[0] < 0 {
            Self {
                parts: self.parts.map(|x| -x),
            }
        } else {
            self
        }
    }

    /// Computes the directions of the body's axes x, y, z in the world, which are the columns of the rotation's matrix. The
    /// directions have 30 fraction bits, rounded to nearest, and length 1 within 2^−28.
    pub fn axes(self) -> [[i32; 3]; 3] {
        self.columns()
            .map(|column| column.map(|x| ((x + (1 << 29)) >> 30) as i32))
    }

    /// Computes the columns of the rotation's matrix exactly, with 60 fraction bits.
    fn columns(self) -> [[i64; 3]; 3] {
        let [w, x, y, z] = self.parts.map(i64::from);
        // Each element of the matrix is at most 1 in magnitude, and no intermediate value exceeds 2, so 64 bits are enough.
        let twice = |a: i64, b: i64| 2 * (a + b);
        [
            [
                w * w + x * x - y * y - z * z,
                twice(x * y, w * z),
                twice(x * z, -w * y),
            ],
            [
                twice(x * y, -w * z),
                w * w - x * x + y * y - z * z,
                twice(y * z, w * x),
            ],
            [
                twice(x * z, w * y),
                twice(y * z, -w * x),
                w * w - x * x - y * y + z * z,
            ],
        ]
    }

    /// Computes the direction of the world's z axis (up) in the body's axes, with 30 fraction bits, rounded down.
    pub(super) fn up(&self) -> [i32; 3] {
        let [w, x, y, z] = self.parts;
        // Each component is at most 1 in magnitude, apart from the error of the quaternion's length.
        [
            ((wide(x, z) - wide(w, y)) >> 29) as i32,
            ((wide(y, z) + wide(w, x)) >> 29) as i32,
            ((wide(w, w) - wide(x, x) - wide(y, y) + wide(z, z)) >> 30) as i32,
        ]
    }

    /// Computes yaw, pitch and roll: successive rotations about the body's z axis, then its y axis, then its x axis.
    /// These angles are for output only.
    ///
    /// Yaw and roll are in [−½, ½) turns and pitch in [−¼, ¼]. An error ε of the quaternion gives yaw and roll an error of
    /// ε/cos(pitch), and their sum an error of ε. For cos(pitch) < 2^−16, roll is defined as 0, and yaw is the whole remaining
    /// rotation: yaw − roll at the pole with pitch +¼, yaw + roll at the pole with pitch −¼.
    pub fn angles(self) -> Angles {
        let [[xx, xy, xz], [yx, yy, yz], [_, _, zz]] = self.columns();
        let (level, yaw) = to_polar(xx, xy);
        let (_, pitch) = to_polar(level, -xz);
        if level < POLE {
            let (_, yaw) = to_polar(yy, -yx);
            return Angles {
                yaw,
                pitch,
                roll: Turns(0),
            };
        }
        let (_, roll) = to_polar(zz, yz);
        Angles { yaw, pitch, roll }
    }

    /// Computes the heading (twist): the angle of the rotation about the world's z axis that is nearest to this attitude.
    /// The heading is continuous, even at both poles of the pitch, except for a body that is upside down.
    pub fn heading(self) -> Turns {
        let [w, _, _, z] = self.parts.map(i64::from);
        let (_, half) = to_polar(w << 30, z << 30);
        Turns(half.0 << 1)
    }

    /// Corrects the length to 1 by one Newton step. The step squares the relative error, so that an error within 2^−15 becomes
    /// smaller than a unit in the last place.
    #[must_use]
    fn renormalised(self) -> Self {
        let parts = self.parts.map(i64::from);
        let excess = (1 << 60) - parts.iter().map(|x| x * x).sum::<i64>();
        // For an error of the length within 2^−15, |excess| is about 2^46 at most, so x·(excess >> 29) is below 2^48.
        let parts = parts.map(|x| (x + ((x * (excess >> 29) + (1 << 31)) >> 32)) as i32);
        Self { parts }
    }
}

/// Computes the product of two quaternions. The unit of its components is the product of the units of both factors. The lengths
/// of both factors are at most 1 apart from rounding errors, so by the Cauchy–Schwarz inequality no partial sum exceeds 1 by more
/// than these errors.
#[inline(always)]
pub(super) fn product(a: &[i32; 4], [w, x, y, z]: [i32; 4]) -> [i64; 4] {
    [
        dot(a, w, -x, -y, -z),
        dot(a, x, w, z, -y),
        dot(a, y, -z, w, x),
        dot(a, z, y, -x, w),
    ]
}

/// Computes the sum of four products. The caller ensures that partial sums fit 64 bits.
#[inline(always)]
fn dot([aw, ax, ay, az]: &[i32; 4], w: i32, x: i32, y: i32, z: i32) -> i64 {
    wide(*aw, w) + wide(*ax, x) + wide(*ay, y) + wide(*az, z)
}

/// Yaw, pitch and roll. Angles of half a turn or more represent negative angles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Angles {
    /// Rotation about the world's z axis.
    pub yaw: Turns,
    /// Rotation about the y axis after yaw. If the body's nose points along x, a positive pitch turns the nose down.
    pub pitch: Turns,
    /// Rotation about the x axis after yaw and pitch.
    pub roll: Turns,
}
