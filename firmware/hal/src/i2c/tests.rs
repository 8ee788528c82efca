use std::cell::RefCell;
use std::collections::VecDeque;
use std::pin::pin;
use std::rc::Rc;
use std::string::String;
use std::task::{Context, Waker};
use std::vec::Vec;

use embedded_hal::i2c::I2c as _;
use litex_pac::Peripherals;
use litex_pac::bus::{self, Bus};

use super::*;
use crate::frequency::Frequency;
use crate::timer::tests::{Uptime, clock};

/// Capacity of the command queue and of the receive queue.
const PLACES: usize = i2c::I2c::COMMAND_PLACES as usize;

/// Model of the registers of the I2C master, with one device on its bus. Each read of the register `status` executes one command, except
/// during periodic reads.
struct Master {
    /// Address of the device.
    address: u8,
    /// Number of bytes that the device acknowledges after its address.
    acknowledged: usize,
    next: u8,
    commands: VecDeque<Command>,
    answers: VecDeque<u8>,
    /// Trace of the bus: S is a start, P a stop, and `d0` a byte. `<` precedes a received byte; `+` follows an acknowledged byte,
    /// `-` any other byte.
    log: Vec<String>,
    /// Whether the next byte is an address.
    addressing: bool,
    transaction: bool,
    error: Error,
    /// Error that the model reports at each start, or `Error::None`.
    breaks: Error,
    /// Whether the model stops executing commands.
    hangs: bool,
    overfull: bool,
    /// Value of the register `rounds`.
    repeats: u32,
    /// Commands of one periodic read.
    round: Vec<Command>,
    uptime: Uptime,
}

impl Master {
    fn new() -> Self {
        Self {
            address: 0x68,
            acknowledged: usize::MAX,
            next: 0xa0,
            commands: VecDeque::new(),
            answers: VecDeque::new(),
            log: Vec::new(),
            addressing: false,
            transaction: false,
            error: Error::None,
            breaks: Error::None,
            hangs: false,
            overfull: false,
            repeats: 0,
            round: Vec::new(),
            uptime: Uptime::new(5_000),
        }
    }

    /// Executes one periodic read.
    fn repeat(&mut self) {
        if self.round.is_empty() {
            self.round = self.commands.drain(..).collect();
        }
        self.commands.extend(&self.round);
        while !self.commands.is_empty() && self.error == Error::None {
            self.step();
        }
    }

    fn step(&mut self) {
        if self.error != Error::None || self.hangs {
            return;
        }
        let Some(command) = self.commands.pop_front() else {
            return;
        };
        let argument = command.argument();
        match command.operation() {
            Action::Start => {
                self.log.push("S".into());
                (self.addressing, self.transaction, self.error) = (true, true, self.breaks);
            }
            Action::Write => {
                let taken = if self.addressing {
                    argument >> 1 == self.address
                } else {
                    let left = self.acknowledged;
                    self.acknowledged = left.saturating_sub(1);
                    left > 0
                };
                let mark = if taken { '+' } else { '-' };
                self.log.push(std::format!("{argument:02x}{mark}"));
                if !taken {
                    self.error = if self.addressing {
                        Error::Address
                    } else {
                        Error::Byte
                    };
                    self.stop();
                }
                self.addressing = false;
            }
            Action::Read => {
                for left in (0..=argument).rev() {
                    let mark = if left > 0 || command.more() { '+' } else { '-' };
                    self.log.push(std::format!("<{:02x}{mark}", self.next));
                    self.answers.push_back(self.next);
                    self.next = self.next.wrapping_add(1);
                }
            }
            Action::Stop => self.stop(),
        }
    }

    fn stop(&mut self) {
        self.log.push("P".into());
        self.transaction = false;
    }
}

struct Registers(Rc<RefCell<Master>>);

impl Bus for Registers {
    fn read(&mut self, address: usize) -> u32 {
        let mut master = self.0.borrow_mut();
        match address.wrapping_sub(i2c::I2c::BASE) {
            0x04 => master
                .answers
                .pop_front()
                .map_or(0, |byte| 1 << 8 | u32::from(byte)),
            0x10 => {
                if master.repeats == 0 {
                    master.step();
                }
                let room = master.commands.len() < PLACES;
                let failed = master.error != Error::None;
                let busy = !failed && (master.transaction || !master.commands.is_empty());
                0b11 | u32::from(room) << 2
                    | u32::from(busy) << 3
                    | u32::from(failed) << 4
                    | (master.error as u32) << 8
            }
            _ => master.uptime.read(address).unwrap(),
        }
    }

    fn write(&mut self, address: usize, value: u32) {
        let mut master = self.0.borrow_mut();
        match address.wrapping_sub(i2c::I2c::BASE) {
            0x00 => {
                master.overfull |= master.commands.len() >= PLACES;
                master
                    .commands
                    .push_back(litex_pac::register::Value::from_bits(value));
            }
            0x08 => {
                assert_eq!(value, 1);
                master.commands.clear();
                master.answers.clear();
                master.round.clear();
                (master.error, master.transaction) = (Error::None, false);
            }
            0x0c => master.repeats = value,
            0x1c => assert_eq!(value, 1, "the end of a transaction raises an interrupt"),
            _ => master.uptime.write(address),
        }
    }
}

fn bus_with(master: Master) -> (I2c, Rc<RefCell<Master>>) {
    let master = Rc::new(RefCell::new(master));
    bus::connect(Registers(master.clone()));
    // SAFETY: a model on the bus answers all accesses, so no device is affected.
    let registers = unsafe { Peripherals::steal() }.i2c;
    (I2c::new(registers, clock(), true), master)
}

fn log(master: &RefCell<Master>) -> String {
    let master = master.borrow();
    assert!(!master.overfull, "a command was lost");
    master.log.join(" ")
}

#[test]
fn writes_and_reads_with_a_repeated_start() {
    let (mut i2c, master) = bus_with(Master::new());
    let mut buffer = [0; 3];
    i2c.write(0x68, &[0x10, 0xde, 0xad]).unwrap();
    i2c.write_read(0x68, &[0x0f], &mut buffer).unwrap();
    assert_eq!(buffer, [0xa0, 0xa1, 0xa2]);
    assert_eq!(
        log(&master),
        "S d0+ 10+ de+ ad+ P S d0+ 0f+ S d1+ <a0+ <a1+ <a2- P"
    );
}

#[test]
fn an_absent_master_is_an_error() {
    let (mut i2c, master) = bus_with(Master::new());
    i2c.is_present = false;
    let mut buffer = [0; 3];
    let result = i2c.write_read(0x68, &[0x0f], &mut buffer);
    assert_eq!(result, Err(BusError::Absent));
    assert_eq!(log(&master), "");
}

#[test]
fn operations_of_one_direction_are_one_run() {
    let (mut i2c, master) = bus_with(Master::new());
    let (mut one, mut none, mut two) = ([0; 1], [0; 0], [0; 2]);
    let mut operations = [
        Operation::Write(&[0]),
        Operation::Write(&[1]),
        Operation::Read(&mut one),
        Operation::Read(&mut two),
        Operation::Read(&mut none),
    ];
    i2c.transaction(0x68, &mut operations).unwrap();
    assert_eq!((one, two), ([0xa0], [0xa1, 0xa2]));
    assert_eq!(log(&master), "S d0+ 00+ 01+ S d1+ <a0+ <a1+ <a2- P");
}

#[test]
fn a_run_may_be_longer_than_the_queue_and_a_command() {
    let (mut i2c, master) = bus_with(Master::new());
    let mut buffer = [0; 600];
    i2c.write(0x68, &[7; 100]).unwrap();
    i2c.read(0x68, &mut buffer).unwrap();
    assert!(
        buffer
            .iter()
            .zip(0xa0..)
            .all(|(&byte, at)| byte == at as u8)
    );
    let log = log(&master);
    assert_eq!(log.matches(" 07+").count(), 100);
    assert_eq!(log.matches('-').count(), 1, "{log}");
}

#[test]
fn a_transaction_after_an_error_works() {
    let (mut i2c, master) = bus_with(Master::new());
    assert_eq!(i2c.write(0x80, &[]), Err(BusError::Address(0x80)));
    assert_eq!(
        i2c.write(0x69, &[1; 50]),
        Err(BusError::NoAcknowledge(NoAcknowledgeSource::Address))
    );
    master.borrow_mut().acknowledged = 2;
    assert_eq!(
        i2c.write(0x68, &[1, 2, 3, 4]),
        Err(BusError::NoAcknowledge(NoAcknowledgeSource::Data))
    );
    assert_eq!(log(&master), "S d2- P S d0+ 01+ 02+ 03- P");
    let stuck = [
        (Error::Clock, BusError::ClockStuck),
        (Error::Data, BusError::DataStuck),
    ];
    for (code, error) in stuck {
        master.borrow_mut().breaks = code;
        assert_eq!(i2c.read(0x68, &mut [0; 2]), Err(error));
    }
    master.borrow_mut().breaks = Error::None;
    master.borrow_mut().hangs = true;
    assert_eq!(i2c.read(0x68, &mut [0; 2]), Err(BusError::Timeout));
    master.borrow_mut().hangs = false;
    master.borrow_mut().log.clear();
    i2c.read(0x68, &mut [0; 2]).unwrap();
    assert_eq!(log(&master), "S d1+ <a0+ <a1- P");
}

#[test]
fn the_remains_of_a_dropped_transaction_are_cleared() {
    let (mut i2c, master) = bus_with(Master::new());
    let mut buffer = [0; 4];
    master.borrow_mut().hangs = true;
    {
        let future = embedded_hal_async::i2c::I2c::write(&mut i2c, 0x68, &[1, 2]);
        let mut context = Context::from_waker(Waker::noop());
        assert!(pin!(future).poll(&mut context).is_pending());
    }
    master.borrow_mut().hangs = false;
    i2c.read(0x68, &mut buffer).unwrap();
    // The first S is the start of the dropped transaction, which was already in progress.
    assert_eq!(log(&master), "S S d1+ <a0+ <a1+ <a2+ <a3- P");
}

const READ: PeriodicRead = PeriodicRead {
    address: 0x68,
    register: 0x3a,
    length: 3,
    period: 480,
    batch: 5,
};

/// Polls once for the next periodic read. Returns its time or error, and its bytes; `None` if the read is not over.
fn poll_next(i2c: &mut I2c) -> Option<(Result<u64, BusError>, [u8; 3])> {
    let mut bytes = [0; 3];
    let found = {
        let future = pin!(i2c.next(&mut bytes));
        let mut context = Context::from_waker(Waker::noop());
        match future.poll(&mut context) {
            Poll::Ready(found) => Some(found),
            Poll::Pending => None,
        }
    };
    found.map(|found| (found, bytes))
}

#[test]
fn periodic_reads_are_taken_one_by_one_with_their_times() {
    let (mut i2c, master) = bus_with(Master::new());
    i2c.begin(READ).unwrap();
    let begun = master.borrow().uptime.now;
    // A read every 39,000 clock cycles, and an interrupt after every five reads.
    assert_eq!(master.borrow().repeats, 1 << 31 | 4 << 24 | 38_999);
    assert!(poll_next(&mut i2c).is_none());
    for _ in 0..2 {
        master.borrow_mut().repeat();
    }
    for (index, first) in [(1, 0xa0), (2, 0xa3)] {
        let (time, bytes) = poll_next(&mut i2c).unwrap();
        assert_eq!(
            time,
            Ok(Frequency::DEFAULT.microseconds(begun + index * 39_000))
        );
        assert_eq!(bytes, [first, first + 1, first + 2]);
    }
    assert!(poll_next(&mut i2c).is_none());
    let round = "S d0+ 3a+ S d1+";
    assert_eq!(log(&master).matches(round).count(), 2);
    // Any other transaction ends the periodic reads.
    i2c.write(0x68, &[1, 2]).unwrap();
    assert_eq!(master.borrow().repeats, 0);
    assert_eq!(poll_next(&mut i2c).unwrap().0, Err(BusError::Reads));
}

#[test]
fn an_error_of_periodic_reads_comes_behind_the_received_bytes() {
    let (mut i2c, master) = bus_with(Master::new());
    i2c.begin(READ).unwrap();
    master.borrow_mut().repeat();
    master.borrow_mut().error = Error::Late;
    assert!(poll_next(&mut i2c).unwrap().0.is_ok());
    assert_eq!(poll_next(&mut i2c).unwrap().0, Err(BusError::Late));
    assert_eq!(master.borrow().repeats, 0);
    // Without progress of the master, the periodic read times out.
    i2c.begin(READ).unwrap();
    let mut bytes = [0; 3];
    assert_eq!(block_on(i2c.next(&mut bytes)), Err(BusError::Timeout));
    let wrong = [
        (PeriodicRead { length: 0, ..READ }, BusError::Reads),
        (PeriodicRead { length: 33, ..READ }, BusError::Reads),
        (PeriodicRead { period: 0, ..READ }, BusError::Reads),
        (
            PeriodicRead {
                period: 300_000,
                ..READ
            },
            BusError::Reads,
        ),
        (PeriodicRead { batch: 17, ..READ }, BusError::Reads),
        (PeriodicRead { batch: 0, ..READ }, BusError::Reads),
        (
            PeriodicRead {
                address: 0x80,
                ..READ
            },
            BusError::Address(0x80),
        ),
    ];
    for (round, error) in wrong {
        assert_eq!(i2c.begin(round), Err(error));
    }
}
