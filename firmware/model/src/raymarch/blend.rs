//! Unions of what has faces and what is round, sharp or with a fillet between them.
//!
//! A fillet is the quadratic smooth minimum of both distances a and b (I. Quilez, "smooth minimum"): min(a, b) − h²/4k with
//! h = max(k − |a − b|, 0). Its slope is a mean of both slopes, with the weight h/2k on the farther one's: so it grows no faster
//! than they do, and the weight is what light needs too.

use glint_core::field::{FixedSpheres, Sample, Surface};

/// Spheres beside a solid that has faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Beside {
    /// The spheres.
    pub spheres: FixedSpheres,
    /// What is between both.
    pub blend: Blend,
}

/// A fillet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Blend {
    /// k, u5.12; 0 where there is none.
    pub width: u32,
    /// 1/2k, u1.16, to nearest.
    pub inverse: u32,
}

impl Blend {
    /// A fillet whose width, 12 fraction bits, is 0 or 2^10 to 2^17 − 1.
    pub fn new(width: u32) -> Self {
        Self {
            width,
            inverse: ((1 << 27) + width / 2).checked_div(width).unwrap_or(0),
        }
    }

    /// What is nearest of a face and a sphere; of equals, the face.
    pub fn union(&self, flat: Sample, round: Sample) -> Sample {
        let is_round = round.distance < flat.distance;
        let nearer = if is_round { round } else { flat };
        let (Surface::Face { axis, positive }, Surface::Round { number }, 1..) =
            (flat.surface, round.surface, self.width)
        else {
            return nearer;
        };
        let apart = flat.distance.abs_diff(round.distance);
        let h = i64::from(self.width.saturating_sub(apart));
        // 16 fraction bits, of 28; at most a little above a half.
        let weight = (h * i64::from(self.inverse)) >> 12;
        let share = if is_round { (1 << 16) - weight } else { weight };
        Sample {
            // A half and 16 fraction bits, rounded down.
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
