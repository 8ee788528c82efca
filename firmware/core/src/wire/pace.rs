//! How long frames are, and how long to wait for an answer.

use super::format::{BLOCK, MAX_BLOCKS};
use super::frame::OVERHEAD;

/// How many sent bytes are remembered.
const MEMORY: u32 = 8_192;
/// A lost frame, in the units of `FrameSize::lost`.
const FRAME: u32 = 256;

/// The best length of a frame, from how often frames are lost.
///
/// A frame of n data bytes and h others on a line that hits one byte in 1/p brings n/(n + h)·(1 − p)^(n + h) of
/// what the line could carry; the maximum is at about n = √(h/p).
pub struct FrameSize {
    /// Lost frames, in 1/256.
    lost: u32,
    /// Sent bytes whose fate is known.
    bytes: u32,
}

impl FrameSize {
    /// Before anything is known: as if one byte in 410 were hit, which is good for 4 blocks.
    pub const fn new() -> Self {
        Self {
            lost: FRAME,
            bytes: 410,
        }
    }

    /// Remembers the fate of so many sent bytes, and of so many frames that were lost.
    pub fn record(&mut self, bytes: u32, lost: u32) {
        self.bytes = self.bytes.saturating_add(bytes);
        self.lost = self.lost.saturating_add(lost.saturating_mul(FRAME));
        // Old news fades.
        while self.bytes > MEMORY {
            self.bytes /= 2;
            self.lost /= 2;
        }
    }

    /// Blocks a frame should have, 1 to [`MAX_BLOCKS`].
    pub fn blocks(&self) -> u32 {
        // At most 10·8192·256, which fits.
        let squared = OVERHEAD as u32 * self.bytes * FRAME / self.lost.max(1);
        ((squared.isqrt() + BLOCK / 2) / BLOCK).clamp(1, MAX_BLOCKS)
    }
}

/// How long to wait for an answer before asking again.
///
/// A little longer every time it was in vain: asking again soon is right on a bad line, which is nobody else's, and
/// the number of questions to a side that is slow grows only with the square root of the time.
pub struct Patience {
    since_ms: Option<u64>,
    tries: u64,
}

/// The first wait in milliseconds.
const FIRST_WAIT: u64 = 15;
/// By how much each wait is longer than the one before.
const LONGER: u64 = 2;

impl Patience {
    pub const fn new() -> Self {
        Self {
            since_ms: None,
            tries: 0,
        }
    }

    /// Whether something is waited for.
    pub const fn is_waiting(&self) -> bool {
        self.since_ms.is_some()
    }

    /// Begins to wait, or begins anew.
    pub const fn begin(&mut self, now_ms: u64) {
        self.since_ms = Some(now_ms);
    }

    /// An answer came; there may be more to wait for.
    pub const fn answered(&mut self, now_ms: u64) {
        *self = Self {
            since_ms: Some(now_ms),
            tries: 0,
        };
    }

    /// Whether the wait was in vain; then a new one begins.
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
        assert_eq!(FrameSize::new().blocks(), 4);
        for one_in in [20, 33, 50, 100, 200, 500, 1_000, 4_000, 50_000] {
            let brings = |blocks: u32| {
                let (data, all) = (blocks * BLOCK, blocks * BLOCK + OVERHEAD as u32);
                f64::from(data) / f64::from(all) * (1.0 - 1.0 / f64::from(one_in)).powi(all as i32)
            };
            let best = (1..=MAX_BLOCKS).map(brings).fold(0.0, f64::max);
            let mut size = FrameSize::new();
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
        let mut size = FrameSize::new();
        size.record(8_000, 0);
        assert_eq!(size.blocks(), MAX_BLOCKS);
    }

    #[test]
    fn questions_become_rarer_until_there_is_an_answer() {
        let mut patience = Patience::new();
        assert!(!patience.is_over(1_000));
        patience.begin(0);
        let asked =
            |patience: &mut Patience, until| (0..until).filter(|&ms| patience.is_over(ms)).count();
        assert_eq!(asked(&mut patience, 111), 5);
        assert_eq!(asked(&mut patience, 5_000), 59);
        patience.answered(6_000);
        assert!(!patience.is_over(6_014));
        assert!(patience.is_over(6_015));
    }
}
