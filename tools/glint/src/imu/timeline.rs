//! Computes the times of a log's samples from time stamps that may wrap or restart, or may be wrong
//! in single samples.

use super::log::Entry;
use glint_core::orientation::LONGEST_STEP;

/// Number of following samples that decide whether a doubtful time stamp is wrong.
const NEXT: usize = 3;

/// Whether a sample at the time `t_us` can be integrated from a sample at the time `last`, both in µs.
fn follows(t_us: u64, last: u64) -> bool {
    t_us > last && t_us - last <= u64::from(LONGEST_STEP)
}

/// Returns the time of each sample in µs since the first sample. Times never decrease:
///
/// - A time stamp that wraps at 2^32 µs continues.
/// - A time stamp is wrong if it does not follow the previous time stamp, but one of the next three
///   does. Such a sample, and a sample that is not later than the previous sample, gets the time of
///   the previous sample.
/// - A step back in time from which the next three samples continue is a restart of the clock. The
///   time continues after a gap that is slightly longer than [`LONGEST_STEP`].
#[must_use]
pub fn times(entries: &[Entry]) -> Vec<u64> {
    let stamps = unwrapped(entries);
    let mut last = stamps.first().copied().unwrap_or_default();
    let mut time = 0_u64;
    let place = |(i, &stamp): (usize, &u64)| {
        let after = stamps.get(i..).unwrap_or_default();
        let is_wrong = || {
            after
                .iter()
                .skip(1)
                .take(NEXT)
                .any(|&next| follows(next, last))
        };
        let is_restart = || {
            let mut pairs = after.windows(2).take(NEXT);
            pairs.len() == NEXT && pairs.all(|pair| follows(pair[1], pair[0]))
        };
        if !follows(stamp, last) && is_wrong() {
            return time;
        }
        if stamp > last {
            time = time.saturating_add(stamp - last);
            last = stamp;
        } else if stamp < last && is_restart() {
            time = time.saturating_add(u64::from(LONGEST_STEP) + 1);
            last = stamp;
        }
        time
    };
    stamps.iter().enumerate().map(place).collect()
}

/// The time stamps without wraps at 2^32 µs.
fn unwrapped(entries: &[Entry]) -> Vec<u64> {
    let mut wraps = 0_u64;
    let mut last = 0;
    let stamp = |entry: &Entry| {
        let (now, before) = (u32::try_from(entry.t_us), u32::try_from(last));
        if let (Ok(now), Ok(before)) = (now, before)
            && now < before
            && now.wrapping_sub(before) <= LONGEST_STEP
        {
            wraps += 1 << 32;
        }
        last = entry.t_us;
        entry.t_us.saturating_add(wraps)
    };
    entries.iter().map(stamp).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_that_do_not_follow() {
        const WRAP: u64 = 1 << 32;
        let gap = u64::from(LONGEST_STEP) + 1;
        let cases: [(&str, &[u64], &[u64]); 11] = [
            ("in order", &[5, 6, 9], &[0, 1, 4]),
            ("one sample", &[7], &[0]),
            (
                "the low word wraps",
                &[WRAP - 2000, WRAP - 1000, 0, 1000],
                &[0, 1000, 2000, 3000],
            ),
            (
                "a second wrap",
                &[WRAP - 1, 400_000, WRAP - 2, 1],
                &[0, 400_001, WRAP - 1, WRAP + 2],
            ),
            (
                "64 bits",
                &[WRAP - 1000, WRAP, WRAP + 1000],
                &[0, 1000, 2000],
            ),
            (
                "one far ahead",
                &[0, 1000, u64::MAX, 3000, 4000],
                &[0, 1000, 1000, 3000, 4000],
            ),
            (
                "two far back",
                &[9_000_000, 9_001_000, 5, 7, 9_004_000, 9_005_000],
                &[0, 1000, 1000, 1000, 4000, 5000],
            ),
            (
                "out of order and doubled",
                &[0, 3000, 1000, 2000, 2000, 4000],
                &[0, 3000, 3000, 3000, 3000, 4000],
            ),
            (
                "a pause of an hour",
                &[0, 1000, 3_600_001_000, 3_600_002_000],
                &[0, 1000, 3_600_001_000, 3_600_002_000],
            ),
            (
                "a restart",
                &[8_000, 9_000, 0, 1000, 2000, 3000],
                &[0, 1000, 1000 + gap, 2000 + gap, 3000 + gap, 4000 + gap],
            ),
            ("the same for ever", &[7; 5], &[0; 5]),
        ];
        for (name, stamps, expected) in cases {
            let entry = |&t_us: &u64| Entry {
                line: 0,
                t_us,
                accel: [0; 3],
                gyro: [0; 3],
                temp: None,
            };
            let entries: Vec<Entry> = stamps.iter().map(entry).collect();
            assert_eq!(times(&entries), expected, "{name}");
        }
    }
}
