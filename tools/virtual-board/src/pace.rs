//! Holds a simulated board back to real time.

use std::time::{Duration, Instant};

/// Delay of a board behind real time that it catches up. A longer delay stays.
const MAX_DELAY: Duration = Duration::from_millis(50);

/// The relation of a board's cycles to real time.
#[derive(Clone, Debug)]
pub struct Pace {
    clock_hz: u32,
    /// A time, and the cycle of the board that belongs to it.
    origin: (Instant, u64),
}

impl Pace {
    /// The pace of a board with a system clock of `clock_hz` Hz that has run `cycle` cycles at the time `now`.
    #[must_use]
    pub fn new(clock_hz: u32, cycle: u64, now: Instant) -> Self {
        Self {
            clock_hz,
            origin: (now, cycle),
        }
    }

    /// Waits until real time has reached the board's cycle `cycle`. A board that is late by more than 50 ms goes on from there,
    /// without catching up.
    pub fn wait(&mut self, cycle: u64) {
        let early = self.early(cycle, Instant::now());
        if !early.is_zero() {
            std::thread::sleep(early);
        }
    }

    /// Returns how early a board is that has run `cycle` cycles at the time `now`.
    fn early(&mut self, cycle: u64, now: Instant) -> Duration {
        let (start, first) = self.origin;
        let cycles = cycle.saturating_sub(first);
        let board = Duration::from_secs_f64(cycles as f64 / f64::from(self.clock_hz));
        let real = now.saturating_duration_since(start);
        if real > board + MAX_DELAY {
            self.origin = (now, cycle);
        }
        board.saturating_sub(real)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLOCK_HZ: u32 = 1_000_000;

    #[test]
    fn a_board_is_never_ahead_and_loses_long_delays() {
        let start = Instant::now();
        let mut pace = Pace::new(CLOCK_HZ, 7, start);
        let mut early = |ms: u64, board_ms: u64| {
            let now = start + Duration::from_millis(ms);
            pace.early(7 + board_ms * 1000, now).as_millis()
        };
        assert_eq!(early(0, 0), 0);
        assert_eq!(early(10, 25), 15);
        // A delay of 40 ms is caught up.
        assert_eq!(early(100, 60), 0);
        assert_eq!(early(100, 110), 10);
        // A delay of 90 ms stays.
        assert_eq!(early(200, 110), 0);
        assert_eq!(early(200, 115), 5);
    }
}
