//! Detection of passes that make no progress.

use glint_hal::timer;
use glint_hal::triangle::{Counters, TIMEOUT};
use litex_pac::cpu;

/// Number of clock cycles without progress after which a pass is cancelled.
const LIMIT: u64 = timer::cycles(TIMEOUT);

/// Watchdog of the triangle engine. It checks that the sum of some of the engine's counters changes, because these counters
/// grow while the engine works.
#[derive(Default)]
pub struct Watchdog {
    progress: u32,
    since: Option<u64>,
}

impl Watchdog {
    /// Whether the triangle engine has made no progress for longer than `LIMIT`. The first call starts the measurement of
    /// this time.
    pub fn is_stuck(&mut self, counters: &Counters) -> bool {
        let progress = counters
            .items_in
            .wrapping_add(counters.items_out)
            .wrapping_add(counters.cycles_walking);
        let now = cpu::cycles();
        match self.since {
            Some(since) if progress == self.progress => now - since > LIMIT,
            _ => {
                (self.progress, self.since) = (progress, Some(now));
                false
            }
        }
    }
}
