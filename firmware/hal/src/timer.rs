//! Time since reset, from the uptime counter of `timer0`.
//!
//! The counter has 64 bits and counts clock cycles of the SoC without stop or wrap. [`Clock`] is a copyable handle,
//! which interrupt handlers may use too: a reading that is interrupted by another reading still gives a time between its
//! own start and end.

use core::future::{Future, poll_fn};
use core::pin::pin;
use core::task::{Context, Poll, Waker};
use core::time::Duration;

use embedded_hal::delay::DelayNs;
use litex_pac::timer0::{EvEnable, EvPending, Timer0};

use crate::frequency::Frequency;

/// Handle of the SoC's uptime counter, with the frequency of the SoC's clock.
#[derive(Clone, Copy)]
pub struct Clock {
    frequency: Frequency,
}

/// The uptime counter does not advance, because the SoC lacks it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stopped;

impl core::fmt::Display for Stopped {
    fn fmt(&self, f: &mut core::fmt::Formatter) -> core::fmt::Result {
        f.write_str("timer0: expected an advancing uptime counter, found a constant value")
    }
}

impl core::error::Error for Stopped {}

/// The whole milliseconds of a duration below 49 days, for messages. [`Duration::as_millis`] returns 128 bits, and the code that
/// prints such a number takes 2.7 KB.
#[must_use]
pub const fn whole_millis(duration: Duration) -> u32 {
    duration.as_millis() as u32
}

impl Clock {
    /// Returns the clock that reads the uptime counter of `timer0`, which counts with `frequency`.
    ///
    /// # Errors
    /// Two readings of the counter are equal.
    pub fn new(_timer: Timer0, frequency: Frequency) -> Result<Self, Stopped> {
        let clock = Self { frequency };
        if clock.cycles() == clock.cycles() {
            Err(Stopped)
        } else {
            Ok(clock)
        }
    }

    /// The frequency of the SoC's clock.
    #[must_use]
    pub const fn frequency(self) -> Frequency {
        self.frequency
    }

    /// Clock cycles since reset.
    #[must_use]
    pub fn cycles(self) -> u64 {
        // SAFETY: every access to the uptime registers first latches the counter and then reads it.
        let timer = unsafe { Timer0::steal() };
        timer.uptime_latch().write(true);
        timer.uptime_cycles().read()
    }

    /// Whole milliseconds since reset.
    #[must_use]
    pub fn milliseconds(self) -> u64 {
        self.frequency.milliseconds(self.cycles())
    }

    /// Returns the point in time that is `span` from now.
    #[must_use]
    pub fn after(self, span: Duration) -> Deadline {
        self.after_cycles(self.frequency.cycles(span))
    }

    /// Returns the point in time `cycles` clock cycles from now.
    #[must_use]
    pub fn after_cycles(self, cycles: u64) -> Deadline {
        Deadline {
            clock: self,
            cycles: self.cycles().saturating_add(cycles),
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
    /// Whether this point in time has passed.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.clock.cycles() >= self.cycles
    }
}

impl DelayNs for Clock {
    /// Waits for at least `ns` nanoseconds, and at most a few dozen cycles longer.
    fn delay_ns(&mut self, ns: u32) {
        let deadline = self.after(Duration::from_nanos(ns.into()));
        while !deadline.passed() {}
    }
}

/// A blocking delay: it occupies the CPU, as the delays of `embedded_hal` do.
pub struct Waiting(pub Clock);

impl embedded_hal_async::delay::DelayNs for Waiting {
    async fn delay_ns(&mut self, ns: u32) {
        let Self(clock) = *self;
        let deadline = clock.after_cycles(clock.frequency.cycles_of_nanoseconds(ns));
        while !deadline.passed() {}
    }
}

/// Polls a future until it is ready, and blocks the CPU until then.
pub fn block_on<T>(future: impl Future<Output = T>) -> T {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(output) = future.as_mut().poll(&mut context) {
            return output;
        }
    }
}

/// A delay ends at the first poll after its time; an interrupt of `timer0` causes this poll. `timer0` has a single
/// interrupt: of several simultaneous delays only the delay that started last gets the interrupt. The other delays end at a poll with
/// another cause.
impl embedded_hal_async::delay::DelayNs for Clock {
    async fn delay_ns(&mut self, ns: u32) {
        self.wait(self.frequency.cycles(Duration::from_nanos(ns.into())))
            .await;
    }

    async fn delay_us(&mut self, us: u32) {
        self.wait(self.frequency.cycles_of_microseconds(us)).await;
    }

    async fn delay_ms(&mut self, ms: u32) {
        self.wait(self.frequency.cycles(Duration::from_millis(ms.into())))
            .await;
    }
}

impl Clock {
    async fn wait(self, cycles: u64) {
        let deadline = self.after_cycles(cycles);
        // An early interrupt only causes an additional poll.
        alarm(u32::try_from(cycles).unwrap_or(u32::MAX));
        poll_fn(|_| {
            if deadline.passed() {
                Poll::Ready(())
            } else {
                Poll::Pending
            }
        })
        .await;
    }
}

/// Makes `timer0` raise an interrupt after slightly more than `cycles` clock cycles from now.
fn alarm(cycles: u32) {
    // SAFETY: only this function writes these registers; the last write sets the interrupt.
    let timer = unsafe { Timer0::steal() };
    timer.en().write(false);
    timer.load().write(cycles.saturating_add(1));
    timer.en().write(true);
    timer.ev_enable().write(EvEnable::default().with_zero(true));
}

/// Clears the interrupt of `timer0`, for the interrupt handler.
pub fn acknowledge() {
    // SAFETY: only this function writes the pending register.
    let timer = unsafe { Timer0::steal() };
    timer
        .ev_pending()
        .write(EvPending::default().with_zero(true));
}

#[cfg(test)]
pub(crate) mod tests {
    use litex_pac::bus::{self, Bus};

    use super::*;

    /// Model of the uptime counter, which advances by `step` at each latch.
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

        /// The 32-bit word at `address`, if the address is that of a register of the uptime counter.
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

    /// A clock whose registers are the model that this thread has connected to the bus.
    pub fn clock() -> Clock {
        // SAFETY: a model on the bus answers all accesses, so no device is affected.
        Clock::new(unsafe { Timer0::steal() }, Frequency::DEFAULT).unwrap()
    }

    #[test]
    fn a_clock_without_a_counter_is_refused() {
        bus::connect(Uptime::new(0));
        // SAFETY: a model on the bus answers all accesses, so no device is affected.
        assert!(Clock::new(unsafe { Timer0::steal() }, Frequency::DEFAULT).is_err());
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

    /// A model of the uptime counter and of the register `load`; the test sees the value last written to `load`.
    struct Alarm(Uptime, std::rc::Rc<core::cell::Cell<u32>>);

    impl Bus for Alarm {
        fn read(&mut self, address: usize) -> u32 {
            self.0.read(address).unwrap()
        }

        fn write(&mut self, address: usize, value: u32) {
            self.0.write(address);
            if address == Timer0::BASE {
                self.1.set(value);
            }
        }
    }

    #[test]
    fn a_delay_is_over_in_time_and_asks_to_be_woken() {
        let asked = std::rc::Rc::new(core::cell::Cell::new(0));
        bus::connect(Alarm(Uptime::new(1_000), asked.clone()));
        let mut clock = clock();
        let mut delay = core::pin::pin!(embedded_hal_async::delay::DelayNs::delay_us(
            &mut clock, 100
        ));
        let mut context = Context::from_waker(Waker::noop());
        let mut polls = 1;
        while delay.as_mut().poll(&mut context).is_pending() {
            polls += 1;
        }
        // The delay takes 8125 cycles, and each reading of the clock advances the model by 1000.
        assert_eq!((polls, asked.get()), (9, 8_126));
    }
}
