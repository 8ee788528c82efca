//! Computes the rotation of a body between two samples of its angular rate.
//!
//! The last four samples of the angular rate are ω₀, ω₁, ω₂ and ω₃, the newest last. A step of duration h leads from ω₂ to ω₃.
//! The rotation vector φ of the step is approximated by the first two terms of the Magnus expansion:
//!
//! ```text
//! φ = ∫ω dt + ½∫∫ ω(s) × ω(t) ds dt (s < t) = h·A + h²/12·A × E
//! ```
//!
//! ω is taken as the cubic through the last four samples at their times. With the differences e₁ = ω₃ − ω₂ and e₂ = ω₂ − ω₁, and
//! with h, h₁ and h₂ as the durations of the last three steps (the newest first), A and E follow from the divided differences S
//! and D of the cubic in units of h:
//!
//! ```text
//! S = (e₁ − g·e₂)·h/(h + h₁)      g = h/h₁
//! D = S − g²·S of the previous step,      T = D·h/(h + h₁ + h₂)
//! A = (ω₂ + ω₃)/2 − (2·S + D·(h + 2·h₁)/(h + h₁ + h₂))/12
//! E = e₁ + 9/5·T
//! ```
//!
//! With equal steps A is the Adams–Moulton formula (9ω₃ + 19ω₂ − 5ω₁ + ω₀)/24. The exact E of the cubic would be e₁ − T/10; the
//! factor 9/5 in its place reduces the accumulated error, as follows. The error of A, −19/720·h⁴·d⁴ω/dt⁴, accumulates while the
//! body turns: integration by parts in the world's axes gives a bounded term and the growing term 19/720·h⁴·ω × d³ω/dt³. As
//! h³·d³ω/dt³ is about 6·T, an additional 19/10·T in E cancels the growing term: −1/10 + 19/10 = 9/5. For a coning motion with 20
//! samples per turn the drift with the factor 9/5 is a ninth of the drift with −1/10.

use super::scale::{Factor, Scale};
use crate::fixed::wide;

/// Longest step, in µs, for which the rate is interpolated by a cubic; for longer steps it is interpolated linearly.
pub const LONGEST_CURVE: u32 = 1 << 15;
/// Largest ratio of a step to the previous step for which the rate is interpolated by a cubic; beyond this ratio old samples
/// would outweigh new samples.
pub const MOST_STRETCH: u32 = 3;
/// The largest rate, in 1/256 LSB: 1.5 times the largest count, so that a bias may be subtracted. This limit ensures that all
/// 32-bit numbers in this file are in range.
pub const LARGEST_RATE: i32 = 3 << 22;

/// State of the earlier samples for the next step.
#[derive(Clone, Copy, Debug)]
pub struct History {
    scale: Scale,
    /// Number of earlier steps that can be used: 0, 1 or 2.
    steps: u8,
    axes: [Axis; 3],
    /// The durations h₁ and h₂ of the two earlier steps, in µs.
    ages: [u32; 2],
    /// The factors of the last step for its half angle and for A × E.
    factor: Factor,
    coning: u32,
}

/// State of the earlier rates about one axis for the next step, in 1/256 LSB.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    /// The rate at the last sample, ω₂.
    last: i32,
    /// The difference of the last two rates, e₂.
    difference: i32,
    /// Twice the divided difference S of the previous step.
    second: i32,
}

/// The weights of the module's formulas for steps that are not equal, which depend only on the times of the samples. Unless
/// stated otherwise, weights have 15 fraction bits.
#[derive(Clone, Copy)]
struct Weights {
    /// g = h/h₁ in units of 2^−30, rounded to 15 fraction bits.
    stretch: u32,
    /// g², the factor of the previous step's S in D.
    stretch_squared: i32,
    /// h/(h + h₁) in units of 2^−32, rounded to 15 fraction bits.
    half: u32,
    /// The factor 9/10·h/(h + h₁ + h₂) of 2·D in E.
    near: i32,
    /// The factor 2/3·(h + 2·h₁)/(h + h₁ + h₂) of 2·D in A.
    far: i32,
}

const FOUR_THIRDS: i32 = (4 << 15) / 3 + 1;
const TWO_THIRDS: i32 = (2 << 15) / 3 + 1;
const NINE_TENTHS: i32 = (9 << 15) / 10 + 1;

impl Weights {
    /// Weights for a step without usable earlier steps: the rate is interpolated linearly.
    const STRAIGHT: Self = Self {
        stretch: 0,
        stretch_squared: 0,
        half: 0,
        near: 0,
        far: 0,
    };

    /// Computes the weights for a step of duration h (`step`) after earlier steps of durations h₁ and h₂, of which `steps` (0 to
    /// 2) can be used.
    #[inline(never)]
    fn of(order: u32, steps: u8, step: u32, [h1, h2]: [u32; 2]) -> Self {
        if steps == 0 {
            return Self::STRAIGHT;
        }
        let g = Divisor::new(h1).ratio(step);
        // D of the cubic (see the module's documentation) needs S of the previous step. Without two earlier steps D is unknown, and
        // its weights are 0.
        let (mut near, mut far) = (0, 0);
        if steps == 2 && order >= 4 {
            let all = Divisor::new(step + h1 + h2);
            near = narrow(wide(all.ratio(step), NINE_TENTHS));
            far = narrow(wide(all.ratio(step + 2 * h1), TWO_THIRDS));
        }
        Self {
            // g is at most 3, so h/(h + h₁) is at most 3/4.
            stretch: (g as u32) << 15,
            stretch_squared: narrow(wide(g, g)),
            half: (Divisor::new(step + h1).ratio(step) as u32) << 17,
            near,
            far,
        }
    }
}

/// Computes x·2^−15, rounded to nearest; the result must fit 31 bits.
const fn narrow(x: i64) -> i32 {
    half_up((x >> 14) as i32)
}

/// Computes x/2, rounded to nearest.
const fn half_up(x: i32) -> i32 {
    (x + 1) >> 1
}

/// Returns the upper 32 bits of the 64-bit product of two numbers.
const fn upper(a: i32, b: u32) -> i32 {
    ((a as i64 * b as i64) >> 32) as i32
}

/// A divisor with its reciprocal, so that several quotients need one slow division.
struct Divisor {
    number: u32,
    /// (2^32 − 1)/divisor, rounded down.
    inverse: u32,
}

impl Divisor {
    const fn new(number: u32) -> Self {
        Self {
            number,
            inverse: u32::MAX / number,
        }
    }

    /// Computes the quotient a/divisor with 15 fraction bits, rounded to nearest. All numbers fit 32 bits, because a < 2^17 and
    /// the quotient is at most 3.
    const fn ratio(&self, a: u32) -> i32 {
        let number = (a << 15) + self.number / 2;
        // `below` is the quotient or 1 less: the product with the reciprocal is too small by less than 1 before the
        // product is rounded down.
        let below = ((number as u64 * self.inverse as u64) >> 32) as u32;
        let rest = number - below * self.number;
        (below + (rest >= self.number) as u32) as i32
    }
}

/// Limits a rate to ±`LARGEST_RATE`.
fn within(rate: i32) -> i32 {
    rate.clamp(-LARGEST_RATE, LARGEST_RATE)
}

/// Whether a rate is within ±`LARGEST_RATE`.
const fn is_in_range(rate: i32) -> bool {
    rate.wrapping_add(LARGEST_RATE).cast_unsigned() <= 2 * LARGEST_RATE.cast_unsigned()
}

/// The components along one axis of A and E (with 13 fraction bits) in the module's formulas.
type Ends = (i32, i32);

impl Axis {
    /// Takes the newest rate about the axis, in 1/256 LSB and [in range](is_in_range), after three equal steps, and computes A and E of its
    /// step:
    ///
    /// ```text
    /// 2·S = e₁ − e₂      2·D = 2·S − 2·S of the previous step
    /// A = (ω₂ + ω₃)/2 − (2·(2·S) + 2·D)/24
    /// E = e₁ + 3/10·(2·D)
    /// ```
    ///
    /// No number overflows: |e₁| is at most 1.5·2^24, so |2·S| is at most 3·2^24, |2·D| 6·2^24, |2·(2·S) + 2·D| 12·2^24, |A| 2^29.4
    /// and |E| 2^30.8.
    #[inline(always)]
    fn advance_even(&mut self, rate: i32) -> Ends {
        const TWO_THIRDS: u32 = 0xAAAA_AAAB;
        const THREE_FIFTHS: u32 = 0x9999_999A;
        let e1 = rate - self.last;
        let second = e1 - self.difference;
        let third = second - self.second;
        // The division by 24 and the change from 8 to 13 fraction bits are together a factor of 4/3.
        let curve = half_up(upper((2 * second + third) << 2, TWO_THIRDS));
        let ends = (
            ((rate + self.last) << 4) - curve,
            (e1 << 5) + upper(third << 4, THREE_FIFTHS),
        );
        *self = Self {
            last: rate,
            difference: e1,
            second,
        };
        ends
    }

    /// Takes the newest rate about the axis, in 1/256 LSB, and computes A and E of its step.
    #[inline(never)]
    fn advance(&mut self, rate: i32, weights: &Weights) -> Ends {
        let rate = within(rate);
        let e1 = rate - self.last;
        // As g ≤ 3, |2·S| is at most 3·3·2^24, and |2·D| at most 10 times as much.
        let before = half_up(upper(self.difference << 3, weights.stretch));
        let second = half_up(upper((e1 - before) << 2, weights.half));
        let third = second - narrow(wide(weights.stretch_squared, self.second));
        // `curve` is the term (2·S + D·…)/12 of A, with 12 fraction bits. The division by 12 and the change from 8 to 12 fraction bits are
        // together a factor of 4/3 for 2·S, and of 2/3 (in `far`) for 2·D.
        let curve = wide(second, FOUR_THIRDS) + wide(third, weights.far);
        let curve = ((curve + (1 << 14)) >> 15) as i32;
        let mean = ((rate + self.last) << 3) - curve;
        let end = e1 + narrow(wide(third, weights.near));
        *self = Self {
            last: rate,
            difference: e1,
            second,
        };
        // No motion within the sensor's range reaches these limits.
        (
            mean.clamp(-MOST_MEAN, MOST_MEAN) << 1,
            end.clamp(-MOST_CHANGE, MOST_CHANGE) << 5,
        )
    }
}

impl History {
    /// Starts with the rate of the first sample, in 1/256 LSB.
    pub fn new(scale: Scale, rate: [i32; 3]) -> Self {
        let axis = |last| Axis {
            last,
            ..Axis::default()
        };
        Self {
            scale,
            steps: 0,
            axes: rate.map(within).map(axis),
            ages: [0; 2],
            factor: Factor::default(),
            coning: 0,
        }
    }

    /// Drops all samples, and starts with the rate of a new sample, in 1/256 LSB.
    pub fn start(&mut self, rate: [i32; 3]) {
        *self = Self::new(self.scale, rate);
    }

    /// The rate of the last sample, in 1/256 LSB.
    pub fn last(&self) -> [i32; 3] {
        self.axes.map(|axis| axis.last)
    }

    /// Takes the rate of a sample that was measured `step` µs (at least 1) after the previous sample. Returns half the rotation
    /// vector of this step, φ/2, in radians with 48 fraction bits.
    ///
    /// The rate saturates to ±[`LARGEST_RATE`]. `ORDER` is the order of the method. Order 1 uses the rate of the newest sample, 2
    /// the mean of two samples, 3 the parabola through three samples (with e₁ instead of E), and 4 or more the cubic through four
    /// samples. The first steps after a start use fewer earlier samples; their total error is of order h³.
    #[inline(always)]
    pub fn advance<const ORDER: u32>(&mut self, rate: [i32; 3], step: u32) -> [i64; 3] {
        let is_even = self.steps == 2 && self.ages == [step; 2];
        let ends = if ORDER >= 4 && is_even && rate.into_iter().all(is_in_range) {
            [0, 1, 2].map(|i| self.axes[i].advance_even(rate[i]))
        } else {
            let [x, y, z] = rate;
            self.advance_uneven(ORDER, x, y, z, step)
        };
        let (coning, factor) = (self.coning, self.factor);
        let [mut x, mut y, mut z] = ends;
        if ORDER == 1 {
            [x.0, y.0, z.0] = rate.map(|rate| within(rate) << 5);
        }
        [
            turned(x.0, y, z, coning, factor),
            turned(y.0, z, x, coning, factor),
            turned(z.0, x, y, coning, factor),
        ]
    }

    /// Takes the rate of a sample as [`Self::advance`] does, by a method of any order. Returns A and E along the axes.
    // The components are separate arguments, so that they are passed in CPU registers.
    #[inline(never)]
    fn advance_uneven(&mut self, order: u32, x: i32, y: i32, z: i32, step: u32) -> [Ends; 3] {
        let [h1, _] = self.ages;
        let curved = step <= LONGEST_CURVE && (self.steps == 0 || step <= MOST_STRETCH * h1);
        let steps = if order >= 3 && curved { self.steps } else { 0 };
        let weights = Weights::of(order, steps, step, self.ages);
        let rate = [x, y, z];
        let ends = [0, 1, 2].map(|i| self.axes[i].advance(rate[i], &weights));
        self.steps = if curved { (self.steps + 1).min(2) } else { 0 };
        self.ages = [step, h1];
        self.factor = self.scale.factor(step);
        self.coning = if order >= 3 && curved {
            self.factor.coning()
        } else {
            0
        };
        ends
    }
}

/// Computes the component of φ/2 along an axis from A along this axis (`mean`), and from A and E along the next two axes in
/// cyclic order (`mj`, `ej` and `mk`, `ek`).
#[inline(always)]
fn turned(mean: i32, (mj, ej): Ends, (mk, ek): Ends, coning: u32, factor: Factor) -> i64 {
    // The cross product A × E in units of 2^6 LSB², each product rounded down; below 2^29.
    let cross = mul_high(mj, ek) - mul_high(mk, ej);
    // In units of 2^−12 LSB, rounded to nearest.
    let coning = half_up(upper(cross << 2, coning));
    factor.half_angle(mean + (coning << 1))
}

/// Returns the upper 32 bits of the 64-bit product of two signed numbers.
const fn mul_high(a: i32, b: i32) -> i32 {
    ((a as i64 * b as i64) >> 32) as i32
}

/// The largest mean rate, 1.5·2^16 LSB with 12 fraction bits. With this limit the rate with its coning term fits 32 bits, even in
/// the longest curved step at the most sensitive scale.
const MOST_MEAN: i32 = 3 << 27;
/// The largest change of the rate in a step, almost 2^17 LSB, with 8 fraction bits.
const MOST_CHANGE: i32 = (1 << 25) - 1;
