//! Unions of a flat solid (plane faces) and a round solid (spheres), sharp or with a fillet.
//!
//! For a fillet of two surfaces with the distances a and b, the distance is their quadratic smooth minimum (I. Quilez, "smooth minimum"):
//! min(a, b) − h²/(4k) with h = max(k − |a − b|, 0). The gradient of the minimum is the weighted mean of the gradients of a and b, with the
//! weight h/(2k) for the larger distance. The blended distance therefore changes no faster than a or b. The same weight blends the colours
//! of the two surfaces.

use glint_core::field::{FieldSample, FixedSpheres, Surface};

/// Spheres, and how they are united with a flat solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Beside {
    /// The spheres of the union.
    pub spheres: FixedSpheres,
    /// The fillet between the spheres and the flat solid.
    pub blend: Blend,
    /// The distance to the flat solid is multiplied by 2^`bend`, with `bend` from 0 to 6, and is then too long; `bend` is above 0 only in a
    /// bent union.
    pub bend: u32,
}

/// Largest distance from a flat solid, s10.12.
const MOST: i32 = (1 << 21) - 1;

impl Beside {
    /// Combines the samples of a flat solid and of a sphere at one point. A distance beyond the range of s10.12 saturates.
    pub fn union(&self, flat: FieldSample, round: FieldSample) -> FieldSample {
        let distance = i64::from(flat.distance) << self.bend;
        let flat = FieldSample {
            distance: distance.clamp(!i64::from(MOST), MOST.into()) as i32,
            ..flat
        };
        self.blend.union(flat, round)
    }
}

/// A fillet: the blended transition between two surfaces, described at the top of this file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Blend {
    /// Width k, u5.12; 0 for a sharp union.
    pub width: u32,
    /// 1/(2k) for the width k, u1.16, rounded to nearest.
    pub inverse: u32,
}

impl Blend {
    /// Returns a fillet of the given `width`, in field units with 12 fraction bits: 0, or 2^10 to 2^17 − 1.
    pub fn new(width: u32) -> Self {
        Self {
            width,
            inverse: ((1 << 27) + width / 2).checked_div(width).unwrap_or(0),
        }
    }

    /// Combines the samples of a flat solid and of a sphere at one point: returns the sample with the smaller distance, or a blended
    /// sample on the fillet. At equal distances a sharp union returns the sample of the flat solid.
    pub fn union(&self, flat: FieldSample, round: FieldSample) -> FieldSample {
        let is_round = round.distance < flat.distance;
        let nearer = if is_round { round } else { flat };
        let (Surface::Face { axis, positive }, Surface::Round { number }, 1..) =
            (flat.surface, round.surface, self.width)
        else {
            return nearer;
        };
        let apart = flat.distance.abs_diff(round.distance);
        let h = i64::from(self.width.saturating_sub(apart));
        // The product has 28 fraction bits; the shift leaves 16. The weight is at most slightly above 1/2.
        let weight = (h * i64::from(self.inverse)) >> 12;
        let share = if is_round { (1 << 16) - weight } else { weight };
        FieldSample {
            // Adds −h·weight/2, rounded down; the weight has 16 fraction bits.
            distance: nearer.distance + ((-h * weight) >> 17) as i32,
            surface: Surface::Blended {
                axis,
                positive,
                number,
                share: (share >> 8).min(255) as u8,
            },
        }
    }
}
