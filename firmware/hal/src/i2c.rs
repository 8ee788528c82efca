//! An I2C master that moves the two wires itself, bit by bit.
//!
//! Single master, 7-bit addresses, clock stretching up to a time-out. Both wires are open drain: the master pulls them
//! low or lets go. A device that was interrupted in the middle of a byte may hold SDA low for ever;
//! [`I2c::clear_bus`] clocks it free, and each transaction begins with that where it is needed.
//!
//! # Limits
//! No second master: a wire that should be high and is low is an error, not somebody else's turn. The times are at
//! least those asked for; the CPU's own instructions come on top.

use core::fmt;
use core::time::Duration;

use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::{ErrorKind, ErrorType, NoAcknowledgeSource, Operation, SevenBitAddress};
use litex_pac::i2c::{self, W};

use crate::timer::Clock;

/// How long a device may stretch the clock: as long as SMBus lets it.
const STRETCH: Duration = Duration::from_millis(25);

/// How the wires are moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    half_period_ns: u32,
}

impl Config {
    /// Standard mode, at most 100 kHz.
    pub const STANDARD: Self = Self {
        half_period_ns: 5_000,
    };
    /// Fast mode, at most 400 kHz: SCL is low for 1.3 µs and high for as long.
    pub const FAST: Self = Self {
        half_period_ns: 1_300,
    };
}

/// The master.
pub struct I2c {
    registers: i2c::I2c,
    clock: Clock,
    config: Config,
}

/// What went wrong on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// The address has more than 7 bits.
    Address(u8),
    /// Nobody acknowledged.
    NoAcknowledge(NoAcknowledgeSource),
    /// SCL was held low longer than a device may stretch it.
    ClockStuck,
    /// SDA was low where it should have been free, and nine clocks did not free it.
    DataStuck,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Address(address) => write!(f, "i2c: address {address:#x}: expected at most 0x7f"),
            Self::NoAcknowledge(NoAcknowledgeSource::Address) => {
                f.write_str("i2c: no device acknowledged the address")
            }
            Self::NoAcknowledge(_) => f.write_str("i2c: the device did not acknowledge a byte"),
            Self::ClockStuck => write!(f, "i2c: SCL was held low for {} ms", STRETCH.as_millis()),
            Self::DataStuck => f.write_str("i2c: SDA is held low and nine clocks did not free it"),
        }
    }
}

impl core::error::Error for Error {}

impl embedded_hal::i2c::Error for Error {
    fn kind(&self) -> ErrorKind {
        match *self {
            Self::Address(_) => ErrorKind::Other,
            Self::NoAcknowledge(source) => ErrorKind::NoAcknowledge(source),
            Self::ClockStuck | Self::DataStuck => ErrorKind::Bus,
        }
    }
}

impl I2c {
    /// A master on `registers`; both wires are let go.
    #[must_use]
    pub fn new(registers: i2c::I2c, clock: Clock, config: Config) -> Self {
        let mut master = Self {
            registers,
            clock,
            config,
        };
        master.wires(true, true);
        master
    }

    /// Clocks SCL until whoever holds SDA lets go of it, at most nine times, and ends with a stop.
    ///
    /// # Errors
    /// When a wire stays low.
    pub fn clear_bus(&mut self) -> Result<(), Error> {
        self.wires(true, true);
        for _ in 0..9 {
            if self.registers.r().read().sda() {
                break;
            }
            self.wires(false, true);
            self.release_clock(true)?;
        }
        self.stop()?;
        if self.registers.r().read().sda() {
            Ok(())
        } else {
            Err(Error::DataStuck)
        }
    }

    /// Pulls each wire low or, where it is to be high, lets go of it, and waits half a period.
    fn wires(&mut self, scl: bool, sda: bool) {
        self.registers
            .w()
            .write(W::default().with_oe(true).with_scl(scl).with_sda(sda));
        self.clock.delay_ns(self.config.half_period_ns);
    }

    /// Lets go of SCL and waits until it is high, which a device may delay, and half a period more.
    fn release_clock(&mut self, sda: bool) -> Result<(), Error> {
        let deadline = self.clock.after(STRETCH);
        self.wires(true, sda);
        if self.registers.r().read().scl() {
            return Ok(());
        }
        while !self.registers.r().read().scl() {
            if deadline.passed() {
                return Err(Error::ClockStuck);
            }
        }
        self.clock.delay_ns(self.config.half_period_ns);
        Ok(())
    }

    /// A start, or in the middle of a transaction a repeated start. Leaves SCL low.
    fn start(&mut self) -> Result<(), Error> {
        self.release_clock(true)?;
        self.wires(true, false);
        self.wires(false, false);
        Ok(())
    }

    fn stop(&mut self) -> Result<(), Error> {
        self.wires(false, false);
        self.release_clock(false)?;
        self.wires(true, true);
        Ok(())
    }

    /// One clock with SDA as given; what SDA was while SCL was high.
    fn bit(&mut self, sda: bool) -> Result<bool, Error> {
        self.wires(false, sda);
        self.release_clock(sda)?;
        let sampled = self.registers.r().read().sda();
        self.wires(false, sda);
        Ok(sampled)
    }

    /// Sends a byte; whether it was acknowledged.
    fn send(&mut self, byte: u8) -> Result<bool, Error> {
        for place in (0..8).rev() {
            self.bit(byte >> place & 1 != 0)?;
        }
        self.bit(true).map(|high| !high)
    }

    /// Receives a byte and acknowledges it unless it is the `last`.
    fn receive(&mut self, last: bool) -> Result<u8, Error> {
        let mut byte = 0;
        for _ in 0..8 {
            byte = byte << 1 | u8::from(self.bit(true)?);
        }
        self.bit(last)?;
        Ok(byte)
    }

    fn address(&mut self, address: u8, read: bool) -> Result<(), Error> {
        self.start()?;
        if self.send(address << 1 | u8::from(read))? {
            Ok(())
        } else {
            Err(Error::NoAcknowledge(NoAcknowledgeSource::Address))
        }
    }

    /// All of a transaction between the free bus and the stop.
    fn operate(&mut self, address: u8, operations: &mut [Operation]) -> Result<(), Error> {
        let mut direction = None;
        let mut rest = operations.iter_mut().peekable();
        while let Some(operation) = rest.next() {
            let read = matches!(operation, Operation::Read(_));
            if direction != Some(read) {
                self.address(address, read)?;
                direction = Some(read);
            }
            match operation {
                Operation::Write(bytes) => {
                    for byte in bytes.iter() {
                        if !self.send(*byte)? {
                            return Err(Error::NoAcknowledge(NoAcknowledgeSource::Data));
                        }
                    }
                }
                Operation::Read(buffer) => {
                    let turns = !matches!(rest.peek(), Some(Operation::Read(_)));
                    let count = buffer.len();
                    for (index, slot) in buffer.iter_mut().enumerate() {
                        *slot = self.receive(turns && index + 1 == count)?;
                    }
                }
            }
        }
        Ok(())
    }
}

impl ErrorType for I2c {
    type Error = Error;
}

impl embedded_hal::i2c::I2c<SevenBitAddress> for I2c {
    fn transaction(&mut self, address: u8, operations: &mut [Operation]) -> Result<(), Error> {
        if address > 0x7f {
            return Err(Error::Address(address));
        }
        if !self.registers.r().read().sda() {
            self.clear_bus()?;
        }
        let result = self.operate(address, operations);
        // The first error is the one that tells; the bus is freed in any case.
        result.and(self.stop())
    }
}

#[cfg(test)]
mod tests;
