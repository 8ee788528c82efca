//! The motion of all segments, without drift.

use super::format::{Point, Segment};
use crate::fixed::{Q5_11, Q12_20};
use crate::orientation::Quaternion;

/// The step δ of a pan: 0.0625. A zoom moves by twice this step along z.
pub const PAN: Q5_11 = Q5_11::from_bits(0x0080);
/// Cosine of the rotation's step ε, as in the original design. Its angle is atan(0x0040/0x07FF), 1.7908°.
pub const ROTATION_COSINE: Q5_11 = Q5_11::from_bits(0x07FF);
/// Sine of the rotation's step ε: √(1 − cos² ε), rounded.
pub const ROTATION_SINE: Q5_11 = Q5_11::from_bits(0x0040);

/// cos(ε/2) with 62 fraction bits, rounded to nearest, for ε = atan(0x0040/0x07FF).
const HALF_COSINE: i128 = 0x3FFD_FFD8_02C0_6979;
/// sin(ε/2) with 62 fraction bits, rounded to nearest.
const HALF_SINE: i128 = 0x0100_07FE_DFF1_02D6;
/// Number of fraction bits of the quaternion's components.
const FRACTION: u32 = 62;
/// The largest displacement in the body's axes: 16, with 34 fraction bits.
const FARTHEST: i64 = 16 << 34;

/// A change of the position of all segments, about or along the world's axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// A translation, in multiples of [`PAN`].
    Pan([i8; 3]),
    /// A rotation by ε about the x axis through the origin: from y to z if `forwards`.
    AboutX {
        /// Whether the rotation is right-handed.
        forwards: bool,
    },
    /// A rotation by ε about the y axis through the origin: from z to x if `forwards`.
    AboutY {
        /// Whether the rotation is right-handed.
        forwards: bool,
    },
}

/// The motion of all segments since the start, without drift: the segments in the program stay unchanged.
///
/// The motion maps a point p to R(p + d). The rotation R is a quaternion with 62 fraction bits and length 1, so that 10,000 steps
/// have an error of 10^−14. The displacement d is in the body's axes, where a rotation does not change it; a pan adds a multiple
/// of a row of R's matrix to it, exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Motion {
    /// The quaternion w, x, y, z, s2.62.
    rotation: [i64; 4],
    /// The displacement d in the body's axes, s6.34, within ±16.
    displacement: [i64; 3],
}

impl Default for Motion {
    fn default() -> Self {
        Self {
            rotation: [1 << FRACTION, 0, 0, 0],
            displacement: [0; 3],
        }
    }
}

impl Motion {
    /// Adds a step. Returns `false` and changes nothing for a pan that would displace the segments by more than 16 in the body's
    /// axes.
    pub fn apply(&mut self, step: Step) -> bool {
        match step {
            Step::Pan(direction) => return self.pan(direction),
            Step::AboutX { forwards } => self.rotate([1, 2, 3], forwards),
            Step::AboutY { forwards } => self.rotate([2, 3, 1], forwards),
        }
        true
    }

    fn pan(&mut self, direction: [i8; 3]) -> bool {
        // A column of the matrix contains the world coordinates of an axis of the body, in units of 2^−30, so its products with
        // the direction are the pan along this axis, with 34 fraction bits for δ = 2^−4.
        let moved = self.quaternion().axes().map(|axis| {
            let products = axis.into_iter().zip(direction);
            products
                .map(|(axis, direction)| i64::from(axis) * i64::from(direction))
                .sum::<i64>()
        });
        let [x, y, z] = self.displacement;
        let [dx, dy, dz] = moved;
        let displacement = [x + dx, y + dy, z + dz];
        let possible = displacement
            .iter()
            .all(|x| (-FARTHEST..=FARTHEST).contains(x));
        if possible {
            self.displacement = displacement;
        }
        possible
    }

    /// Rotates by ±ε: multiplies the quaternion from the left by the step's quaternion, rounds to nearest, and corrects the
    /// length to 1. `k` is the index of the axis' component, and `i` and `j` are the indices of the next axes' components.
    fn rotate(&mut self, [k, i, j]: [usize; 3], forwards: bool) {
        let sine = if forwards { HALF_SINE } else { -HALF_SINE };
        let old = self.rotation.map(i128::from);
        let part = |number: usize| old.get(number).copied().unwrap_or_default();
        let nearest = |x: i128| (x + (1 << (FRACTION - 1))) >> FRACTION;
        let mut new = old;
        for (number, other) in [(0, -part(k)), (k, part(0)), (i, -part(j)), (j, part(i))] {
            if let Some(new) = new.get_mut(number) {
                *new = nearest(part(number) * HALF_COSINE + other * sine);
            }
        }
        // One Newton step towards the length 1. The error of the squared length is a few units of 2^−62, and no sum exceeds
        // 2^126.
        let excess = (1 << FRACTION) - nearest(new.iter().map(|x| x * x).sum());
        self.rotation = new.map(|x| (x + nearest(x * excess / 2)) as i64);
    }

    /// The rotation with 30 fraction bits, rounded to nearest.
    fn quaternion(&self) -> Quaternion {
        let parts = self
            .rotation
            .map(|x| ((x + (1 << (FRACTION - 31))) >> (FRACTION - 30)) as i32);
        // Rounding changes the length by less than 2^−29, so the quaternion is accepted.
        Quaternion::exact(parts).unwrap_or(Quaternion::IDENTITY)
    }

    /// Computes the constants of a frame.
    pub fn pose(&self) -> Pose {
        Pose {
            axes: self.quaternion().axes(),
            displacement: self.displacement.map(|x| ((x + (1 << 13)) >> 14) as i32),
        }
    }
}

/// The constants of a frame that move the points of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pose {
    /// Columns of the rotation's matrix, s2.30.
    axes: [[i32; 3]; 3],
    /// The displacement d, s6.20, within ±16.
    displacement: [i32; 3],
}

impl Pose {
    /// Moves a point p to R(p + d), rounded once to nearest. Each coordinate is within ±56.
    pub fn point(&self, point: Point) -> [Q12_20; 3] {
        let [x, y, z] = point.map(|x| i64::from(x.to_bits()) << 9);
        let [dx, dy, dz] = self.displacement.map(i64::from);
        // Each sum is within 2^25 and the columns have length 1, so the sum of three products is below 2^56.
        let moved = [x + dx, y + dy, z + dz];
        let mut sums = [1 << 29; 3];
        for (axis, along) in self.axes.iter().zip(moved) {
            for (sum, &part) in sums.iter_mut().zip(axis) {
                *sum += i64::from(part) * along;
            }
        }
        sums.map(|sum| Q12_20::from_bits((sum >> 30) as i32))
    }

    /// Moves both ends of a segment.
    pub fn segment(&self, segment: Segment) -> [[Q12_20; 3]; 2] {
        segment.map(|point| self.point(point))
    }
}
