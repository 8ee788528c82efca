//! The length of data frames, and the timeouts after which an answer is requested again.

use super::format::{BLOCK, MAX_BLOCKS};
use super::frame::OVERHEAD;

/// Largest number of sent bytes in the statistics of `FrameLength`; beyond it the statistics are halved.
const MEMORY: u32 = 8_192;
/// One frame in units of 1/256 frame, as in `FrameLength::lost`.
const FRAME: u32 = 256;

/// Chooses the best length of a data frame from the rate of lost frames.
///
/// With n data bytes and h bytes of overhead in a frame, on a line that damages a byte with probability p, the used part of the
/// line's capacity is n/(n + h)·(1 − p)^(n + h). The maximum is at about n = √(h/p).
pub struct FrameLength {
    /// Number of lost frames, in units of 1/256 frame; older frames count less.
    lost: u32,
    /// Number of sent bytes that are known to have arrived or to be lost; older bytes count less.
    bytes: u32,
}

impl FrameLength {
    /// Starts with the estimate of one lost frame in 410 bytes, which gives frames of 4 blocks.
    pub const fn new() -> Self {
        Self {
            lost: FRAME,
            bytes: 410,
        }
    }

    /// Adds `bytes` sent bytes that have arrived or are lost, and the number of frames that were lost, to the statistics.
    pub fn record(&mut self, bytes: u32, lost: u32) {
        self.bytes = self.bytes.saturating_add(bytes);
        self.lost = self.lost.saturating_add(lost.saturating_mul(FRAME));
        // Older statistics get less weight.
        while self.bytes > MEMORY {
            self.bytes /= 2;
            self.lost /= 2;
        }
    }

    /// Computes the best number of blocks per data frame, 1 to [`MAX_BLOCKS`].
    pub fn blocks(&self) -> u32 {
        // The product is at most 10·8192·256, which fits 32 bits.
        let squared = OVERHEAD as u32 * self.bytes * FRAME / self.lost.max(1);
        ((squared.isqrt() + BLOCK / 2) / BLOCK).clamp(1, MAX_BLOCKS)
    }
}

/// The timeouts after which a missing answer is requested again.
///
/// Each timeout is slightly longer than the previous one. The first timeouts are short, which suits a bad line. If the other side
/// is slow, the number of requests grows only with the square root of the time.
pub struct Backoff {
    since_ms: Option<u64>,
    tries: u64,
}

/// First timeout in milliseconds.
const FIRST_WAIT: u64 = 15;
/// Difference between successive timeouts in milliseconds.
const LONGER: u64 = 2;

impl Backoff {
    pub const fn new() -> Self {
        Self {
            since_ms: None,
            tries: 0,
        }
    }

    /// Whether an answer is pending.
    pub const fn is_waiting(&self) -> bool {
        self.since_ms.is_some()
    }

    /// Starts or restarts the timeout.
    pub const fn begin(&mut self, now_ms: u64) {
        self.since_ms = Some(now_ms);
    }

    /// Records an answer and starts the shortest timeout again, because further answers may be pending.
    pub const fn answered(&mut self, now_ms: u64) {
        *self = Self {
            since_ms: Some(now_ms),
            tries: 0,
        };
    }

    /// Returns whether an answer is pending and its timeout has passed. In this case the next, longer timeout starts.
    pub fn is_over(&mut self, now_ms: u64) -> bool {
        let wait = FIRST_WAIT + LONGER * self.tries;
        let over = self
            .since_ms
            .is_some_and(|since| now_ms.saturating_sub(since) >= wait);
        if over {
            *self = Self {
                since_ms: Some(now_ms),
                tries: self.tries + 1,
            };
        }
        over
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_as_long_as_the_line_allows() {
        assert_eq!(FrameLength::new().blocks(), 4);
        for one_in in [20, 33, 50, 100, 200, 500, 1_000, 4_000, 50_000] {
            let brings = |blocks: u32| {
                let (data, all) = (blocks * BLOCK, blocks * BLOCK + OVERHEAD as u32);
                f64::from(data) / f64::from(all) * (1.0 - 1.0 / f64::from(one_in)).powi(all as i32)
            };
            let best = (1..=MAX_BLOCKS).map(brings).fold(0.0, f64::max);
            let mut size = FrameLength::new();
            (0..100).for_each(|_| size.record(one_in, 1));
            assert!(
                brings(size.blocks()) >= 0.98 * best,
                "{one_in} {}",
                size.blocks()
            );
        }
    }

    #[test]
    fn a_clean_line_gets_the_longest_frames_within_8_kib() {
        let mut size = FrameLength::new();
        size.record(8_000, 0);
        assert_eq!(size.blocks(), MAX_BLOCKS);
    }

    #[test]
    fn questions_become_rarer_until_there_is_an_answer() {
        let mut backoff = Backoff::new();
        assert!(!backoff.is_over(1_000));
        backoff.begin(0);
        let asked =
            |backoff: &mut Backoff, until| (0..until).filter(|&ms| backoff.is_over(ms)).count();
        assert_eq!(asked(&mut backoff, 111), 5);
        assert_eq!(asked(&mut backoff, 5_000), 59);
        backoff.answered(6_000);
        assert!(!backoff.is_over(6_014));
        assert!(backoff.is_over(6_015));
    }
}
