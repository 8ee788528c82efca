//! Which way is up, by the accelerometer.
//!
//! What an accelerometer reads is gravity and whatever moves it. In the axes of the world, where gravity stands still, the acceleration of
//! something that comes back to where it was is 0 in the mean, so a low pass there is what rejects it: the attitude turns by
//!
//! ```text
//! (1 − exp(−dt/τ))·(a × up)/g
//! ```
//!
//! with `a` and `up` in the body's axes, and carries along what it has turned so far. The reading is not made of length 1, and not
//! left out where its length is a little wrong: either would weigh accelerations unequally and so bend their mean. Left out is what
//! no motion of a hand or a walk makes: a reading beyond 3 g, or at the end of the sensor's range.

use super::gain::Gain;
use super::quaternion::{Angles, Quaternion};
use crate::fixed::Turns;
use crate::polar::polar;

/// τ unless told otherwise, in µs.
pub const TIME_CONSTANT: u32 = 3_000_000;
/// The LSB per g that are accepted.
pub const LSB_PER_G: [u32; 2] = [1_024, 32_767];
/// How old an attitude counts as that one reading has made, in µs.
pub const FRESH: u32 = 20_000;
/// How old an attitude counts as after the gyroscope was at its end, or said nothing for long, in µs: what it is off by gives way to the
/// accelerometer in the time that it takes to get ten times as old, and a short stop at the end of the range does not throw it over.
pub const DOUBTFUL: u32 = 100_000;
/// The most that is gravity and motion, in g.
const MOST: u32 = 3;

/// Corrects the tilt.
#[derive(Clone, Copy, Debug)]
pub struct Tilt {
    /// 2^32 LSB over those of 1 g.
    inverse: u32,
    /// The square of the largest reading that counts, in LSB².
    largest: u32,
    time_constant: u32,
    /// For how long readings have been taken, in µs; a running mean until that is the time constant.
    age: u32,
    gain: Gain,
}

impl Tilt {
    /// For an accelerometer with so many LSB per g, which count as within [`LSB_PER_G`], and a time constant in µs.
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

    /// Whether the accelerometer has been listened to for as long as the time constant.
    pub fn is_settled(&self) -> bool {
        self.age >= self.time_constant
    }

    /// Says that the attitude may be off by anything: the next readings count for more.
    pub fn doubt(&mut self) {
        self.age = self.age.min(DOUBTFUL);
        self.gain = Gain::new(self.age.min(self.time_constant));
    }

    /// Whether a reading is gravity and motion.
    fn is_plausible(&self, reading: [i16; 3]) -> bool {
        let saturated = reading.iter().any(|&x| is_saturated(x));
        !saturated && square(reading) <= self.largest
    }

    /// The correction of a step in µs (at most 2^19) by what was read at its end: half an angle about each of the body's axes, in radians with 48 fraction bits,
    /// at most 3. `None` where the reading is left out.
    pub fn correct(
        &mut self,
        attitude: Quaternion,
        reading: [i16; 3],
        step: u32,
    ) -> Option<[i64; 3]> {
        if !self.is_plausible(reading) {
            return None;
        }
        let up = attitude.up();
        let a = reading.map(i64::from);
        // LSB with 14 fraction bits, rounded down: at most 2^30.
        let mut error = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            (a[j] * up[k] - a[k] * up[j]) >> 16
        });
        let upright: i64 = core::iter::zip(a, up).map(|(a, up)| a * up).sum();
        if upright < 0 {
            error = lengthened(error, up, i64::from(square(reading).isqrt()) << 15);
        }
        if self.gain.time_constant() < self.time_constant {
            self.age = self.age.saturating_add(step).min(self.time_constant);
            self.gain = Gain::new(self.age);
        }
        let gain = u64::from(self.gain.of(step));
        // Half the gain over g, for 2^−14 LSB, with 57 fraction bits: at most 2^32.
        let factor = ((gain * u64::from(self.inverse)) >> 22) as i64;
        Some(error.map(|x| (x * factor) >> 9))
    }

    /// The attitude with yaw 0 in which a reading points upwards; without a direction the identity.
    pub fn align(reading: [i16; 3]) -> Quaternion {
        let [x, y, z] = reading.map(|x| i64::from(x) << 40);
        let (level, roll) = polar(z, y);
        let (_, pitch) = polar(level, -x);
        // Nose up or down there is no roll, and polar says 0.
        Quaternion::from_angles(Angles {
            yaw: Turns(0),
            pitch,
            roll,
        })
    }
}

/// |a × up| falls again where the error is more than a right angle. There it is made twice as long as `a`, about the angle of the
/// error in radians, so that upside down is no place to stay; where it has no direction, that of an axis across `up` will do.
fn lengthened(error: [i64; 3], up: [i64; 3], length: i64) -> [i64; 3] {
    // At most 2^62.
    let now = error.iter().map(|x| x * x).sum::<i64>().isqrt();
    if now > 1 << 14 {
        // At most 2^31 times 2^31.
        return error.map(|x| x * length / now);
    }
    let smallest = (0..3).min_by_key(|&i| up[i].abs()).unwrap_or(0);
    let mut across = [0; 3];
    across[smallest] = length;
    across
}

/// At an end of the range.
pub(super) const fn is_saturated(count: i16) -> bool {
    count == i16::MAX || count == i16::MIN
}

/// |v|², at most 3·2^30.
fn square(v: [i16; 3]) -> u32 {
    v.iter().map(|&x| u32::from(x.unsigned_abs()).pow(2)).sum()
}
