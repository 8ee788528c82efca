//! Periodic I2C reads: the interface between the drivers of sensors and a bus that repeats a read.

use embedded_hal_async::i2c::I2c;

/// A periodic register read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PeriodicRead {
    /// Address of the device.
    pub address: u8,
    /// Number of the first register to read; it is written to the device before each read.
    pub register: u8,
    /// Number of bytes in one read, 1 to 32.
    pub length: u8,
    /// Time from the start of a read to the start of the next read, in µs.
    pub period: u32,
    /// Number of reads after which the bus interrupts the processor, 1 to 16.
    pub batch: u8,
}

/// A bus that repeats a read periodically until another transaction or an error.
pub trait PeriodicI2c: I2c {
    /// Begins to repeat `read`; the first read starts one period from now.
    ///
    /// # Errors
    /// The bus does not support this read.
    fn begin(&mut self, read: PeriodicRead) -> Result<(), Self::Error>;

    /// Waits for the bytes of the next read, fills `bytes` with them, and returns the time at which the read started, in µs.
    ///
    /// # Errors
    /// The bus reports an error, no read is being repeated, or the queue of reads overflowed.
    fn next(&mut self, bytes: &mut [u8]) -> impl Future<Output = Result<u64, Self::Error>>;
}
