//! A bit-banged I2C bus.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::{
    ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation, SevenBitAddress,
};

/// The wires SCL and SDA. Pull-ups hold them high while they are released.
pub trait Wires {
    /// Releases a wire (`true`) or pulls it low (`false`).
    fn set(&mut self, scl: bool, sda: bool);

    /// Whether SDA is high.
    fn sda(&mut self) -> bool;
}

/// A quarter of the clock period of SCL in ns, for 100 kHz, which every chip supports.
const QUARTER: u32 = 2_500;

/// A device did not acknowledge its address or a byte of data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoAcknowledge(pub NoAcknowledgeSource);

impl core::fmt::Display for NoAcknowledge {
    fn fmt(&self, f: &mut core::fmt::Formatter) -> core::fmt::Result {
        f.write_str(match self.0 {
            NoAcknowledgeSource::Address => "no device acknowledged the address",
            _ => "the device did not acknowledge a byte",
        })
    }
}

impl core::error::Error for NoAcknowledge {}

impl embedded_hal_async::i2c::Error for NoAcknowledge {
    fn kind(&self) -> ErrorKind {
        ErrorKind::NoAcknowledge(self.0)
    }
}

/// A bit-banged I2C bus on two [`Wires`], of at most 100 kHz. Devices must not stretch the clock; SCCB chips never do.
pub struct TwoWires<W, D> {
    wires: W,
    delay: D,
}

impl<W: Wires, D: DelayNs> TwoWires<W, D> {
    /// Makes a bus; `delay` determines the timing of its clock.
    pub const fn new(wires: W, delay: D) -> Self {
        Self { wires, delay }
    }

    /// Sets the wires and waits a quarter of a clock period.
    async fn set(&mut self, scl: bool, sda: bool) {
        self.wires.set(scl, sda);
        self.delay.delay_ns(QUARTER).await;
    }

    /// Sends a start, or a repeated start: SDA falls while SCL is high.
    async fn start(&mut self) {
        self.set(false, true).await;
        self.set(true, true).await;
        self.set(true, false).await;
        self.set(false, false).await;
    }

    /// Sends a stop: SDA rises while SCL is high.
    async fn stop(&mut self) {
        self.set(false, false).await;
        self.set(true, false).await;
        self.set(true, true).await;
    }

    /// Sends a bit (`true` releases SDA) and returns the bit on the wire.
    async fn bit(&mut self, bit: bool) -> bool {
        self.set(false, bit).await;
        self.set(true, bit).await;
        let found = self.wires.sda();
        self.set(true, bit).await;
        self.set(false, bit).await;
        found
    }

    /// Sends a byte, the highest bit first.
    async fn send(&mut self, byte: u8, source: NoAcknowledgeSource) -> Result<(), NoAcknowledge> {
        for place in (0..8).rev() {
            self.bit(byte >> place & 1 != 0).await;
        }
        if self.bit(true).await {
            return Err(NoAcknowledge(source));
        }
        Ok(())
    }

    /// Receives a byte, and acknowledges it unless it is the last byte.
    async fn receive(&mut self, is_last: bool) -> u8 {
        let mut byte = 0;
        for _ in 0..8 {
            byte = byte << 1 | u8::from(self.bit(true).await);
        }
        self.bit(is_last).await;
        byte
    }

    async fn operate(
        &mut self,
        address: SevenBitAddress,
        operations: &mut [Operation<'_>],
    ) -> Result<(), NoAcknowledge> {
        let mut reads = None;
        let mut operations = operations.iter_mut().peekable();
        while let Some(operation) = operations.next() {
            let is_read = matches!(operation, Operation::Read(_));
            if reads.replace(is_read) != Some(is_read) {
                self.start().await;
                let first = address << 1 | u8::from(is_read);
                self.send(first, NoAcknowledgeSource::Address).await?;
            }
            match operation {
                Operation::Write(bytes) => {
                    for &byte in bytes.iter() {
                        self.send(byte, NoAcknowledgeSource::Data).await?;
                    }
                }
                Operation::Read(bytes) => {
                    // If the next operation is also a read, the device continues to send.
                    let ends = !matches!(operations.peek(), Some(Operation::Read(_)));
                    let length = bytes.len();
                    for (place, byte) in bytes.iter_mut().enumerate() {
                        *byte = self.receive(ends && place + 1 == length).await;
                    }
                }
            }
        }
        Ok(())
    }
}

impl<W, D> ErrorType for TwoWires<W, D> {
    type Error = NoAcknowledge;
}

impl<W: Wires, D: DelayNs> I2c for TwoWires<W, D> {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), Self::Error> {
        let result = self.operate(address, operations).await;
        self.stop().await;
        result
    }
}
