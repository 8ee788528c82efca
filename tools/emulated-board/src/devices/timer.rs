//! LiteX's timer: counts down, and reloads from `reload`.

use litex_pac::timer0::offset;

use crate::{Device, Events, MainMemory};

/// Bit of the event in the event registers.
const ZERO: u32 = 1;

/// The timer.
pub struct Timer {
    load: u32,
    reload: u32,
    enabled: bool,
    /// For an enabled timer: the cycle of the last register change, and the count in that cycle.
    start: (u64, u32),
    value: u32,
    uptime: u64,
    /// Last written values of the registers `update_value` and `uptime_latch`.
    latches: [u32; 2],
    /// Next cycle in which the count becomes 0.
    zero: u64,
    events: Events,
}

impl Timer {
    /// The timer after a reset. Its count is 0, which raises the event.
    pub fn new() -> Self {
        let mut events = Events::default();
        events.set_level(ZERO, true);
        Self {
            load: 0,
            reload: 0,
            enabled: false,
            start: (0, 0),
            value: 0,
            uptime: 0,
            latches: [0; 2],
            zero: u64::MAX,
            events,
        }
    }

    fn count(&self, now: u64) -> u32 {
        let (since, value) = self.start;
        if !self.enabled {
            return self.load;
        }
        match (now - since).checked_sub(u64::from(value) + 1) {
            None => value - (now - since) as u32,
            // Cycles since the first reload.
            Some(cycles) => self.reload - (cycles % (u64::from(self.reload) + 1)) as u32,
        }
    }

    /// Restarts from `value` at `now`, after a register change.
    fn restart(&mut self, now: u64, value: u32) {
        self.start = (now, value);
        self.events.set_level(ZERO, value == 0);
        self.zero = match (self.enabled, value) {
            (false, _) => u64::MAX,
            (true, 0) if self.reload == 0 => u64::MAX,
            (true, 0) => now + u64::from(self.reload) + 1,
            (true, value) => now + u64::from(value),
        };
    }
}

impl Device for Timer {
    fn read(&mut self, offset: u32, now: u64) -> u32 {
        match offset {
            offset::EN => self.enabled.into(),
            offset::UPDATE_VALUE => self.latches[0],
            offset::VALUE => self.value,
            offset::UPTIME_LATCH => self.latches[1],
            offset::UPTIME_CYCLES => (self.uptime >> 32) as u32,
            at if at == offset::UPTIME_CYCLES + 4 => self.uptime as u32,
            offset::EV_STATUS => u32::from(self.count(now) == 0) * ZERO,
            offset::EV_PENDING => self.events.pending(),
            offset::EV_ENABLE => self.events.enabled(),
            _ => 0,
        }
    }

    fn write(&mut self, offset: u32, value: u32, now: u64, _ram: &mut MainMemory) {
        match offset {
            offset::LOAD => {
                self.load = value;
                if !self.enabled {
                    self.restart(now, value);
                }
            }
            offset::RELOAD => {
                let count = self.count(now);
                self.reload = value;
                self.restart(now, count);
            }
            offset::EN => {
                // A disabled timer holds `load`, and counts from it when it is enabled.
                let count = if self.enabled && value & 1 != 0 {
                    self.count(now)
                } else {
                    self.load
                };
                self.enabled = value & 1 != 0;
                self.restart(now, count);
            }
            offset::UPDATE_VALUE => {
                self.latches[0] = value & 1;
                self.value = self.count(now);
            }
            offset::UPTIME_LATCH => {
                self.latches[1] = value & 1;
                self.uptime = now;
            }
            offset::EV_PENDING => self.events.clear(value),
            offset::EV_ENABLE => self.events.enable(value & ZERO),
            _ => {}
        }
    }

    fn advance(&mut self, now: u64, _ram: &mut MainMemory) -> u64 {
        if now >= self.zero {
            self.events.raise(ZERO);
            // More than one period may have passed.
            let period = u64::from(self.reload) + 1;
            self.zero = match self.reload {
                0 => u64::MAX,
                _ => now + period - (now - self.zero) % period,
            };
        }
        // The event's level falls in the next cycle, or stays high if `reload` is 0.
        self.events.set_level(ZERO, self.count(now) == 0);
        self.zero
    }

    fn interrupt(&self) -> bool {
        self.events.interrupt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn enabled(load: u32, reload: u32) -> (Timer, MainMemory) {
        let (mut timer, mut ram) = (Timer::new(), MainMemory::new());
        let mut write = |offset, value| timer.write(offset, value, 100, &mut ram);
        write(offset::LOAD, load);
        write(offset::RELOAD, reload);
        write(offset::EN, 1);
        write(offset::EV_PENDING, ZERO);
        write(offset::EV_ENABLE, ZERO);
        (timer, ram)
    }

    fn count(timer: &mut Timer, now: u64, ram: &mut MainMemory) -> u32 {
        timer.write(offset::UPDATE_VALUE, 1, now, ram);
        timer.read(offset::VALUE, now)
    }

    #[test]
    fn one_shot_stays_at_zero() {
        let (mut timer, mut ram) = enabled(10, 0);
        assert_eq!(timer.advance(105, &mut ram), 110);
        assert_eq!(count(&mut timer, 105, &mut ram), 5);
        assert!(!timer.interrupt());
        assert_eq!(timer.advance(110, &mut ram), u64::MAX);
        assert!(timer.interrupt());
        timer.write(offset::EV_PENDING, ZERO, 111, &mut ram);
        timer.advance(200, &mut ram);
        assert_eq!(count(&mut timer, 200, &mut ram), 0);
        assert!(!timer.interrupt());
    }

    #[test]
    fn a_period_has_one_cycle_more_than_the_reload_value() {
        let (mut timer, mut ram) = enabled(3, 9);
        assert_eq!(timer.advance(100, &mut ram), 103);
        assert_eq!(timer.advance(103, &mut ram), 113);
        assert_eq!(count(&mut timer, 104, &mut ram), 9);
        assert_eq!(count(&mut timer, 113, &mut ram), 0);
        assert_eq!(timer.advance(125, &mut ram), 133);
        assert_eq!(timer.read(offset::EV_STATUS, 133), ZERO);
        assert_eq!(timer.read(offset::EV_STATUS, 134), 0);
    }

    #[test]
    fn a_count_that_stays_at_zero_is_one_event() {
        let (mut timer, mut ram) = enabled(10, 0);
        timer.advance(110, &mut ram);
        timer.write(offset::EV_PENDING, ZERO, 111, &mut ram);
        for (register, value) in [(offset::EN, 1), (offset::RELOAD, 20)] {
            timer.write(register, value, 112, &mut ram);
            assert!(!timer.interrupt());
        }
        timer.advance(timer.zero, &mut ram);
        assert!(timer.interrupt());
    }

    #[test]
    fn each_period_is_an_event() {
        let (mut timer, mut ram) = enabled(3, 9);
        for _ in 0..3 {
            let zero = timer.zero;
            timer.advance(zero, &mut ram);
            assert!(timer.interrupt());
            timer.write(offset::EV_PENDING, ZERO, zero, &mut ram);
        }
    }

    #[test]
    fn latches_read_what_was_written() {
        let (mut timer, mut ram) = (Timer::new(), MainMemory::new());
        for register in [offset::UPDATE_VALUE, offset::UPTIME_LATCH] {
            timer.write(register, 3, 100, &mut ram);
            assert_eq!(timer.read(register, 100), 1);
        }
    }
}
