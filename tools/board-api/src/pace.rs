//! Limits the speed of a simulated board to real time.

use std::time::{Duration, Instant};

/// The clock that limits a board to real time.
pub trait Clock {
    /// Time since the start of the clock.
    fn now(&self) -> Duration;

    /// Waits for `time`. On a platform that cannot wait, the call returns immediately, and the
    /// board runs ahead of real time.
    fn wait(&self, time: Duration);
}

/// The system's clock.
#[derive(Clone, Copy, Debug)]
pub struct SystemClock(Instant);

impl SystemClock {
    /// A clock that starts now.
    #[must_use]
    pub fn start() -> Self {
        Self(Instant::now())
    }
}

impl Clock for SystemClock {
    fn now(&self) -> Duration {
        self.0.elapsed()
    }

    fn wait(&self, time: Duration) {
        std::thread::sleep(time);
    }
}

/// Longest delay behind real time that a board makes up for. A longer delay is dropped: real time is measured from the current cycle again.
const MAX_DELAY: Duration = Duration::from_millis(50);

/// Relates a board's cycles to real time.
#[derive(Clone, Debug)]
pub struct Pace<C> {
    clock: C,
    clock_hz: u32,
    /// A time of the clock, and the board's cycle at that time.
    origin: (Duration, u64),
}

impl<C: Clock> Pace<C> {
    /// The pace of a board that has a system clock of `clock_hz` Hz and is now at cycle `cycle`.
    #[must_use]
    pub fn new(clock: C, clock_hz: u32, cycle: u64) -> Self {
        Self {
            origin: (clock.now(), cycle),
            clock,
            clock_hz,
        }
    }

    /// The clock that limits the board.
    pub fn clock(&self) -> &C {
        &self.clock
    }

    /// Waits until real time has reached cycle `cycle` of the board. A board that is more than 50
    /// ms late does not catch up the delay.
    pub fn wait(&mut self, cycle: u64) {
        let early = self.early(cycle);
        if !early.is_zero() {
            self.clock.wait(early);
        }
    }

    /// Returns the time by which a board at cycle `cycle` is ahead of real time.
    pub fn early(&mut self, cycle: u64) -> Duration {
        let now = self.clock.now();
        let (start, first) = self.origin;
        let cycles = cycle.saturating_sub(first);
        let board = Duration::from_secs_f64(cycles as f64 / f64::from(self.clock_hz));
        let real = now.saturating_sub(start);
        if real > board + MAX_DELAY {
            self.origin = (now, cycle);
        }
        board.saturating_sub(real)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use std::cell::Cell;

    const CLOCK_HZ: u32 = 1_000_000;

    /// A clock whose time the test sets.
    #[derive(Default)]
    struct Set(Cell<Duration>);

    impl Clock for Set {
        fn now(&self) -> Duration {
            self.0.get()
        }

        fn wait(&self, time: Duration) {
            self.0.set(self.0.get() + time);
        }
    }

    #[test]
    fn a_board_is_never_ahead_and_loses_long_delays() {
        let mut pace = Pace::new(Set::default(), CLOCK_HZ, 7);
        let mut early = |ms: u64, board_ms: u64| {
            pace.clock.0.set(Duration::from_millis(ms));
            pace.early(7 + board_ms * 1000).as_millis()
        };
        assert_eq!(early(0, 0), 0);
        assert_eq!(early(10, 25), 15);
        // The board catches up a delay of 40 ms.
        assert_eq!(early(100, 60), 0);
        assert_eq!(early(100, 110), 10);
        // The board does not catch up a delay of 90 ms.
        assert_eq!(early(200, 110), 0);
        assert_eq!(early(200, 115), 5);
        pace.wait(7 + 115_000);
        assert_eq!(pace.clock.now(), Duration::from_millis(205));
    }
}
