//! Tests of the image sensors' set-up with virtual chips, on a bus of bytes and on a bus of two wires.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::pin::pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::{ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};
use glint_core::image_sensor::{Error, FrameSize, ImageSensor, Model};
use glint_i2c::{NoAcknowledge, TwoWires, Wires};

/// A chip with registers, as its SCCB bus sees it.
struct Chip {
    model: Model,
    /// Contents of the registers that were written, or that differ from 0 after a reset.
    registers: BTreeMap<u16, u8>,
    /// A register that keeps its value of 0.
    stuck: Option<u16>,
    register: u16,
    /// The registers in the order of their writes.
    writes: Vec<(u16, u8)>,
    /// Bytes of the transaction so far, without the address.
    received: Vec<u8>,
}

impl Chip {
    fn new(model: Model, product: u16) -> Self {
        let first = match model {
            Model::Ov7670 => 0x0a,
            Model::Ov5640 => 0x300a,
        };
        let [high, low] = product.to_be_bytes();
        Self {
            model,
            registers: BTreeMap::from([(first, high), (first + 1, low)]),
            stuck: None,
            register: 0,
            writes: vec![],
            received: vec![],
        }
    }

    fn write(&mut self, byte: u8) {
        self.received.push(byte);
        let value = match (self.model, &self.received[..]) {
            (Model::Ov7670, &[register]) => {
                self.register = register.into();
                return;
            }
            (Model::Ov5640, &[high, low]) => {
                self.register = u16::from_be_bytes([high, low]);
                return;
            }
            (Model::Ov7670, &[_, value]) | (Model::Ov5640, &[_, _, value]) => value,
            (Model::Ov5640, [_]) => return,
            _ => panic!("SCCB writes one register at a time: {:?}", self.received),
        };
        self.writes.push((self.register, value));
        let kept = if self.stuck == Some(self.register) {
            0
        } else {
            value
        };
        self.registers.insert(self.register, kept);
    }

    fn read(&self) -> u8 {
        self.registers.get(&self.register).copied().unwrap_or(0)
    }
}

type Shared = Rc<RefCell<Chip>>;

/// A bus of bytes with one chip. SCCB has no repeated start, so a transaction has one operation.
struct Bytes(Shared);

impl ErrorType for Bytes {
    type Error = ErrorKind;
}

impl I2c for Bytes {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), ErrorKind> {
        let mut chip = self.0.borrow_mut();
        if address != chip.model.address() {
            return Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
        }
        let [operation] = operations else {
            panic!("a transaction of SCCB has no repeated start");
        };
        match operation {
            Operation::Write(bytes) => {
                chip.received.clear();
                bytes.iter().for_each(|&byte| chip.write(byte));
            }
            Operation::Read(bytes) => bytes.fill(chip.read()),
        }
        Ok(())
    }
}

/// A bus that is stuck.
struct Stuck;

impl ErrorType for Stuck {
    type Error = ErrorKind;
}

impl I2c for Stuck {
    async fn transaction(&mut self, _: u8, _: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        Err(ErrorKind::Bus)
    }
}

/// Two wires with a chip: decodes starts, stops and bits.
struct Pins {
    chip: Shared,
    scl: bool,
    sda: bool,
    /// Whether the chip pulls SDA low.
    pulled: bool,
    /// Number of clocks since the start, and the byte that comes in; `None` outside of transactions.
    bits: Option<(u32, u8)>,
    /// Whether the chip sends.
    sends: bool,
    starts: Rc<RefCell<[u32; 2]>>,
}

impl Wires for Pins {
    fn set(&mut self, scl: bool, sda: bool) {
        let level = sda && !self.pulled;
        let mut chip = self.chip.borrow_mut();
        if self.scl && scl && self.sda != sda {
            if sda {
                self.starts.borrow_mut()[1] += 1;
                self.bits = None;
            } else {
                assert_eq!(self.bits, None, "SCCB has no repeated start");
                self.starts.borrow_mut()[0] += 1;
                chip.received.clear();
                (self.bits, self.sends, self.pulled) = (Some((0, 0)), false, false);
            }
        } else if scl && !self.scl {
            if let Some((count, byte)) = &mut self.bits {
                if *count % 9 < 8 {
                    *byte = *byte << 1 | u8::from(level);
                } else if *count == 8 {
                    self.sends = *byte & 1 != 0;
                } else if !self.sends {
                    chip.write(*byte);
                }
                *count += 1;
            }
        } else if !scl && self.scl {
            // The chip changes SDA while SCL is low.
            self.pulled = match self.bits {
                Some((8, byte)) if byte >> 1 != chip.model.address() => {
                    self.bits = None;
                    false
                }
                Some((count, _)) if count > 0 => match (self.sends, count % 9) {
                    (true, 8) if count > 8 => false,
                    (true, place) if count > 8 => chip.read() >> (7 - place) & 1 == 0,
                    (_, 8) => true,
                    _ => false,
                },
                _ => false,
            };
        }
        (self.scl, self.sda) = (scl, sda);
    }

    fn sda(&mut self) -> bool {
        self.sda && !self.pulled
    }
}

/// Delays that only add up.
#[derive(Clone, Default)]
struct Clock(Rc<RefCell<u64>>);

impl DelayNs for Clock {
    async fn delay_ns(&mut self, ns: u32) {
        *self.0.borrow_mut() += u64::from(ns);
    }
}

fn run<T>(future: impl Future<Output = T>) -> T {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => panic!("nothing to wait for"),
    }
}

fn start(bus: impl I2c<Error = ErrorKind>, size: FrameSize) -> Result<Model, Error<ErrorKind>> {
    run(ImageSensor::new(bus).start(size, &mut Clock::default()))
}

fn shared(model: Model, product: u16) -> Shared {
    Rc::new(RefCell::new(Chip::new(model, product)))
}

#[test]
fn the_known_chips_are_set_up() {
    for (model, product) in [(Model::Ov7670, 0x7673), (Model::Ov5640, 0x5640)] {
        for size in [FrameSize::Qvga, FrameSize::Vga] {
            let chip = shared(model, product);
            assert_eq!(start(Bytes(chip.clone()), size), Ok(model));
            let chip = chip.borrow();
            let has = |register, value| {
                assert_eq!(
                    chip.registers.get(&register),
                    Some(&value),
                    "{model} {register:#06x}"
                )
            };
            let [columns, rows] = size.pixels();
            match model {
                Model::Ov7670 => {
                    assert_eq!(chip.writes[0], (0x12, 0x80), "first the reset");
                    for (register, value) in
                        [(0x12, 0x04), (0x40, 0xd0), (0x8c, 0x00), (0x15, 0x00)]
                    {
                        has(register, value);
                    }
                    has(0x0c, if size == FrameSize::Qvga { 4 } else { 0 });
                }
                Model::Ov5640 => {
                    assert_eq!(
                        chip.writes[..2],
                        [(0x3103, 0x11), (0x3008, 0x82)],
                        "first the reset"
                    );
                    assert_eq!(
                        chip.writes.last(),
                        Some(&(0x3008, 0x02)),
                        "at last the end of the sleep"
                    );
                    has(0x4300, 0x61);
                    has(0x501f, 0x01);
                    let size = [0x3808, 0x380a].map(|register| {
                        u16::from_be_bytes([
                            chip.registers[&register],
                            chip.registers[&(register + 1)],
                        ])
                    });
                    assert_eq!(size, [columns, rows]);
                }
            }
        }
    }
}

#[test]
fn absent_and_unknown_chips_are_errors() {
    let text = |error: Error<NoAcknowledge>| error.to_string();
    // A chip of another maker at a third address.
    let other = Rc::new(RefCell::new(Chip::new(Model::Ov7670, 0x7673)));
    struct Elsewhere(Shared);
    impl ErrorType for Elsewhere {
        type Error = ErrorKind;
    }
    impl I2c for Elsewhere {
        async fn transaction(&mut self, _: u8, _: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
            assert!(self.0.borrow().writes.is_empty());
            Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address))
        }
    }
    assert_eq!(start(Elsewhere(other), FrameSize::Qvga), Err(Error::Absent));
    assert_eq!(
        text(Error::Absent),
        "no image sensor answers: expected an OV7670 at 0x21 or an OV5640 at 0x3c; check its supply, its clock XCLK and the wires SCL \
         and SDA"
    );
    for (model, found, message) in [
        (
            Model::Ov7670,
            0x7648,
            "the chip at 0x21 has the product number 0x7648: expected 0x7673 (OV7670)",
        ),
        (
            Model::Ov5640,
            0x5642,
            "the chip at 0x3c has the product number 0x5642: expected 0x5640 (OV5640)",
        ),
    ] {
        let chip = shared(model, found);
        assert_eq!(
            start(Bytes(chip.clone()), FrameSize::Qvga),
            Err(Error::Identity { model, found })
        );
        assert!(
            chip.borrow().writes.is_empty(),
            "an unknown chip is left as it is"
        );
        assert_eq!(text(Error::Identity { model, found }), message);
    }
    assert_eq!(
        start(Stuck, FrameSize::Qvga),
        Err(Error::Bus(ErrorKind::Bus))
    );
}

#[test]
fn a_register_that_does_not_keep_its_value_is_an_error() {
    let chip = shared(Model::Ov5640, 0x5640);
    chip.borrow_mut().stuck = Some(0x4300);
    let error = Error::Register {
        register: 0x4300,
        expected: 0x61,
        found: 0,
    };
    assert_eq!(start(Bytes(chip), FrameSize::Vga), Err(error));
    assert_eq!(
        error.to_string(),
        "register 0x4300 is 0x00: expected 0x61 as written"
    );
}

#[test]
fn a_chip_that_was_without_supply_has_lost_its_settings() {
    for (model, product) in [(Model::Ov7670, 0x7673), (Model::Ov5640, 0x5640)] {
        let chip = shared(model, product);
        let mut sensor = ImageSensor::new(Bytes(chip.clone()));
        let size = FrameSize::Qvga;
        assert_eq!(
            run(sensor.start(size, &mut Clock::default())),
            Ok(model),
            "{model}"
        );
        let writes = chip.borrow().writes.len();
        assert_eq!(run(sensor.keeps(model, size)), Ok(true));
        assert_eq!(run(sensor.keeps(model, FrameSize::Vga)), Ok(false));
        *chip.borrow_mut() = Chip::new(model, product);
        assert_eq!(run(sensor.keeps(model, size)), Ok(false));
        assert!(writes > 0 && chip.borrow().writes.is_empty());
        // Another chip in its place.
        chip.borrow_mut().model = match model {
            Model::Ov7670 => Model::Ov5640,
            Model::Ov5640 => Model::Ov7670,
        };
        assert!(run(sensor.keeps(model, size)).is_err());
    }
}

#[test]
fn two_wires_carry_the_same_bytes() {
    for (model, product) in [(Model::Ov7670, 0x7673), (Model::Ov5640, 0x5640)] {
        let direct = shared(model, product);
        assert_eq!(start(Bytes(direct.clone()), FrameSize::Qvga), Ok(model));
        let chip = shared(model, product);
        let starts = Rc::new(RefCell::new([0; 2]));
        let pins = Pins {
            chip: chip.clone(),
            scl: true,
            sda: true,
            pulled: false,
            bits: None,
            sends: false,
            starts: starts.clone(),
        };
        let clock = Clock::default();
        let bus = TwoWires::new(pins, clock.clone());
        let result = run(ImageSensor::new(bus).start(FrameSize::Qvga, &mut Clock::default()));
        assert_eq!(result, Ok(model));
        assert_eq!(chip.borrow().writes, direct.borrow().writes);
        let [starts, stops] = *starts.borrow();
        assert_eq!(starts, stops, "each start has its stop");
        let time = *clock.0.borrow() / 1_000_000;
        assert!((10..30).contains(&time), "{time} ms");
    }
}
