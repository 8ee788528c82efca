//! Detection of passes that make no progress.

use glint_hal::frequency::Frequency;
use glint_hal::triangle::{Counters, TIMEOUT};
use litex_pac::cpu;

/// Watchdog of the triangle engine. It checks that the sum of some engine counters changes, because these counters increase while the
/// engine works.
pub struct Watchdog {
    /// Number of clock cycles without progress after which a pass is cancelled.
    limit: u64,
    progress: u32,
    since: Option<u64>,
}

impl Watchdog {
    /// Creates a watchdog for a clock of `frequency`.
    pub const fn new(frequency: Frequency) -> Self {
        Self {
            limit: frequency.cycles(TIMEOUT),
            progress: 0,
            since: None,
        }
    }

    /// Restarts the timeout at the next call of [`is_stuck`](Self::is_stuck).
    pub const fn reset(&mut self) {
        self.since = None;
    }

    /// Whether the triangle engine has made no progress for longer than [`TIMEOUT`]. The first call starts the timeout.
    pub fn is_stuck(&mut self, counters: &Counters) -> bool {
        let progress = counters
            .items_in
            .wrapping_add(counters.items_out)
            .wrapping_add(counters.cycles_walking);
        let now = cpu::cycles();
        match self.since {
            Some(since) if progress == self.progress => now - since > self.limit,
            _ => {
                (self.progress, self.since) = (progress, Some(now));
                false
            }
        }
    }
}
