//! The I2C master `i2c`, which works off a queue of commands by itself.
//!
//! Single master, 7-bit addresses, 400 kHz, clock stretching. A transaction is put into the queue, and the master says when it has ended:
//! [`embedded_hal_async::i2c::I2c`] leaves the CPU to others meanwhile, [`embedded_hal::i2c::I2c`] waits. A device that was
//! interrupted in the middle of a byte may hold SDA low for ever; each start clocks it free where it is needed.
//!
//! Rounds ([`Rounds`]) are the same transaction at a steady pace, which the master keeps by itself; an interrupt tells of several.
//!
//! A future that is dropped before its transaction has ended leaves the bus within a byte; the next transaction begins with a
//! start all the same.
//!
//! # Limits
//! No second master: a wire that should be high and is low is an error, not somebody else's turn.

use core::fmt;
use core::future::{Future, poll_fn};
use core::pin::pin;
use core::task::{Context, Poll, Waker};
use core::time::Duration;

use embedded_hal::i2c::{ErrorKind, ErrorType, NoAcknowledgeSource, Operation, SevenBitAddress};
use glint_core::mpu6050::{Round, Rounds};
use litex_pac::i2c::{self, Command, Control, EvEnable, EvPending, Rounds as Repeat, Status};

use crate::timer::{Clock, Deadline, cycles, microseconds};

/// The longest wait for the master to go on. It gives a device up that stretches the clock for more than 25.8 ms, and of 33 bytes between
/// two looks each takes 0.03 ms.
const WAIT: Duration = Duration::from_millis(100);
const WAIT_CYCLES: u64 = cycles(WAIT);

/// Places in the queue of commands.
const PLACES: u32 = 33;

/// The most bytes that one command receives.
const MOST_RECEIVED: usize = 256;

/// The most bytes that a round receives.
const MOST_IN_ROUND: usize = 32;

/// The master.
pub struct I2c {
    registers: i2c::I2c,
    clock: Clock,
    rounds: Option<Going>,
}

/// Rounds that are going on.
#[derive(Clone, Copy)]
struct Going {
    /// When the next one that is asked for begins, and from one to the next, in clock cycles.
    next: u64,
    period: u64,
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
    /// The master did not go on.
    Timeout,
    /// A round was not over when the next one was due: the device stretches the clock, or nobody has taken what was received.
    Late,
    /// Rounds that the master cannot do: of 0 or more than 32 bytes, too long a period, or none have begun.
    Rounds,
}

impl fmt::Display for Error {
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
                "i2c: the master did not go on for {} ms",
                WAIT.as_millis()
            ),
            Self::Late => f.write_str("i2c: a round was not over when the next one was due"),
            Self::Rounds => f.write_str("i2c: these rounds cannot be done"),
        }
    }
}

impl core::error::Error for Error {}

impl embedded_hal::i2c::Error for Error {
    fn kind(&self) -> ErrorKind {
        match *self {
            Self::Address(_) | Self::Timeout | Self::Rounds => ErrorKind::Other,
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
            rounds: None,
        };
        master.clear();
        master
            .registers
            .ev_enable()
            .write(EvEnable::default().with_ended(true));
        master
    }

    fn clear(&mut self) {
        self.rounds = None;
        self.registers.rounds().write(Repeat::default());
        self.registers
            .control()
            .write(Control::default().with_clear(true));
    }

    /// How it stands.
    fn status(&self) -> Result<Status, Error> {
        let status = self.registers.status().read();
        if !status.failed() {
            return Ok(status);
        }
        Err(match status.error() {
            1 => Error::NoAcknowledge(NoAcknowledgeSource::Address),
            2 => Error::NoAcknowledge(NoAcknowledgeSource::Data),
            3 => Error::ClockStuck,
            4 => Error::DataStuck,
            _ => Error::Late,
        })
    }

    /// All of a transaction.
    async fn transact(&mut self, mut transfer: Transfer<'_, '_>) -> Result<(), Error> {
        // What is left of one that was dropped.
        if self.rounds.is_some() || !matches!(self.status(), Ok(status) if !status.busy()) {
            self.clear();
        }
        let mut deadline = None;
        let result = poll_fn(|_| self.serve(&mut transfer, &mut deadline)).await;
        if result.is_err() {
            self.clear();
        }
        result
    }

    /// Takes a round's bytes, behind those that have been received.
    fn take(
        &self,
        bytes: &mut [u8],
        received: &mut usize,
        deadline: &mut Option<Deadline>,
    ) -> Poll<Result<(), Error>> {
        while let Some(slot) = bytes.get_mut(*received) {
            let answer = self.registers.answer().read();
            if !answer.valid() {
                // What was received before an error has been taken.
                return match (self.status(), &deadline) {
                    (Err(error), _) => Poll::Ready(Err(error)),
                    (_, Some(deadline)) if deadline.passed() => Poll::Ready(Err(Error::Timeout)),
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

    /// Puts commands into the queue, as there is room, and takes what has been received. One function for both: it runs in interrupts,
    /// and the less code it has the less has to come from memory.
    fn serve(
        &self,
        transfer: &mut Transfer,
        deadline: &mut Option<Deadline>,
    ) -> Poll<Result<(), Error>> {
        let status = match self.status() {
            Ok(status) => status,
            Err(error) => return Poll::Ready(Err(error)),
        };
        let is_over = transfer.stage == Stage::Over && !status.busy();
        let room = if status.busy() {
            u32::from(status.room())
        } else {
            PLACES
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
                    return Poll::Ready(Err(Error::Timeout));
                }
            }
            _ => *deadline = Some(self.clock.after_cycles(WAIT_CYCLES)),
        }
        Poll::Pending
    }
}

/// What comes next of a transaction.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// Operations, or a start before them.
    Operations,
    /// The address after a start.
    Address,
    /// Nothing: the stop is in the queue.
    Over,
}

/// A transaction on its way: commands that go into the queue, and bytes that come out of the other.
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
                return Some(Command::default().with_operation(STOP));
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
                return Some(Command::default().with_operation(START));
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
                .with_operation(READ)
                // 1 to 256 bytes.
                .with_argument((count - 1) as u8)
                .with_more(self.sent < length || self.reads_on());
            return Some(command);
        }
    }

    /// Whether the next operation that does anything reads as this one.
    fn reads_on(&self) -> bool {
        let rest = self.operations.iter().skip(self.operation + 1);
        rest.map_while(|operation| match operation {
            Operation::Read(buffer) => Some(!buffer.is_empty()),
            Operation::Write(_) => None,
        })
        .any(|has_bytes| has_bytes)
    }

    /// Where the next bytes go; none when all are there.
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

/// What a command does: its field `operation`.
const START: u8 = 0;
const WRITE: u8 = 1;
const READ: u8 = 2;
const STOP: u8 = 3;

fn write(byte: u8) -> Command {
    Command::default().with_operation(WRITE).with_argument(byte)
}

/// Clears the master's interrupt; its handler calls this.
pub fn acknowledge() {
    // SAFETY: nobody else writes the pending register.
    let registers = unsafe { i2c::I2c::steal() };
    registers
        .ev_pending()
        .write(EvPending::default().with_ended(true));
}

impl ErrorType for I2c {
    type Error = Error;
}

impl embedded_hal_async::i2c::I2c<SevenBitAddress> for I2c {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), Error> {
        if address > 0x7f {
            return Err(Error::Address(address));
        }
        self.transact(Transfer::new(address, operations)).await
    }
}

impl embedded_hal::i2c::I2c<SevenBitAddress> for I2c {
    fn transaction(&mut self, address: u8, operations: &mut [Operation]) -> Result<(), Error> {
        block_on(embedded_hal_async::i2c::I2c::transaction(
            self, address, operations,
        ))
    }
}

impl Rounds for I2c {
    fn begin(&mut self, round: Round) -> Result<(), Error> {
        self.clear();
        let length = usize::from(round.length);
        let period = cycles(Duration::from_micros(round.period.into()));
        let last_clock = u32::try_from(period)
            .ok()
            .and_then(|period| period.checked_sub(1));
        let last_clock = last_clock.filter(|clock| *clock < 1 << 24);
        let (Some(last_clock), 1..=MOST_IN_ROUND, 1..=16) = (last_clock, length, round.batch)
        else {
            return Err(Error::Rounds);
        };
        if round.address > 0x7f {
            return Err(Error::Address(round.address));
        }
        let repeat = Repeat::default()
            .with_period(last_clock)
            .with_batch(round.batch - 1)
            .with_repeats(true);
        self.registers.rounds().write(repeat);
        self.rounds = Some(Going {
            next: self.clock.cycles() + period,
            period,
        });
        // They are in the queue before the first round is due.
        let mut room = [0; MOST_IN_ROUND];
        let mut operations = [
            Operation::Write(&[round.register]),
            Operation::Read(room.get_mut(..length).unwrap_or_default()),
        ];
        let mut transfer = Transfer::new(round.address, &mut operations);
        while let Some(command) = transfer.next_command() {
            self.registers.command().write(command);
        }
        Ok(())
    }

    async fn next(&mut self, bytes: &mut [u8]) -> Result<u64, Error> {
        let Some(going) = self.rounds else {
            return Err(Error::Rounds);
        };
        let (mut received, mut deadline) = (0, None);
        let result = poll_fn(|_| self.take(bytes, &mut received, &mut deadline)).await;
        if let Err(error) = result {
            self.clear();
            return Err(error);
        }
        self.rounds = Some(Going {
            next: going.next + going.period,
            ..going
        });
        Ok(microseconds(going.next))
    }
}

/// Waits for what nobody else has to do anything for.
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
