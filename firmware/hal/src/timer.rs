//! Time since reset, from the uptime counter of `timer0`.
//!
//! The counter has 64 bits and counts clock cycles of the SoC; it never stops and never wraps. [`Clock`] is a copyable
//! handle that anybody may hold, also an interrupt handler: a reading that another one disturbs is still a time
//! between the two.

use core::time::Duration;

use embedded_hal::delay::DelayNs;
use litex_pac::constants::CONFIG_CLOCK_FREQUENCY;
use litex_pac::timer0::Timer0;

/// Clock cycles of the SoC a second.
pub const FREQUENCY: u32 = CONFIG_CLOCK_FREQUENCY;

/// The SoC's uptime.
#[derive(Clone, Copy)]
pub struct Clock {
    _running: (),
}

/// The uptime counter stands still: the SoC has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stopped;

impl core::fmt::Display for Stopped {
    fn fmt(&self, f: &mut core::fmt::Formatter) -> core::fmt::Result {
        f.write_str("timer0: expected an uptime that advances, found that it stands still")
    }
}

impl core::error::Error for Stopped {}

impl Clock {
    /// The clock on `timer0`, of which only the uptime is used.
    ///
    /// # Errors
    /// When two readings are equal.
    pub fn new(_timer: Timer0) -> Result<Self, Stopped> {
        let clock = Self { _running: () };
        if clock.cycles() == clock.cycles() {
            Err(Stopped)
        } else {
            Ok(clock)
        }
    }

    /// Clock cycles since reset.
    #[must_use]
    pub fn cycles(self) -> u64 {
        // SAFETY: `new` took the only handle and drops it, so that all that is left are readings of the uptime.
        let timer = unsafe { Timer0::steal() };
        timer.uptime_latch().write(true);
        timer.uptime_cycles().read()
    }

    /// Whole milliseconds since reset.
    #[must_use]
    pub fn milliseconds(self) -> u64 {
        self.cycles() / u64::from(FREQUENCY / 1000)
    }

    /// The point in time `span` from now.
    #[must_use]
    pub fn after(self, span: Duration) -> Deadline {
        Deadline {
            clock: self,
            cycles: self.cycles().saturating_add(cycles(span)),
        }
    }
}

/// A point in time.
#[derive(Clone, Copy)]
pub struct Deadline {
    clock: Clock,
    cycles: u64,
}

impl Deadline {
    /// Whether it has passed.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.clock.cycles() >= self.cycles
    }
}

impl DelayNs for Clock {
    /// Waits at least `ns`, and a few dozen cycles more.
    fn delay_ns(&mut self, ns: u32) {
        let deadline = self.after(Duration::from_nanos(ns.into()));
        while !deadline.passed() {}
    }
}

/// A span in clock cycles, rounded up to the next cycle; it saturates.
#[must_use]
pub fn cycles(span: Duration) -> u64 {
    let frequency = u64::from(FREQUENCY);
    // Below a second in nanoseconds times 2^27: no overflow.
    let part = (u64::from(span.subsec_nanos()) * frequency).div_ceil(1_000_000_000);
    span.as_secs()
        .saturating_mul(frequency)
        .saturating_add(part)
}

#[cfg(test)]
pub(crate) mod tests {
    use litex_pac::bus::{self, Bus};

    use super::*;

    /// Advances the uptime by `step` at each latch.
    pub struct Uptime {
        pub now: u64,
        pub latched: u64,
        pub step: u64,
    }

    impl Uptime {
        pub const fn new(step: u64) -> Self {
            Self {
                now: 0,
                latched: 0,
                step,
            }
        }

        /// The word at `address`, if it is one of the uptime's.
        pub fn read(&self, address: usize) -> Option<u32> {
            match address - Timer0::BASE {
                0x24 => Some((self.latched >> 32) as u32),
                0x28 => Some(self.latched as u32),
                _ => None,
            }
        }

        pub fn write(&mut self, address: usize) {
            if address == Timer0::BASE + 0x20 {
                self.now += self.step;
                self.latched = self.now;
            }
        }
    }

    impl Bus for Uptime {
        fn read(&mut self, address: usize) -> u32 {
            Self::read(self, address).unwrap()
        }

        fn write(&mut self, address: usize, _: u32) {
            Self::write(self, address);
        }
    }

    /// The clock of a bus that this thread has connected.
    pub fn clock() -> Clock {
        // SAFETY: the registers are a model's.
        Clock::new(unsafe { Timer0::steal() }).unwrap()
    }

    #[test]
    fn a_clock_without_a_counter_is_refused() {
        bus::connect(Uptime::new(0));
        // SAFETY: the registers are a model's.
        assert!(Clock::new(unsafe { Timer0::steal() }).is_err());
    }

    #[test]
    fn counts_and_waits() {
        bus::connect(Uptime::new(7));
        let mut clock = clock();
        assert_eq!(clock.cycles(), 21);
        clock.delay_us(1000);
        assert!(clock.cycles() >= 21 + 81_250);
        bus::connect(Uptime {
            now: (5 << 32) - 1,
            latched: 0,
            step: 1,
        });
        assert_eq!(clock.cycles(), 5 << 32);
    }

    #[test]
    fn spans_become_cycles() {
        assert_eq!(cycles(Duration::from_secs(2)), 2 * u64::from(FREQUENCY));
        assert_eq!(cycles(Duration::from_nanos(1)), 1);
        assert_eq!(cycles(Duration::ZERO), 0);
        assert_eq!(cycles(Duration::MAX), u64::MAX);
    }
}
