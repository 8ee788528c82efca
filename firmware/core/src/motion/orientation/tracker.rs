//! Computes a body's attitude from samples of its sensor.

use super::integrator::{Integrator, LONGEST_STEP};
use super::quaternion::Quaternion;
use super::rest::RestBias;
use super::sample::Sample;
use super::scale::Scale;
use super::tilt::{FirstReading, Tilt, is_end};

/// Effect of a sample on the attitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleEffect {
    /// First sample: the attitude starts.
    First,
    /// The attitude was integrated from the previous sample to this one.
    Step,
    /// Ignored, because the sample is not later than the previous sample.
    Stale,
    /// The sample follows a gap of more than [`LONGEST_STEP`], or the clock has restarted: the attitude stayed constant over the gap
    /// and continues from this sample.
    Gap,
}

/// Numbers of samples by their effect on the attitude.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Integrated samples.
    pub steps: u64,
    /// Number of samples whose times were ignored, because they are not later than their predecessor, or far ahead of all others.
    pub stale: u64,
    /// Number of gaps of more than `LONGEST_STEP` between samples, and of restarts of the clock, during which the attitude stayed
    /// constant.
    pub gaps: u64,
    /// Number of samples in which a rate of the gyroscope is at an end of its range.
    pub saturated: u64,
    /// Number of samples with a rejected accelerometer reading.
    pub rejected: u64,
}

/// The largest bias, in 1/256 LSB. Counts in this unit have 24 bits, so a count minus a bias fits 32 bits.
const LARGEST_BIAS: i32 = 1 << 30;

/// Number of successive stale samples, each later than the one before, after which the clock counts as restarted. A few samples out
/// of order do not count as a restart.
const RESTART: u8 = 4;

/// The samples since the last step whose times do not follow this step. These samples show whether single times
/// were wrong or the clock has restarted.
#[derive(Clone, Copy, Debug, Default)]
struct Detour {
    /// Time of the first sample after the latest gap.
    start: u64,
    /// Time of the tracker's last sample before the first gap, and the age of the tilt at that time.
    before: Option<(u64, u32)>,
    /// Number of gaps since the time `before`.
    gaps: u64,
    /// Time of the tracker's last sample before the stale samples.
    last: u64,
    /// Time of the latest stale sample, and number of successive stale samples in the order of their times.
    stale: u64,
    in_order: u8,
}

/// Whether a sample at the time `t_us` can be integrated from a sample at the time `last`.
fn follows(t_us: u64, last: u64) -> bool {
    (1..=u64::from(LONGEST_STEP)).contains(&t_us.wrapping_sub(last))
}

/// Computes the attitude of a body from samples.
#[derive(Clone, Copy, Debug)]
pub struct Tracker {
    integrator: Integrator,
    tilt: Option<Tilt>,
    bias: [i32; 3],
    resting: Option<RestBias>,
    /// Time of the last sample; `None` before the first, and while no reading of the accelerometer has shown the direction of gravity.
    last: Option<u64>,
    counts: Counts,
    /// Time of the last sample, while no reading of the accelerometer has shown the direction of gravity.
    unaligned: Option<u64>,
    detour: Detour,
}

impl Tracker {
    /// Makes a tracker, which starts at its first sample. Without `tilt` the accelerometer is ignored.
    pub fn new(scale: Scale, tilt: Option<Tilt>) -> Self {
        Self {
            integrator: Integrator::new(scale, Quaternion::IDENTITY, [0; 3]),
            tilt,
            bias: [0; 3],
            resting: None,
            last: None,
            counts: Counts::default(),
            unaligned: None,
            detour: Detour::default(),
        }
    }

    /// Sets a constant bias of the gyroscope, in 1/256 LSB. The bias saturates to ±2^30, which exceeds every rate.
    pub fn set_bias(&mut self, bias: [i32; 3]) {
        self.bias = bias.map(|bias| bias.clamp(-LARGEST_BIAS, LARGEST_BIAS));
        self.resting = None;
    }

    /// Makes the tracker correct the gyroscope's bias by `resting` while the sensor is at rest.
    pub fn follow_bias(&mut self, resting: RestBias) {
        self.set_bias(resting.bias());
        self.resting = Some(resting);
    }

    /// Current bias of the gyroscope in 1/256 LSB.
    pub const fn bias(&self) -> [i32; 3] {
        self.bias
    }

    /// The attitude at the last sample; the identity before the first.
    pub const fn attitude(&self) -> Quaternion {
        self.integrator.attitude()
    }

    /// Numbers of samples so far, by their effect on the attitude.
    pub const fn counts(&self) -> Counts {
        self.counts
    }

    /// Whether the tilt correction has settled; `false` without tilt correction.
    pub fn is_settled(&self) -> bool {
        self.tilt.is_some_and(|tilt| tilt.is_settled())
    }

    /// Takes a sample and updates the attitude; returns the sample's effect.
    // On the soft core, instruction cache misses take most of the time, so the code for every sample is small and contiguous, and
    // rare cases are in separate functions.
    #[inline(never)]
    pub fn on_sample(&mut self, sample: &Sample) -> SampleEffect {
        let Some(last) = self.last else {
            return self.begin(sample);
        };
        let step = sample.t_us.wrapping_sub(last);
        // The time of an earlier sample results in a large unsigned step.
        if step == 0 || step > u64::from(LONGEST_STEP) {
            return self.hold(sample, last);
        }
        let step = step as u32;
        // Only the time is written, because `last` is `Some` here.
        if let Some(last) = &mut self.last {
            *last = sample.t_us;
        }
        self.integrator.step::<4>(self.rate(sample), step);
        // The correction uses the attitude after the step, which is the attitude at the time of the reading. With the attitude
        // before the step, fast turns would cause a tilt error.
        if let Some(tilt) = &mut self.tilt {
            let (attitude, half) = self.integrator.correctable();
            if !tilt.correct(attitude, sample.accel, step, half) {
                self.counts.rejected += 1;
            }
        }
        self.counts.steps += 1;
        if let Some(resting) = &mut self.resting {
            resting.on_sample(sample, step);
            // The bias is a weighted mean of counts and of the first bias, so no rate overflows.
            self.bias = resting.bias();
        }
        if sample.gyro.into_iter().any(|count| is_end(count.into())) {
            self.counts.saturated += 1;
            self.integrator.forget();
            self.doubt();
        }
        SampleEffect::Step
    }

    /// The rate of a sample without the bias, in 1/256 LSB.
    fn rate(&self, sample: &Sample) -> [i32; 3] {
        [0, 1, 2].map(|i| (i32::from(sample.gyro[i]) << 8) - self.bias[i])
    }

    /// Takes the first sample, which starts the attitude, and all samples until a reading shows the direction of gravity. Up to that
    /// reading the attitude is the rotation since the first sample. The tilt of the first sample follows
    /// from the reading, rotated back to this sample.
    #[cold]
    #[inline(never)]
    fn begin(&mut self, sample: &Sample) -> SampleEffect {
        let tilt = self.tilt.take();
        let effect = match self.unaligned.take() {
            None => {
                self.last = Some(sample.t_us);
                self.integrator.restart(self.rate(sample));
                SampleEffect::First
            }
            last => {
                self.last = last;
                self.on_sample(sample)
            }
        };
        self.tilt = tilt;
        let Some(tilt) = &tilt else {
            return effect;
        };
        let reading = tilt.judge(sample.accel);
        if reading == FirstReading::Gravity {
            let turned = self.integrator.attitude();
            let tilted = Tilt::align_after(turned, sample.accel);
            self.integrator.set_attitude(tilted);
        } else {
            self.counts.rejected += u64::from(reading == FirstReading::Rejected);
            self.unaligned = self.last.take();
        }
        effect
    }

    /// Takes a sample that is not integrated, because it is not later than the previous sample or follows a gap. If the time goes back
    /// to before earlier gaps, the times in between were wrong; the attitude then continues from before the
    /// gaps.
    #[cold]
    #[inline(never)]
    fn hold(&mut self, sample: &Sample, last: u64) -> SampleEffect {
        let mut detour = self.detour;
        // After a longer series of valid steps, the times after the gaps count as correct.
        let since = last.wrapping_sub(detour.start);
        if since > u64::from(LONGEST_STEP) {
            detour.before = None;
        }
        // The steps since the gap were integrated, so their duration is added to the time before the gap.
        let before = detour.before;
        let before = before.map(|(before, age)| (before.wrapping_add(since), age));
        if let Some((before, age)) = before
            && follows(sample.t_us, before)
        {
            self.counts.gaps -= detour.gaps;
            self.counts.stale += detour.gaps;
            if let Some(tilt) = &mut self.tilt {
                tilt.set_age(age);
            }
            self.last = Some(before);
            self.detour = Detour::default();
            return self.on_sample(sample);
        }
        let is_earlier = sample.t_us.wrapping_sub(last).cast_signed() <= 0;
        if is_earlier {
            let is_in_order =
                detour.in_order > 0 && detour.last == last && follows(sample.t_us, detour.stale);
            detour.in_order = 1 + if is_in_order { detour.in_order } else { 0 };
            detour.stale = sample.t_us;
            detour.last = last;
            self.detour = detour;
            if detour.in_order < RESTART {
                self.counts.stale += 1;
                return SampleEffect::Stale;
            }
        }
        let age = self.tilt.map_or(0, |tilt| tilt.age());
        self.detour = Detour {
            start: sample.t_us,
            // After several wrong times, the clock returns to the time before the first of them.
            before: before.or(Some((last, age)).filter(|_| !is_earlier)),
            gaps: 1 + before.map_or(0, |_| detour.gaps),
            ..Detour::default()
        };
        self.last = Some(sample.t_us);
        self.counts.gaps += 1;
        self.integrator.restart(self.rate(sample));
        self.doubt();
        SampleEffect::Gap
    }

    /// Marks the tilt as uncertain after a gap or saturation.
    #[cold]
    #[inline(never)]
    fn doubt(&mut self) {
        if let Some(tilt) = &mut self.tilt {
            tilt.doubt();
        }
    }
}
