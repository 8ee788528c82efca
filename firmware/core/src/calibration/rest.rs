//! The bias as it wanders, learnt at rest.

use super::Units;
use crate::orientation::{Gain, Sample};

/// The time constant of the means that say whether it rests, in µs.
const NOTICE: u32 = 500_000;
/// How long it must have rested before anything is learnt, in µs.
const REST: u32 = 1_500_000;
/// The time constant of learning, in µs.
const LEARN: u32 = 100_000_000;
/// The most a rate may differ from its mean at rest, in °/s.
const MOST_RATE: u32 = 1;
/// The most the mean may differ from the bias at rest, in °/s: what temperature does to it between two rests.
const MOST_BIAS: u32 = 2;
/// The most a force may differ from its mean at rest, in 1/16 g.
const MOST_FORCE: u32 = 1;

/// Follows the bias of a gyroscope while it rests. Numbers have 32 fraction bits of a LSB, so the smallest gain, 10^−5 at 1 kHz, still
/// sees a difference of 2^−15 LSB.
#[derive(Clone, Copy, Debug)]
pub struct RestBias {
    units: Units,
    bias: [i64; 3],
    mean: [i64; 3],
    force: [i64; 3],
    /// For how long it has rested, in µs; nothing before the first sample.
    rested: Option<u32>,
    notice: Gain,
    learn: Gain,
}

impl RestBias {
    /// Begins with a bias in 1/256 LSB.
    pub fn new(units: Units, bias: [i32; 3]) -> Self {
        Self {
            units,
            bias: bias.map(|x| i64::from(x) << 24),
            mean: [0; 3],
            force: [0; 3],
            rested: None,
            notice: Gain::new(NOTICE),
            learn: Gain::new(LEARN),
        }
    }

    /// The bias in 1/256 LSB, to nearest.
    pub fn bias(&self) -> [i32; 3] {
        self.bias.map(|x| ((x + (1 << 23)) >> 24) as i32)
    }

    /// Whether it has rested long enough to learn from.
    pub fn is_at_rest(&self) -> bool {
        self.rested.is_some_and(|time| time >= REST)
    }

    /// Takes a sample that was measured `step` µs (at most 2^19) after the last one.
    pub fn on_sample(&mut self, sample: &Sample, step: u32) {
        let rate = sample.gyro.map(|x| i64::from(x) << 32);
        let force = sample.accel.map(|x| i64::from(x) << 32);
        let Some(rested) = self.rested else {
            (self.mean, self.force, self.rested) = (rate, force, Some(0));
            return;
        };
        let near = |a: [i64; 3], b: [i64; 3], most: u32| {
            core::iter::zip(a, b).all(|(a, b)| (a - b).unsigned_abs() >> 32 < u64::from(most))
        };
        let still = near(rate, self.mean, self.units.rate(MOST_RATE))
            && near(
                force,
                self.force,
                (self.units.per_g * MOST_FORCE).div_ceil(16),
            )
            && near(self.mean, self.bias, self.units.rate(MOST_BIAS));
        self.rested = Some(if still {
            rested.saturating_add(step)
        } else {
            0
        });
        let gain = self.notice.of(step);
        approach(&mut self.mean, rate, gain);
        approach(&mut self.force, force, gain);
        if self.is_at_rest() {
            approach(&mut self.bias, rate, self.learn.of(step));
        }
    }
}

/// Moves a mean towards a value, both with 32 fraction bits of a LSB: at most 2^48, so the product of 31 bits of the gain fits. To nearest.
fn approach(mean: &mut [i64; 3], value: [i64; 3], gain: u32) {
    for (mean, value) in core::iter::zip(mean, value) {
        let difference = value - *mean;
        let (high, low) = (difference >> 32, difference & i64::from(u32::MAX));
        let gain = i64::from(gain);
        *mean += high * gain + ((low * (gain >> 1) + (1 << 30)) >> 31);
    }
}
