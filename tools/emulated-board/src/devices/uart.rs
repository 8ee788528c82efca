//! The UART as a stream of bytes: it transfers bytes without the delay of a serial line.

use std::collections::VecDeque;

use litex_pac::register::Value;
use litex_pac::uart::{EvPending, offset};

use crate::{Device, Events, MainMemory};

/// Bit of the event for the transmitter in the event registers.
const TX: u32 = 1;
/// Bit of the event for the receiver in the event registers.
const RX: u32 = 2;

/// The UART.
pub struct Uart {
    /// Bytes that the CPU has not read.
    received: VecDeque<u8>,
    /// Bytes from the CPU that the host has not read.
    sent: Vec<u8>,
    events: Events,
}

impl Uart {
    /// The UART after a reset. The transmit buffer is not full, so the event of the transmitter is pending.
    pub fn new() -> Self {
        let mut events = Events::default();
        events.set_level(TX, true);
        Self {
            received: VecDeque::new(),
            sent: Vec::new(),
            events,
        }
    }

    /// Resets the UART. Bytes from the CPU that the host has not read remain.
    pub fn reset(&mut self) {
        self.events = Self::new().events;
        self.received.clear();
    }

    /// Sends bytes to the CPU.
    pub fn push(&mut self, bytes: &[u8]) {
        self.received.extend(bytes);
        self.events.set_level(RX, !self.received.is_empty());
    }

    /// Number of bytes that the CPU has not read yet.
    pub fn queued(&self) -> usize {
        self.received.len()
    }

    /// Bytes from the CPU; the caller removes the bytes that it has read.
    pub fn sent(&mut self) -> &mut Vec<u8> {
        &mut self.sent
    }
}

impl Device for Uart {
    fn read(&mut self, offset: u32, _now: u64) -> u32 {
        match offset {
            offset::RXTX => self.received.front().copied().unwrap_or(0).into(),
            offset::TXFULL | offset::RXFULL => 0,
            offset::RXEMPTY => self.received.is_empty().into(),
            offset::TXEMPTY => 1,
            offset::EV_STATUS => self.events.status(),
            offset::EV_PENDING => self.events.pending(),
            offset::EV_ENABLE => self.events.enabled(),
            _ => 0,
        }
    }

    fn write(&mut self, offset: u32, value: u32, _now: u64, _ram: &mut MainMemory) {
        match offset {
            offset::RXTX => self.sent.push(value as u8),
            offset::EV_PENDING => {
                self.events.clear(value);
                if EvPending::from_bits(value).rx() {
                    // Clearing the event removes the byte in `rxtx` from the queue.
                    self.received.pop_front();
                    self.events.set_level(RX, !self.received.is_empty());
                }
            }
            offset::EV_ENABLE => self.events.enable(value & (TX | RX)),
            _ => {}
        }
    }

    fn interrupt(&self) -> bool {
        self.events.interrupt()
    }
}
