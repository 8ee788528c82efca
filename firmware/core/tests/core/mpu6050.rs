//! Tests of the driver with a virtual MPU-6050: samples, compatible chips and faults.

use std::cell::RefCell;
use std::future::poll_fn;
use std::pin::pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::{ErrorKind, ErrorType, I2c, Operation};
use glint_core::mpu6050::{ADDRESSES, Error, Identity, Measurement, Sink, Stream};
use glint_i2c::{PeriodicI2c, PeriodicRead};
use virtual_mpu6050::{Bus, Chip, Fault, Imperfections, Source, State};

const MILLISECOND: u64 = 1_000_000;
const SECOND: u64 = 1_000 * MILLISECOND;

/// Delays on the clock of the bus: a delay advances this clock, and then yields to the test once.
struct Clock(Bus);

impl DelayNs for Clock {
    async fn delay_ns(&mut self, ns: u32) {
        self.0.advance(ns.into());
        let mut over = false;
        poll_fn(|_| {
            if over {
                return Poll::Ready(());
            }
            over = true;
            Poll::Pending
        })
        .await;
    }
}

/// The errors of the test's I2C bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Trouble {
    Bus(virtual_mpu6050::Error),
    /// A periodic read was not finished when the next read was due.
    Late,
}

impl embedded_hal_async::i2c::Error for Trouble {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Bus(error) => error.kind(),
            Self::Late => ErrorKind::Overrun,
        }
    }
}

/// A bus that repeats a read periodically.
struct Master {
    bus: Bus,
    read: Option<PeriodicRead>,
    /// Time at which the next periodic read starts, in ns.
    next: u64,
}

impl ErrorType for Master {
    type Error = Trouble;
}

impl I2c for Master {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), Self::Error> {
        self.read = None;
        I2c::transaction(&mut self.bus, address, operations)
            .await
            .map_err(Trouble::Bus)
    }
}

impl PeriodicI2c for Master {
    fn begin(&mut self, read: PeriodicRead) -> Result<(), Self::Error> {
        self.read = Some(read);
        self.next = self.bus.now() + u64::from(read.period) * 1_000;
        Ok(())
    }

    async fn next(&mut self, bytes: &mut [u8]) -> Result<u64, Self::Error> {
        let read = self.read.expect("reads have begun");
        assert_eq!(bytes.len(), usize::from(read.length));
        let now = self.bus.now();
        Clock(self.bus.clone())
            .delay_ns((self.next - now) as u32)
            .await;
        let begun = self.next;
        self.next += u64::from(read.period) * 1_000;
        let register = [read.register];
        let mut operations = [Operation::Write(&register), Operation::Read(bytes)];
        let result = I2c::transaction(&mut self.bus, read.address, &mut operations).await;
        if result.is_err() || self.bus.now() > self.next {
            self.read = None;
        }
        result.map_err(Trouble::Bus)?;
        if self.read.is_none() {
            return Err(Trouble::Late);
        }
        Ok(begun / 1_000)
    }
}

/// The events reported by the stream, each with the time on the bus's clock in ns. A sample also has a time stamp in µs.
#[derive(Default)]
struct Record {
    starts: Vec<(u64, Identity)>,
    samples: Vec<(u64, u64, Measurement)>,
    errors: Vec<(u64, Error<Trouble>)>,
}

struct Recorder(Bus, Rc<RefCell<Record>>);

impl Sink<Trouble> for Recorder {
    fn on_start(&mut self, identity: Identity) {
        self.1.borrow_mut().starts.push((self.0.now(), identity));
    }

    fn on_sample(&mut self, time: u64, measurement: &Measurement) {
        let sample = (self.0.now(), time, *measurement);
        self.1.borrow_mut().samples.push(sample);
    }

    fn on_error(&mut self, error: Error<Trouble>) {
        self.1.borrow_mut().errors.push((self.0.now(), error));
    }
}

/// A motion whose rate about x grows by one count every 61 µs, so that the rate in a sample shows the time of the measurement.
fn ramp(time: f64) -> State {
    State {
        rate: [1_000.0 * time - 1_900.0, 0.0, 0.0],
        ..State::default()
    }
}

fn chip(motion: fn(f64) -> State, imperfections: Imperfections) -> Chip {
    Chip::new(Source::Motion(Box::new(motion)), imperfections, 7)
}

/// An action on the chip, and the time in ns at which it happens.
type Action<'a> = (u64, &'a dyn Fn(&mut Chip));

/// Runs a stream for a given time and executes the planned actions on the chip.
fn run(chip: Chip, end: u64, plan: &[Action]) -> (Record, Bus) {
    let bus = Bus::new(chip);
    let record = Rc::new(RefCell::new(Record::default()));
    let recorder = Recorder(bus.clone(), record.clone());
    let master = Master {
        bus: bus.clone(),
        read: None,
        next: 0,
    };
    let mut stream = Stream::new(master, Clock(bus.clone()), recorder);
    let mut plan = plan.iter().peekable();
    {
        let mut future = pin!(stream.run());
        let mut context = Context::from_waker(Waker::noop());
        while bus.now() < end {
            if let Some((_, action)) = plan.next_if(|(time, _)| bus.now() >= *time) {
                bus.with_chip(action);
            }
            assert!(future.as_mut().poll(&mut context).is_pending());
        }
    }
    drop(stream);
    let record = Rc::into_inner(record).expect("no other reference remains");
    (record.into_inner(), bus)
}

#[test]
fn every_sample_comes_once_with_its_time() {
    for clock in [0.0, 0.01, -0.01, 0.0037] {
        let imperfections = Imperfections {
            clock,
            ..Imperfections::NONE
        };
        let (record, bus) = run(chip(ramp, imperfections), 3 * SECOND, &[]);
        assert!(record.errors.is_empty(), "{:?}", record.errors);
        let (started, identity) = record.starts[0];
        assert_eq!((record.starts.len(), identity), (1, Identity::Mpu6050));
        assert!((130..140).contains(&(started / MILLISECOND)), "{started}");
        let missed = bus.with_chip(|chip| chip.missed);
        assert!(
            missed <= 40,
            "{missed} samples are missed before the first read"
        );
        let expected = (3 * SECOND - started) as f64 * 1e-6 * (1.0 + clock);
        let found = record.samples.len() as f64;
        assert!((found - expected).abs() <= 2.0, "{found} of {expected}");
        for (index, (_, time, measurement)) in record.samples.iter().enumerate() {
            // The time in µs at which the chip measures this rate: the time of the motion plus 2.8 ms, the delay of the chip's
            // filter.
            let measured = (f64::from(measurement.gyro[0]) / 16.4 + 1_900.0) * 1e3 + 2_800.0;
            let late = *time as f64 - measured;
            let most = if index < 100 { 300.0 } else { 100.0 };
            assert!(late.abs() < most, "sample {index} is {late} us late");
        }
        let per_sample = bus.transactions() as f64 / found;
        assert!(per_sample < 2.2, "{per_sample} transactions a sample");
    }
}

#[test]
fn counts_are_those_of_the_registers() {
    let motion = |_: f64| State {
        rate: [10.0, -20.0, 1_000.0],
        force: [0.5, -1.0, 2.0],
        temperature: 36.53,
    };
    let (record, _) = run(chip(motion, Imperfections::TYPICAL), SECOND, &[]);
    let mean = |pick: fn(&Measurement) -> i16| {
        let all = record
            .samples
            .iter()
            .map(|(.., sample)| f64::from(pick(sample)));
        all.sum::<f64>() / record.samples.len() as f64
    };
    // The expected mean of a rate is the sum of the modelled chip's bias, its drift over 11.53 °C, and the rate with the error of its
    // scale; the mean of a force has no drift.
    let rate = [
        -4.5 + 1.8448 + 10.1,
        1.25 - 1.153 - 19.8,
        2.0 + 0.5765 + 1_005.0,
    ];
    let force = [0.02 + 0.505, -0.03 - 0.995, 0.05 + 1.98];
    let near =
        |found: f64, expected: f64| assert!((found - expected).abs() < 3.0, "{found} {expected}");
    near(mean(|m| m.gyro[0]), rate[0] * 16.4);
    near(mean(|m| m.gyro[1]), rate[1] * 16.4);
    near(mean(|m| m.gyro[2]), rate[2] * 16.4);
    near(mean(|m| m.accel[0]), force[0] * 4_096.0);
    near(mean(|m| m.accel[1]), force[1] * 4_096.0);
    near(mean(|m| m.accel[2]), force[2] * 4_096.0);
    near(mean(|m| m.temperature), 0.0);
    assert_eq!(Identity::Mpu6050.temperature(0), 3_653);
    assert_eq!(Identity::Mpu6050.temperature(-521), 3_500);
    assert_eq!(Identity::Mpu6500.temperature(0), 2_100);
}

#[test]
fn a_chip_at_the_other_address_is_found() {
    let mut chip = chip(ramp, Imperfections::NONE);
    chip.address = ADDRESSES[1];
    let (record, _) = run(chip, SECOND / 4, &[]);
    assert!(record.errors.is_empty(), "{:?}", record.errors);
    assert!(record.samples.len() > 100);
}

#[test]
fn relatives_are_known_and_strangers_are_used() {
    let relatives = [
        (0x68, Identity::Mpu6050),
        (0x70, Identity::Mpu6500),
        (0x71, Identity::Mpu9250),
        (0x73, Identity::Mpu9255),
        (0x98, Identity::Icm20689),
        // Clones, and chips with the same registers.
        (0x72, Identity::Other(0x72)),
        (0x12, Identity::Other(0x12)),
    ];
    for (code, identity) in relatives {
        let mut chip = chip(ramp, Imperfections::NONE);
        chip.fault = Some(Fault::Identity(code));
        let (record, _) = run(chip, SECOND / 4, &[]);
        assert_eq!(record.starts[0].1, identity);
        assert!(!record.samples.is_empty());
    }
    for code in [0x00, 0xff] {
        let mut chip = chip(ramp, Imperfections::NONE);
        chip.fault = Some(Fault::Identity(code));
        let (record, _) = run(chip, SECOND / 4, &[]);
        assert_eq!(record.errors[0].1, Error::Identity(code));
        assert!(record.samples.is_empty());
    }
    assert_eq!(Identity::Icm20689.to_string(), "ICM-20689");
    assert_eq!(
        Identity::Other(0x72).to_string(),
        "unknown chip, used as an MPU-6050: WHO_AM_I is 0x72"
    );
    assert_eq!(Identity::Other(0x72).temperature(0), 3_653);
}

/// The motion of a sensor at rest.
fn still(_: f64) -> State {
    State::default()
}

/// Runs a stream with a fault that `begin` causes at 1 s and that ends at 1.3 s. Checks that the stream reports the fault and
/// recovers within `within` ms.
fn recovers(begin: impl Fn(&mut Chip), within: u64) -> Record {
    let (from, to) = (SECOND, 1_300 * MILLISECOND);
    let end = |chip: &mut Chip| chip.fault = None;
    let plan: [Action; 2] = [(from, &begin), (to, &end)];
    let (record, _) = run(chip(still, Imperfections::TYPICAL), 2 * SECOND, &plan);
    assert!(!record.errors.is_empty());
    assert!(
        record
            .errors
            .iter()
            .all(|(at, _)| (from..to + 200 * MILLISECOND).contains(at))
    );
    let after = record.samples.iter().filter(|(at, ..)| *at >= to);
    let (at, time, _) = *after.clone().next().expect("samples again");
    let took = (at - to) / MILLISECOND;
    assert!(took <= within, "{took} ms");
    assert!(at / 1_000 - time < 2_000, "the time stamp is recent");
    let rate = after.count() as u64 * 1_000 / (2_000 - 1_300 - took);
    assert!(
        (980..1_020).contains(&rate),
        "{rate} samples per second after the fault"
    );
    record
}

#[test]
fn it_comes_back_from_faults_of_the_bus() {
    let faults = [
        Fault::Absent,
        Fault::NoAcknowledge,
        Fault::StuckData(0),
        Fault::Stretched(u64::MAX),
    ];
    for fault in faults {
        let record = recovers(|chip| chip.fault = Some(fault), 100);
        assert!(matches!(record.errors[0].1, Error::Bus(_)), "{fault:?}");
    }
}

#[test]
fn a_sample_that_is_cut_off_is_refused() {
    // A read has 16 bytes. The last byte follows the sample, so a chip that vanishes before this byte gives no sample.
    for bytes in 0..32 {
        let record = recovers(|chip| chip.fault = Some(Fault::Vanishing(bytes)), 100);
        if bytes % 16 != 0 {
            assert_eq!(record.errors[0].1, Error::Cut, "after {bytes} bytes");
        }
        for (at, _, measurement) in record.samples {
            let turns = measurement.gyro.into_iter().any(|count| count.abs() > 100);
            assert!(!turns, "after {bytes} bytes: {measurement:?} at {at}");
        }
    }
}

#[test]
fn a_chip_that_lost_its_configuration_is_set_up_again() {
    // The sensor is unplugged and plugged in again.
    let unplug = |chip: &mut Chip| {
        chip.reset();
        chip.fault = Some(Fault::Absent);
    };
    let record = recovers(unplug, 250);
    assert_eq!(record.starts.len(), 2);
    // The supply fails briefly, and the chip responds again before the next read.
    let (record, _) = run(
        chip(still, Imperfections::TYPICAL),
        2 * SECOND,
        &[(SECOND, &|chip: &mut Chip| chip.reset())],
    );
    let gap = record
        .samples
        .windows(2)
        .map(|pair| pair[1].0 - pair[0].0)
        .max();
    assert!(gap.expect("samples") < 300 * MILLISECOND, "{gap:?}");
    assert_eq!(record.starts.len(), 2);
}

#[test]
fn a_chip_that_measures_no_more_is_reset() {
    let record = recovers(|chip| chip.fault = Some(Fault::Stalled), 250);
    assert_eq!(record.errors[0].1, Error::Silent);
    let record = recovers(|chip| chip.fault = Some(Fault::Frozen), 250);
    assert_eq!(record.errors[0].1, Error::Frozen);
    let record = recovers(
        |chip| {
            chip.reset();
            chip.fault = Some(Fault::Identity(0x00));
        },
        250,
    );
    assert!(
        record
            .errors
            .iter()
            .any(|(_, error)| *error == Error::Identity(0))
    );
}

#[test]
fn a_slow_chip_is_read_all_the_same() {
    let fault = |chip: &mut Chip| chip.fault = Some(Fault::Stretched(10_000));
    let plan: [Action; 1] = [(SECOND, &fault)];
    let (record, _) = run(chip(still, Imperfections::TYPICAL), 2 * SECOND, &plan);
    // A read takes longer than the period of reads, so the stream doubles the period.
    assert_eq!(record.errors.len(), 1, "{:?}", record.errors);
    assert_eq!(record.errors[0].1, Error::Bus(Trouble::Late));
    let missing = 2_000 - 130 - record.samples.len();
    assert!(missing < 60, "{missing}");
}

#[test]
fn errors_say_what_was_expected() {
    let text = |error: Error<&str>| error.to_string();
    assert_eq!(
        text(Error::Identity(0x12)),
        "WHO_AM_I is 0x12: expected 0x68 (MPU-6050), 0x70 (MPU-6500), 0x71 (MPU-9250), 0x73 (MPU-9255), 0x98 (ICM-20689)"
    );
    let register = Error::Register {
        register: 0x1b,
        expected: 0x18,
        found: 0,
    };
    assert_eq!(
        text(register),
        "register 0x1b is 0x00: expected 0x18 as written"
    );
    assert_eq!(text(Error::Bus("SCL")), "SCL");
}
