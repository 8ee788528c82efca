//! A bus with the virtual MPU-6050 that implements the I2C traits of `embedded-hal`.

use std::cell::RefCell;
use std::rc::Rc;

use embedded_hal::i2c::{ErrorKind, ErrorType, NoAcknowledgeSource, Operation};

use virtual_i2c_device::Device;

use crate::chip::{Chip, Fault};

/// Time in ns of a byte and its acknowledge bit at 400 kHz.
const BYTE_TIME: u64 = 9 * 2_500;
/// Longest clock stretching that the master accepts, in ns.
const STRETCH_TIMEOUT: u64 = 25_000_000;
/// Number of clocks that the master sends to free a stuck device.
const RECOVERY_CLOCKS: u32 = 9;

/// Errors of a transfer on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// The chip did not acknowledge a byte.
    NoAcknowledge(NoAcknowledgeSource),
    /// SCL or SDA is stuck low.
    Stuck,
}

impl embedded_hal::i2c::Error for Error {
    fn kind(&self) -> ErrorKind {
        match *self {
            Self::NoAcknowledge(source) => ErrorKind::NoAcknowledge(source),
            Self::Stuck => ErrorKind::Bus,
        }
    }
}

/// An I2C bus with a chip and a simulated time. Transfers and delays advance this time. Clones are handles of the same bus.
#[derive(Clone)]
pub struct Bus {
    shared: Rc<RefCell<Shared>>,
}

struct Shared {
    chip: Chip,
    now: u64,
    register: u8,
    transactions: u64,
}

impl Bus {
    /// Creates a bus with `chip`, at time 0.
    #[must_use]
    pub fn new(chip: Chip) -> Self {
        let shared = Shared {
            chip,
            now: 0,
            register: 0,
            transactions: 0,
        };
        Self {
            shared: Rc::new(RefCell::new(shared)),
        }
    }

    /// Calls `action` with the chip, and returns its result.
    pub fn with_chip<T>(&self, action: impl FnOnce(&mut Chip) -> T) -> T {
        action(&mut self.shared.borrow_mut().chip)
    }

    /// Current time in ns.
    #[must_use]
    pub fn now(&self) -> u64 {
        self.shared.borrow().now
    }

    /// Number of transactions so far, including failed transactions.
    #[must_use]
    pub fn transactions(&self) -> u64 {
        self.shared.borrow().transactions
    }

    /// Advances the time by `time` ns.
    pub fn advance(&self, time: u64) {
        self.shared.borrow_mut().advance(time);
    }
}

impl Shared {
    fn advance(&mut self, time: u64) {
        self.now += time;
        self.chip.advance(self.now);
    }

    fn transaction(&mut self, address: u8, operations: &mut [Operation]) -> Result<(), Error> {
        self.transactions += 1;
        self.require_free()?;
        self.chip.set_addressed(true);
        let result = self.operate(address, operations);
        self.chip.set_addressed(false);
        self.advance(BYTE_TIME / 9);
        result
    }

    /// Checks, as a master does before a start, that SDA is not held low. Otherwise tries to free the bus by sending clocks.
    fn require_free(&mut self) -> Result<(), Error> {
        match self.chip.fault {
            Some(Fault::StuckData(clocks @ 1..=RECOVERY_CLOCKS)) => {
                self.advance(u64::from(clocks) * BYTE_TIME / 9);
                self.chip.fault = None;
                Ok(())
            }
            Some(Fault::StuckData(_)) => {
                self.advance(BYTE_TIME);
                Err(Error::Stuck)
            }
            _ => Ok(()),
        }
    }

    fn operate(&mut self, address: u8, operations: &mut [Operation]) -> Result<(), Error> {
        let mut reading = None;
        // The first byte after the address of a write is the register number. The number and the following values may be in different
        // operations.
        let mut has_register = false;
        for operation in operations {
            let reads = matches!(operation, Operation::Read(_));
            if reading != Some(reads) {
                self.advance_byte()?;
                if !self.chip.answers(address) {
                    return Err(Error::NoAcknowledge(NoAcknowledgeSource::Address));
                }
                (reading, has_register) = (Some(reads), false);
            }
            match operation {
                Operation::Write(bytes) => {
                    for &byte in bytes.iter() {
                        self.advance_byte()?;
                        if self.chip.fault == Some(Fault::NoAcknowledge) {
                            return Err(Error::NoAcknowledge(NoAcknowledgeSource::Data));
                        }
                        if has_register {
                            self.chip.write(self.register, byte);
                            self.register = self.register.wrapping_add(1);
                        } else {
                            (self.register, has_register) = (byte, true);
                        }
                    }
                }
                Operation::Read(buffer) => {
                    for slot in buffer.iter_mut() {
                        self.advance_byte()?;
                        *slot = self.chip.read(self.register);
                        self.register = self.register.wrapping_add(1);
                    }
                }
            }
        }
        Ok(())
    }

    /// Advances the time by the duration of one byte. Fails if the chip stretches the clock for too long.
    fn advance_byte(&mut self) -> Result<(), Error> {
        self.advance(BYTE_TIME);
        match self.chip.fault {
            Some(Fault::Stretched(time)) if time > STRETCH_TIMEOUT => {
                self.advance(STRETCH_TIMEOUT);
                Err(Error::Stuck)
            }
            Some(Fault::Stretched(time)) => {
                self.advance(time);
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

impl ErrorType for Bus {
    type Error = Error;
}

impl embedded_hal::i2c::I2c for Bus {
    fn transaction(&mut self, address: u8, operations: &mut [Operation]) -> Result<(), Error> {
        self.shared.borrow_mut().transaction(address, operations)
    }
}

impl embedded_hal_async::i2c::I2c for Bus {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), Error> {
        self.shared.borrow_mut().transaction(address, operations)
    }
}

impl embedded_hal::delay::DelayNs for Bus {
    fn delay_ns(&mut self, ns: u32) {
        self.advance(ns.into());
    }
}

impl embedded_hal_async::delay::DelayNs for Bus {
    async fn delay_ns(&mut self, ns: u32) {
        self.advance(ns.into());
    }
}
