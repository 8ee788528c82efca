//! The rays from hits to the first light.

use super::words::{Inverse, Words};

/// The rays to the first light, which is far away: all have its direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sun {
    /// The direction, s1.14, of length 1.
    pub direction: [i16; 3],
    /// Whether the direction leads down along each axis.
    pub down: [bool; 3],
    /// Magnitude of the direction's components, u0.28: half of those of a direction of length 1, odd numbers, the middles of
    /// intervals.
    pub speed: [u32; 3],
    /// Reciprocals of `speed`.
    pub inverse: [Inverse; 3],
}

impl Sun {
    /// The rays to a light in this direction, s1.14, of length 1.
    pub fn new(direction: [i16; 3], words: &Words) -> Self {
        let inverse = Self::speed(direction).map(|speed| Inverse::of(speed, words));
        Self::with_inverse(direction, inverse)
    }

    /// As [`new`](Self::new), with given reciprocals.
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
