//! Tests of the I2C engine. A virtual MPU-6050 is on the bus, or the test itself drives SCL and
//! SDA.

use glint_testbench::{Bits, Module, Port};
use virtual_mpu6050::{Chip, Fault, Imperfections, Source, State, Wires};

/// Number of clocks of a phase, a third of a bit on the bus, at 81.25 MHz as in the SoC.
const PHASE: u64 = 68;
/// Longest clock stretching that the tested variant of the engine accepts, in clocks.
const PATIENCE: u64 = 1 << 15;

const START: u32 = 0;
const WRITE: u32 = 1;
const READ: u32 = 2;
const STOP: u32 = 3;
const MORE: u32 = 1 << 10;

const WRITES: u32 = 0xd0;
const READS: u32 = 0xd1;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Failure {
    Address = 1,
    Byte,
    Clock,
    Data,
    Late,
}

/// Packs a command for the engine's queue.
fn command(operation: u32, argument: u32) -> u32 {
    operation << 8 | argument
}

/// Makes the commands of a transaction with the sensor: start, write of the bytes `sent`, read of `received` bytes, stop.
fn transfer(sent: &[u32], received: u32) -> Vec<u32> {
    let mut commands = vec![command(START, 0), command(WRITE, WRITES)];
    commands.extend(sent.iter().map(|&byte| command(WRITE, byte)));
    if received > 0 {
        commands.extend([
            command(START, 0),
            command(WRITE, READS),
            command(READ, received - 1),
        ]);
    }
    commands.push(command(STOP, 0));
    commands
}

struct Bench {
    module: Module,
    device: Wires,
    ports: Ports,
    /// Whether the test bench reads the received bytes.
    listens: bool,
    answers: Vec<u8>,
    ended: u32,
}

struct Ports {
    rst: Port,
    command: [Port; 3],
    answer: [Port; 3],
    wires: [Port; 4],
    rounds: [Port; 3],
    ended: Port,
    busy: Port,
    failed: Port,
    error: Port,
}

impl Bench {
    fn new(fault: Option<Fault>) -> Self {
        let module = Module::new("i2c_engine_hasty", 3);
        let port = |name: &str| module.port(name);
        let ports = Ports {
            rst: port("rst"),
            command: ["command_valid", "command_ready", "command_data"].map(port),
            answer: ["answer_valid", "answer_ready", "answer_data"].map(port),
            wires: ["scl_in", "scl_out", "sda_in", "sda_out"].map(port),
            rounds: ["repeats", "period", "batch"].map(port),
            ended: port("ended"),
            busy: port("busy"),
            failed: port("failed"),
            error: port("error"),
        };
        let chip = Chip::new(
            Source::Motion(Box::new(|_| State::default())),
            Imperfections::NONE,
            1,
        );
        let mut device = Wires::new(chip);
        device.log = Some(Vec::new());
        device.set_fault(fault);
        let mut bench = Self {
            module,
            device,
            ports,
            listens: true,
            answers: Vec::new(),
            ended: 0,
        };
        bench.reset();
        bench
    }

    /// Resets the engine. The reset lasts until SCL and SDA are high again.
    fn reset(&mut self) {
        self.module.set(self.ports.rst, 1);
        for _ in 0..10 {
            self.clock();
        }
        self.module.set(self.ports.rst, 0);
    }

    /// Advances by one clock. SCL and SDA are high if both the engine and the device release them.
    fn clock(&mut self) {
        let [scl_in, scl_out, sda_in, sda_out] = self.ports.wires;
        let now = self.module.cycles() * 160 / 13;
        let [scl, sda] = [scl_out, sda_out].map(|port| self.module.is_high(port));
        let (scl, sda) = self.device.update(now, scl, sda);
        self.module.set(scl_in, u64::from(scl));
        self.module.set(sda_in, u64::from(sda));
        self.module
            .set(self.ports.answer[1], u64::from(self.listens));
        self.module.settle();
        if self.listens && self.module.is_high(self.ports.answer[0]) {
            self.answers
                .push(self.module.value(self.ports.answer[2]) as u8);
        }
        self.module.clock();
        self.ended += u32::from(self.module.is_high(self.ports.ended));
    }

    /// Queues commands one by one; waits while the queue is full.
    fn push(&mut self, commands: &[u32]) {
        let [valid, ready, data] = self.ports.command;
        for &command in commands {
            self.module.set(valid, 1);
            self.module.set(data, Bits::from(u64::from(command)));
            self.module.settle();
            while !self.module.is_high(ready) {
                self.clock();
            }
            self.clock();
            self.module.set(valid, 0);
        }
    }

    /// Runs until the engine is idle; returns the number of clocks.
    fn finish(&mut self) -> u64 {
        const LONG: u64 = 4_000_000;
        let start = self.module.cycles();
        self.clock();
        self.clock();
        while self.module.is_high(self.ports.busy) {
            self.clock();
            assert!(
                self.module.cycles() - start < LONG,
                "the transfer does not end"
            );
        }
        self.module.cycles() - start
    }

    fn failure(&self) -> Option<Failure> {
        let all = [
            Failure::Address,
            Failure::Byte,
            Failure::Clock,
            Failure::Data,
            Failure::Late,
        ];
        let error = self.module.value(self.ports.error);
        assert_eq!(self.module.is_high(self.ports.failed), error != 0);
        all.into_iter().find(|&failure| failure as u64 == error)
    }

    /// Runs a transfer to its end; returns its error, if any.
    fn run(&mut self, commands: &[u32]) -> Option<Failure> {
        let ended = self.ended;
        self.push(commands);
        self.finish();
        assert_eq!(self.ended, ended + 1, "one event per transfer");
        self.failure()
    }

    /// Makes the I2C engine repeat the transaction `commands` every `period` clocks. Each repetition is a round; the output
    /// `ended` pulses once per `batch` rounds.
    fn repeat(&mut self, commands: &[u32], period: u64, batch: u64) {
        let [repeats, clocks, rounds] = self.ports.rounds;
        self.module.set(clocks, period - 1);
        self.module.set(rounds, batch - 1);
        self.module.set(repeats, 1);
        self.push(commands);
    }

    /// Runs for `clocks` clocks; returns the numbers of the clocks with start conditions.
    fn starts(&mut self, clocks: u64) -> Vec<u64> {
        let [_, scl_out, _, sda_out] = self.ports.wires;
        let mut starts = Vec::new();
        let mut before = false;
        for _ in 0..clocks {
            self.clock();
            let low = self.module.is_high(scl_out) && !self.module.is_high(sda_out);
            let high = self.module.is_high(scl_out) && self.module.is_high(sda_out);
            if before && low {
                starts.push(self.module.cycles());
            }
            before = high;
        }
        starts
    }

    fn log(&self) -> String {
        self.device.log.as_deref().unwrap_or_default().join(" ")
    }
}

#[test]
fn bytes_go_both_ways_within_the_times_of_fast_mode() {
    let mut bench = Bench::new(None);
    assert_eq!(bench.run(&transfer(&[0x19, 0x07, 0x02], 0)), None);
    assert_eq!(bench.run(&transfer(&[0x19], 2)), None);
    assert_eq!(bench.answers, [0x07, 0x02]);
    assert_eq!(bench.log(), "S d0+ 19+ 07+ 02+ P S d0+ 19+ S d1+ 07+ 02- P");
    let violations = &bench.device.violations;
    assert!(violations.is_empty(), "{violations:#?}");
}

#[test]
fn a_burst_takes_the_time_that_is_stated() {
    let mut bench = Bench::new(None);
    bench.push(&transfer(&[0x3a], 15));
    let took = bench.finish();
    let phases = 18 * 27 + 3 + 4 + 4;
    let filter = 18 * 9 * 7;
    let stated = phases * PHASE + filter;
    assert!(
        (stated..stated + 50).contains(&took),
        "{took} clocks, expected {stated}"
    );
    assert_eq!(bench.answers.len(), 15);
}

#[test]
fn rounds_begin_at_their_times() {
    const PERIOD: u64 = 39_000;
    let mut bench = Bench::new(None);
    let begin = bench.module.cycles();
    bench.repeat(&transfer(&[0x3a], 15), PERIOD, 3);
    let starts = bench.starts(10 * PERIOD);
    // Skip every second start condition, the repeated start within a round.
    let first: Vec<u64> = starts.iter().map(|at| at - begin).step_by(2).collect();
    assert_eq!(first.len(), 9, "{starts:?}");
    assert!(
        (PERIOD..PERIOD + 2 * PHASE).contains(&first[0]),
        "{first:?}"
    );
    assert!(
        first.windows(2).all(|pair| pair[1] - pair[0] == PERIOD),
        "{first:?}"
    );
    assert_eq!((bench.failure(), bench.ended), (None, 3));
    assert_eq!(bench.answers.len(), 9 * 15);
    let round = "S d0+ 3a+ S d1+";
    assert_eq!(bench.log().matches(round).count(), 9, "{}", bench.log());
    let violations = &bench.device.violations;
    assert!(violations.is_empty(), "{violations:#?}");
    // A reset clears the queue, which still holds the commands of the rounds.
    bench.module.set(bench.ports.rounds[0], 0);
    bench.reset();
    bench.answers.clear();
    assert_eq!(bench.run(&transfer(&[0x75], 1)), None);
    assert_eq!(bench.answers, [0x68]);
}

#[test]
fn a_round_that_is_not_over_in_time_is_an_error() {
    // The transfer takes 34,883 clocks, more than the period.
    let mut bench = Bench::new(None);
    bench.repeat(&transfer(&[0x3a], 15), 34_000, 1);
    bench.starts(3 * 34_000);
    assert_eq!((bench.failure(), bench.ended), (Some(Failure::Late), 1));
    // The test bench reads no received byte. Nine rounds receive 15 bytes each, but the receive queue holds only 129 bytes, so
    // the ninth round is late.
    let mut bench = Bench::new(None);
    bench.listens = false;
    bench.repeat(&transfer(&[0x3a], 15), 39_000, 1);
    bench.starts(9 * 39_000);
    assert_eq!((bench.failure(), bench.ended), (None, 8));
    bench.starts(2 * 39_000);
    assert_eq!((bench.failure(), bench.ended), (Some(Failure::Late), 9));
    bench.listens = true;
    bench.starts(200);
    assert_eq!(bench.answers.len(), 129);
}

#[test]
fn rounds_end_with_a_device_that_is_gone() {
    let mut bench = Bench::new(None);
    bench.repeat(&transfer(&[0x3a], 15), 39_000, 4);
    bench.starts(3 * 39_000 - PHASE);
    bench.device.set_fault(Some(Fault::Absent));
    let starts = bench.starts(4 * 39_000);
    assert_eq!(starts.len(), 1, "{starts:?}");
    assert_eq!((bench.failure(), bench.ended), (Some(Failure::Address), 1));
}

#[test]
fn reads_in_a_row_are_one_and_wait_for_room() {
    let mut bench = Bench::new(None);
    bench.listens = false;
    let mut commands = transfer(&[0x19], 1);
    let stop = commands.pop().expect("a stop");
    commands.pop();
    commands.extend([
        command(READ, 0) | MORE,
        command(READ, 39) | MORE,
        command(READ, 255),
        stop,
    ]);
    bench.push(&commands);
    // The receive queue holds 129 bytes. While it is full, SCL stays low, without a time-out.
    for _ in 0..3 * PATIENCE {
        bench.clock();
    }
    assert!(bench.module.is_high(bench.ports.busy));
    bench.listens = true;
    bench.finish();
    assert_eq!(bench.failure(), None);
    assert_eq!(bench.answers.len(), 297);
    let log = bench.log();
    assert_eq!(log.matches('+').count(), 2 + 1 + 296, "{log}");
    assert_eq!(log.matches('-').count(), 1, "{log}");
}

#[test]
fn a_transaction_waits_for_its_next_command() {
    let mut bench = Bench::new(None);
    bench.push(&[command(START, 0), command(WRITE, WRITES)]);
    for _ in 0..3 * PATIENCE {
        bench.clock();
    }
    bench.push(&[command(WRITE, 0x1a), command(WRITE, 0x05), command(STOP, 0)]);
    bench.finish();
    assert_eq!(
        (bench.failure(), bench.log().as_str()),
        (None, "S d0+ 1a+ 05+ P")
    );
}

#[test]
fn what_is_not_acknowledged_ends_the_transaction() {
    let mut bench = Bench::new(None);
    let other = [
        command(START, 0),
        command(WRITE, 0xd2),
        command(WRITE, 1),
        command(STOP, 0),
    ];
    assert_eq!(bench.run(&other), Some(Failure::Address));
    assert_eq!(bench.log(), "S d2- P");
    // Commands wait until the error is cleared.
    bench.push(&transfer(&[0x19], 0));
    for _ in 0..20 * PHASE {
        bench.clock();
    }
    assert_eq!(bench.log(), "S d2- P");
    bench.reset();
    for _ in 0..20 * PHASE {
        bench.clock();
    }
    assert_eq!(bench.log(), "S d2- P");
    bench.device.set_fault(Some(Fault::NoAcknowledge));
    assert_eq!(bench.run(&transfer(&[0x19], 0)), Some(Failure::Byte));
    assert_eq!(bench.log(), "S d2- P S d0+ 19- P");
}

#[test]
fn a_clock_may_be_stretched_for_a_while() {
    let mut bench = Bench::new(Some(Fault::Stretched(200_000)));
    assert_eq!(bench.run(&transfer(&[0x19, 0x21], 0)), None);
    assert_eq!(bench.run(&transfer(&[0x19], 1)), None);
    assert_eq!(bench.answers, [0x21]);
    bench.device.set_fault(Some(Fault::Stretched(u64::MAX)));
    let start = bench.module.cycles();
    assert_eq!(bench.run(&transfer(&[0x19], 0)), Some(Failure::Clock));
    let took = bench.module.cycles() - start;
    assert!(
        (PATIENCE..PATIENCE + 50 * PHASE).contains(&took),
        "{took} clocks"
    );
    // SCL low from the beginning of a transfer causes the same error.
    bench.reset();
    assert_eq!(bench.run(&transfer(&[0x19], 0)), Some(Failure::Clock));
    bench.device.set_fault(None);
    bench.reset();
    assert_eq!(bench.run(&transfer(&[0x19], 0)), None);
}

#[test]
fn a_stuck_device_is_clocked_free() {
    for clocks in 1..=9 {
        let mut bench = Bench::new(Some(Fault::StuckData(clocks)));
        assert_eq!(bench.run(&transfer(&[0x75], 1)), None, "{clocks} clocks");
        assert_eq!(bench.answers, [0x68]);
    }
    for clocks in [0, 10] {
        let mut bench = Bench::new(Some(Fault::StuckData(clocks)));
        assert_eq!(bench.run(&transfer(&[0x75], 1)), Some(Failure::Data));
    }
}

#[test]
fn a_device_left_in_a_byte_is_freed_wherever_it_is() {
    // Resets the engine during a transfer, after 100 clocks, 197 clocks and so on. The transfers are a read of bytes 0x00, which
    // hold SDA low, and a write.
    for commands in [transfer(&[0x00], 3), transfer(&[0x19, 0x00], 0)] {
        let mut length = 0;
        for clocks in (100..).step_by(97) {
            let mut bench = Bench::new(None);
            bench.push(&commands);
            while bench.module.cycles() < clocks {
                bench.clock();
            }
            if !bench.module.is_high(bench.ports.busy) {
                break;
            }
            length = clocks;
            bench.reset();
            bench.answers.clear();
            assert_eq!(bench.run(&transfer(&[0x75], 1)), None, "after {clocks}");
            assert_eq!(bench.answers, [0x68], "after {clocks}");
        }
        assert!(length > 27 * PHASE, "{length}");
    }
}

#[test]
fn another_device_on_sda_is_detected() {
    let mut bench = Bench::new(None);
    bench.push(&transfer(&[0x75], 0));
    while bench.log() != "S" {
        bench.clock();
    }
    bench.device.set_fault(Some(Fault::StuckData(0)));
    bench.finish();
    assert_eq!(bench.failure(), Some(Failure::Data));
}
