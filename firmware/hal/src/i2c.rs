//! The I2C master `i2c`, which executes a queue of commands.
//!
//! The bus must have no other master. The master supports 7-bit addresses, 400 kHz and clock stretching. The driver puts
//! a transaction into the queue, and an interrupt reports the end of the transaction: [`embedded_hal_async::i2c::I2c`] yields
//! until then, [`embedded_hal::i2c::I2c`] polls. A device that was interrupted in the middle of a byte may hold SDA low; before
//! each start the master therefore sends clocks until the device releases SDA.
//!
//! Periodic reads ([`PeriodicI2c`], the register `rounds`) are a transaction that the master repeats periodically, with an
//! interrupt after each batch of reads.
//!
//! A future that is dropped before its transaction has ended may leave the bus in the middle of a byte; the next
//! transaction clears the master and begins with a start.
//!
//! # Limits
//! The master does no arbitration: a wire that another device holds low is reported as an error.

use core::fmt;
use core::future::poll_fn;
use core::task::Poll;
use core::time::Duration;

use embedded_hal::i2c::{ErrorKind, ErrorType, NoAcknowledgeSource, Operation, SevenBitAddress};
use glint_i2c::{PeriodicI2c, PeriodicRead};
use litex_pac::i2c::{
    self, Command, Control, Error, EvEnable, EvPending, Operation as Action, Rounds, Status,
};

use crate::timer::{Clock, Deadline, block_on, whole_millis};

/// Longest time without progress before a transaction times out. This exceeds the 25.8 ms of clock stretching after which the
/// master reports `ClockStuck`, and the 1 ms for the 33 bytes of a full queue.
const WAIT: Duration = Duration::from_millis(100);

/// Largest number of bytes received by one command.
const MOST_RECEIVED: usize = 256;

/// Largest number of bytes of a periodic read.
const MOST_IN_READ: usize = 32;

/// The I2C master.
pub struct I2c {
    registers: i2c::I2c,
    /// Whether the gateware has the master.
    is_present: bool,
    clock: Clock,
    /// The timeout [`WAIT`] in clock cycles.
    wait: u64,
    periodic: Option<Periodic>,
}

/// Periodic reads that are in progress.
#[derive(Clone, Copy)]
struct Periodic {
    /// Start time, in clock cycles, of the read whose bytes the driver takes next.
    next: u64,
    /// Number of clock cycles between the starts of two reads.
    period: u64,
}

/// Reason why a transaction failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BusError {
    /// The address has more than 7 bits.
    Address(u8),
    /// The device did not acknowledge its address or a byte of data.
    NoAcknowledge(NoAcknowledgeSource),
    /// SCL was held low longer than a device may stretch it.
    ClockStuck,
    /// SDA was low instead of free, and nine clocks did not release SDA.
    DataStuck,
    /// The transaction made no progress for 100 ms.
    Timeout,
    /// A periodic read had not ended when the next read was due, because the device stretches the clock or the receive queue is
    /// full.
    Late,
    /// The gateware has no I2C master.
    Absent,
    /// The requested periodic reads exceed the master's limits, or no periodic reads have begun.
    Reads,
    /// The master reports an undocumented error code.
    Unknown,
}

impl fmt::Display for BusError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Address(address) => write!(f, "i2c: address {address:#x}: expected at most 0x7f"),
            Self::NoAcknowledge(NoAcknowledgeSource::Address) => {
                f.write_str("i2c: no device acknowledged the address")
            }
            Self::NoAcknowledge(_) => f.write_str("i2c: the device did not acknowledge a byte"),
            Self::ClockStuck => {
                f.write_str("i2c: SCL is held low longer than a device may stretch it")
            }
            Self::DataStuck => f.write_str("i2c: SDA is held low: nine clocks did not release it"),
            Self::Timeout => write!(
                f,
                "i2c: timed out: no progress for {} ms",
                whole_millis(WAIT)
            ),
            Self::Late => f.write_str("i2c: a periodic read was not over when the next read was due"),
            Self::Absent => f.write_str("i2c: this gateware has no master"),
            Self::Reads => f.write_str(
                "i2c: periodic reads: expected 1 to 32 bytes, batch 1 to 16, period below 2^24 cycles",
            ),
            Self::Unknown => f.write_str("i2c: unknown error code of the master"),
        }
    }
}

impl core::error::Error for BusError {}

impl embedded_hal::i2c::Error for BusError {
    fn kind(&self) -> ErrorKind {
        match *self {
            Self::Address(_) | Self::Timeout | Self::Absent | Self::Reads | Self::Unknown => {
                ErrorKind::Other
            }
            Self::Late => ErrorKind::Overrun,
            Self::NoAcknowledge(source) => ErrorKind::NoAcknowledge(source),
            Self::ClockStuck | Self::DataStuck => ErrorKind::Bus,
        }
    }
}

impl I2c {
    /// The driver of the master at `registers`, with SCL and SDA released. The end of each transaction raises an interrupt. If the gateware
    /// has no master, every transaction fails with [`BusError::Absent`].
    #[must_use]
    pub fn new(registers: i2c::I2c, clock: Clock, is_present: bool) -> Self {
        let mut master = Self {
            registers,
            is_present,
            clock,
            wait: clock.frequency().cycles(WAIT),
            periodic: None,
        };
        master.clear();
        master
            .registers
            .ev_enable()
            .write(EvEnable::default().with_ended(true));
        master
    }

    fn clear(&mut self) {
        self.periodic = None;
        self.registers.rounds().write(Rounds::default());
        self.registers
            .control()
            .write(Control::default().with_clear(true));
    }

    /// Reads the status of the master. Returns the error if an error has ended the transaction.
    fn status(&self) -> Result<Status, BusError> {
        let status = self.registers.status().read();
        if !status.failed() {
            return Ok(status);
        }
        Err(match status.error() {
            Some(Error::Address) => BusError::NoAcknowledge(NoAcknowledgeSource::Address),
            Some(Error::Byte) => BusError::NoAcknowledge(NoAcknowledgeSource::Data),
            Some(Error::Clock) => BusError::ClockStuck,
            Some(Error::Data) => BusError::DataStuck,
            Some(Error::Late) => BusError::Late,
            Some(Error::None) | None => BusError::Unknown,
        })
    }

    /// Runs a transaction to its end.
    async fn transact(&mut self, mut transfer: Transfer<'_, '_>) -> Result<(), BusError> {
        if !self.is_present {
            return Err(BusError::Absent);
        }
        // Clears the remains of a transaction whose future was dropped.
        if self.periodic.is_some() || !matches!(self.status(), Ok(status) if !status.busy()) {
            self.clear();
        }
        let mut deadline = None;
        let result = poll_fn(|_| self.serve(&mut transfer, &mut deadline)).await;
        if result.is_err() {
            self.clear();
        }
        result
    }

    /// Moves the bytes of a periodic read from the receive queue to `bytes` until `bytes` is full. `received` is the
    /// number of bytes moved by earlier calls, and is updated.
    fn take(
        &self,
        bytes: &mut [u8],
        received: &mut usize,
        deadline: &mut Option<Deadline>,
    ) -> Poll<Result<(), BusError>> {
        while let Some(slot) = bytes.get_mut(*received) {
            let answer = self.registers.answer().read();
            if !answer.valid() {
                // The receive queue is empty, so all bytes received before an error have been taken: an error is reported now.
                return match (self.status(), &deadline) {
                    (Err(error), _) => Poll::Ready(Err(error)),
                    (_, Some(deadline)) if deadline.passed() => Poll::Ready(Err(BusError::Timeout)),
                    _ => {
                        deadline.get_or_insert_with(|| self.clock.after_cycles(self.wait));
                        Poll::Pending
                    }
                };
            }
            *slot = answer.byte();
            *received += 1;
        }
        Poll::Ready(Ok(()))
    }

    /// Fills the command queue and empties the receive queue. This code runs after interrupts, when it is not in the
    /// instruction cache: one small function for both queues is faster than two functions.
    fn serve(
        &self,
        transfer: &mut Transfer,
        deadline: &mut Option<Deadline>,
    ) -> Poll<Result<(), BusError>> {
        let status = match self.status() {
            Ok(status) => status,
            Err(error) => return Poll::Ready(Err(error)),
        };
        let is_over = transfer.stage == Stage::Over && !status.busy();
        let room = if status.busy() {
            u32::from(status.room())
        } else {
            i2c::I2c::COMMAND_PLACES
        };
        let mut has_moved = false;
        for command in (0..room).map_while(|_| transfer.next_command()) {
            self.registers.command().write(command);
            has_moved = true;
        }
        while let Some(slots) = transfer.slots() {
            let mut received = 0;
            for slot in slots.iter_mut() {
                let answer = self.registers.answer().read();
                if !answer.valid() {
                    break;
                }
                *slot = answer.byte();
                received += 1;
            }
            let is_full = received == slots.len();
            has_moved |= received > 0;
            transfer.received += received;
            if !is_full {
                break;
            }
        }
        if is_over {
            return Poll::Ready(Ok(()));
        }
        match deadline {
            Some(deadline) if !has_moved => {
                if deadline.passed() {
                    return Poll::Ready(Err(BusError::Timeout));
                }
            }
            _ => *deadline = Some(self.clock.after_cycles(self.wait)),
        }
        Poll::Pending
    }
}

/// Kind of the next command of a transaction.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// A command that reads or writes bytes of an operation, or the start before an operation.
    Operations,
    /// The address byte after a start.
    Address,
    /// No further command: the stop is in the queue.
    Over,
}

/// A transaction in progress: commands go into the command queue, received bytes come from the receive queue.
struct Transfer<'o, 'b> {
    address: u8,
    operations: &'o mut [Operation<'b>],
    stage: Stage,
    /// Whether the last start began a read; `None` before the first start.
    reads: Option<bool>,
    /// Index in `operations` of the operation of the next command.
    operation: usize,
    /// Number of bytes of that operation for which a command is already in the queue.
    sent: usize,
    /// Index in `operations` of the read that gets the next received byte.
    receiver: usize,
    /// Number of bytes already received for that read.
    received: usize,
}

impl<'o, 'b> Transfer<'o, 'b> {
    fn new(address: u8, operations: &'o mut [Operation<'b>]) -> Self {
        Self {
            address,
            operations,
            stage: Stage::Operations,
            reads: None,
            operation: 0,
            sent: 0,
            receiver: 0,
            received: 0,
        }
    }

    /// Returns the next command for the command queue; `None` after the stop.
    fn next_command(&mut self) -> Option<Command> {
        match self.stage {
            Stage::Over => return None,
            Stage::Address => {
                self.stage = Stage::Operations;
                let reads = self.reads == Some(true);
                return Some(write(self.address << 1 | u8::from(reads)));
            }
            Stage::Operations => {}
        }
        loop {
            let Some(operation) = self.operations.get(self.operation) else {
                self.stage = Stage::Over;
                return Some(Command::default().with_operation(Action::Stop));
            };
            let (reads, length) = match operation {
                Operation::Read(buffer) => (true, buffer.len()),
                Operation::Write(bytes) => (false, bytes.len()),
            };
            // A read of 0 bytes is impossible, because a device sends a byte after its read address.
            let is_nothing = reads && length == 0;
            if self.reads != Some(reads) && !is_nothing {
                self.reads = Some(reads);
                self.stage = Stage::Address;
                return Some(Command::default().with_operation(Action::Start));
            }
            if self.sent == length {
                self.operation += 1;
                self.sent = 0;
                continue;
            }
            if let Operation::Write(bytes) = operation {
                let byte = bytes.get(self.sent).copied().unwrap_or_default();
                self.sent += 1;
                return Some(write(byte));
            }
            let count = (length - self.sent).min(MOST_RECEIVED);
            self.sent += count;
            let command = Command::default()
                .with_operation(Action::Read)
                // The argument is one less than the number of bytes to receive, 1 to 256.
                .with_argument((count - 1) as u8)
                .with_more(self.sent < length || self.reads_on());
            return Some(command);
        }
    }

    /// Whether the current read continues in a later operation: a read with at least one byte follows before any write.
    fn reads_on(&self) -> bool {
        let rest = self.operations.iter().skip(self.operation + 1);
        rest.map_while(|operation| match operation {
            Operation::Read(buffer) => Some(!buffer.is_empty()),
            Operation::Write(_) => None,
        })
        .any(|has_bytes| has_bytes)
    }

    /// The buffer for the next received bytes; `None` after the last byte of the transaction.
    fn slots(&mut self) -> Option<&mut [u8]> {
        loop {
            let length = match self.operations.get(self.receiver)? {
                Operation::Read(buffer) => buffer.len(),
                Operation::Write(_) => 0,
            };
            if self.received < length {
                break;
            }
            self.receiver += 1;
            self.received = 0;
        }
        match self.operations.get_mut(self.receiver)? {
            Operation::Read(buffer) => buffer.get_mut(self.received..),
            Operation::Write(_) => None,
        }
    }
}

fn write(byte: u8) -> Command {
    Command::default()
        .with_operation(Action::Write)
        .with_argument(byte)
}

/// Clears the master's interrupt, for the interrupt handler.
pub fn acknowledge() {
    // SAFETY: only this function writes the pending register.
    let registers = unsafe { i2c::I2c::steal() };
    registers
        .ev_pending()
        .write(EvPending::default().with_ended(true));
}

impl ErrorType for I2c {
    type Error = BusError;
}

impl embedded_hal_async::i2c::I2c<SevenBitAddress> for I2c {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), BusError> {
        if address > 0x7f {
            return Err(BusError::Address(address));
        }
        self.transact(Transfer::new(address, operations)).await
    }
}

impl embedded_hal::i2c::I2c<SevenBitAddress> for I2c {
    fn transaction(&mut self, address: u8, operations: &mut [Operation]) -> Result<(), BusError> {
        block_on(embedded_hal_async::i2c::I2c::transaction(
            self, address, operations,
        ))
    }
}

impl PeriodicI2c for I2c {
    fn begin(&mut self, read: PeriodicRead) -> Result<(), BusError> {
        self.clear();
        let length = usize::from(read.length);
        let frequency = self.clock.frequency();
        let period = frequency.cycles_of_microseconds(read.period);
        let last_clock = u32::try_from(period)
            .ok()
            .and_then(|period| period.checked_sub(1));
        let last_clock = last_clock.filter(|clock| *clock < 1 << 24);
        let (Some(last_clock), 1..=MOST_IN_READ, 1..=16) = (last_clock, length, read.batch) else {
            return Err(BusError::Reads);
        };
        if read.address > 0x7f {
            return Err(BusError::Address(read.address));
        }
        let rounds = Rounds::default()
            .with_period(last_clock)
            .with_batch(read.batch - 1)
            .with_repeats(true);
        self.registers.rounds().write(rounds);
        self.periodic = Some(Periodic {
            next: self.clock.cycles() + period,
            period,
        });
        // The commands are queued before the first read is due.
        let mut room = [0; MOST_IN_READ];
        let mut operations = [
            Operation::Write(&[read.register]),
            Operation::Read(room.get_mut(..length).unwrap_or_default()),
        ];
        let mut transfer = Transfer::new(read.address, &mut operations);
        while let Some(command) = transfer.next_command() {
            self.registers.command().write(command);
        }
        Ok(())
    }

    async fn next(&mut self, bytes: &mut [u8]) -> Result<u64, BusError> {
        let Some(periodic) = self.periodic else {
            return Err(BusError::Reads);
        };
        let (mut received, mut deadline) = (0, None);
        let result = poll_fn(|_| self.take(bytes, &mut received, &mut deadline)).await;
        if let Err(error) = result {
            self.clear();
            return Err(error);
        }
        self.periodic = Some(Periodic {
            next: periodic.next + periodic.period,
            ..periodic
        });
        Ok(self.clock.frequency().microseconds(periodic.next))
    }
}

#[cfg(test)]
mod tests;
