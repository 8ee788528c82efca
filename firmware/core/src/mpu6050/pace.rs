//! Time stamps of samples from the times of reads.

/// A model of the sensor's clock.
///
/// A new sample in a read was measured since the read before. The period of reads is no fraction of the samples' period, so that reads drift
/// across the samples and their interval bounds the sample's time closely now and then. The clock predicts the time, and the smallest
/// correction moves the prediction into the interval.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Period of the samples in 2^−8 µs: nominal, and estimated.
    nominal: u32,
    period: u32,
    /// Time of the read before, in µs.
    looked: Option<u64>,
    /// Time of the next sample, 2^−8 µs.
    expected: Option<u64>,
    /// Samples until corrections apply to the period too, not only to the phase.
    settling: u8,
}

/// Number of samples in which reads drift across a sample's period.
const SETTLED: u8 = 32;

/// Part of the clock's error that corrects the period: 2^−5, which settles in some dozens of corrections.
const SLOWNESS: u32 = 5;
/// Largest error of the nominal period: 1/32.
const TOLERANCE: u32 = 5;

impl Pace {
    /// For samples with a period in µs, at most 2^20.
    #[must_use]
    pub const fn new(period: u32) -> Self {
        Self {
            nominal: period << 8,
            period: period << 8,
            looked: None,
            expected: None,
            settling: SETTLED,
        }
    }

    /// Takes a read at a time in µs, later than the one before, and gives the time of its new sample. A sample of the first read may be old
    /// and is ignored.
    pub fn on_look(&mut self, time: u64, found: bool) -> Option<u64> {
        let before = self.looked.replace(time)?;
        if !found {
            return None;
        }
        let (from, to) = (before << 8, time << 8);
        let expected = self.expected.unwrap_or(from.midpoint(to));
        let measured = expected.clamp(from, to);
        if self.settling > 0 {
            self.settling -= 1;
        } else {
            // A part of the error, which is less than a period unless samples were lost.
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
