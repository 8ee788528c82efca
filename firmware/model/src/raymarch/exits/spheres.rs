//! Spheres of a list, and a solid cone: a ray meets a sphere if its direction is in the cone around the sphere.

use super::cones::{Cone, ConeKind, Cones, DISTANCE_OFFSET, FRACTION, SHARE};
use super::narrow::{floor, normalised, squared};
use super::ray::Beam;
use super::setup::Exits;
use super::words::Inverse;

/// Fraction bits of c·D and of the root.
const LENGTH: i32 = 22;
/// Fraction bits of the number under the root.
const SQUARE: i32 = 30;
/// A ray meets a sphere if the number under the root exceeds 2^−`LEAST`. This margin exceeds all rounding errors, so that a tangent ray
/// always misses.
const LEAST: i32 = 20;
/// Fraction bits of the mantissa of a reciprocal.
const MANTISSA: i32 = 18;

/// A sphere, or a face of a solid cone, that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Met {
    /// The parameter T, with 14 integer bits and the fraction bits of `Words::parameter`.
    pub t: i64,
    /// Number of the sphere, or [`Cone::BASE`].
    pub number: u8,
}

impl Exits {
    /// The nearest sphere of the list that a ray meets up to the far limit, and the number of tested cones. Of several spheres at the same
    /// parameter, returns the first in the list.
    pub fn meet(&self, cones: &[Cones; 2], beam: &Beam) -> (Option<Met>, u32) {
        let mut best: Option<Met> = None;
        let mut tests = 0;
        // The lateral surface and the section of a solid cone are between these parameters.
        let mut limits = (0, i64::MAX);
        for cone in cones[beam.eye].list() {
            if !cone.rectangle.holds(beam.column, beam.row) {
                continue;
            }
            tests += 1;
            match cone.kind {
                ConeKind::Base => limits = (self.crossing(beam, cone), i64::MAX),
                ConeKind::Limit => limits = (0, self.crossing(beam, cone)),
                _ => {}
            }
            let t = match cone.kind {
                ConeKind::Sphere | ConeKind::Base => self.meet_cone(beam, cone),
                _ => self
                    .meet_cone(beam, cone)
                    .filter(|&t| limits.0 < t && t < limits.1),
            };
            if let Some(t) = t
                && best.as_ref().is_none_or(|best| t < best.t)
            {
                let number = cone.number;
                best = Some(Met { t, number });
            }
        }
        (best.filter(|met| met.t <= self.far), tests)
    }

    /// The parameter at which a ray crosses the plane of a solid cone's base; `i64::MAX` for a ray that does not cross the plane.
    #[inline(never)]
    fn crossing(&self, beam: &Beam, cone: &Cone) -> i64 {
        let forward = cone.forward_at(beam.column, beam.row);
        match forward < 0 {
            true => i64::MAX,
            false => self.parameter(cone, floor(forward, FRACTION as i32 - LENGTH)),
        }
    }

    /// The parameter at which a ray in a cone meets the sphere or the face; `None` if the ray misses, or if the point is in front of the
    /// near plane.
    fn meet_cone(&self, beam: &Beam, cone: &Cone) -> Option<i64> {
        let (column, row) = (beam.column, beam.row);
        let sides = cone.sides.map(|side| side.at(column, row, cone.shift));
        let limit = 2 << FRACTION;
        if sides.iter().any(|side| !(-limit..limit).contains(side)) {
            return None;
        }
        let forward = cone.forward_at(column, row);
        // The squares omit the square of the bits after the first 18 bits.
        let fraction = self.words.outline as i32;
        let cut = (fraction - 16).max(0) as u32;
        let square = |x| squared(floor(x, FRACTION as i32 - fraction), cut);
        let [a, b] = sides.map(square);
        let rounded = |rest| floor(rest, 2 * fraction - SQUARE);
        let (rest, least) = match cone.kind {
            ConeKind::Limit => return None,
            // Rounded to the next lower integer, even if the number is an integer.
            ConeKind::Sphere => (rounded(square(forward) - a - b - 1), SQUARE - LEAST),
            ConeKind::Base | ConeKind::Section => (rounded(square(forward) - a - b - 1), 0),
            ConeKind::Lateral => (rounded(square(forward) - a - 1), 0),
            // The surface has no outline, so the number is never negative.
            ConeKind::Around => (rounded(a + b).max(1), 0),
        };
        if forward < 0 || rest >> least <= 0 {
            return None;
        }
        if cone.kind == ConeKind::Section {
            return Some(self.near);
        }
        let (root, shift) = normalised(rest);
        let root = floor(i64::from(root), 2 + (shift + SQUARE) / 2 - LENGTH);
        let addend = match cone.kind {
            ConeKind::Lateral => sides[1],
            _ => forward,
        };
        let addend = floor(addend, FRACTION as i32 - LENGTH);
        // The divisor is below 4, has 22 fraction bits, and represents the middle of its rounding interval. The root is rounded down, the
        // divisor up.
        let part = match cone.kind {
            ConeKind::Around => -(cone.share * root),
            _ => cone.share * root,
        };
        let divisor = -((-(addend << SHARE) - part) >> SHARE);
        if divisor < 0 {
            return None;
        }
        let t = self.parameter(cone, divisor);
        (t >= self.near).then_some(t)
    }

    /// The parameter at a hit: the distance of the cone divided by `divisor`, which has 22 fraction bits.
    fn parameter(&self, cone: &Cone, divisor: i64) -> i64 {
        // The divisor exceeds 24 bits only for invalid constants.
        let inverse = Inverse::of(((divisor as u32 & 0xFF_FFFF) << 1 | 1) << 3, &self.words);
        let mantissa = floor(
            i64::from(inverse.mantissa),
            self.words.inverse as i32 - MANTISSA,
        );
        let (distance, exponent) = cone.distance;
        // `inverse` is the reciprocal of a quarter of the divisor, hence the −2.
        let bits = exponent as i32 - DISTANCE_OFFSET + inverse.exponent - 2 - MANTISSA;
        self.words.parameter_of(distance * mantissa, -bits)
    }
}
