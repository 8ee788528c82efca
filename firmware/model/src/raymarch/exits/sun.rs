//! The shadow rays from hits to the first light.

use super::words::{Inverse, Words};

/// The shadow rays. The light is infinitely far away, so all shadow rays have the same direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sun {
    /// The direction, s1.14, of length 1.
    pub direction: [i16; 3],
    /// Whether the direction points down along each axis.
    pub down: [bool; 3],
    /// Magnitudes of the components of half the direction, u0.28, with the lowest bit set, because they represent the middle of an
    /// interval.
    pub speed: [u32; 3],
    /// Reciprocals of `speed`.
    pub inverse: [Inverse; 3],
}

impl Sun {
    /// The shadow rays to a light in this direction, a unit vector, s1.14.
    pub fn new(direction: [i16; 3], words: &Words) -> Self {
        let inverse = Self::speed(direction).map(|speed| Inverse::of(speed, words));
        Self::with_inverse(direction, inverse)
    }

    /// As [`new`](Self::new), but with given reciprocals.
    pub fn with_inverse(direction: [i16; 3], inverse: [Inverse; 3]) -> Self {
        Self {
            direction,
            down: direction.map(|part| part < 0),
            speed: Self::speed(direction),
            inverse,
        }
    }

    fn speed(direction: [i16; 3]) -> [u32; 3] {
        direction.map(|part| u32::from(part.unsigned_abs()) << 13 | 1)
    }
}
