//! When samples were measured, told from when they were looked for.

/// A clock that runs along with a sensor's.
///
/// A sample that a look finds was measured after the look before. Looks whose period is no fraction of the samples' move across it, so
/// every now and then one of the two is close to the sample; between them the clock says when, and it is moved by
/// as little as they ask for.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Of the samples, 2^−8 µs: what it is said to be, and what it seems to be.
    nominal: u32,
    period: u32,
    /// When the look before was, in µs.
    looked: Option<u64>,
    /// When the next sample is measured, 2^−8 µs.
    expected: Option<u64>,
    /// Samples until corrections say something of the period, and not only of where the first one was.
    settling: u8,
}

/// By then looks have moved across the samples' times.
const SETTLED: u8 = 32;

/// What the period takes of the clock's error is 2^−5: it settles in some dozens of corrections.
const SLOWNESS: u32 = 5;
/// The period is off by at most 1/32 of it.
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

    /// Takes a look at a time in µs, later than the one before: when the sample was measured that it has found, if it has. A sample of
    /// the first look may be old, and does not count.
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
            // A part of what it is off by, which is less than a period unless samples were lost.
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
