use std::cell::RefCell;
use std::rc::Rc;
use std::vec::Vec;

use embedded_hal::i2c::I2c as _;
use litex_pac::Peripherals;
use litex_pac::bus::{self, Bus};

use super::*;
use crate::timer::tests::{Uptime, clock};

/// A device with 256 registers behind a pointer, as a sensor has, watching the wires.
struct Device {
    address: u8,
    registers: [u8; 256],
    pointer: u8,
    state: State,
    /// What the master does to the wires: true is let go.
    scl: bool,
    sda: bool,
    /// Whether the device pulls SDA.
    pulls: bool,
    /// Readings of the wires for which the device still holds SCL, and for how many it does at each byte.
    stretching: u32,
    stretch: u32,
    /// Clocks that a stuck device needs before it lets go of SDA.
    stuck: u32,
    /// S, P and the bytes on the wire, acknowledged (+) or not (-).
    log: Vec<std::string::String>,
    uptime: Uptime,
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    Idle,
    /// Shifting a byte in: bits so far, their number, whether it is the address, whether it sets the pointer.
    In {
        bits: u8,
        count: u8,
        address: bool,
        pointer: bool,
    },
    /// Shifting a byte out.
    Out {
        count: u8,
    },
}

impl Device {
    fn new() -> Self {
        Self {
            address: 0x68,
            registers: core::array::from_fn(|index| index as u8 ^ 0xa5),
            pointer: 0,
            state: State::Idle,
            scl: true,
            sda: true,
            pulls: false,
            stretching: 0,
            stretch: 0,
            stuck: 0,
            log: Vec::new(),
            uptime: Uptime::new(50),
        }
    }

    fn wire_sda(&self) -> bool {
        self.sda && !self.pulls && self.stuck == 0
    }

    /// The master moves the wires.
    fn drive(&mut self, scl: bool, sda: bool) {
        let (before, was_high) = (self.wire_sda(), self.scl);
        (self.scl, self.sda) = (scl, sda);
        let after = self.wire_sda();
        match (was_high, scl) {
            (true, true) if before && !after => {
                self.log.push("S".into());
                self.state = State::In {
                    bits: 0,
                    count: 0,
                    address: true,
                    pointer: true,
                };
            }
            (true, true) if !before && after => {
                self.log.push("P".into());
                self.state = State::Idle;
            }
            (false, true) => self.rises(),
            (true, false) => {
                self.stuck = self.stuck.saturating_sub(1);
                self.falls();
            }
            _ => {}
        }
    }

    fn rises(&mut self) {
        let sda = self.wire_sda();
        match &mut self.state {
            State::In { bits, count, .. } => {
                if *count < 8 {
                    *bits = *bits << 1 | u8::from(sda);
                }
                *count += 1;
            }
            State::Out { count } => {
                *count += 1;
                if *count == 9 {
                    let byte = self.registers[self.pointer as usize];
                    self.log
                        .push(std::format!("{byte:02x}{}", if sda { '-' } else { '+' }));
                    self.pointer = self.pointer.wrapping_add(1);
                    self.state = if sda {
                        State::Idle
                    } else {
                        State::Out { count: 0 }
                    };
                }
            }
            State::Idle => {}
        }
    }

    fn falls(&mut self) {
        self.pulls = false;
        match self.state {
            State::In {
                bits,
                count: 8,
                address,
                ..
            } => {
                let mine = !address || bits >> 1 == self.address;
                self.log
                    .push(std::format!("{bits:02x}{}", if mine { '+' } else { '-' }));
                self.pulls = mine;
                self.stretching = self.stretch;
                if !mine {
                    self.state = State::Idle;
                }
            }
            State::In {
                bits,
                count: 9,
                address,
                pointer,
            } => {
                if address && bits & 1 != 0 {
                    self.state = State::Out { count: 0 };
                    self.falls();
                    return;
                }
                if !address && pointer {
                    self.pointer = bits;
                } else if !address {
                    self.registers[self.pointer as usize] = bits;
                    self.pointer = self.pointer.wrapping_add(1);
                }
                self.state = State::In {
                    bits: 0,
                    count: 0,
                    address: false,
                    pointer: address,
                };
            }
            State::Out { count } if count < 8 => {
                self.pulls = self.registers[self.pointer as usize] << count & 0x80 == 0;
            }
            _ => {}
        }
    }
}

struct Wires(Rc<RefCell<Device>>);

impl Bus for Wires {
    fn read(&mut self, address: usize) -> u32 {
        let mut device = self.0.borrow_mut();
        if address != i2c::I2c::BASE + 4 {
            return device.uptime.read(address).unwrap();
        }
        let stretched = device.stretching > 0;
        device.stretching = device.stretching.saturating_sub(1);
        u32::from(device.wire_sda()) | u32::from(device.scl && !stretched) << 1
    }

    fn write(&mut self, address: usize, value: u32) {
        let mut device = self.0.borrow_mut();
        if address == i2c::I2c::BASE {
            assert!(value & 2 != 0, "the master must have its outputs enabled");
            device.drive(value & 1 != 0, value & 4 != 0);
        } else {
            device.uptime.write(address);
        }
    }
}

fn bus_with(device: Device) -> (I2c, Rc<RefCell<Device>>) {
    let device = Rc::new(RefCell::new(device));
    bus::connect(Wires(device.clone()));
    // SAFETY: the registers are a model's.
    let registers = unsafe { Peripherals::steal() }.i2c;
    (I2c::new(registers, clock(), Config::FAST), device)
}

fn log(device: &RefCell<Device>) -> std::string::String {
    device.borrow().log.join(" ")
}

#[test]
fn writes_and_reads_with_a_repeated_start() {
    let (mut master, device) = bus_with(Device::new());
    let mut buffer = [0; 3];
    master.write(0x68, &[0x10, 0xde, 0xad]).unwrap();
    master.write_read(0x68, &[0x0f], &mut buffer).unwrap();
    assert_eq!(buffer, [0x0f ^ 0xa5, 0xde, 0xad]);
    assert_eq!(
        log(&device),
        "S d0+ 10+ de+ ad+ P S d0+ 0f+ S d1+ aa+ de+ ad- P"
    );
}

#[test]
fn operations_of_one_direction_are_one_run() {
    let (mut master, device) = bus_with(Device::new());
    let (mut one, mut none, mut two) = ([0; 1], [0; 0], [0; 2]);
    let mut operations = [
        Operation::Write(&[0]),
        Operation::Write(&[1]),
        Operation::Read(&mut one),
        Operation::Read(&mut two),
    ];
    master.transaction(0x68, &mut operations).unwrap();
    assert_eq!(log(&device), "S d0+ 00+ 01+ S d1+ a4+ a7+ a6- P");
    master
        .transaction(0x68, &mut [Operation::Read(&mut none)])
        .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn nobody_at_the_address() {
    let (mut master, device) = bus_with(Device::new());
    let error = master.write(0x69, &[1]).unwrap_err();
    assert_eq!(error, Error::NoAcknowledge(NoAcknowledgeSource::Address));
    assert_eq!(log(&device), "S d2- P");
    assert_eq!(master.write(0x80, &[]), Err(Error::Address(0x80)));
}

#[test]
fn a_device_may_stretch_the_clock_for_a_while() {
    let (mut master, _) = bus_with(Device {
        stretch: 5,
        ..Device::new()
    });
    let mut buffer = [0; 1];
    master.write_read(0x68, &[7], &mut buffer).unwrap();
    assert_eq!(buffer, [7 ^ 0xa5]);
    let (mut master, _) = bus_with(Device {
        stretch: u32::MAX,
        ..Device::new()
    });
    assert_eq!(master.write(0x68, &[7]), Err(Error::ClockStuck));
}

#[test]
fn a_stuck_device_is_clocked_free() {
    let (mut master, _) = bus_with(Device {
        stuck: 9,
        ..Device::new()
    });
    let mut buffer = [0; 1];
    master.write_read(0x68, &[7], &mut buffer).unwrap();
    assert_eq!(buffer, [7 ^ 0xa5]);
    let (mut master, _) = bus_with(Device {
        stuck: 1000,
        ..Device::new()
    });
    assert_eq!(master.write(0x68, &[7]), Err(Error::DataStuck));
}
