//! Coordinates of a point that are mirrored and exchanged (folded) while the distance of a solid is evaluated. Folding preserves
//! distances in the maximum norm. Each coordinate carries its direction in the world, which gives the normal of the nearest face at the
//! end.

use super::surface::Surface;

/// A coordinate during folding: its value, and the world direction of increasing values.
///
/// The integer k represents the coordinate x = k + 1/2, the middle of the interval that is truncated to k. Therefore −x is
/// exactly `!k`, and a mirror needs no carry.
#[derive(Clone, Copy)]
pub(in crate::field) struct Folded {
    pub value: i32,
    axis: u8,
    positive: bool,
}

impl Folded {
    /// Returns the coordinates of a point before any folding.
    pub fn of(point: [i32; 3]) -> [Self; 3] {
        [0, 1, 2].map(|axis: u8| Self {
            value: point[usize::from(axis)],
            axis,
            positive: true,
        })
    }

    /// Returns the coordinate mirrored at 0 (−x) if `negate`, otherwise the coordinate itself.
    pub fn negated_if(self, negate: bool) -> Self {
        if negate {
            Self {
                value: !self.value,
                positive: !self.positive,
                ..self
            }
        } else {
            self
        }
    }

    /// Returns a coordinate with the given value and the direction of this coordinate.
    pub fn with(self, value: i32) -> Self {
        Self { value, ..self }
    }

    pub fn plus(self, offset: i32) -> Self {
        Self {
            value: self.value + offset,
            ..self
        }
    }

    /// Returns the face whose normal is the direction in which the coordinate increases.
    pub const fn face(self) -> Surface {
        Surface::Face {
            axis: self.axis,
            positive: self.positive,
        }
    }
}

/// Returns the index of the largest of three numbers. Among equal numbers y is preferred to x, and x to z.
pub(in crate::field) fn largest([x, y, z]: [i32; 3]) -> usize {
    if z > x && z > y {
        2
    } else if x > y {
        0
    } else {
        1
    }
}
