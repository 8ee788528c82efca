//! Cameras.
//!
//! A camera is an eye and an orthonormal basis: `u` to the right of the screen, `v` down, `n` forward into the
//! scene, with u × v = n. The world is right-handed with z up. Every [`View`] is checked, so that users of a view may
//! rely on its ranges.

mod error;
mod lens;
mod limits;
mod projection;
mod volume;

use core::fmt;

use crate::fixed::{Q2_23, Q4_28, Q32_32, Turns, U4_28, U8_28};
use crate::trig::sin_cos_q30;
use crate::vector::{self, unit};

pub use error::{BasisVector, Side, ViewError};
pub use lens::Lens;
pub use limits::{
    DEFAULT_HALF_WIDTH, DEFAULT_NEAR, FIELD_OF_VIEW, HALF_HEIGHT, HALF_WIDTH, MAX_EYE, MIDDLE,
    NEAR, RADIUS, WIDTH,
};
pub use projection::Projection;
pub use volume::{Sides, ViewVolume};

/// Default upward direction on the screen: the z axis.
pub const UP: [Q32_32; 3] = [Q32_32::ZERO, Q32_32::ZERO, Q32_32::ONE];

/// Smallest sine of the angle between gaze and up, 2^−10 in units of 2^−30.
const MIN_SINE: i64 = 1 << 20;

/// A vector with components in units of 2^−60.
type Exact = [i64; 3];

/// A checked camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    eye: [Q32_32; 3],
    u: [Q2_23; 3],
    v: [Q2_23; 3],
    n: [Q2_23; 3],
    lens: Lens,
}

impl View {
    /// Makes a perspective camera from its eye, basis, half width and near plane, after checking them.
    ///
    /// The basis must be orthonormal within 1e-4 (lengths and scalar products) with u × v = n, and is used without normalisation.
    /// In world units, the eye must be within 32 of the origin, `half_width` in [0.0087, 115] and `near` in [0.01, 2].
    ///
    /// # Errors
    /// The first violated condition.
    pub fn new_checked(
        eye: [Q32_32; 3],
        u: [Q2_23; 3],
        v: [Q2_23; 3],
        n: [Q2_23; 3],
        half_width: U8_28,
        near: U4_28,
    ) -> Result<Self, ViewError> {
        check_eye(eye)?;
        check_basis(u, v, n)?;
        let lens = Lens::new(Projection::Perspective, half_width, near)?;
        Ok(Self { eye, u, v, n, lens })
    }

    /// Returns the camera that looks at the origin from a point C on the sphere of radius `r` about the origin.
    ///
    /// With θ = `theta` and φ = `phi`, C = r·(sin φ cos θ, sin φ sin θ, cos φ), u = (−sin θ, cos θ, 0),
    /// v = (cos φ cos θ, cos φ sin θ, −sin φ) and n = −C/r. θ is the azimuth, and φ the angle from the z axis, at most half a
    /// turn. The formulas have no singularity: at the poles θ determines the basis. The sines and cosines have the errors of
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
            lens: Lens::DEFAULT,
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
            lens: Lens::DEFAULT,
        })
    }

    /// Returns the camera at `eye` that looks in the direction `gaze`, with the direction `up` upwards on the screen as far as
    /// possible: n = gaze/|gaze|, u = n × up/|n × up|, v = n × u. `gaze` and `up` may have any length except 0.
    ///
    /// If `gaze` and `up` are parallel or opposite within 0.056° (a sine below 2^−10), the coordinate axis along which `up` has
    /// its smallest component replaces `up`; among equal components the first. For example, with `up` = z and a gaze along z, x
    /// points up.
    ///
    /// Each component of the basis is within 0.51 units (2^−23) of its exact value; u and v have an additional error of 2^−29
    /// divided by the sine of the angle between `gaze` and `up`.
    ///
    /// # Errors
    /// A direction is 0, or the eye is more than 32 world units from the origin.
    pub fn towards(
        eye: [Q32_32; 3],
        gaze: [Q32_32; 3],
        up: [Q32_32; 3],
    ) -> Result<Self, ViewError> {
        check_eye(eye)?;
        let n = unit::<30>(gaze.map(Q32_32::to_bits)).ok_or(ViewError::Gaze)?;
        let up = unit::<30>(up.map(Q32_32::to_bits)).ok_or(ViewError::Up)?;
        let across = |up| {
            let across = vector::cross(n, up);
            let sine = across.map(|x| (x >> 30) as i32);
            let is_long = vector::dot(sine, sine) >= MIN_SINE * MIN_SINE;
            is_long.then(|| unit::<30>(across)).flatten()
        };
        let u = across(up)
            .or_else(|| across(across_axis(up)))
            .ok_or(ViewError::Up)?;
        Ok(Self {
            eye,
            u: rounded(u.map(|x| i64::from(x) << 30)),
            v: rounded(vector::cross(n, u)),
            n: rounded(n.map(|x| i64::from(x) << 30)),
            lens: Lens::DEFAULT,
        })
    }

    /// Returns this camera in perspective, with another horizontal field of view: its half width is tan(`angle`/2), with a
    /// relative error of at most 2^−22. The picture is centred on the direction of view and its pixels are square, so the vertical field of
    /// view is 2·atan(H/W·tan(angle/2)) for a picture of W×H pixels.
    ///
    /// # Errors
    /// The angle is not from 1° to 179°.
    #[inline(never)]
    pub fn with_field_of_view(self, angle: Turns) -> Result<Self, ViewError> {
        let half_width = tangent_of_half(angle)?;
        let lens = Lens::new(Projection::Perspective, half_width, self.near())?;
        Ok(Self { lens, ..self })
    }

    /// Returns this camera in perspective, with a horizontal and a vertical field of view: half width and half height are tan(angle/2) of
    /// these angles, each with a relative error of at most 2^−22. Pixels are square only if the angles belong to the shape of the picture.
    ///
    /// # Errors
    /// An angle is not from 1° to 179°.
    #[inline(never)]
    pub fn with_fields_of_view(self, [across, down]: [Turns; 2]) -> Result<Self, ViewError> {
        let half = [tangent_of_half(across)?, tangent_of_half(down)?];
        let lens = Lens::window(
            Projection::Perspective,
            half,
            [Q32_32::ZERO; 2],
            self.near(),
        )?;
        Ok(Self { lens, ..self })
    }

    /// Returns this camera in orthographic projection, whose picture is `width` world units wide. The half width is `width`/2,
    /// rounded down to 2^−28; the picture is centred on the direction of view, and its pixels are square.
    ///
    /// # Errors
    /// The width is not from 0.0174 to 230.
    #[inline(never)]
    pub fn with_width(self, width: U8_28) -> Result<Self, ViewError> {
        if !(WIDTH[0]..=WIDTH[1]).contains(&width) {
            return Err(ViewError::Width(width));
        }
        let half_width = U8_28::from_bits(width.to_bits() >> 1);
        let lens = Lens::new(Projection::Orthographic, half_width, self.near())?;
        Ok(Self { lens, ..self })
    }

    /// Returns this camera with another half width, in world units, and square pixels. Projection and middle of the picture are unchanged.
    ///
    /// # Errors
    /// The half width is not from 0.0087 to 115.
    pub fn with_half_width(self, half_width: U8_28) -> Result<Self, ViewError> {
        let lens = self.lens.with_half_width(half_width)?;
        Ok(Self { lens, ..self })
    }

    /// Returns this camera with a picture enlarged about its middle by `factor`: half width and half height are divided by `factor`,
    /// rounded down.
    ///
    /// # Errors
    /// The half width is then not from 0.0087 to 115, or the half height not from 0.0049 to 115.
    #[inline(never)]
    pub fn zoomed(self, factor: U8_28) -> Result<Self, ViewError> {
        let lens = self.lens.zoomed(factor)?;
        Ok(Self { lens, ..self })
    }

    /// Returns this camera with another distance of the near plane from the eye, in world units.
    ///
    /// # Errors
    /// The distance is not from 0.01 to 2.
    #[inline(never)]
    pub fn with_near(self, near: U4_28) -> Result<Self, ViewError> {
        let lens = self.lens.with_near(near)?;
        Ok(Self { lens, ..self })
    }

    /// Returns this camera with another projection, and the same window and near plane.
    #[must_use]
    pub const fn with_projection(self, projection: Projection) -> Self {
        let lens = self.lens.with_projection(projection);
        Self { lens, ..self }
    }

    /// Returns this camera with another lens.
    #[must_use]
    pub const fn with_lens(self, lens: Lens) -> Self {
        Self { lens, ..self }
    }

    /// Returns this camera with the lens of `other`.
    #[must_use]
    pub const fn with_lens_of(self, other: &Self) -> Self {
        self.with_lens(other.lens)
    }

    /// Returns the camera of one eye of a stereo pair: this camera with its eye moved by `aside` world units (at most 1) to the
    /// right, and the middle of the picture shifted by `shift` (at most 1 in magnitude).
    pub(crate) fn beside(&self, aside: Q32_32, shift: Q4_28) -> Self {
        Self {
            eye: moved(self.eye, self.u, aside),
            lens: self.lens.shifted(shift),
            ..*self
        }
    }

    /// The eye. In orthographic projection, the eye moved sideways to the middle of the picture, because parallel lines of sight define no
    /// eye.
    pub fn eye_of_middle(&self) -> [Q32_32; 3] {
        let [right, down] = self.lens.middle().map(Q32_32::from);
        match self.projection() {
            Projection::Perspective => self.eye,
            Projection::Orthographic => moved(moved(self.eye, self.u, right), self.v, down),
        }
    }

    /// The position of the eye in world units, at most 32 from the origin; an eye of a stereo pair may be
    /// up to 1 farther.
    pub const fn eye(&self) -> [Q32_32; 3] {
        self.eye
    }

    /// Whether the eye is within `distance` world units of the origin.
    pub fn is_within(&self, distance: u32) -> bool {
        is_within(self.eye, distance)
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

    /// The lens: projection, window and near plane.
    pub const fn lens(&self) -> &Lens {
        &self.lens
    }

    /// The projection of the lens: perspective or orthographic.
    pub const fn projection(&self) -> Projection {
        self.lens.projection()
    }

    /// Half the width of the image plane in world units, from 0.0087 to 115: at distance 1 in perspective, at every distance in
    /// orthographic projection.
    pub const fn half_width(&self) -> U8_28 {
        self.lens.half_width()
    }

    /// The distance of the near plane from the eye along `n`, in world units, from 0.01 to 2.
    pub const fn near(&self) -> U4_28 {
        self.lens.near()
    }
}

/// Writes the arguments of the console's command `view`: eye, u, v, n and the [`Lens`]. Each number is the shortest decimal that reads back
/// as the same bits.
impl fmt::Display for View {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.eye.iter().try_for_each(|x| write!(f, "{x} "))?;
        [self.u, self.v, self.n]
            .as_flattened()
            .iter()
            .try_for_each(|x| write!(f, "{x} "))?;
        self.lens.fmt(f)
    }
}

/// The unit vector, in units of 2^−30, of the coordinate axis along which `vector` has its smallest component in magnitude.
fn across_axis(vector: [i32; 3]) -> [i32; 3] {
    let [x, y, z] = vector.map(i32::unsigned_abs);
    let one = 1 << 30;
    if x <= y && x <= z {
        [one, 0, 0]
    } else if y <= z {
        [0, one, 0]
    } else {
        [0, 0, one]
    }
}

/// The tangent of half a field of view, with a relative error of at most 2^−22.
///
/// # Errors
/// The angle is not from 1° to 179°.
#[inline(never)]
fn tangent_of_half(angle: Turns) -> Result<U8_28, ViewError> {
    if !(FIELD_OF_VIEW[0]..=FIELD_OF_VIEW[1]).contains(&angle) {
        return Err(ViewError::FieldOfView(angle));
    }
    let (sin, cos) = sines(Turns(angle.0 / 2));
    // The cosine of an angle below 90° is at least 2^23 units, and the dividend is at most 2^59.
    let tangent = ((sin << 29) / cos + 1) >> 1;
    Ok(U8_28::from_bits(tangent.unsigned_abs()))
}

/// Returns the point at the distance `by` (less than 8 world units) from the point `place` along an axis of a camera. Each product is
/// rounded down in magnitude.
#[inline(never)]
fn moved(place: [Q32_32; 3], axis: [Q2_23; 3], by: Q32_32) -> [Q32_32; 3] {
    [0, 1, 2].map(|i: usize| {
        // The product of the distance and the axis has 24 + 23 fraction bits, of which 32 remain, rounded down.
        let along = (by.to_bits().abs() >> 8) * i64::from(axis[i].to_bits());
        Q32_32::from_bits(place[i].to_bits() + by.to_bits().signum() * (along >> 15))
    })
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

/// Whether a point is within `distance` world units of the origin.
pub fn is_within(place: [Q32_32; 3], distance: u32) -> bool {
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
    if is_within(eye, MAX_EYE) {
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

    let rows = [
        (BasisVector::U, u),
        (BasisVector::V, v),
        (BasisVector::N, n),
    ];
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
    // The three vectors are orthonormal, so u × v is either n or −n. The sign of (u × v)·n distinguishes the two cases.
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

/// Computes the scalar product of two vectors, in units of 2^−46. The result is exact for components within ±2.
fn dot(a: [Q2_23; 3], b: [Q2_23; 3]) -> i64 {
    core::iter::zip(a, b)
        .map(|(a, b)| i64::from(a.to_bits()) * i64::from(b.to_bits()))
        .sum()
}

/// Converts a product in units of 2^−46 to units of 2^−23, rounded down.
const fn narrow_product(x: i64) -> i32 {
    (x >> 23) as i32
}
