//! Spheres of a list, and their constants for a frame.
//!
//! With q from a sphere's centre to the eye and a ray's direction D, both q×D and q·D are linear in the pixel's column and row.

use glint_core::field::FRACTION;

use super::narrow::nearest;
use super::rectangle::Rectangle;

/// Bits of a coefficient's magnitude.
const COEFFICIENT: u32 = 24;

/// Fraction bits of a half chord in radii, times |D|².
pub(super) const ROOT: u32 = 18;

/// A sphere of a list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ball {
    /// The centre in field units, s9.12.
    pub centre: [i32; 3],
    /// The radius in field units, u9.12.
    pub radius: i32,
    /// The sphere from each eye.
    pub sights: [Sight; 2],
}

impl Ball {
    /// The sphere from an eye at `origin`, in field units. `directions` are the first direction D and its changes per pixel to the right and
    /// per pixel down, s2.30.
    pub(super) fn seen_from(
        &self,
        origin: [i32; 3],
        directions: [[i32; 3]; 3],
        rectangle: Rectangle,
    ) -> Sight {
        let q = [0, 1, 2].map(|i: usize| i64::from(origin[i] - self.centre[i]));
        let radius = i64::from(self.radius.max(1));
        let [first, across, down] = directions.map(|direction| direction.map(i64::from));
        // Directions have 30 fraction bits, q and the radius 12. The components of q have 25 bits, so a product has at most 57.
        let cross = [0, 1, 2].map(|i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let part = |d: &[i64; 3]| {
                let product = q[j] * d[k] - q[k] * d[j];
                (2 * product + radius).div_euclid(2 * radius)
            };
            Linear {
                first: part(&first),
                across: part(&across),
                down: part(&down),
            }
        });
        let dot = |d: &[i64; 3]| (0..3).map(|i| q[i] * d[i]).sum();
        let along = Linear {
            first: dot(&first),
            across: dot(&across),
            down: dot(&down),
        };
        let excess = |bits: u32| bits.saturating_sub(COEFFICIENT) as i32;
        let cut = excess(cross.map(|part| part.bits()).into_iter().fold(0, u32::max));
        let along_cut = excess(along.bits()).max(12);
        // No component of D exceeds 1, so q·D is at most the sum of q's components.
        let most = q.map(i64::abs).iter().sum::<i64>() + 2 * radius;
        let spare = (COEFFICIENT - 1)
            .saturating_sub(most.max(1).ilog2())
            .min(ROOT - FRACTION);
        Sight {
            rectangle,
            is_inside: q.map(|x| x * x).iter().sum::<i64>() < radius * radius,
            cross: cross.map(|part| part.narrowed(cut)),
            cross_fraction: 30 - cut,
            along: along.narrowed(along_cut),
            along_fraction: 42 - along_cut,
            fraction: FRACTION + spare,
        }
    }
}

/// A sphere from an eye.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sight {
    /// The pixels that may see the sphere.
    pub rectangle: Rectangle,
    /// Whether the eye is in the sphere.
    pub is_inside: bool,
    /// q×D/r, with `cross_fraction` fraction bits.
    pub(super) cross: [Linear; 3],
    pub(super) cross_fraction: i32,
    /// q·D, with `along_fraction` fraction bits.
    pub(super) along: Linear,
    pub(super) along_fraction: i32,
    /// Fraction bits of q·D and of a half chord: the longest with which a ray's distance to the sphere has 24 bits and a sign.
    pub(super) fraction: u32,
}

/// A number that is linear in the column and the row of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Linear {
    first: i64,
    across: i64,
    down: i64,
}

impl Linear {
    pub(super) const fn at(&self, column: u32, row: u32) -> i64 {
        self.first + column as i64 * self.across + row as i64 * self.down
    }

    /// Bits of the larger coefficient.
    const fn bits(&self) -> u32 {
        let most = self.across.unsigned_abs() | self.down.unsigned_abs();
        64 - most.leading_zeros()
    }

    fn narrowed(self, bits: i32) -> Self {
        Self {
            first: nearest(self.first, bits),
            across: nearest(self.across, bits),
            down: nearest(self.down, bits),
        }
    }
}
