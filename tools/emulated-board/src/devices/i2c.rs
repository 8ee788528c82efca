//! The I2C master, which generates each edge on the bus of a virtual sensor. The master has the states of gateware/rtl/i2c/i2c_engine.sv.

use std::collections::VecDeque;

use litex_pac::constants::CONFIG_CLOCK_FREQUENCY;
use litex_pac::i2c::{
    Answer, Command, Control, Error, I2c as Block, Operation, Rounds, Status, offset,
};
use litex_pac::register::Value;
use virtual_mpu6050::Wires;

use crate::{Device, Events, MainMemory, nanoseconds};

/// Bit of the event in the event registers.
const ENDED: u32 = 1;

/// Number of cycles of a phase, a third of a bit at 400 kHz.
const PHASE: u64 = (CONFIG_CLOCK_FREQUENCY as u64).div_ceil(3 * 400_000);
/// Number of cycles until a rise of SCL passes the spike filter.
const FILTER: u64 = 7;
/// Number of cycles between two samples of SCL while a device holds it low.
const POLL_CYCLES: u64 = 16;
/// Maximum number of cycles that a device may hold SCL low.
const STRETCH: u64 = 1 << 21;
/// Index of the clock of the acknowledge bit in a byte.
const LAST_CLOCK: u32 = 8;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Idle,
    Held,
    Set,
    High,
    Low,
    Fall,
    Rise,
    Free,
    Failed,
}

/// The I2C master.
pub struct I2c {
    /// The sensor on the bus, if any.
    pub sensor: Option<Wires>,
    /// Last written values of the registers `command` and `control`.
    command: u32,
    control: u32,
    commands: VecDeque<Command>,
    answers: VecDeque<u8>,
    rounds: Rounds,
    state: State,
    /// Cycle in which the phase ends; `u64::MAX` in a state that waits.
    until: u64,
    /// Cycle in which the master released SCL, in a phase with SCL high.
    released: u64,
    /// Whether a device held SCL low at the last sample.
    stretched: bool,
    /// Cycle in which the next round begins.
    round: u64,
    rounds_done: u8,
    error: Error,
    scl: bool,
    sda: bool,
    shift: u16,
    clocks: u32,
    bytes: u8,
    addressing: bool,
    events: Events,
}

impl I2c {
    /// The master after a reset, without a sensor.
    pub fn new() -> Self {
        Self {
            sensor: None,
            command: 0,
            control: 0,
            commands: VecDeque::new(),
            answers: VecDeque::new(),
            rounds: Rounds::default(),
            state: State::Idle,
            until: u64::MAX,
            released: 0,
            stretched: false,
            round: u64::MAX,
            rounds_done: 0,
            error: Error::None,
            scl: true,
            sda: true,
            shift: 0,
            clocks: 0,
            bytes: 0,
            addressing: false,
            events: Events::default(),
        }
    }

    /// Resets the master; the sensor stays.
    pub fn reset(&mut self) {
        let sensor = self.sensor.take();
        *self = Self {
            sensor,
            ..Self::new()
        };
    }

    /// Levels of SCL and SDA.
    fn wires(&mut self, now: u64) -> (bool, bool) {
        match &mut self.sensor {
            Some(sensor) => sensor.update(nanoseconds(now), self.scl, self.sda),
            None => (self.scl, self.sda),
        }
    }

    fn clear(&mut self, now: u64) {
        self.commands.clear();
        self.answers.clear();
        self.state = State::Idle;
        self.until = u64::MAX;
        self.error = Error::None;
        self.bytes = 0;
        (self.scl, self.sda) = (true, true);
        self.wires(now);
    }

    fn fail(&mut self, error: Error) {
        self.error = error;
        (self.scl, self.sda) = (true, true);
        self.state = State::Failed;
        self.until = u64::MAX;
        self.events.raise(ENDED);
    }

    fn enter(&mut self, state: State, now: u64) {
        self.state = state;
        self.until = now + PHASE;
    }

    /// The operation of the current command, or a stop after an error.
    fn operation(&self) -> Option<Operation> {
        if self.error != Error::None {
            return Some(Operation::Stop);
        }
        self.commands.front().map(|command| command.operation())
    }

    fn is_last_byte(&self, command: Command) -> bool {
        command.operation() != Operation::Read || self.bytes == command.argument()
    }

    /// Removes the current command from the queue. While rounds are repeated, appends it to the end of the queue.
    fn take(&mut self) {
        if let Some(command) = self.commands.pop_front()
            && self.rounds.repeats()
        {
            self.commands.push_back(command);
        }
    }

    /// Leaves a waiting state if the next operation can begin.
    fn begin(&mut self, now: u64, due: bool) {
        let room = self.answers.len() < Block::ANSWER_PLACES as usize;
        let Some(operation) = self.operation() else {
            return;
        };
        let command = self.commands.front().copied().unwrap_or_default();
        self.clocks = 0;
        self.shift = if command.operation() == Operation::Write {
            u16::from(command.argument()) << 1 | 1
        } else {
            0x1fe | u16::from(self.is_last_byte(command) && !command.more())
        };
        if self.state == State::Idle && operation == Operation::Start {
            if due || !self.rounds.repeats() {
                self.released = now;
                self.enter(State::High, now);
            }
        } else if operation != Operation::Read || room {
            self.scl = false;
            self.sda = match operation {
                Operation::Start => true,
                Operation::Stop => false,
                Operation::Read => true,
                Operation::Write => command.argument() & 0x80 != 0,
            };
            self.enter(State::Set, now);
        }
    }

    /// Ends the current phase.
    fn step(&mut self, now: u64) {
        let (scl, sda) = self.wires(now);
        if self.scl && !scl {
            // A device stretches the clock. The phase starts when SCL is high.
            if now - self.released > STRETCH {
                self.fail(Error::Clock);
            } else {
                self.until = now + POLL_CYCLES;
                self.stretched = true;
            }
            return;
        }
        if std::mem::take(&mut self.stretched) {
            self.until = now + FILTER + PHASE;
            return;
        }
        let Some(operation) = self.operation() else {
            // The queue has been cleared during the phase.
            self.state = State::Idle;
            self.until = u64::MAX;
            return;
        };
        let command = self.commands.front().copied().unwrap_or_default();
        match self.state {
            State::Idle | State::Held | State::Failed => {}
            State::Set => {
                self.scl = true;
                self.released = now;
                self.enter(State::High, now + FILTER);
            }
            State::High => self.sample(now, operation, command, sda),
            State::Low => self.shift_out(now, operation, command),
            State::Fall => {
                self.scl = false;
                self.enter(State::Low, now);
            }
            State::Rise => self.enter(State::Free, now),
            State::Free => self.stop(sda),
        }
    }

    /// Ends a phase with SCL high.
    fn sample(&mut self, now: u64, operation: Operation, command: Command, sda: bool) {
        let ninth = self.clocks == LAST_CLOCK;
        match operation {
            Operation::Start => {
                self.addressing = true;
                if sda {
                    self.sda = false;
                    self.enter(State::Fall, now);
                } else if self.clocks == LAST_CLOCK + 1 {
                    self.fail(Error::Data);
                } else {
                    self.scl = false;
                    self.enter(State::Low, now);
                }
            }
            Operation::Stop => {
                self.sda = true;
                self.enter(State::Rise, now);
            }
            Operation::Read | Operation::Write => {
                let sent = self.shift >> 8 & 1 == 1;
                self.shift = self.shift << 1 & 0x1ff | u16::from(sda);
                if !ninth && command.operation() == Operation::Write && sda != sent {
                    self.fail(Error::Data);
                } else {
                    self.scl = false;
                    self.enter(State::Low, now);
                }
            }
        }
    }

    /// Ends a phase with SCL low: starts the next bit, or ends a byte or a start.
    fn shift_out(&mut self, now: u64, operation: Operation, command: Command) {
        let ninth = self.clocks == LAST_CLOCK;
        let started = !self.sda;
        let ended = if operation == Operation::Start {
            started
        } else {
            ninth
        };
        self.clocks += 1;
        if operation != Operation::Start && !ninth {
            self.sda = self.shift >> 8 & 1 == 1;
        }
        if !ended {
            self.enter(State::Set, now);
            return;
        }
        if operation == Operation::Read {
            self.answers.push_back((self.shift >> 1) as u8);
        }
        let last_byte = self.is_last_byte(command);
        if operation == Operation::Start || last_byte {
            self.take();
        }
        self.bytes = if last_byte {
            0
        } else {
            self.bytes.wrapping_add(1)
        };
        if operation == Operation::Write {
            if self.shift & 1 != 0 {
                self.error = if self.addressing {
                    Error::Address
                } else {
                    Error::Byte
                };
            }
            self.addressing = false;
        }
        self.state = State::Held;
        self.until = u64::MAX;
        self.begin(now, false);
    }

    /// Ends the bus free time after a stop.
    fn stop(&mut self, sda: bool) {
        self.until = u64::MAX;
        let last = self.rounds_done == self.rounds.batch();
        if self.error == Error::None {
            self.take();
            if !sda {
                self.error = Error::Data;
            }
        }
        self.state = if self.error == Error::None {
            State::Idle
        } else {
            State::Failed
        };
        if self.state == State::Failed || !self.rounds.repeats() || last {
            self.events.raise(ENDED);
        }
        // The field `batch` may have become smaller than the count; the count then wraps at the width of the field.
        let next = Rounds::default().with_batch(self.rounds_done + 1).batch();
        self.rounds_done = if last { 0 } else { next };
        if !self.rounds.repeats() {
            self.rounds_done = 0;
        }
    }

    fn is_busy(&self) -> bool {
        match self.state {
            State::Failed => false,
            State::Idle => !self.commands.is_empty(),
            State::Held | State::Set | State::High | State::Low => true,
            State::Fall | State::Rise | State::Free => true,
        }
    }
}

impl Device for I2c {
    fn read(&mut self, offset: u32, now: u64) -> u32 {
        match offset {
            offset::ANSWER => match self.answers.pop_front() {
                Some(byte) => Answer::default().with_byte(byte).with_valid(true).bits(),
                None => 0,
            },
            offset::COMMAND => self.command,
            offset::CONTROL => self.control,
            offset::ROUNDS => self.rounds.bits(),
            offset::STATUS => {
                let (scl, sda) = self.wires(now);
                Status::default()
                    .with_scl(scl)
                    .with_sda(sda)
                    .with_room(self.commands.len() < Block::COMMAND_PLACES as usize)
                    .with_busy(self.is_busy())
                    .with_failed(self.state == State::Failed)
                    .with_error(self.error)
                    .bits()
            }
            offset::EV_STATUS => self.events.status(),
            offset::EV_PENDING => self.events.pending(),
            offset::EV_ENABLE => self.events.enabled(),
            _ => 0,
        }
    }

    fn write(&mut self, offset: u32, value: u32, now: u64, _ram: &mut MainMemory) {
        match offset {
            offset::COMMAND => {
                self.command = value & 0x7ff;
                if self.commands.len() < Block::COMMAND_PLACES as usize {
                    self.commands.push_back(Command::from_bits(value));
                }
            }
            offset::CONTROL => {
                self.control = value & 1;
                if Control::from_bits(value).clear() {
                    self.clear(now);
                }
            }
            offset::ROUNDS => {
                let before = self.rounds;
                self.rounds = Rounds::from_bits(value);
                let period = u64::from(self.rounds.period());
                if !self.rounds.repeats() {
                    self.round = u64::MAX;
                    self.rounds_done = 0;
                } else if before.repeats() {
                    // The counter has the width of the field `period`, and continues to count. If the counter has already exceeded the new
                    // period, the period ends after the counter has wrapped.
                    let counts_from = self.round - u64::from(before.period());
                    let left = counts_from.wrapping_add(period).wrapping_sub(now + 1);
                    let wrap = Rounds::default().with_period(u32::MAX).period();
                    self.round = now + 1 + (left & u64::from(wrap));
                } else {
                    self.round = now + period + 1;
                }
            }
            offset::EV_PENDING => self.events.clear(value),
            offset::EV_ENABLE => self.events.enable(value & ENDED),
            _ => {}
        }
    }

    fn advance(&mut self, now: u64, _ram: &mut MainMemory) -> u64 {
        loop {
            if matches!(self.state, State::Idle | State::Held) {
                self.begin(now, false);
            }
            let due = self.until.min(self.round);
            if due > now {
                return due;
            }
            if self.until <= self.round {
                self.step(self.until);
            } else {
                let round = self.round;
                self.round += u64::from(self.rounds.period()) + 1;
                match self.state {
                    State::Idle => self.begin(round, true),
                    State::Failed => {}
                    State::Held | State::Set | State::High | State::Low => self.fail(Error::Late),
                    State::Fall | State::Rise | State::Free => self.fail(Error::Late),
                }
            }
        }
    }

    fn interrupt(&self) -> bool {
        self.events.interrupt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Number of cycles of a round.
    const ROUND: u64 = 2000;

    /// A master whose rounds consist of a start and a stop and begin at cycle 0.
    fn started(rounds: Rounds) -> (I2c, MainMemory) {
        let (mut i2c, mut ram) = (I2c::new(), MainMemory::new());
        for operation in [Operation::Start, Operation::Stop] {
            let command = Command::default().with_operation(operation);
            i2c.write(offset::COMMAND, command.bits(), 0, &mut ram);
        }
        i2c.write(offset::ROUNDS, rounds.bits(), 0, &mut ram);
        i2c.write(offset::EV_ENABLE, ENDED, 0, &mut ram);
        (i2c, ram)
    }

    fn rounds(period: u64, batch: u8) -> Rounds {
        let rounds = Rounds::default().with_repeats(true);
        rounds.with_period(period as u32 - 1).with_batch(batch)
    }

    #[test]
    fn the_count_of_rounds_wraps_when_a_batch_becomes_shorter() {
        let (mut i2c, mut ram) = started(rounds(ROUND, 3));
        let end = |round: u64| (round + 1) * ROUND - 1;
        i2c.advance(end(2), &mut ram);
        i2c.write(offset::ROUNDS, rounds(ROUND, 0).bits(), end(2), &mut ram);
        // Two rounds have been counted. The count has four bits, so it is 0 again after 14 further rounds.
        i2c.advance(end(16), &mut ram);
        assert!(!i2c.interrupt());
        i2c.advance(end(17), &mut ram);
        assert!(i2c.interrupt());
        i2c.advance(end(300), &mut ram);
        assert_eq!(i2c.error, Error::None);
    }

    #[test]
    fn the_time_since_the_last_round_counts_on_when_the_period_changes() {
        let (mut i2c, mut ram) = started(rounds(5 * ROUND, 0));
        i2c.write(offset::ROUNDS, rounds(ROUND, 0).bits(), 1000, &mut ram);
        assert_eq!(i2c.round, ROUND);
        i2c.advance(ROUND, &mut ram);
        i2c.write(offset::ROUNDS, rounds(500, 0).bits(), 3000, &mut ram);
        assert_eq!(i2c.round, ROUND + 500 + (1 << 24));
        i2c.write(offset::ROUNDS, rounds(1001, 0).bits(), 3000, &mut ram);
        assert_eq!(i2c.round, 3001);
    }

    #[test]
    fn registers_read_what_was_written() {
        let (mut i2c, mut ram) = (I2c::new(), MainMemory::new());
        i2c.write(offset::COMMAND, u32::MAX, 0, &mut ram);
        i2c.write(offset::CONTROL, 3, 0, &mut ram);
        let command = Command::default().with_operation(Operation::Stop);
        let command = command.with_argument(0xff).with_more(true);
        assert_eq!(i2c.read(offset::COMMAND, 0), command.bits());
        assert_eq!(i2c.read(offset::CONTROL, 0), 1);
    }
}
