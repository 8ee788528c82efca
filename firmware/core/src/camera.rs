//! Cameras.
//!
//! A camera is an eye and an orthonormal basis: `u` to the right of the screen, `v` down, `n` forward into the
//! scene, with u × v = n. The world is right-handed with z up. Every [`View`] is checked, so that users of a view may
//! rely on its ranges.

use core::fmt;

use crate::fixed::{Q2_23, Q32_32, Turns, U4_28};
use crate::trig::sin_cos_q30;

/// Half width of the image plane at distance 1, in world units, for cameras that are defined by angles.
pub const DEFAULT_HALF_WIDTH: U4_28 = U4_28::lit("0.9");
/// Distance of the near plane from the eye, in world units, for cameras that are defined by angles.
pub const DEFAULT_NEAR: U4_28 = U4_28::lit("0.1");

/// Largest accepted distance of an eye from the origin, in world units.
pub const MAX_EYE: u32 = 32;
/// Smallest and largest accepted half width of the image plane at distance 1, in world units.
pub const HALF_WIDTH: [U4_28; 2] = [U4_28::lit("0.05"), U4_28::lit("4")];
/// Smallest and largest accepted distance of the near plane from the eye, in world units.
pub const NEAR: [U4_28; 2] = [U4_28::lit("0.01"), U4_28::lit("2")];
/// Smallest and largest accepted distance of a camera of `View::spherical` from the origin, in world units.
pub const RADIUS: [Q32_32; 2] = [Q32_32::lit("2"), Q32_32::lit("5")];

/// A vector with components in units of 2^−60.
type Exact = [i64; 3];

/// A checked camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    eye: [Q32_32; 3],
    u: [Q2_23; 3],
    v: [Q2_23; 3],
    n: [Q2_23; 3],
    half_width: U4_28,
    near: U4_28,
}

impl View {
    /// Makes a camera from its eye, basis, half width and near plane, after checking them.
    ///
    /// The basis must be orthonormal within 1e-4 (lengths and scalar products) with u × v = n; it is not normalised. In world
    /// units, the eye must be within 32 of the origin, `half_width` in [0.05, 4] and `near` in [0.01, 2].
    ///
    /// # Errors
    /// The first violated condition.
    pub fn new_checked(
        eye: [Q32_32; 3],
        u: [Q2_23; 3],
        v: [Q2_23; 3],
        n: [Q2_23; 3],
        half_width: U4_28,
        near: U4_28,
    ) -> Result<Self, ViewError> {
        check_eye(eye)?;
        check_basis(u, v, n)?;
        if !(HALF_WIDTH[0]..=HALF_WIDTH[1]).contains(&half_width) {
            return Err(ViewError::HalfWidth(half_width));
        }
        if !(NEAR[0]..=NEAR[1]).contains(&near) {
            return Err(ViewError::Near(near));
        }
        Ok(Self {
            eye,
            u,
            v,
            n,
            half_width,
            near,
        })
    }

    /// Returns the camera that looks at the origin from a point C on the sphere of radius `r` about the origin.
    ///
    /// With θ = `theta` and φ = `phi`, C = r·(sin φ cos θ, sin φ sin θ, cos φ), u = (−sin θ, cos θ, 0),
    /// v = (cos φ cos θ, cos φ sin θ, −sin φ) and n = −C/r. θ is the azimuth, and φ the angle from the z axis, at most half a
    /// turn. The formulas have no singularity: at the poles the basis follows from θ. The sines and cosines have the errors of
    /// [`sin_cos_q30`]; apart from these errors the eye is exact to 2^−32, and each component of the basis to 2^−24.
    ///
    /// # Errors
    /// `r` is outside [2, 5] world units, or `phi` is beyond half a turn.
    pub fn spherical(r: Q32_32, theta: Turns, phi: Turns) -> Result<Self, ViewError> {
        if !(RADIUS[0]..=RADIUS[1]).contains(&r) {
            return Err(ViewError::Radius(r));
        }
        if phi > Turns::HALF {
            return Err(ViewError::Polar(phi));
        }
        let (st, ct) = sines(theta);
        let (sp, cp) = sines(phi);
        let outward = [sp * ct, sp * st, cp << 30];
        Ok(Self {
            eye: outward.map(|x| scaled(r, x)),
            u: rounded([-st << 30, ct << 30, 0]),
            v: rounded([cp * ct, cp * st, -sp << 30]),
            n: rounded(outward.map(|x| -x)),
            half_width: DEFAULT_HALF_WIDTH,
            near: DEFAULT_NEAR,
        })
    }

    /// Returns the free camera, which is given by an eye and three angles: yaw y to the right, pitch p downwards, and roll r
    /// about the direction of view.
    ///
    /// In a left-handed frame (x right, y up, z forward) the directions to the right, up and forward without roll are
    /// R = (cos y, 0, −sin y), U = (sin p sin y, cos p, sin p cos y) and F = (cos p sin y, −sin p, cos p cos y). Roll turns the
    /// first two directions to R' = R cos r + U sin r and U' = −R sin r + U cos r. P exchanges the second and the third
    /// coordinate, which converts to the world's right-handed frame: u = P·R', v = −P·U', n = P·F. With all angles 0 the camera
    /// looks along +y.
    ///
    /// # Errors
    /// The eye is more than 32 world units from the origin.
    pub fn look(
        eye: [Q32_32; 3],
        yaw: Turns,
        pitch: Turns,
        roll: Turns,
    ) -> Result<Self, ViewError> {
        check_eye(eye)?;
        let (sy, cy) = sines(yaw);
        let (sp, cp) = sines(pitch);
        let (sr, cr) = sines(roll);
        let right = [cy, 0, -sy];
        let up = [narrow(sp * sy), cp, narrow(sp * cy)];
        let forward = [cp * sy, -sp << 30, cp * cy];
        let rolled = |a: i64, b: i64| -> Exact { [0, 1, 2].map(|i| right[i] * a + up[i] * b) };
        let swapped = |[x, y, z]: Exact| [x, z, y];
        Ok(Self {
            eye,
            u: rounded(swapped(rolled(cr, sr))),
            v: rounded(swapped(rolled(sr, -cr))),
            n: rounded(swapped(forward)),
            half_width: DEFAULT_HALF_WIDTH,
            near: DEFAULT_NEAR,
        })
    }

    /// Returns this camera with the half width and the near plane of `other`.
    #[must_use]
    pub const fn with_lens_of(self, other: &Self) -> Self {
        Self {
            half_width: other.half_width,
            near: other.near,
            ..self
        }
    }

    /// The position of the eye in world units, at most 32 from the origin.
    pub const fn eye(&self) -> [Q32_32; 3] {
        self.eye
    }

    /// Whether the eye is within `distance` world units of the origin.
    pub fn is_within(&self, distance: u32) -> bool {
        within(self.eye, distance)
    }

    /// The direction in the world that points to the right of the screen.
    pub const fn u(&self) -> [Q2_23; 3] {
        self.u
    }

    /// The direction in the world that points down the screen.
    pub const fn v(&self) -> [Q2_23; 3] {
        self.v
    }

    /// The direction in the world in which the camera looks.
    pub const fn n(&self) -> [Q2_23; 3] {
        self.n
    }

    /// Half the width of the image plane at distance 1, in world units, from 0.05 to 4.
    pub const fn half_width(&self) -> U4_28 {
        self.half_width
    }

    /// The distance of the near plane from the eye along `n`, in world units, from 0.01 to 2.
    pub const fn near(&self) -> U4_28 {
        self.near
    }
}

/// Writes the arguments of the console's command `view`: eye, u, v, n, half width and near plane. Each number is the shortest
/// decimal that reads back as the same bits.
impl fmt::Display for View {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.eye.iter().try_for_each(|x| write!(f, "{x} "))?;
        [self.u, self.v, self.n]
            .as_flattened()
            .iter()
            .try_for_each(|x| write!(f, "{x} "))?;
        write!(f, "{} {}", self.half_width, self.near)
    }
}

/// Returns sine and cosine of an angle, in units of 2^−30; the product of two such numbers is below 2^61.
fn sines(angle: Turns) -> (i64, i64) {
    let (sin, cos) = sin_cos_q30(angle);
    (sin.to_bits().into(), cos.to_bits().into())
}

/// Converts a number in units of 2^−60 to units of 2^−30, rounded to nearest.
const fn narrow(x: i64) -> i64 {
    (x + (1 << 29)) >> 30
}

/// Converts a vector in units of 2^−60 to units of 2^−23, rounded to nearest. Each component is at most 1 in
/// magnitude plus a rounding error.
fn rounded(x: Exact) -> [Q2_23; 3] {
    x.map(|x| Q2_23::from_bits(((x + (1 << 36)) >> 37) as i32))
}

/// Computes r·x for a radius r and a number x in units of 2^−60, rounded to nearest. |r| ≤ 5 and |x| ≤ 1, so the result fits.
fn scaled(r: Q32_32, x: i64) -> Q32_32 {
    Q32_32::from_bits(((i128::from(r.to_bits()) * i128::from(x) + (1 << 59)) >> 60) as i64)
}

fn within(place: [Q32_32; 3], distance: u32) -> bool {
    let limit = u128::from(distance) << 32;
    // The square of each coordinate is at most 2^126, so the sum fits 128 bits.
    let squared: u128 = place
        .map(|x| u128::from(x.to_bits().unsigned_abs()).pow(2))
        .iter()
        .sum();
    // `limit * limit` does not overflow: `limit` is below 2^64.
    squared <= limit * limit
}

fn check_eye(eye: [Q32_32; 3]) -> Result<(), ViewError> {
    if within(eye, MAX_EYE) {
        Ok(())
    } else {
        Err(ViewError::Eye(eye))
    }
}

fn check_basis(u: [Q2_23; 3], v: [Q2_23; 3], n: [Q2_23; 3]) -> Result<(), ViewError> {
    const ONE: i64 = 1 << 46;
    // The tolerance 1e-4 and its square, in units of 2^−46.
    const TOLERANCE: i64 = ONE / 10_000;
    const SQUARE: i64 = ONE / 100_000_000;

    let rows = [(Axis::U, u), (Axis::V, v), (Axis::N, n)];
    for (axis, row) in rows {
        // The scalar products cannot overflow if all components are below 2 in magnitude.
        let squared = row
            .iter()
            .all(|x| x.unsigned_abs() < 2)
            .then(|| dot(row, row));
        match squared {
            Some(squared) if (squared - ONE - SQUARE).abs() <= 2 * TOLERANCE => {}
            _ => return Err(ViewError::Length { axis, row }),
        }
    }
    for [(a, row), (b, other)] in [[rows[0], rows[1]], [rows[1], rows[2]], [rows[2], rows[0]]] {
        let product = dot(row, other);
        if product.abs() > TOLERANCE {
            return Err(ViewError::NotPerpendicular {
                a,
                b,
                product: Q2_23::from_bits(narrow_product(product)),
            });
        }
    }
    // The three vectors are orthonormal, so u × v is either n or −n. The sign of (u × v)·n decides.
    let cross = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| {
        let (a, b) = (
            i64::from(u[i].to_bits()) * i64::from(v[j].to_bits()),
            i64::from(u[j].to_bits()) * i64::from(v[i].to_bits()),
        );
        Q2_23::from_bits(narrow_product(a - b))
    });
    if dot(cross, n) > 0 {
        Ok(())
    } else {
        Err(ViewError::Mirrored)
    }
}

/// Computes the scalar product of two vectors, in units of 2^−46. It is exact for components within ±2.
fn dot(a: [Q2_23; 3], b: [Q2_23; 3]) -> i64 {
    core::iter::zip(a, b)
        .map(|(a, b)| i64::from(a.to_bits()) * i64::from(b.to_bits()))
        .sum()
}

/// Converts a product in units of 2^−46 to units of 2^−23, rounded down.
const fn narrow_product(x: i64) -> i32 {
    (x >> 23) as i32
}

/// One of the three vectors of a camera's basis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The vector u, which points to the right of the screen.
    U,
    /// The vector v, which points down the screen.
    V,
    /// The vector n, which points into the scene.
    N,
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::U => "u",
            Self::V => "v",
            Self::N => "n",
        })
    }
}

/// Reason why numbers do not describe a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewError {
    /// The eye is too far from the origin.
    Eye([Q32_32; 3]),
    /// The length of a vector of the basis differs from 1 by more than 1e-4.
    Length {
        /// Name of the vector.
        axis: Axis,
        /// Components of the vector.
        row: [Q2_23; 3],
    },
    /// The scalar product of two vectors of the basis exceeds 1e-4 in magnitude.
    NotPerpendicular {
        /// The first vector.
        a: Axis,
        /// The second vector.
        b: Axis,
        /// Their scalar product.
        product: Q2_23,
    },
    /// The basis is orthonormal but u × v = −n.
    Mirrored,
    /// The half width is out of range.
    HalfWidth(U4_28),
    /// The near plane is out of range.
    Near(U4_28),
    /// The radius of a spherical camera is out of range.
    Radius(Q32_32),
    /// The polar angle of a spherical camera is out of range.
    Polar(Turns),
}

impl fmt::Display for ViewError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Eye([x, y, z]) => write!(
                f,
                "eye ({x}, {y}, {z}): expected within {MAX_EYE} of the origin"
            ),
            Self::Length {
                axis,
                row: [x, y, z],
            } => {
                write!(f, "{axis} = ({x}, {y}, {z}): expected length 1 within 1e-4")
            }
            Self::NotPerpendicular { a, b, product } => {
                write!(f, "{a}·{b} = {product}: expected 0 within 1e-4")
            }
            Self::Mirrored => {
                f.write_str("u × v = −n: expected u × v = n (u right, v down, n forward)")
            }
            Self::HalfWidth(x) => write!(
                f,
                "half_width {x}: expected {} to {}",
                HALF_WIDTH[0], HALF_WIDTH[1]
            ),
            Self::Near(x) => write!(f, "near {x}: expected {} to {}", NEAR[0], NEAR[1]),
            Self::Radius(r) => write!(f, "radius {r}: expected {} to {}", RADIUS[0], RADIUS[1]),
            Self::Polar(phi) => write!(f, "phi {} degrees: expected 0 to 180", phi.to_degrees()),
        }
    }
}

impl core::error::Error for ViewError {}
