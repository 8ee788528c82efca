//! Tests of the image sensors' set-up with virtual chips on a bus of two wires.

use std::cell::RefCell;
use std::pin::pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::{ErrorKind, ErrorType, I2c, Operation};
use glint_core::image_sensor::{Error, FrameSize, ImageSensor, Model};
use glint_i2c::{NoAcknowledge, TwoWires, Wires};
use virtual_image_sensor::{Chip, ChipFault};

/// A virtual chip at two wires, and the time in ns.
struct Line {
    device: virtual_i2c_device::Wires<Chip>,
    now: u64,
    /// Level of SDA.
    sda: bool,
}

#[derive(Clone)]
struct Shared(Rc<RefCell<Line>>);

impl Shared {
    fn new(model: Model) -> Self {
        let mut device = virtual_i2c_device::Wires::new(chip(model));
        device.log = Some(vec![]);
        let (now, sda) = (0, true);
        Self(Rc::new(RefCell::new(Line { device, now, sda })))
    }

    /// A driver of the chip over a software I2C master.
    fn driver(&self) -> ImageSensor<TwoWires<Self, Self>> {
        ImageSensor::new(TwoWires::new(self.clone(), self.clone()))
    }

    fn start(&self, size: FrameSize) -> Result<Model, Error<NoAcknowledge>> {
        run(self.driver().start(size, &mut self.clone()))
    }

    /// Checks that the transactions so far conform to SCCB (no repeated start, one register at a time), and returns them.
    fn log(&self, model: Model) -> Vec<String> {
        let line = self.0.borrow();
        assert_eq!(line.device.violations, [""; 0]);
        let log = line.device.log.as_ref().expect("a log").join(" ");
        let most = [3, 4][usize::from(model == Model::Ov5640)];
        let transactions: Vec<_> = log.split_inclusive('P').map(str::trim).collect();
        for transaction in &transactions {
            let words: Vec<_> = transaction.split(' ').collect();
            assert_eq!((words[0], words.last()), ("S", Some(&"P")), "{transaction}");
            let bytes = &words[1..words.len() - 1];
            assert!(
                bytes.len() <= most && !bytes.contains(&"S"),
                "{transaction}"
            );
        }
        transactions.into_iter().map(str::to_owned).collect()
    }
}

impl Wires for Shared {
    fn set(&mut self, scl: bool, sda: bool) {
        let line = &mut *self.0.borrow_mut();
        (_, line.sda) = line.device.update(line.now, scl, sda);
    }

    fn sda(&mut self) -> bool {
        self.0.borrow().sda
    }
}

impl DelayNs for Shared {
    async fn delay_ns(&mut self, ns: u32) {
        self.0.borrow_mut().now += u64::from(ns);
    }
}

/// A bus whose wires do not change.
struct Stuck;

impl ErrorType for Stuck {
    type Error = ErrorKind;
}

impl I2c for Stuck {
    async fn transaction(&mut self, _: u8, _: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        Err(ErrorKind::Bus)
    }
}

const MODELS: [Model; 2] = [Model::Ov7670, Model::Ov5640];

fn chip(model: Model) -> Chip {
    Chip::new(match model {
        Model::Ov7670 => virtual_image_sensor::Model::Ov7670,
        Model::Ov5640 => virtual_image_sensor::Model::Ov5640,
    })
}

fn run<T>(future: impl Future<Output = T>) -> T {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => panic!("expected a future that is ready at once"),
    }
}

#[test]
fn the_known_chips_are_set_up() {
    for model in MODELS {
        for size in [FrameSize::Qvga, FrameSize::Vga] {
            let line = Shared::new(model);
            assert_eq!(line.start(size), Ok(model));
            let address = format!("S {:02x}+", model.address() << 1);
            let writes = 2 + usize::from(model == Model::Ov5640);
            let is_write = |transaction: &String| {
                transaction.starts_with(&address) && transaction.matches('+').count() == writes + 1
            };
            let log = line.log(model);
            let writes: Vec<_> = log.iter().filter(|text| is_write(text)).collect();
            let line = line.0.borrow();
            let register = |register| line.device.chip.register(register);
            let [columns, rows] = size.pixels();
            match model {
                Model::Ov7670 => {
                    assert_eq!(writes[0], "S 42+ 12+ 80+ P", "first the reset");
                    let set = [0x12, 0x40, 0x8c, 0x15].map(register);
                    assert_eq!(set, [0x04, 0xd0, 0x00, 0x00]);
                    let halves = if size == FrameSize::Qvga { 4 } else { 0 };
                    assert_eq!(register(0x0c), halves);
                }
                Model::Ov5640 => {
                    let reset = ["S 78+ 31+ 03+ 11+ P", "S 78+ 30+ 08+ 82+ P"];
                    assert_eq!(writes[..2], reset, "first the reset");
                    let wake = "S 78+ 30+ 08+ 02+ P";
                    assert_eq!(
                        writes.last().unwrap(),
                        &wake,
                        "the last write ends the sleep"
                    );
                    assert_eq!([0x4300, 0x501f].map(register), [0x61, 0x01]);
                    let size = [0x3808, 0x380a]
                        .map(|high| u16::from_be_bytes([high, high + 1].map(register)));
                    assert_eq!(size, [columns, rows]);
                }
            }
            let time = line.now / 1_000_000;
            assert!((10..200).contains(&time), "{time} ms");
        }
    }
}

#[test]
fn absent_and_unknown_chips_are_errors() {
    let line = Shared::new(Model::Ov7670);
    let refused = || {
        let error = line.start(FrameSize::Qvga).expect_err("refused");
        let writes = line.0.borrow().device.chip.writes;
        assert_eq!(writes, 0, "no register of an unknown chip is written");
        error.to_string()
    };
    let set_fault = |fault| line.0.borrow_mut().device.set_fault(Some(fault));
    set_fault(ChipFault::Absent);
    assert_eq!(
        refused(),
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
        line.0.borrow_mut().device.chip = chip(model);
        set_fault(ChipFault::Identity(found));
        assert_eq!(refused(), message);
    }
    let stuck = run(ImageSensor::new(Stuck).start(FrameSize::Qvga, &mut line.clone()));
    assert_eq!(stuck, Err(Error::Bus(ErrorKind::Bus)));
}

#[test]
fn a_register_that_does_not_keep_its_value_is_an_error() {
    let line = Shared::new(Model::Ov5640);
    let fault = ChipFault::Kept(0x4300);
    line.0.borrow_mut().device.set_fault(Some(fault));
    let error = line.start(FrameSize::Vga).expect_err("refused");
    assert_eq!(
        error.to_string(),
        "register 0x4300 is 0xf8: expected 0x61 as written"
    );
}

#[test]
fn a_chip_that_was_without_supply_has_lost_its_settings() {
    for (model, other) in [(MODELS[0], MODELS[1]), (MODELS[1], MODELS[0])] {
        let line = Shared::new(model);
        assert_eq!(line.start(FrameSize::Qvga), Ok(model));
        let keeps = |size| run(line.driver().keeps(model, size));
        assert_eq!(keeps(FrameSize::Qvga), Ok(true));
        assert_eq!(keeps(FrameSize::Vga), Ok(false));
        line.0.borrow_mut().device.chip = chip(model);
        assert_eq!(keeps(FrameSize::Qvga), Ok(false));
        assert_eq!(line.0.borrow().device.chip.writes, 0);
        // Another chip replaces the first chip.
        line.0.borrow_mut().device.chip = chip(other);
        assert!(keeps(FrameSize::Qvga).is_err());
    }
}
