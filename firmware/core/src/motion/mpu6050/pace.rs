//! Computes the time stamps of samples from the times of the reads that fetched them.

/// A model of the sensor's clock, which computes the times at which samples were measured.
///
/// A new sample was measured between the previous read and the current read, and at most a period before the current read. The
/// sample period is not a multiple of the read period, so the reads drift relative to the samples, and from time to time the
/// interval begins or ends close to the sample's time. The clock predicts the time of each sample. A prediction outside the
/// interval is moved to the nearer end of the interval.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Nominal period (`nominal`) and estimated period (`period`) of the samples, in 2^−8 µs.
    nominal: u32,
    period: u32,
    /// Time of the previous read, in µs.
    previous: Option<u64>,
    /// Predicted time of the next sample, in 2^−8 µs.
    expected: Option<u64>,
    /// Number of samples until corrections also change the estimated period.
    settling: u8,
}

/// Number of samples after a start in which corrections change only the estimated time, not the estimated period. In these
/// samples the reads drift across a whole sample period.
const SETTLED: u8 = 32;

/// Each correction of the time changes the estimated period by 2^−5 of the correction, so that the period settles within some
/// dozens of corrections. The constant is the exponent.
const SLOWNESS: u32 = 5;
/// Largest relative difference between the estimated and the nominal period: 2^−5. The constant is the exponent.
const TOLERANCE: u32 = 5;

impl Pace {
    /// Starts a clock for samples with a nominal period in µs, at most 2^20.
    #[must_use]
    pub const fn new(period: u32) -> Self {
        Self {
            nominal: period << 8,
            period: period << 8,
            previous: None,
            expected: None,
            settling: SETTLED,
        }
    }

    /// Takes the time of a read in µs, which is later than the time of the previous read. If `found` states that the read has a
    /// new sample, returns the time in µs at which this sample was measured. The result is `None` for the first read, because its
    /// sample may be old.
    pub fn on_poll(&mut self, time: u64, found: bool) -> Option<u64> {
        let before = self.previous.replace(time)?;
        if !found {
            return None;
        }
        let to = time << 8;
        // The chip holds its newest sample, which is at most a period old even if samples were lost.
        let from = (before << 8).max(to.saturating_sub(self.period.into()));
        let expected = self.expected.unwrap_or(from.midpoint(to));
        let measured = expected.clamp(from, to);
        if self.settling > 0 {
            self.settling -= 1;
        } else {
            // The period is corrected by a part of the prediction's error. This error is less than a period unless samples were
            // lost.
            let most = i64::from(self.nominal);
            let off = (measured as i64 - expected as i64).clamp(-most, most) >> SLOWNESS;
            let tolerance = self.nominal >> TOLERANCE;
            self.period = self
                .period
                .saturating_add_signed(off as i32)
                .clamp(self.nominal - tolerance, self.nominal + tolerance);
        }
        self.expected = Some(measured + u64::from(self.period));
        Some(measured >> 8)
    }
}
