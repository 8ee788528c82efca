//! The frequency of the SoC's clock, and the conversions between clock cycles and time.
//!
//! The register `identity.clock` contains the gateware's frequency, so one firmware supports all frequencies.

use core::fmt;
use core::time::Duration;

use litex_pac::constants::CONFIG_CLOCK_FREQUENCY;

/// Unit of frequencies in Hz: one cycle in 4 µs. Every frequency is a multiple of this unit.
const UNIT: u32 = 250_000;

/// Lowest frequency in units of `UNIT`.
const LOWEST: u32 = 5;
/// Highest frequency in units of `UNIT`.
const HIGHEST: u32 = 1000;

/// A frequency of the SoC's clock: a multiple of 250 kHz, from 1.25 MHz to 250 MHz.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frequency {
    hertz: u32,
    /// Microseconds per cycle with 64 fraction bits, rounded up. A multiplication replaces a division, which would take a thousand
    /// cycles.
    inverse: u64,
}

/// Error: a number of Hz that is not a [`Frequency`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotAFrequency(u32);

impl fmt::Display for NotAFrequency {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let unit = UNIT / 1000;
        write!(
            f,
            "clock frequency: expected a multiple of {unit} kHz from {} to {} kHz, found {} Hz",
            LOWEST * unit,
            HIGHEST * unit,
            self.0
        )
    }
}

impl core::error::Error for NotAFrequency {}

impl Frequency {
    /// The frequency of the SoC that the register access crate was generated from.
    pub const DEFAULT: Self = match Self::new(CONFIG_CLOCK_FREQUENCY) {
        Ok(frequency) => frequency,
        Err(_) => panic!("CONFIG_CLOCK_FREQUENCY is out of range"),
    };

    /// The frequency of `hertz` cycles per second.
    ///
    /// # Errors
    /// `hertz` is out of range, or not a multiple of 250 kHz.
    pub const fn new(hertz: u32) -> Result<Self, NotAFrequency> {
        let quarters = hertz / UNIT;
        if !hertz.is_multiple_of(UNIT) || quarters < LOWEST || quarters > HIGHEST {
            return Err(NotAFrequency(hertz));
        }
        // 4 · 2^64 / `quarters`, in two steps because the dividend has 67 bits.
        let quarters = quarters as u64;
        let (high, rest) = ((1 << 33) / quarters, (1 << 33) % quarters);
        Ok(Self {
            hertz,
            inverse: (high << 33) + (rest << 33).div_ceil(quarters),
        })
    }

    /// Clock cycles per second.
    #[must_use]
    pub const fn hertz(self) -> u32 {
        self.hertz
    }

    /// Converts clock cycles to µs, rounded down. The result is exact below 2^54 cycles, which is more than two years.
    #[must_use]
    pub const fn microseconds(self, cycles: u64) -> u64 {
        ((cycles as u128 * self.inverse as u128) >> 64) as u64
    }

    /// Converts clock cycles to ms, rounded down.
    #[must_use]
    pub const fn milliseconds(self, cycles: u64) -> u64 {
        cycles / (self.hertz / 1000) as u64
    }

    /// Converts clock cycles to seconds with 32 fraction bits, rounded down, modulo 2^32 seconds.
    #[must_use]
    pub const fn seconds(self, cycles: u64) -> u64 {
        let hertz = self.hertz as u64;
        // The remainder is below 2^28.
        ((cycles / hertz) << 32) + ((cycles % hertz) << 32) / hertz
    }

    /// Converts a duration to clock cycles, rounded up; saturates.
    #[must_use]
    pub const fn cycles(self, span: Duration) -> u64 {
        let hertz = self.hertz as u64;
        // A number of ns below 2^30 times a frequency below 2^28 cannot overflow.
        let part = (span.subsec_nanos() as u64 * hertz).div_ceil(1_000_000_000);
        span.as_secs().saturating_mul(hertz).saturating_add(part)
    }

    /// Converts ns to clock cycles, rounded up. Up to 4 ms the conversion needs no 64-bit division and takes few cycles.
    #[must_use]
    pub const fn cycles_of_nanoseconds(self, nanoseconds: u32) -> u64 {
        match nanoseconds.checked_mul(self.hertz / UNIT) {
            Some(product) => product.div_ceil(1_000_000_000 / UNIT) as u64,
            None => self.cycles(Duration::from_nanos(nanoseconds as u64)),
        }
    }

    /// Converts µs to clock cycles, rounded up.
    #[must_use]
    pub const fn cycles_of_microseconds(self, microseconds: u32) -> u64 {
        (microseconds as u64 * (self.hertz / UNIT) as u64).div_ceil(4)
    }
}

#[cfg(test)]
mod tests {
    use std::string::ToString;

    use super::*;

    /// The lowest and the highest frequency, the boards' frequencies, and a frequency whose number of units is a power of 2.
    const FREQUENCIES: [u32; 6] = [
        1_250_000,
        40_000_000,
        81_250_000,
        100_000_000,
        128_000_000,
        250_000_000,
    ];

    #[test]
    fn cycles_become_microseconds() {
        for hertz in FREQUENCIES {
            let frequency = Frequency::new(hertz).unwrap();
            let exact = |cycles| (u128::from(cycles) * 1_000_000 / u128::from(hertz)) as u64;
            let hour = u64::from(hertz) * 3_600;
            for cycles in [0, 1, hour - 1, hour, (1 << 54) - 1] {
                assert_eq!(frequency.microseconds(cycles), exact(cycles), "{hertz}");
            }
            for turn in 0..1_000_u64 {
                // The last cycle of a microsecond is the first to detect a reciprocal that is too large.
                let cycles = ((turn << 43) + 4) * u64::from(hertz / UNIT) / 4 - 1;
                let cycles = cycles & ((1 << 54) - 1);
                assert_eq!(frequency.microseconds(cycles), exact(cycles), "{hertz}");
            }
        }
    }

    #[test]
    fn cycles_become_seconds() {
        for hertz in FREQUENCIES {
            let frequency = Frequency::new(hertz).unwrap();
            let day = u64::from(hertz) * 86_400;
            for cycles in [0, 1, day - 1, day, u64::from(u32::MAX) + 7, u64::MAX] {
                let exact = (u128::from(cycles) << 32) / u128::from(hertz);
                assert_eq!(frequency.seconds(cycles), exact as u64, "{hertz} {cycles}");
            }
        }
    }

    #[test]
    fn spans_become_cycles() {
        for hertz in FREQUENCIES {
            let frequency = Frequency::new(hertz).unwrap();
            let cycles = |span| frequency.cycles(span);
            assert_eq!(cycles(Duration::from_secs(2)), 2 * u64::from(hertz));
            assert_eq!(cycles(Duration::from_millis(100)), u64::from(hertz / 10));
            assert_eq!(cycles(Duration::from_nanos(1)), 1);
            assert_eq!(cycles(Duration::ZERO), 0);
            assert_eq!(cycles(Duration::MAX), u64::MAX);
            for microseconds in [0, 1, 3, 480, u32::MAX] {
                assert_eq!(
                    frequency.cycles_of_microseconds(microseconds),
                    cycles(Duration::from_micros(microseconds.into()))
                );
            }
            assert_eq!(frequency.milliseconds(u64::from(hertz) * 3_600), 3_600_000);
            for nanoseconds in [0, 1, 2_500, 1_000_000, 4_294_967, 20_000_000, u32::MAX] {
                assert_eq!(
                    frequency.cycles_of_nanoseconds(nanoseconds),
                    frequency.cycles(Duration::from_nanos(nanoseconds.into()))
                );
            }
        }
    }

    #[test]
    fn other_numbers_are_refused() {
        for hertz in [0, 1_000_000, 81_250_001, 83_333_333, 250_250_000, u32::MAX] {
            assert_eq!(Frequency::new(hertz), Err(NotAFrequency(hertz)));
        }
        assert_eq!(
            NotAFrequency(0).to_string(),
            "clock frequency: expected a multiple of 250 kHz from 1250 to 250000 kHz, found 0 Hz"
        );
    }
}
