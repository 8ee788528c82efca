//! Samples in, attitude out.

use core::mem;

use super::integrator::{Integrator, LONGEST_STEP};
use super::quaternion::Quaternion;
use super::sample::Sample;
use super::scale::Scale;
use super::tilt::{Tilt, is_end};
use crate::calibration::RestBias;

/// What became of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It is the first: the attitude begins here.
    First,
    /// The attitude has gone on to it.
    Step,
    /// It is not later than the one before, and was ignored.
    Stale,
    /// It came more than [`LONGEST_STEP`] after the one before: the attitude was held, and goes on from here.
    Gap,
}

/// What happened to the attitude so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Samples that moved it.
    pub steps: u64,
    /// Samples that were ignored because of their time.
    pub stale: u64,
    /// Times that it was held because no sample came.
    pub gaps: u64,
    /// Samples at an end of the gyroscope's range: the body turned faster than it can say.
    pub saturated: u64,
    /// Samples whose accelerometer was left out.
    pub rejected: u64,
}

/// The largest bias, in 1/256 LSB: counts have 24 bits, so the difference has 32.
const LARGEST_BIAS: i32 = 1 << 30;

/// The attitude of a body.
#[derive(Clone, Copy, Debug)]
pub struct Tracker {
    integrator: Integrator,
    tilt: Option<Tilt>,
    /// Half an angle that the last reading asks for, 48 fraction bits; the next step makes it.
    correction: [i64; 3],
    bias: [i32; 3],
    resting: Option<RestBias>,
    /// When the last sample was taken; nothing before the first.
    last: Option<u32>,
    counts: Counts,
}

impl Tracker {
    /// Waits for its first sample. Without `tilt` the accelerometer is left out.
    pub fn new(scale: Scale, tilt: Option<Tilt>) -> Self {
        Self {
            integrator: Integrator::new(scale, Quaternion::IDENTITY, [0; 3]),
            tilt,
            correction: [0; 3],
            bias: [0; 3],
            resting: None,
            last: None,
            counts: Counts::default(),
        }
    }

    /// Sets what the gyroscope reads at rest, in 1/256 LSB; it stays so. Beyond ±2^30 it counts as that, which leaves no rate anyway.
    pub fn set_bias(&mut self, bias: [i32; 3]) {
        self.bias = bias.map(|bias| bias.clamp(-LARGEST_BIAS, LARGEST_BIAS));
        self.resting = None;
    }

    /// Follows what the gyroscope reads at rest from now on.
    pub fn follow_bias(&mut self, resting: RestBias) {
        self.set_bias(resting.bias());
        self.resting = Some(resting);
    }

    /// What the gyroscope is taken to read at rest, in 1/256 LSB.
    pub const fn bias(&self) -> [i32; 3] {
        self.bias
    }

    /// The attitude at the last sample; the identity before the first.
    pub const fn attitude(&self) -> Quaternion {
        self.integrator.attitude()
    }

    /// What happened so far.
    pub const fn counts(&self) -> Counts {
        self.counts
    }

    /// Whether the tilt is as well known as it ever is; without an accelerometer it never is.
    pub fn is_settled(&self) -> bool {
        self.tilt.is_some_and(|tilt| tilt.is_settled())
    }

    /// Takes a sample.
    // What is done for every sample is kept together, and small: on the soft core most of the time goes into what its instruction cache does
    // not hold. What is rare is elsewhere.
    #[inline(never)]
    pub fn on_sample(&mut self, sample: &Sample) -> Outcome {
        let rate = [0, 1, 2].map(|i| (i32::from(sample.gyro[i]) << 8) - self.bias[i]);
        let Some(last) = self.last else {
            return self.begin(sample, rate);
        };
        let step = sample.t_us.wrapping_sub(last);
        if step == 0 || step > LONGEST_STEP {
            return self.hold(sample.t_us, step, rate);
        }
        self.last = Some(sample.t_us);
        let mut half = self.integrator.half_angle::<4>(rate, step);
        for (half, correction) in core::iter::zip(&mut half, &mut self.correction) {
            *half += mem::take(correction);
        }
        self.integrator.turn(&half);
        // A reading is compared with the attitude that it was made in: of the one before a fast turn would make a tilt.
        if let Some(tilt) = &mut self.tilt
            && !tilt.correct(
                self.integrator.rounded(),
                sample.accel,
                step,
                &mut self.correction,
            )
        {
            self.counts.rejected += 1;
        }
        self.counts.steps += 1;
        if let Some(resting) = &mut self.resting {
            resting.on_sample(sample, step);
            // A mean of counts and of what it began with.
            self.bias = resting.bias();
        }
        if sample.gyro.into_iter().any(|count| is_end(count.into())) {
            self.counts.saturated += 1;
            self.doubt(rate);
        }
        Outcome::Step
    }

    /// The first sample.
    #[cold]
    #[inline(never)]
    fn begin(&mut self, sample: &Sample, rate: [i32; 3]) -> Outcome {
        self.last = Some(sample.t_us);
        self.integrator.restart(rate);
        if self.tilt.is_some() {
            self.integrator.set_attitude(Tilt::align(sample.accel));
        }
        Outcome::First
    }

    /// A sample that makes no step: it is not later than the one before, or much.
    #[cold]
    #[inline(never)]
    fn hold(&mut self, t_us: u32, step: u32, rate: [i32; 3]) -> Outcome {
        // More than half of the range of stamps is a time before the last one.
        if step == 0 || step > u32::MAX / 2 {
            self.counts.stale += 1;
            return Outcome::Stale;
        }
        self.last = Some(t_us);
        self.counts.gaps += 1;
        self.doubt(rate);
        Outcome::Gap
    }

    /// After something has happened that no sample tells: the last rate says nothing of those before, and the tilt may have changed.
    #[cold]
    #[inline(never)]
    fn doubt(&mut self, rate: [i32; 3]) {
        self.integrator.restart(rate);
        if let Some(tilt) = &mut self.tilt {
            tilt.doubt();
        }
    }
}
