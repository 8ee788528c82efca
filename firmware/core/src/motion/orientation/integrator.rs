//! Computes an attitude by integration of angular rates: exactly for a constant rate, and without numerical drift.
//!
//! A step turns the body by twice the half angle vector h. The step multiplies the attitude q by the quaternion exp h = (cos|h|,
//! h·sin|h|/|h|). The product is computed as q + q·(exp h − 1), because the second term is small, and so is its rounding error.
//! The series of 1 − cos|h| and of 1 − sin|h|/|h| in |h|² have no singularity and need neither a root nor a division. Three
//! rounding errors would accumulate over millions of steps and are avoided: the attitude has 62 fraction bits, of which the upper
//! 30 are multiplied; the vector of exp h is rounded to 32 bits and its remainder goes into the next step; and each step corrects
//! the length, by half of 1 − |q|².

use super::quaternion::{Quaternion, product};
use super::rate::History;
use super::scale::Scale;

/// Longest integrated step, in µs.
pub const LONGEST_STEP: u32 = 500_000;

/// Integrates angular rates to an attitude.
#[derive(Clone, Copy, Debug)]
pub struct Integrator {
    history: History,
    /// The attitude with 62 fraction bits.
    attitude: [i64; 4],
    /// The attitude rounded to 30 fraction bits, to nearest.
    rounded: Quaternion,
    /// Half angle vector with 48 fraction bits that the next step adds to its own half angle vector. This vector contains the
    /// rounding remainder of the last step's vector part of exp h, and corrections.
    rest: [i64; 3],
}

/// Largest component of the half angle vector h that one multiplication applies: 1/8 rad with 48 fraction bits. This limits |h|²
/// to 3/64.
const LARGEST: i64 = 1 << 45;

impl Integrator {
    /// Starts with the given attitude and the given angular rate about each axis, in 1/256 LSB.
    pub fn new(scale: Scale, attitude: Quaternion, rate: [i32; 3]) -> Self {
        let mut integrator = Self {
            history: History::new(scale, rate),
            attitude: [0; 4],
            rounded: attitude,
            rest: [0; 3],
        };
        integrator.set_attitude(attitude);
        integrator
    }

    /// Continues from another attitude.
    pub fn set_attitude(&mut self, attitude: Quaternion) {
        self.attitude = attitude.parts.map(|x| i64::from(x) << 32);
        self.rounded = attitude;
    }

    /// Drops the earlier rates and continues from `rate` (in 1/256 LSB) with the current attitude.
    pub fn restart(&mut self, rate: [i32; 3]) {
        self.history.start(rate);
    }

    /// Drops all rates except the last one.
    #[cold]
    #[inline(never)]
    pub(super) fn forget(&mut self) {
        self.history.start(self.history.last());
    }

    /// Integrates a rate in 1/256 LSB that was measured `step` µs after the previous rate. `correction` is an additional
    /// rotation: a half angle vector in the body's axes, in radians with 48 fraction bits, with components within ±8.
    ///
    /// The rate saturates to ±1.5·2^23. If the step is 0 or longer than [`LONGEST_STEP`], the attitude is kept, and integration
    /// restarts from this rate.
    pub fn advance(&mut self, rate: [i32; 3], step: u32, correction: [i64; 3]) {
        self.advance_order::<4>(rate, step, correction);
    }

    /// Integrates a rate as [`Self::advance`] does, by a method of the given order; orders above 4 count as 4. Between two
    /// samples, order 1 uses the newest rate, order 2 the mean of two rates, order 3 a parabola through three rates, and order 4
    /// a cubic through four rates.
    pub fn advance_order<const ORDER: u32>(
        &mut self,
        rate: [i32; 3],
        step: u32,
        correction: [i64; 3],
    ) {
        if step == 0 || step > LONGEST_STEP {
            return self.restart(rate);
        }
        for (rest, correction) in core::iter::zip(&mut self.rest, correction) {
            *rest += correction;
        }
        self.step::<ORDER>(rate, step);
    }

    /// Integrates a rate in 1/256 LSB that was measured `step` µs (1 to [`LONGEST_STEP`]) after the previous rate.
    #[inline(always)]
    pub(super) fn step<const ORDER: u32>(&mut self, rate: [i32; 3], step: u32) {
        let half = self.history.advance::<ORDER>(rate, step);
        self.turn([0, 1, 2].map(|i| half[i] + self.rest[i]));
    }

    /// The attitude, rounded to nearest.
    pub const fn attitude(&self) -> Quaternion {
        self.rounded
    }

    /// References to the attitude, rounded to nearest, and to a half angle vector that the next step adds to its own: in the
    /// body's axes, in radians with 48 fraction bits. A caller may add a vector with components within ±8.
    pub(super) const fn correctable(&mut self) -> (&Quaternion, &mut [i64; 3]) {
        (&self.rounded, &mut self.rest)
    }

    /// Turns the attitude by the rotation with the half angle vector `half`, of any length. Its components have 48 fraction bits
    /// and are within ±2^57.
    #[inline(always)]
    fn turn(&mut self, half: [i64; 3]) {
        if half.iter().all(|x| (-LARGEST..LARGEST).contains(x)) {
            self.turn_part(half);
        } else {
            self.turn_far(half);
        }
    }

    /// Turns the attitude by a long half angle vector, in several equal parts.
    #[cold]
    #[inline(never)]
    fn turn_far(&mut self, half: [i64; 3]) {
        let all = half.iter().fold(0, |all, x| all | x.unsigned_abs());
        let halvings = all.ilog2().saturating_sub(LARGEST.ilog2()) + 1;
        let part = half.map(|x| x >> halvings);
        self.rest = [0; 3];
        for _ in 0..1_u32 << halvings {
            self.turn_part([0, 1, 2].map(|i| part[i] + self.rest[i]));
        }
    }

    /// Turns the attitude by a short half angle vector.
    // Inlined in the code that runs for every sample; `turn_far` contains a second copy.
    #[inline(always)]
    fn turn_part(&mut self, half: [i64; 3]) {
        // h with 32 fraction bits, rounded down, in 32-bit words like all of the following numbers.
        let short = half.map(|x| (((x >> 32) as i32) << 16) | (x as u32 >> 16).cast_signed());
        // `square` is |h|² with 32 fraction bits, rounded down; each of its three addends is below 2^26.
        let square = short
            .map(|x| ((i64::from(x) * i64::from(x)) >> 32) as u32)
            .iter()
            .sum();
        let (versine, deficit) = series(square);
        let q = &self.rounded.parts;
        // The scalar part of `change` uses half of 1 − |q|², with 32 fraction bits, rounded down.
        let mut change = [(excess(q) >> 27) - versine as i32, 0, 0, 0];
        for i in 0..3 {
            // h·sin|h|/|h| is h minus this product, which has 64 fraction bits.
            let less = i64::from(short[i]) * i64::from(deficit);
            // Rounding remainder of the difference, with 48 fraction bits, plus 2^−33 so that the shift rounds to nearest.
            let low = (half[i] as i32 & 0xFFFF) - (less as u32 >> 16) as i32 + (1 << 15);
            change[i + 1] = short[i] - (less >> 32) as i32 + (low >> 16);
            self.rest[i] = i64::from((low & 0xFFFF) - (1 << 15));
        }
        // |change| < 0.24, so no component of the sum below exceeds 1.24·2^62.
        let turned = product(q, change);
        for (part, turned) in core::iter::zip(&mut self.attitude, turned) {
            *part += turned;
        }
        // Rounding by the highest bit of the low word takes fewer instructions than a 64-bit addition.
        let round = |part: i64| (part >> 32) as i32 + (part as u32 >> 31) as i32;
        self.rounded.parts = self.attitude.map(round);
    }
}

/// Computes 1 − |q|² with 58 fraction bits. The length of q is 1 within 2^−28, so the result fits 32 bits and needs only the low
/// words of products. With q = 2a + b, where b is the lowest bit of q, q² is 4·a·(a + b) + b. The sum of the terms b/4 is
/// neglected.
fn excess(q: &[i32; 4]) -> i32 {
    q.iter().fold(0_i32, |sum, &q| {
        sum.wrapping_sub((q >> 1).wrapping_mul(q - (q >> 1)))
    })
}

/// Computes 1 − cos x and 1 − sin(x)/x from x². Argument and results have 32 fraction bits. For x² up to 3/64 the errors are at
/// most 2 units; the first omitted terms of the series, x⁸/8! and x⁸/9!, are then 1.2e-10, half a unit, and 1.3e-11.
fn series(square: u32) -> (u32, u32) {
    const fn one_over(n: u64) -> u32 {
        (((1 << 32) + n / 2) / n) as u32
    }
    let times = |a: u32| ((u64::from(square) * u64::from(a)) >> 32) as u32;
    let versine = times(one_over(24) - times(one_over(720)));
    let versine = times((1 << 31) - versine);
    let deficit = times(one_over(120) - times(one_over(5_040)));
    let deficit = times(one_over(6) - deficit);
    (versine, deficit)
}
