//! Time stamps of samples from the times of reads.

/// A model of the sensor's clock.
///
/// A new sample was measured between the previous read and the present read. The periods of reads and samples have no common
/// multiple, so reads drift across the samples, and from time to time this interval bounds the sample's time closely. The clock
/// predicts the time; the smallest correction moves the prediction into the interval.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Nominal and estimated period of the samples, in 2^−8 µs.
    nominal: u32,
    period: u32,
    /// Time of the previous read, in µs.
    looked: Option<u64>,
    /// Time of the next sample, 2^−8 µs.
    expected: Option<u64>,
    /// Samples until corrections also apply to the period.
    settling: u8,
}

/// Number of samples in which reads drift across a sample's period.
const SETTLED: u8 = 32;

/// Part of the clock's error that corrects the period: 2^−5, which settles in some dozens of corrections.
const SLOWNESS: u32 = 5;
/// Largest error of the nominal period: 1/32.
const TOLERANCE: u32 = 5;

impl Pace {
    /// A clock for samples with a nominal period in µs, at most 2^20.
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

    /// Takes the time of a read in µs, later than the previous read, and gives the time of its new sample. The sample of the first read
    /// may be old and is ignored.
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
            // Corrects a part of the error. The error is less than a period unless samples were lost.
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
