//! The I2C master `i2c`, which works off a queue of commands by itself.
//!
//! Single master, 7-bit addresses, 400 kHz, clock stretching. A transaction is put into the queue, and an interrupt reports its end:
//! [`embedded_hal_async::i2c::I2c`] yields the CPU meanwhile, [`embedded_hal::i2c::I2c`] polls. A device that was
//! interrupted in the middle of a byte may hold SDA low; each start clocks it free where necessary.
//!
//! Periodic reads ([`PeriodicI2c`], the register `rounds`) are one transaction at a steady pace, which the master keeps by itself. It
//! raises an interrupt after each batch of them.
//!
//! A future that is dropped before its transaction has ended may leave the bus within a byte; the next transaction clears the
//! master and begins with a start.
//!
//! # Limits
//! Single master only: a wire that should be high and is low is an error, not arbitration.

use core::fmt;
use core::future::{Future, poll_fn};
use core::pin::pin;
use core::task::{Context, Poll, Waker};
use core::time::Duration;

use embedded_hal::i2c::{ErrorKind, ErrorType, NoAcknowledgeSource, Operation, SevenBitAddress};
use glint_core::i2c::{PeriodicI2c, PeriodicRead};
use litex_pac::i2c::{
    self, Command, Control, Error, EvEnable, EvPending, Operation as Action, Rounds, Status,
};

use crate::timer::{Clock, Deadline, cycles, microseconds};

/// Longest time without progress. The master itself gives up a device that stretches the clock for more than 25.8 ms, and the 33
/// bytes of a full queue take 1 ms.
const WAIT: Duration = Duration::from_millis(100);
const WAIT_CYCLES: u64 = cycles(WAIT);

/// Most bytes that one command receives.
const MOST_RECEIVED: usize = 256;

/// Most bytes of a periodic read.
const MOST_IN_READ: usize = 32;

/// The I2C master.
pub struct I2c {
    registers: i2c::I2c,
    clock: Clock,
    periodic: Option<Periodic>,
}

/// Periodic reads under way.
#[derive(Clone, Copy)]
struct Periodic {
    /// Start of the read that is taken next, and time between two starts, in clock cycles.
    next: u64,
    period: u64,
}

/// Why a transaction has failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BusError {
    /// The address has more than 7 bits.
    Address(u8),
    /// The address or a byte was not acknowledged.
    NoAcknowledge(NoAcknowledgeSource),
    /// SCL was held low longer than a device may stretch it.
    ClockStuck,
    /// SDA was low where it should have been free, and nine clocks did not free it.
    DataStuck,
    /// No progress for 100 ms.
    Timeout,
    /// A periodic read was not over when the next one was due: the device stretches the clock, or the queue of received bytes is full.
    Late,
    /// Periodic reads beyond the master's limits, or none have begun.
    Reads,
    /// The master reports an error that its description does not name.
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
            Self::DataStuck => f.write_str("i2c: SDA is held low and nine clocks did not free it"),
            Self::Timeout => write!(
                f,
                "i2c: timed out: no progress for {} ms",
                WAIT.as_millis()
            ),
            Self::Late => f.write_str("i2c: a periodic read was not over when the next one was due"),
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
            Self::Address(_) | Self::Timeout | Self::Reads | Self::Unknown => ErrorKind::Other,
            Self::Late => ErrorKind::Overrun,
            Self::NoAcknowledge(source) => ErrorKind::NoAcknowledge(source),
            Self::ClockStuck | Self::DataStuck => ErrorKind::Bus,
        }
    }
}

impl I2c {
    /// A master on `registers`; both wires are let go. The end of each transaction is an interrupt.
    #[must_use]
    pub fn new(registers: i2c::I2c, clock: Clock) -> Self {
        let mut master = Self {
            registers,
            clock,
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

    /// The status, or the error that has ended the transaction.
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
        // The remains of a transaction whose future was dropped.
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

    /// Takes the bytes of a periodic read, behind those that have been received.
    fn take(
        &self,
        bytes: &mut [u8],
        received: &mut usize,
        deadline: &mut Option<Deadline>,
    ) -> Poll<Result<(), BusError>> {
        while let Some(slot) = bytes.get_mut(*received) {
            let answer = self.registers.answer().read();
            if !answer.valid() {
                // What was received before an error has been taken.
                return match (self.status(), &deadline) {
                    (Err(error), _) => Poll::Ready(Err(error)),
                    (_, Some(deadline)) if deadline.passed() => Poll::Ready(Err(BusError::Timeout)),
                    _ => {
                        deadline.get_or_insert_with(|| self.clock.after_cycles(WAIT_CYCLES));
                        Poll::Pending
                    }
                };
            }
            *slot = answer.byte();
            *received += 1;
        }
        Poll::Ready(Ok(()))
    }

    /// Fills the queue of commands and empties the queue of received bytes. One function for both: it runs in interrupts, where code
    /// has to come from memory, so less code is faster.
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
            _ => *deadline = Some(self.clock.after_cycles(WAIT_CYCLES)),
        }
        Poll::Pending
    }
}

/// Next part of a transaction.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// Operations, or a start before them.
    Operations,
    /// The address after a start.
    Address,
    /// Nothing: the stop is in the queue.
    Over,
}

/// A transaction under way: its commands go into one queue, its bytes come out of the other.
struct Transfer<'o, 'b> {
    address: u8,
    operations: &'o mut [Operation<'b>],
    stage: Stage,
    /// Whether what was started last reads.
    reads: Option<bool>,
    /// The operation whose commands come next, and how many of its bytes have theirs.
    operation: usize,
    sent: usize,
    /// The operation whose bytes come next, and how many it has.
    receiver: usize,
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

    /// The next command; none after the stop.
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
            // A device cannot be asked for nothing: after its address it sends.
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
                // 1 to 256 bytes.
                .with_argument((count - 1) as u8)
                .with_more(self.sent < length || self.reads_on());
            return Some(command);
        }
    }

    /// Whether the next operation that is not empty is a read.
    fn reads_on(&self) -> bool {
        let rest = self.operations.iter().skip(self.operation + 1);
        rest.map_while(|operation| match operation {
            Operation::Read(buffer) => Some(!buffer.is_empty()),
            Operation::Write(_) => None,
        })
        .any(|has_bytes| has_bytes)
    }

    /// Place of the next bytes; `None` when all are there.
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

/// Clears the master's interrupt; its handler calls this.
pub fn acknowledge() {
    // SAFETY: the pending register is written here only.
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
        let period = cycles(Duration::from_micros(read.period.into()));
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
        // The commands are in the queue before the first read is due.
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
        Ok(microseconds(periodic.next))
    }
}

/// Polls a future that needs no other task.
fn block_on<T>(future: impl Future<Output = T>) -> T {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(output) = future.as_mut().poll(&mut context) {
            return output;
        }
    }
}

#[cfg(test)]
mod tests;
