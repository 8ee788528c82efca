//! From samples of the angular rate to the rotation of the step between two of them.
//!
//! A step of length h goes from the sample before the last, ω₂, to the last, ω₃. What it turns by is a vector φ, of which the
//! first two terms of Magnus' expansion are taken:
//!
//! ```text
//! φ = ∫ω dt + ½∫∫ ω(s) × ω(t) ds dt (s < t) = h·A + h²/12·A × E
//! ```
//!
//! ω is the cubic through the last four samples at their times. With the differences e₁ = ω₃ − ω₂, e₂ = ω₂ − ω₁ and the ages h,
//! h₁, h₂ of the samples, its divided differences in units of h are
//!
//! ```text
//! S = (e₁ − g·e₂)·h/(h + h₁)      g = h/h₁
//! D = S − g²·S of the step before,      T = D·h/(h + h₁ + h₂)
//! A = (ω₂ + ω₃)/2 − (2·S + D·(h + 2·h₁)/(h + h₁ + h₂))/12
//! E = e₁ + 9/5·T
//! ```
//!
//! and with equal steps A is the Adams–Moulton formula (9ω₃ + 19ω₂ − 5ω₁ + ω₀)/24. For the cubic itself E would be e₁ − T/10. What
//! A leaves out, −19/720·h⁴·d⁴ω/dt⁴, adds up while the body turns: integrated by parts in the world's axes it is a term that stays small and
//! 19/720·h⁴·ω × d³ω/dt³ that does not, and since h³·d³ω/dt³ is about 6·T, 19/10·T more in E cancels that. With 9/5 coning at
//! 20 samples a turn drifts by a ninth of what it does with −1/10.

use super::scale::Scale;

/// The longest step between samples through which a cubic is laid, in µs; longer ones are straight lines.
pub const LONGEST_CURVE: u32 = 1 << 15;
/// The most a step may be longer than the one before it for a cubic; what is older would weigh more than what is new.
pub const MOST_STRETCH: u32 = 3;
/// The largest rate, in 1/256 LSB: all counts, and a bias of half of them. Then all numbers below have 32 bits.
pub const LARGEST_RATE: i32 = 3 << 22;

/// The samples before the last, as far as a step needs them. Rates are in 1/256 LSB.
#[derive(Clone, Copy, Debug, Default)]
pub struct History {
    /// How many steps there are to look back on: 0, 1, 2.
    steps: u8,
    /// ω₂.
    last: [i32; 3],
    /// e₂.
    difference: [i32; 3],
    /// S of the step before.
    second: [i32; 3],
    /// h₁ and h₂ in µs.
    ages: [u32; 2],
}

/// What the times of samples make of a cubic, with 15 fraction bits.
struct Weights {
    /// g, and its square.
    stretch: [i32; 2],
    /// h/(h + h₁).
    half: i32,
    /// 9/5·h/(h + h₁ + h₂).
    near: i32,
    /// 4/3·(h + 2·h₁)/(h + h₁ + h₂).
    far: i32,
}

const EIGHT_THIRDS: i32 = (8 << 15) / 3;
const FOUR_THIRDS: i32 = (4 << 15) / 3 + 1;
const NINE_FIFTHS: i32 = (9 << 15) / 5;

impl Weights {
    /// Of equal steps.
    const EVEN: Self = Self {
        stretch: [1 << 15; 2],
        half: 1 << 14,
        near: NINE_FIFTHS / 3 + 1,
        far: FOUR_THIRDS,
    };

    /// Of any steps h, h₁, h₂.
    fn of(step: u32, [h1, h2]: [u32; 2]) -> Self {
        if step == h1 && step == h2 {
            return Self::EVEN;
        }
        let g = ratio(step, h1);
        let all = step + h1 + h2;
        Self {
            stretch: [g, narrow(wide(g, g))],
            half: ratio(step, step + h1),
            near: narrow(wide(ratio(step, all), NINE_FIFTHS)),
            far: narrow(wide(ratio(step + 2 * h1, all), FOUR_THIRDS)),
        }
    }
}

/// The product of two numbers.
const fn wide(a: i32, b: i32) -> i64 {
    a as i64 * b as i64
}

/// x·2^−15, to nearest, of what has 32 bits then.
const fn narrow(x: i64) -> i32 {
    ((x + (1 << 14)) >> 15) as i32
}

/// a/b with 15 fraction bits, to nearest. The products stay in 32 bits: a < 2^17.
const fn ratio(a: u32, b: u32) -> i32 {
    (((a << 15) + b / 2) / b) as i32
}

impl History {
    /// Begins at a sample.
    pub fn start(&mut self, rate: [i32; 3]) {
        *self = Self {
            last: rate,
            ..Self::default()
        };
    }

    /// Takes a sample, `step` µs (at least 1) after the last one, and gives half of φ as a rotation vector, 48 fraction bits.
    ///
    /// `rate` is within ±[`LARGEST_RATE`]. `ORDER` is that of the method: 1 takes the newest sample alone, 2 the mean of two,
    /// 3 the parabola through three with e₁ for E, 4 (and more) the cubic. The first steps have less to look back on and
    /// leave an error in h³ once.
    pub fn advance<const ORDER: u32>(
        &mut self,
        rate: [i32; 3],
        step: u32,
        scale: Scale,
    ) -> [i64; 3] {
        let curved =
            step <= LONGEST_CURVE && (self.steps == 0 || step <= MOST_STRETCH * self.ages[0]);
        if !curved {
            self.steps = 0;
        }
        let axes = [0, 1, 2];
        let factor = scale.factor(step);
        // Twelve fraction bits.
        let mut mean = match ORDER {
            1 => rate.map(|x| x << 4),
            _ => axes.map(|i| (rate[i] + self.last[i]) << 3),
        };
        let e1 = axes.map(|i| rate[i] - self.last[i]);
        let mut second = [0; 3];
        if ORDER >= 3 && curved {
            let mut end = e1;
            if self.steps >= 1 {
                // g ≤ 3, so |S| ≤ 3·1.5·2^24 and |D| ≤ 10 times that.
                let weights = Weights::of(step, self.ages);
                let [g, g2] = weights.stretch;
                second = axes.map(|i| {
                    let before = narrow(wide(g, self.difference[i]));
                    narrow(wide(e1[i] - before, weights.half))
                });
                let mut third = [0; 3];
                if ORDER >= 4 && self.steps >= 2 {
                    third = axes.map(|i| second[i] - narrow(wide(g2, self.second[i])));
                }
                // A twelfth of 16 makes twelve fraction bits of eight.
                mean = axes.map(|i| {
                    let curve = wide(second[i], EIGHT_THIRDS) + wide(third[i], weights.far);
                    mean[i] - narrow(curve)
                });
                end = axes.map(|i| e1[i] + narrow(wide(third[i], weights.near)));
            }
            // No motion within the range is cut by this.
            let straight = mean.map(|x| x.clamp(-MOST_MEAN, MOST_MEAN));
            let end = end.map(|x| x.clamp(-MOST_CHANGE, MOST_CHANGE));
            let turn = i64::from(factor.coning());
            mean = axes.map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                // LSB² with 20 fraction bits, at most 2^55.
                let cross = wide(straight[j], end[k]) - wide(straight[k], end[j]);
                let cross = i64::from((cross >> 25) as i32);
                straight[i] + ((cross * turn + (1 << 31)) >> 32) as i32
            });
        }
        *self = Self {
            steps: if curved { (self.steps + 1).min(2) } else { 0 },
            last: rate,
            difference: e1,
            second,
            ages: [step, self.ages[0]],
        };
        mean.map(|x| factor.half_angle(x))
    }
}

/// The largest mean rate, 2^17 LSB with 12 fraction bits.
const MOST_MEAN: i32 = 1 << 29;
/// The largest change of the rate in a step, 2^17 LSB with 8 fraction bits.
const MOST_CHANGE: i32 = 1 << 25;
