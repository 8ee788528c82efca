//! The filters between the hand and the camera: a low pass whose corner frequency rises with the speed of its input, and a dead zone.

use crate::fixed::{Q4_28, U16_16};

/// 2π·2^32/10^6, rounded to nearest: the angle in radians by which an oscillation of 1 Hz advances in 1 µs, with 32 fraction bits.
const RADIANS: u32 = 26_986;
/// Minimum and maximum step, in µs.
const STEPS: [u32; 2] = [1_000, 100_000];

/// The time between two camera frames, converted to the units that the filters need.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeStep {
    /// 2π·step: the angle in radians by which an oscillation of 1 Hz advances in one step, with 32 fraction bits.
    radians: u32,
    /// Reciprocal of the step: steps per second, with 12 fraction bits, rounded down.
    rate: u32,
}

impl TimeStep {
    /// Makes a step of `micros` µs, which is clamped to 1 to 100 ms.
    pub fn new(micros: u32) -> Self {
        let micros = micros.clamp(STEPS[0], STEPS[1]);
        Self {
            // 26,986 · 100,000 is below 2^32.
            radians: micros * RADIANS,
            rate: (1_000_000 << 12) / micros,
        }
    }
}

/// Returns the gain of a low pass of first order with the corner frequency `cutoff`, for one step: k/(1 + k) with k = 2π·cutoff·step,
/// with 16 fraction bits, rounded up. Unlike the explicit gain k, this gain is below 1 for every step, so the filter is monotone.
#[inline(never)]
pub fn low_pass_gain(cutoff: U16_16, step: TimeStep) -> u32 {
    // The step is at most 0.63 rad per Hz, so k is below 2^16 with 16 fraction bits.
    let k = ((u64::from(cutoff.to_bits()) * u64::from(step.radians)) >> 32) as u32;
    // 1/(1 + k) with 16 fraction bits, rounded down. The sum saturates at a gain of 1 − 2^−16.
    (1 << 16) - u32::MAX / k.saturating_add(1 << 16)
}

/// Parameters of a [`OneEuro`] filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tuning {
    /// Corner frequency at rest, in Hz.
    pub cutoff: U16_16,
    /// Growth of the corner frequency with the speed, in Hz per input unit per second.
    pub slope: U16_16,
    /// Corner frequency of the low pass for the speed, in Hz.
    pub speed_cutoff: U16_16,
}

/// A low pass of first order whose corner frequency grows with the speed of its input: the 1€ filter (Casiez, Roussel and Vogel,
/// CHI 2012). At rest the filter is slow and rejects noise; in motion it is fast.
///
/// At the constant speed v the output lags by 1/(2π·(cutoff + slope·v)).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OneEuro {
    input: Q4_28,
    output: Q4_28,
    /// Filtered speed in input units per second, with 24 fraction bits.
    speed: i32,
}

impl OneEuro {
    /// Makes a filter at rest at `input`.
    pub const fn new(input: Q4_28) -> Self {
        Self {
            input,
            output: input,
            speed: 0,
        }
    }

    /// Takes the next input, and returns the output. The speed saturates at 128 units per second.
    pub fn next(&mut self, input: Q4_28, tuning: &Tuning, step: TimeStep) -> Q4_28 {
        let gain = low_pass_gain(tuning.speed_cutoff, step);
        self.next_with(input, tuning, step, gain)
    }

    /// Takes the next input as [`Self::next`] does, with the given gain of the low pass for the speed.
    pub(super) fn next_with(
        &mut self,
        input: Q4_28,
        tuning: &Tuning,
        step: TimeStep,
        gain: u32,
    ) -> Q4_28 {
        let moved = input.saturating_sub(self.input).to_bits();
        self.input = input;
        // The product has 28 + 12 fraction bits, the speed 24.
        let speed = (i64::from(moved) * i64::from(step.rate)) >> 16;
        let speed = speed.clamp(i32::MIN.into(), i32::MAX.into()) as i32;
        self.speed = towards(self.speed, speed, gain);
        let opened =
            (u64::from(self.speed.unsigned_abs()) * u64::from(tuning.slope.to_bits())) >> 24;
        let cutoff = u64::from(tuning.cutoff.to_bits()) + opened;
        let cutoff = U16_16::from_bits(cutoff.min(u32::MAX.into()) as u32);
        let gain = low_pass_gain(cutoff, step);
        self.output = Q4_28::from_bits(towards(self.output.to_bits(), input.to_bits(), gain));
        self.output
    }
}

/// Moves `from` towards `to` by the part `gain` (16 fraction bits, at most 1) of the distance, rounded to nearest. The distance
/// saturates at 2^31.
pub fn towards(from: i32, to: i32, gain: u32) -> i32 {
    let way = i64::from(to.saturating_sub(from)) * i64::from(gain);
    // The gain is at most 1, so the sum lies between the two numbers.
    from.wrapping_add(((way + (1 << 15)) >> 16) as i32)
}

/// A moving dead zone: the output stays constant while the input is within the zone about it; otherwise the zone's edge follows
/// the input. Therefore the output has no jumps, and differs from the input by at most the zone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Backlash(Q4_28);

impl Backlash {
    /// Makes a dead zone about `output`.
    pub const fn new(output: Q4_28) -> Self {
        Self(output)
    }

    /// Takes the next input, and returns the output. `zone` is the largest difference between input and output.
    pub fn next(&mut self, input: Q4_28, zone: Q4_28) -> Q4_28 {
        let least = input.saturating_sub(zone);
        let greatest = input.saturating_add(zone);
        self.0 = self.0.max(least).min(greatest);
        self.0
    }
}
