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
pub const MOST_STRETCH: u32 = 4;

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

/// a/b with 15 fraction bits, to nearest. The products stay in 32 bits: a < 2^17.
fn ratio(a: u32, b: u32) -> i64 {
    (((a << 15) + b / 2) / b).into()
}

/// x·2^−`bits`, to nearest.
const fn round(x: i64, bits: u32) -> i64 {
    (x + (1 << (bits - 1))) >> bits
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
    /// `rate` is within ±2^24. `ORDER` is that of the method: 1 takes the newest sample alone, 2 the mean of two, 3 the parabola
    /// through three with e₁ for E, 4 (and more) the cubic. The first steps have less to look back on and leave an error in
    /// h³ once.
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
        let [h1, h2] = self.ages;
        let axes = [0, 1, 2];
        // Within 2^25: the bias is in both.
        let e1 = axes.map(|i| i64::from(rate[i] - self.last[i]));
        let mut s = [0; 3];
        let mut d = [0; 3];
        let (mut far, mut near) = (0, 0);
        if ORDER >= 3 && self.steps >= 1 {
            let g = ratio(step, h1);
            let p = ratio(step, step + h1);
            // g ≤ 4, so |S| ≤ 4·2^25 and |D| ≤ 17 times that.
            s = axes.map(|i| {
                round(
                    (e1[i] - round(g * i64::from(self.difference[i]), 15)) * p,
                    15,
                )
            });
            if ORDER >= 4 && self.steps >= 2 {
                let g2 = round(g * g, 15);
                d = axes.map(|i| s[i] - round(g2 * i64::from(self.second[i]), 15));
                near = ratio(step, step + h1 + h2);
                far = ratio(step + 2 * h1, step + h1 + h2);
            }
        }
        let mean = axes.map(|i| {
            if ORDER == 1 {
                return rate[i] << 4;
            }
            // Thirds of 16 for a twelfth in 12 fraction bits.
            const FOUR_THIRDS: i64 = (4 << 30) / 3;
            let curve = round((2 * s[i] + round(d[i] * far, 15)) * FOUR_THIRDS, 30);
            let straight = (i64::from(rate[i]) + i64::from(self.last[i])) << 3;
            (straight - curve).clamp(-MOST_MEAN, MOST_MEAN) as i32
        });
        let mut half = mean.map(|x| scale.half_angle(x, step));
        if ORDER >= 3 && curved {
            let end = axes.map(|i| {
                const NINE_FIFTHS: i64 = (9 << 30) / 5;
                let third = round(d[i] * near, 15);
                (e1[i] + round(third * NINE_FIFTHS, 30)).clamp(-MOST_CHANGE, MOST_CHANGE)
            });
            let coning = axes.map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                i64::from(mean[j]) * end[k] - i64::from(mean[k]) * end[j]
            });
            let extra = coning.map(|x| scale.coning(x, step));
            half = axes.map(|i| half[i] + scale.half_angle(extra[i], step));
        }
        *self = Self {
            steps: if curved { (self.steps + 1).min(2) } else { 0 },
            last: rate,
            difference: e1.map(|x| x as i32),
            second: s.map(|x| x as i32),
            ages: [step, h1],
        };
        half
    }
}

/// The largest mean rate, 2^17 LSB with 12 fraction bits; saturates there, which no motion within the range reaches.
const MOST_MEAN: i64 = 1 << 29;
/// The largest change of the rate in a step, 2^17 LSB with 8 fraction bits; saturates.
const MOST_CHANGE: i64 = 1 << 25;
