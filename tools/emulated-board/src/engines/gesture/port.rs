//! The port of the image sensor: the pin levels in each period of the sensor's clock.

use glint_model::gesture::Pins;
use litex_pac::constants::CONFIG_CLOCK_FREQUENCY;
use virtual_image_sensor::{ImageSensor, Levels};

/// Frequency of the system clock in Hz.
const CLOCK: u64 = CONFIG_CLOCK_FREQUENCY as u64;

/// A time or a duration: a number of whole cycles, and a fraction of a cycle in units of 1 / (2 · clock) cycle.
#[derive(Clone, Copy, Debug, Default)]
struct Time {
    cycle: u64,
    part: u64,
}

impl Time {
    /// Adds `length` to this time. The unit of the fraction is 1 / `parts` cycle.
    fn after(self, length: Self, parts: u64) -> Self {
        let part = self.part + length.part;
        let carry = u64::from(part >= parts);
        Self {
            cycle: self.cycle + length.cycle + carry,
            part: part - carry * parts,
        }
    }

    /// The first cycle that begins at this time or later.
    fn ceil(self) -> u64 {
        self.cycle + u64::from(self.part > 0)
    }
}

/// The frame that the sensor is sending.
#[derive(Default)]
pub struct Port {
    frame: Vec<Levels>,
    /// Index of the next period in `frame`.
    at: usize,
    /// Index of the period in which VSYNC changes next, or the length of `frame` if it does not change.
    change: usize,
    /// Number of the half period of the sensor's clock in which `frame` began, counted from the start of the board.
    begin: u64,
    /// The time at which `frame` began.
    first: Time,
    /// The time at which the period `at` begins.
    now: Time,
    /// Length of half a period.
    half: Time,
    /// Frequency of the sensor's clock in Hz.
    clock: u64,
    /// Levels in the last period that has been processed.
    before: Levels,
    /// Cycle of the last edge of the sensor's clock.
    pub last_tick: u64,
}

impl Port {
    /// Drops the frame, because the sensor starts or stops.
    pub fn clear(&mut self) {
        self.frame.clear();
        self.at = 0;
        self.change = 0;
    }

    /// Fetches the sensor's next frame if the previous frame has been sent. The first frame begins at the cycle `now`.
    pub fn fill(&mut self, sensor: &mut ImageSensor, now: u64) {
        if self.at < self.frame.len() {
            return;
        }
        let clock = u64::from(sensor.timing.clock.max(1));
        self.begin = if self.frame.is_empty() || clock != self.clock {
            (u128::from(now) * 2 * u128::from(clock) / u128::from(CLOCK)) as u64
        } else {
            self.begin + 2 * self.frame.len() as u64
        };
        self.clock = clock;
        let (begin, halves) = (u128::from(self.begin), u128::from(2 * clock));
        let parts = begin * u128::from(CLOCK);
        self.first = Time {
            cycle: (parts / halves) as u64,
            part: (parts % halves) as u64,
        };
        self.now = self.first;
        self.half = Time {
            cycle: CLOCK / (2 * clock),
            part: CLOCK % (2 * clock),
        };
        let seconds = self.begin as f64 / (2.0 * clock as f64);
        self.frame = sensor.frame(seconds);
        self.at = 0;
        self.find_change();
    }

    /// Returns the next edge of the sensor's clock up to the cycle `now`: its cycle, and the levels
    /// of the pins. `falling` selects falling edges.
    pub fn next(&mut self, now: u64, falling: bool) -> Option<(u64, Pins)> {
        while let Some(&levels) = self.frame.get(self.at) {
            // Levels change at the beginning of a period, and PCLK rises in its middle.
            let begins = levels.is_inverted() != falling;
            let parts = 2 * self.clock;
            let middle = self.now.after(self.half, parts);
            let cycle = if begins { self.now } else { middle }.ceil();
            if cycle > now {
                return None;
            }
            let seen = if begins { self.before } else { levels };
            self.before = levels;
            self.at += 1;
            self.now = middle.after(self.half, parts);
            if self.at > self.change {
                self.find_change();
            }
            if levels.ticks() {
                let pins = Pins {
                    vsync: seen.vsync(),
                    href: seen.href(),
                    data: seen.data(),
                };
                return Some((cycle, pins));
            }
        }
        None
    }

    /// Whether the frame has ended at the cycle `now`, so that the next frame begins.
    pub fn has_sent(&self, now: u64) -> bool {
        let periods = self.frame.len();
        periods > 0 && self.at >= periods && self.cycle(2 * periods as u64) <= now
    }

    /// The cycle in which VSYNC changes next or the frame ends; `u64::MAX` without a frame.
    pub fn next_event(&self) -> u64 {
        if self.frame.is_empty() {
            u64::MAX
        } else {
            self.cycle(2 * self.change as u64 + 2)
        }
    }

    /// The present levels of the pins.
    pub const fn levels(&self) -> Levels {
        self.before
    }

    /// The first cycle after `halves` half periods of the frame.
    fn cycle(&self, halves: u64) -> u64 {
        let Time { cycle, part } = self.first;
        cycle + (part + halves * CLOCK).div_ceil(2 * self.clock.max(1))
    }

    fn find_change(&mut self) {
        let rest = self.frame.get(self.at..).unwrap_or_default();
        let mut vsync = self.before.vsync();
        let change = rest.iter().position(|levels| {
            let was = std::mem::replace(&mut vsync, levels.vsync());
            was != vsync
        });
        self.change = self.at + change.unwrap_or(rest.len());
    }
}
