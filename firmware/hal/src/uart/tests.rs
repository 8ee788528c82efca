use std::boxed::Box;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::fmt::Write as _;
use std::rc::Rc;
use std::vec::Vec;

use litex_pac::Peripherals;
use litex_pac::bus::{self, Bus};

use super::*;
use crate::timer::tests::{Uptime, clock};

/// A model of LiteX's UART: it holds 16 bytes in each direction, raises events on the edges of "not empty" and "not full", and
/// removes a received byte when its event is cleared.
struct Line {
    to_cpu: VecDeque<u8>,
    from_cpu: VecDeque<u8>,
    sent: Vec<u8>,
    enabled: u32,
    pending: u32,
    uptime: Uptime,
}

const DEPTH: usize = 16;
const TX: u32 = 1;
const RX: u32 = 2;

impl Line {
    fn new() -> Rc<RefCell<Self>> {
        Rc::new(RefCell::new(Self {
            to_cpu: VecDeque::new(),
            from_cpu: VecDeque::new(),
            sent: Vec::new(),
            enabled: 0,
            pending: 0,
            uptime: Uptime::new(1000),
        }))
    }

    fn arrive(&mut self, bytes: &[u8]) {
        if self.to_cpu.is_empty() && !bytes.is_empty() {
            self.pending |= RX;
        }
        self.to_cpu.extend(bytes);
        assert!(self.to_cpu.len() <= DEPTH);
    }

    /// Removes `count` bytes from the transmit queue, as sent over the line.
    fn take(&mut self, count: usize) {
        if self.from_cpu.len() == DEPTH && count > 0 {
            self.pending |= TX;
        }
        let count = count.min(self.from_cpu.len());
        self.sent.extend(self.from_cpu.drain(..count));
    }

    fn interrupting(&self) -> bool {
        self.pending & self.enabled != 0
    }
}

struct Wire(Rc<RefCell<Line>>);

impl Bus for Wire {
    fn read(&mut self, address: usize) -> u32 {
        let line = self.0.borrow();
        if let Some(word) = address
            .checked_sub(uart::Uart::BASE)
            .filter(|offset| *offset < 0x20)
        {
            return match word {
                0x00 => line.to_cpu.front().copied().unwrap_or(0).into(),
                0x04 => (line.from_cpu.len() == DEPTH).into(),
                0x08 => line.to_cpu.is_empty().into(),
                0x10 => line.pending,
                0x14 => line.enabled,
                0x18 => line.from_cpu.is_empty().into(),
                _ => panic!("read of uart + {word:#x}"),
            };
        }
        line.uptime.read(address).unwrap()
    }

    fn write(&mut self, address: usize, value: u32) {
        let mut line = self.0.borrow_mut();
        match address.wrapping_sub(uart::Uart::BASE) {
            0x00 => {
                assert!(
                    line.from_cpu.len() < DEPTH,
                    "a byte was written to a full queue"
                );
                line.from_cpu.push_back(value as u8);
            }
            0x10 => {
                line.pending &= !value;
                if value & RX != 0 {
                    line.to_cpu.pop_front();
                }
            }
            0x14 => line.enabled = value,
            _ => line.uptime.write(address),
        }
    }
}

type Small = Uart<32, 32>;

fn started() -> (&'static Small, Rc<RefCell<Line>>) {
    let line = Line::new();
    bus::connect(Wire(line.clone()));
    let uart = Box::leak(Box::new(Small::new()));
    // SAFETY: a model on the bus answers all accesses, so no device is affected.
    uart.start(unsafe { Peripherals::steal() }.uart);
    (uart, line)
}

#[test]
fn receives_what_came_before_and_after_the_start() {
    let line = Line::new();
    line.borrow_mut().arrive(b"early");
    bus::connect(Wire(line.clone()));
    let uart = Small::new();
    // SAFETY: a model on the bus answers all accesses, so no device is affected.
    uart.start(unsafe { Peripherals::steal() }.uart);
    let mut buffer = [0; 8];
    assert_eq!(
        (uart.receive(&mut buffer), &buffer[..5]),
        (5, b"early".as_slice())
    );
    line.borrow_mut().arrive(b"late");
    assert!(line.borrow().interrupting());
    uart.on_interrupt();
    assert!(!line.borrow().interrupting());
    assert_eq!(
        (uart.receive(&mut buffer), &buffer[..4]),
        (4, b"late".as_slice())
    );
    assert_eq!(uart.receive(&mut buffer), 0);
}

#[test]
fn a_full_receive_queue_drops_and_counts() {
    let (uart, line) = started();
    for chunk in [b"0123456789abcdef"; 3] {
        line.borrow_mut().arrive(chunk);
        uart.on_interrupt();
    }
    assert_eq!(uart.lost(), 16);
    let mut buffer = [0; 64];
    assert_eq!(uart.receive(&mut buffer), 32);
    assert_eq!(&buffer[..32], b"0123456789abcdef0123456789abcdef");
}

#[test]
fn sends_by_interrupts_in_order() {
    let (uart, line) = started();
    let text: Vec<u8> = (0..100).collect();
    let mut rest = text.as_slice();
    while !rest.is_empty() || line.borrow().sent.len() < text.len() {
        rest = &rest[uart.send(rest)..];
        line.borrow_mut().take(5);
        if line.borrow().interrupting() {
            uart.on_interrupt();
        }
    }
    assert_eq!(line.borrow().sent, text);
}

#[test]
fn a_writer_waits_only_so_long() {
    let (uart, line) = started();
    let mut writer = uart.writer(clock(), Duration::from_millis(1));
    assert_eq!(writer.flush(), Ok(()));
    // The hardware's queue holds 16 bytes and the driver's queue 32, so 48 bytes fit.
    assert_eq!(writer.write_all(&[1; 48]), Ok(()));
    assert_eq!(writer.write_ready(), Ok(false));
    assert_eq!(writer.write(b"x"), Err(TimedOut));
    assert_eq!(writer.flush(), Err(TimedOut));
    line.borrow_mut().take(3);
    uart.on_interrupt();
    assert_eq!(writer.write(b"four"), Ok(3));
}

#[test]
fn a_reader_waits_only_so_long() {
    let (uart, line) = started();
    let mut reader = uart.reader(clock(), Duration::from_millis(1));
    assert_eq!(reader.read_ready(), Ok(false));
    assert_eq!(reader.read(&mut [0; 4]), Err(TimedOut));
    line.borrow_mut().arrive(b"abc");
    uart.on_interrupt();
    assert_eq!(reader.read_ready(), Ok(true));
    let mut buffer = [0; 2];
    assert_eq!((reader.read(&mut buffer), &buffer), (Ok(2), b"ab"));
    assert_eq!(reader.read(&mut []), Ok(0));
}

#[test]
fn the_end_drains_the_queue_and_speaks_directly() {
    let (uart, line) = started();
    assert_eq!(uart.send(&[b'.'; 20]), 20);
    line.borrow_mut().take(10);
    uart.drain();
    // SAFETY: a model on the bus answers all accesses, so no device is affected.
    let mut direct = unsafe { Direct::seize() };
    write!(direct, "!").unwrap();
    line.borrow_mut().take(DEPTH);
    assert_eq!(line.borrow().sent, b"....................!");
    // Sending stops if the line accepts no bytes.
    assert!(write!(direct, "{:20}", "").is_err());
}
