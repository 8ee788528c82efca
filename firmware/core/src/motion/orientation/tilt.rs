//! Tilt correction by the accelerometer.
//!
//! An accelerometer reads gravity plus acceleration. In the axes of the world gravity is constant, and the acceleration of a body
//! that returns to its place has mean 0, so a low-pass filter in these axes removes the acceleration. For each reading the
//! attitude turns by
//!
//! ```text
//! (1 − exp(−dt/τ))·(a × up)/g
//! ```
//!
//! where τ is the filter's time constant, dt the time since the previous reading, `a` the reading and `up` the upward direction,
//! both in the body's axes. Readings are not normalised, and are accepted despite small deviations of their length from 1 g.
//! Normalising or rejecting would weight accelerations unequally, and their mean would not be 0. Readings above 3 g, which do not
//! occur in a hand or during walking, and readings at the end of the sensor's range are rejected.

use super::gain::Gain;
use super::quaternion::{Angles, Quaternion};
use crate::cordic::to_polar;
use crate::fixed::{Turns, wide};

/// Default time constant τ of the filter, in µs.
pub const TIME_CONSTANT: u32 = 3_000_000;
/// Smallest and largest accepted LSB per g.
pub const LSB_PER_G: [u32; 2] = [1_024, 32_767];
/// Weight of an attitude from a single reading, as a time in µs: the attitude has the weight of the mean of readings over this time.
pub const FRESH: u32 = 20_000;
/// Largest weight of an attitude after saturation of the gyroscope or after a gap, as a time in µs: the attitude has the
/// weight of the mean of readings over this time. A short saturation changes the attitude little, and the accelerometer corrects
/// the error within ten times this time.
pub const DOUBTFUL: u32 = 100_000;
/// Largest accepted reading, in g.
const MOST: u32 = 3;
/// Smallest reading that shows the direction of gravity, as a part of a g: 1/2. The constant is the divisor.
const LEAST: u64 = 2;

/// Use of a reading as the direction of gravity at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FirstReading {
    /// The reading is near the direction of gravity.
    Gravity,
    /// The reading is too small to have a direction.
    FreeFall,
    /// The reading exceeds the largest accepted reading.
    Rejected,
}

/// Corrects the tilt of an attitude by the readings of an accelerometer.
#[derive(Clone, Copy, Debug)]
pub struct Tilt {
    /// 2^32 divided by the accelerometer's LSB per g.
    inverse: u32,
    /// Square of the largest accepted reading, in LSB².
    largest: u32,
    time_constant: u32,
    /// Total time of the readings so far in µs, limited to `time_constant`. The filter uses this time as its current time
    /// constant, so that the first readings form a running mean.
    age: u32,
    gain: Gain,
}

impl Tilt {
    /// Prepares the correction for an accelerometer with `lsb_per_g`, which is limited to the range [`LSB_PER_G`],
    /// and a time constant in µs.
    pub fn new(lsb_per_g: u32, time_constant: u32) -> Self {
        let one = lsb_per_g.clamp(LSB_PER_G[0], LSB_PER_G[1]);
        Self {
            inverse: (((1 << 32) + u64::from(one / 2)) / u64::from(one)) as u32,
            largest: (MOST * one).min(u16::MAX.into()).pow(2),
            time_constant,
            age: FRESH,
            gain: Gain::new(FRESH.min(time_constant)),
        }
    }

    /// Whether the total time of the readings has reached the time constant.
    pub fn is_settled(&self) -> bool {
        self.age >= self.time_constant
    }

    /// Marks the attitude as uncertain, which gives the next readings more weight.
    #[cold]
    #[inline(never)]
    pub fn doubt(&mut self) {
        self.set_age(self.age.min(DOUBTFUL));
    }

    /// The age of the attitude in µs: the total time of the readings so far, reduced by
    /// [`doubt`](Self::doubt).
    pub(super) const fn age(&self) -> u32 {
        self.age
    }

    /// Sets the age of the attitude in µs.
    pub(super) fn set_age(&mut self, age: u32) {
        self.age = age;
        self.gain = Gain::new(age.min(self.time_constant));
    }

    /// Whether a reading with the squared length `square` is within the largest accepted acceleration and the sensor's range.
    #[inline(always)]
    fn accepts(&self, a: [i32; 3], square: u32) -> bool {
        square <= self.largest && !a.into_iter().any(is_end)
    }

    /// Judges the use of a reading as the direction of gravity at the start.
    #[cold]
    #[inline(never)]
    pub(super) fn judge(&self, reading: [i16; 3]) -> FirstReading {
        let a = reading.map(i32::from);
        let square = square(a);
        let least = ((1 << 32) / u64::from(self.inverse) / LEAST) as u32;
        if !self.accepts(a, square) {
            FirstReading::Rejected
        } else if square < least.pow(2) {
            FirstReading::FreeFall
        } else {
            FirstReading::Gravity
        }
    }

    /// Corrects the attitude by the reading at the end of a step of `step` µs (at most 2^19): adds the correction to `half`, a
    /// half angle vector in the body's axes with 48 fraction bits. Each component changes by at most 3 rad. Returns whether the
    /// reading was accepted.
    #[inline]
    pub fn correct(
        &mut self,
        attitude: &Quaternion,
        reading: [i16; 3],
        step: u32,
        half: &mut [i64; 3],
    ) -> bool {
        let a = reading.map(i32::from);
        let square = square(a);
        if !self.accepts(a, square) {
            return false;
        }
        if self.gain.time_constant() < self.time_constant {
            self.grow(step);
        }
        // `factor` converts the error, in units of 2^−14 LSB, to a half angle with 57 fraction bits. The factor is half the
        // gain, divided by g. `self.inverse` is at most 2^22.
        let factor = ((u64::from(self.gain.of(step)) * u64::from(self.inverse)) >> 22) as u32;
        let up = attitude.up();
        // This shift lets the error below use only the upper 32 bits of the products.
        let a = a.map(|x| x << 16);
        // The components of a × up, in LSB with 14 fraction bits, rounded down; they are at most 2^30.
        let error = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            ((wide(a[j], up[k]) - wide(a[k], up[j])) >> 32) as i32
        });
        // The sum is at most √3·2^61.
        let upright = wide(a[0], up[0]) + wide(a[1], up[1]) + wide(a[2], up[2]);
        let error = if upright < 0 {
            lengthened(error, up, square)
        } else {
            error
        };
        for (half, error) in core::iter::zip(half, error) {
            *half += (i64::from(error) * i64::from(factor)) >> 9;
        }
        true
    }

    /// Lengthens the filter's current time constant by `step` µs, to at most `time_constant`.
    #[inline(never)]
    fn grow(&mut self, step: u32) {
        self.age = self.age.saturating_add(step).min(self.time_constant);
        self.gain = Gain::new(self.age);
    }

    /// Computes the attitude with yaw 0 in which the reading points upwards. A reading of 0 gives the identity.
    #[cold]
    #[inline(never)]
    pub fn align(reading: [i16; 3]) -> Quaternion {
        upright(reading.map(|x| i64::from(x) << 40))
    }

    /// Computes the attitude of a body that has turned by `turned` since its yaw was 0, and in which the reading now points upwards.
    pub(super) fn align_after(turned: Quaternion, reading: [i16; 3]) -> Quaternion {
        if turned == Quaternion::IDENTITY {
            return Self::align(reading);
        }
        // The reading in the axes of the first sample is the sum of the turned axes, weighted by the reading's components; its
        // components are below 2^46.
        let mut first = [0; 3];
        for (axis, x) in turned.axes().iter().zip(reading) {
            for (sum, &part) in first.iter_mut().zip(axis) {
                *sum += wide(part, x.into());
            }
        }
        upright(first.map(|x| x << 10)).times(turned)
    }
}

/// The attitude with yaw 0 in which a vector in the body's axes points upwards. The zero vector gives the identity.
#[cold]
#[inline(never)]
fn upright([x, y, z]: [i64; 3]) -> Quaternion {
    let (level, roll) = to_polar(z, y);
    let (_, pitch) = to_polar(level, -x);
    // If the x axis points straight up or down, the roll is undefined; `to_polar` then gives 0.
    Quaternion::from_angles(Angles {
        yaw: Turns(0),
        pitch,
        roll,
    })
}

/// Lengthens `error`, which is a × up, for an attitude with a tilt error of more than a right angle. At such angles |a × up|
/// decreases as the error grows, and it is 0 for an attitude upside down, which would never be corrected. The length is set to
/// 2·|a|, roughly |a| times the angle in radians. A vector near 0 is replaced by a vector perpendicular to `up`. `square` is
/// |a|², at most (2^16 − 1)².
#[cold]
#[inline(never)]
fn lengthened(error: [i32; 3], up: [i32; 3], square: u32) -> [i32; 3] {
    // 2·|a| in units of 2^−14 LSB; below 2^31.
    let length = i64::from(square.isqrt()) << 15;
    let error = error.map(i64::from);
    // The sum of squares is at most 2^62.
    let now = error.iter().map(|x| x * x).sum::<i64>().isqrt();
    if now > 1 << 14 {
        // The product x·length is at most 2^30·2^31. As |x| is at most `now`, the quotient is at most `length`, apart from the
        // rounding of the root.
        let most = i64::from(i32::MAX);
        return error.map(|x| (x * length / now).clamp(-most, most) as i32);
    }
    let smallest = (0..3).min_by_key(|&i| up[i].abs()).unwrap_or(0);
    let mut across = [0; 3];
    across[smallest] = length as i32;
    across
}

/// Returns whether a count is the smallest or the largest 16-bit number.
pub(super) const fn is_end(count: i32) -> bool {
    count ^ (count >> 31) == i16::MAX as i32
}

/// The squared length |v|² of a vector of counts, at most 3·2^30.
fn square(v: [i32; 3]) -> u32 {
    v.iter().map(|&x| (x * x) as u32).sum()
}
