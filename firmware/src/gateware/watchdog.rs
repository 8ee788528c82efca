//! A limit on the time without progress.

use glint_hal::triangle::Counters;
use litex_pac::cpu;

/// Cycles without progress after which a pass is cancelled: 100 ms.
const LIMIT: u64 = glint_hal::timer::FREQUENCY as u64 / 10;

/// Watches counters that advance while the engine works.
#[derive(Default)]
pub struct Watchdog {
    progress: u32,
    since: Option<u64>,
}

impl Watchdog {
    /// Whether the engine has made no progress for longer than the limit, counted from the first call.
    pub fn is_stuck(&mut self, counters: &Counters) -> bool {
        let progress = counters
            .words_read
            .wrapping_add(counters.words_written)
            .wrapping_add(counters.walking);
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
