//! Tracking of a gyroscope's bias while the sensor is at rest.

use super::gain::Gain;
use super::sample::Sample;
use super::units::Units;

/// Time constant, in µs, of the running means of rates and forces; rest is detected by the differences from these means.
const NOTICE: u32 = 500_000;
/// Time in µs that the sensor must be at rest before the bias is tracked.
const REST: u32 = 1_500_000;
/// Time constant, in µs, with which the bias approaches the rates at rest.
const LEARN: u32 = 100_000_000;
/// At rest, the difference between a rate and its running mean is below this limit, in °/s.
const MOST_RATE: u32 = 1;
/// At rest, the difference between the mean rate and the bias is below this limit, in °/s. The limit allows for the change of the
/// bias with temperature since the last rest.
const MOST_BIAS: u32 = 2;
/// At rest, the difference between a force and its running mean is below this limit, in 1/16 g.
const MOST_FORCE: u32 = 1;

/// Tracks the bias of a gyroscope at rest. Bias and means are in LSB with 32 fraction bits, so that even the smallest gain, 10^−5
/// at 1 kHz, resolves a difference of 2^−15 LSB.
#[derive(Clone, Copy, Debug)]
pub struct RestBias {
    /// The limits of `MOST_RATE`, `MOST_FORCE` and `MOST_BIAS`, in this order, converted to LSB.
    most: [u32; 3],
    bias: [i64; 3],
    mean: [i64; 3],
    force: [i64; 3],
    /// Time in µs since the sensor came to rest, 0 in motion; `None` before the first sample.
    rested: Option<u32>,
    notice: Gain,
    learn: Gain,
}

impl RestBias {
    /// Starts with the given bias of each axis, in 1/256 LSB.
    pub fn new(units: Units, bias: [i32; 3]) -> Self {
        Self {
            most: [
                units.rate(MOST_RATE),
                (units.per_g * MOST_FORCE).div_ceil(16),
                units.rate(MOST_BIAS),
            ],
            bias: bias.map(|x| i64::from(x) << 24),
            mean: [0; 3],
            force: [0; 3],
            rested: None,
            notice: Gain::new(NOTICE),
            learn: Gain::new(LEARN),
        }
    }

    /// The bias of each axis in 1/256 LSB, rounded to nearest.
    #[inline(never)]
    pub fn bias(&self) -> [i32; 3] {
        self.bias.map(|x| ((x + (1 << 23)) >> 24) as i32)
    }

    /// Whether the sensor has rested long enough to track the bias.
    pub fn is_at_rest(&self) -> bool {
        self.rested.is_some_and(|time| time >= REST)
    }

    /// Takes a sample that was measured `step` µs (at most 2^19) after the previous sample.
    #[inline(never)]
    pub fn on_sample(&mut self, sample: &Sample, step: u32) {
        let Some(rested) = self.rested else {
            self.mean = sample.gyro.map(fraction);
            self.force = sample.accel.map(fraction);
            self.rested = Some(0);
            return;
        };
        let [most_rate, most_force, most_bias] = self.most;
        let still = [0, 1, 2].into_iter().all(|i| {
            near(fraction(sample.gyro[i]), self.mean[i], most_rate)
                && near(fraction(sample.accel[i]), self.force[i], most_force)
                && near(self.mean[i], self.bias[i], most_bias)
        });
        let rested = if still {
            rested.saturating_add(step)
        } else {
            0
        };
        self.rested = Some(rested);
        let notice = self.notice.of(step);
        let learn = (rested >= REST).then(|| self.learn.of(step));
        for i in 0..3 {
            approach(&mut self.mean[i], sample.gyro[i], notice);
            approach(&mut self.force[i], sample.accel[i], notice);
            if let Some(learn) = learn {
                approach(&mut self.bias[i], sample.gyro[i], learn);
            }
        }
    }
}

/// Converts a count in LSB to a fixed-point number with 32 fraction bits.
fn fraction(count: i16) -> i64 {
    i64::from(count) << 32
}

/// Whether two numbers with 32 fraction bits differ by less than `most` LSB.
#[inline(never)]
fn near(a: i64, b: i64, most: u32) -> bool {
    (a - b).unsigned_abs() >> 32 < u64::from(most)
}

/// Moves `mean` towards `count` by the part `gain` (32 fraction bits) of their difference, rounded to nearest. The mean has 32
/// fraction bits and is below 2^48 units of 2^−32 in magnitude, so no product overflows.
#[inline(never)]
fn approach(mean: &mut i64, count: i16, gain: u32) {
    let difference = fraction(count) - *mean;
    let (high, low) = ((difference >> 32) as i32, difference as u32);
    let whole = i64::from(high) * i64::from(gain);
    *mean += whole + ((u64::from(low) * u64::from(gain >> 1) + (1 << 30)) >> 31) as i64;
}
