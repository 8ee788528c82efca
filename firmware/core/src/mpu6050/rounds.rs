//! Transactions at a steady pace.

use embedded_hal_async::i2c::I2c;

/// What is done in each round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Round {
    /// The device.
    pub address: u8,
    /// Written to it.
    pub register: u8,
    /// So many bytes are read then, 1 to 32.
    pub length: u8,
    /// From the start of a round to that of the next, in µs.
    pub period: u32,
    /// So many rounds are told of at once, 1 to 16: until they are over nobody has to do anything.
    pub batch: u8,
}

/// A bus that repeats a transaction by itself. Any other transaction ends that, and so does an error.
pub trait Rounds: I2c {
    /// Begins rounds, the first of them a period from now.
    ///
    /// # Errors
    /// The bus cannot do them.
    fn begin(&mut self, round: Round) -> Result<(), Self::Error>;

    /// Waits for the bytes of the next round, as many as it reads: when it began, in µs.
    ///
    /// # Errors
    /// Something went wrong on the bus, or rounds have not begun, or nobody has asked for so long that there was no room.
    fn next(&mut self, bytes: &mut [u8]) -> impl Future<Output = Result<u64, Self::Error>>;
}
