//! A cone with lengths in field units: its distance, and the directions of its normals.

use crate::division::quotient;
use crate::field::surface::{FieldSample, Surface};
use crate::vector::unit;

/// A cone about the z axis with lengths in field units, which have 12 fraction bits.
///
/// Its lateral surface has the outward normal (cos·x/r, cos·y/r, sin) at the distance r from the axis, where tan = radius/height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedCone {
    /// Radius of the base, u10.12, at least 2^6 units of 2^−12.
    pub radius: i32,
    /// Half the height, u10.12, at least 2^5 units of 2^−12: the apex is at this z, the base at its negative.
    pub half: i32,
    /// The sine and the cosine of the half angle at the apex, u0.30.
    pub angle: [i32; 2],
    /// Factors of the normal at a point of the lateral surface, times 2^−`lead`, u0.30: cos·height/radius
    /// for x and y, sin for z. The normal is (a·x, a·y, b·d)/d with the factors a and b, for a point at
    /// the distance d below the apex.
    slopes: [i32; 2],
    /// The smallest exponent, 0 to 11, for which both `slopes` are at most 1.
    pub lead: u32,
}

impl FixedCone {
    /// Makes a cone from the radius of its base and half its height.
    pub fn new(radius: i32, half: i32) -> Self {
        let (radius, half) = (radius.max(1), half.max(1));
        let [sine, cosine, _] =
            unit::<30>([radius.into(), 2 * i64::from(half), 0]).unwrap_or_default();
        let slope = quotient(
            u64::from(cosine.unsigned_abs()) * 2 * u64::from(half.unsigned_abs()),
            radius.unsigned_abs().into(),
        );
        let lead = (64 - slope.leading_zeros()).saturating_sub(30);
        Self {
            radius,
            half,
            angle: [sine, cosine],
            slopes: [(slope >> lead) as i32, sine >> lead],
            lead,
        }
    }

    /// A cone with the apex at z = `half`, for directions to lights that [`lit_from`](Self::lit_from) has
    /// already converted, as in the gateware's registers.
    pub const fn lit(half: i32, lead: u32) -> Self {
        Self {
            radius: half,
            half,
            angle: [0, 0],
            slopes: [1 << 30, -1 << 30],
            lead,
        }
    }

    /// Position of the apex, s10.12.
    pub const fn apex(&self) -> [i32; 3] {
        [0, 0, self.half]
    }

    /// Converts a direction to a vector whose scalar product with the vector from the apex to a point of
    /// the lateral surface is the cosine of the angle between the normal and `direction`, times 2^−`lead` and
    /// the distance from the apex along the axis.
    pub fn lit_from(&self, direction: [i32; 3]) -> [i32; 3] {
        let [across, along] = self.slopes.map(i64::from);
        let [x, y, z] = direction.map(i64::from);
        [across * x, across * y, -along * z].map(|product| ((product + (1 << 29)) >> 30) as i32)
    }

    /// The direction of the normal at a point of the lateral surface, with any length. `from_apex` is the
    /// vector from the apex to the point.
    pub fn normal(&self, from_apex: [i32; 3]) -> [i32; 3] {
        let [across, along] = self.slopes.map(i64::from);
        let [x, y, z] = from_apex.map(i64::from);
        [across * x, across * y, -along * z].map(|product| (product >> 26) as i32)
    }

    /// Returns a lower bound of the distance from a point to the cone, rounded down, and the nearest surface. The bound is the larger one of
    /// the distances to the cone without a base and to the half-space above the base. `from_axis` is the point's distance from the axis,
    /// `number` the number of the lateral surface.
    pub(super) fn sample(&self, from_axis: i32, z: i32, number: u8) -> FieldSample {
        let [sine, cosine] = self.angle.map(i64::from);
        let below_apex = i64::from(self.half) - i64::from(z);
        let beside = ((i64::from(from_axis) * cosine - below_apex * sine) >> 30) as i32;
        let below = -self.half - z;
        match beside >= below {
            true => FieldSample {
                distance: beside,
                surface: Surface::Round { number },
            },
            false => FieldSample {
                distance: below,
                surface: Surface::BASE,
            },
        }
    }

    /// Whether a point is inside, and not on the surface.
    pub fn holds(&self, [x, y, z]: [i32; 3]) -> bool {
        let square = |x: i32| i128::from(x).pow(2);
        z > -self.half
            && z < self.half
            && (square(x) + square(y)) * square(2 * self.half)
                < square(self.half - z) * square(self.radius)
    }
}
