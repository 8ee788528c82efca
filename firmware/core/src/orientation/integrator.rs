//! Computes an attitude by integration of angular rates: exactly for a constant rate, and without numerical drift.
//!
//! A step turns the body by twice the half angle vector h. It multiplies the attitude q by the quaternion exp h = (cos|h|,
//! h·sin|h|/|h|). The product is computed as q + q·(exp h − 1), because the second term is small, and so is its rounding error.
//! The series of 1 − cos|h| and of 1 − sin|h|/|h| in |h|² have no singularity and need neither a root nor a division. Three
//! rounding errors would accumulate over millions of steps and are avoided: the attitude has 62 fraction bits, of which the upper
//! 30 are multiplied; the vector of exp h is rounded to 32 bits and its remainder goes into the next step; and each step corrects
//! the length, by half of 1 − |q|².

use super::quaternion::{Quaternion, dot, product};
use super::rate::History;
use super::scale::Scale;

/// Longest integrated step, in µs.
pub const LONGEST_STEP: u32 = 500_000;

/// Integrates angular rates to an attitude.
#[derive(Clone, Copy, Debug)]
pub struct Integrator {
    scale: Scale,
    history: History,
    /// The attitude with 62 fraction bits.
    attitude: [i64; 4],
    /// The attitude rounded to 30 fraction bits, to nearest.
    rounded: Quaternion,
    /// The remainder of the last step's vector part of exp h after rounding, with 48 fraction bits. It is added to the half angle
    /// vector of the next step.
    rest: [i32; 3],
}

/// Largest component of the half angle vector h that one multiplication applies: 0.25 rad with 48 fraction bits. It bounds
/// |h|² by 3/16.
const LARGEST: i64 = 1 << 46;

impl Integrator {
    /// Starts with the given attitude and the given angular rate about each axis, in 1/256 LSB.
    pub fn new(scale: Scale, attitude: Quaternion, rate: [i32; 3]) -> Self {
        let mut integrator = Self {
            scale,
            history: History::default(),
            attitude: [0; 4],
            rounded: attitude,
            rest: [0; 3],
        };
        integrator.set_attitude(attitude);
        integrator.restart(rate);
        integrator
    }

    /// Continues from another attitude.
    pub fn set_attitude(&mut self, attitude: Quaternion) {
        self.attitude = attitude.parts.map(|x| i64::from(x) << 32);
        self.rounded = attitude;
    }

    /// Drops the earlier rates and continues from `rate` (in 1/256 LSB) with the present attitude.
    pub fn restart(&mut self, rate: [i32; 3]) {
        self.history.start(rate);
    }

    /// Integrates a rate in 1/256 LSB that was measured `step` µs after the previous rate. `correction` is an additional
    /// rotation: a half angle vector in the body's axes, in radians with 48 fraction bits, with components within ±8.
    ///
    /// The rate saturates to ±1.5·2^23. If the step is 0 or longer than [`LONGEST_STEP`], the attitude is kept, and integration
    /// restarts from this rate.
    pub fn advance(&mut self, rate: [i32; 3], step: u32, correction: [i64; 3]) {
        self.advance_order::<4>(rate, step, correction);
    }

    /// Integrates a rate as [`Self::advance`] does, by a method of the given order; orders above 4 count as 4. As the rate
    /// between two samples, order 1 takes the newest sample, 2 the mean of two samples, 3 a parabola through three samples, and 4
    /// a cubic through four samples.
    pub fn advance_order<const ORDER: u32>(
        &mut self,
        rate: [i32; 3],
        step: u32,
        correction: [i64; 3],
    ) {
        if step == 0 || step > LONGEST_STEP {
            return self.restart(rate);
        }
        let half = self.half_angle::<ORDER>(rate, step);
        self.turn(&[0, 1, 2].map(|i| half[i] + correction[i]));
    }

    /// Takes a rate in 1/256 LSB that was measured `step` µs (1 to [`LONGEST_STEP`]) after the previous rate. Returns the
    /// rotation of the step as a half angle vector in the body's axes, in radians with 48 fraction bits.
    pub(super) fn half_angle<const ORDER: u32>(&mut self, rate: [i32; 3], step: u32) -> [i64; 3] {
        self.history.advance::<ORDER>(rate, step, self.scale)
    }

    /// The attitude, rounded to nearest.
    pub const fn attitude(&self) -> Quaternion {
        self.rounded
    }

    /// A reference to the attitude, rounded to nearest.
    pub(super) const fn rounded(&self) -> &Quaternion {
        &self.rounded
    }

    /// Turns the attitude by the rotation with the half angle vector `half`, of any length. Its components have 48 fraction bits
    /// and are within ±2^57.
    pub(super) fn turn(&mut self, half: &[i64; 3]) {
        if half.iter().all(|x| (-LARGEST..LARGEST).contains(x)) {
            self.turn_part(half);
        } else {
            self.turn_far(half);
        }
    }

    /// Turns the attitude by a long half angle vector, in several equal parts.
    #[cold]
    #[inline(never)]
    fn turn_far(&mut self, half: &[i64; 3]) {
        let all = half.iter().fold(0, |all, x| all | x.unsigned_abs());
        let halvings = all.ilog2().saturating_sub(LARGEST.ilog2()) + 1;
        let part = half.map(|x| x >> halvings);
        for _ in 0..1_u32 << halvings {
            self.turn_part(&part);
        }
    }

    #[inline(never)]
    fn turn_part(&mut self, half: &[i64; 3]) {
        let half = [0, 1, 2].map(|i| half[i] + i64::from(self.rest[i]));
        // `square` is |h|² with 32 fraction bits, rounded down; each of its three addends is below 2^29.
        let short = half.map(|x| (x >> 16) as i32);
        let square = short
            .map(|x| ((i64::from(x) * i64::from(x)) >> 32) as u32)
            .iter()
            .sum();
        let (versine, lack) = series(square);
        let q = &self.rounded.parts;
        // `excess` is 1 − |q|² with 60 fraction bits. The scalar part of `change` uses half of it, with 32 fraction
        // bits, rounded down.
        let excess = (1 << 60) - dot(q, q[0], q[1], q[2], q[3]);
        let mut change = [(excess >> 29) as i32 - versine as i32, 0, 0, 0];
        for i in 0..3 {
            // `exact` is h·sin|h|/|h| with 48 fraction bits, plus 2^−33 so that the shift below rounds to nearest.
            let exact = half[i] - ((i64::from(short[i]) * i64::from(lack)) >> 16) + (1 << 15);
            self.rest[i] = i32::from(exact as u16) - (1 << 15);
            change[i + 1] = (exact >> 16) as i32;
        }
        // |change| < 0.47, so no component of the sum below exceeds 1.47·2^62.
        let turned = product(q, change);
        for (part, turned) in core::iter::zip(&mut self.attitude, turned) {
            *part += turned;
        }
        self.rounded.parts = self.attitude.map(|part| ((part + (1 << 31)) >> 32) as i32);
    }
}

/// Computes 1 − cos x and 1 − sin(x)/x from x². Argument and results have 32 fraction bits. For x² up to 3/16 the errors are at
/// most 2 units; the first omitted terms of the series, x¹²/12! and x¹⁰/11!, are then 9e-14 and 6e-12.
fn series(square: u32) -> (u32, u32) {
    const fn one_over(n: u64) -> u32 {
        (((1 << 32) + n / 2) / n) as u32
    }
    let times = |a: u32| ((u64::from(square) * u64::from(a)) >> 32) as u32;
    let versine = times(one_over(40_320) - times(one_over(3_628_800)));
    let versine = times(one_over(720) - versine);
    let versine = times(one_over(24) - versine);
    let versine = times((1 << 31) - versine);
    let lack = times(one_over(5_040) - times(one_over(362_880)));
    let lack = times(one_over(120) - lack);
    let lack = times(one_over(6) - lack);
    (versine, lack)
}
