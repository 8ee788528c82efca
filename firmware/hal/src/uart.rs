//! The UART, driven by interrupts, with a queue of bytes in each direction: calls do not wait for the line.
//!
//! A [`Uart`] is a `static`. [`Uart::start`] sets its registers, [`Uart::on_interrupt`] handles
//! [`Interrupt::Uart`](litex_pac::Interrupt::Uart). The program reads through [`Uart::reader`] and writes through
//! [`Uart::writer`]. Bytes that arrive while the receive queue is full are dropped and counted ([`Uart::lost`]).
//!
//! ```no_run
//! # use core::time::Duration;
//! # use glint_hal::{frequency::Frequency, timer::Clock, uart::Uart};
//! use embedded_io::Write;
//! static UART: Uart<1024, 1024> = Uart::new();
//!
//! let peripherals = litex_pac::Peripherals::take().unwrap();
//! let frequency = Frequency::new(peripherals.identity.clock().read())?;
//! let clock = Clock::new(peripherals.timer0, frequency)?;
//! UART.start(peripherals.uart);
//! let mut console = UART.writer(clock, Duration::from_millis(100));
//! writeln!(console, "hello")?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use core::cell::RefCell;
use core::fmt;
use core::time::Duration;

use critical_section::Mutex;
use embedded_io::{ErrorKind, ErrorType, Read, ReadReady, Write, WriteReady};
use heapless::Deque;
use litex_pac::uart::{self, EvEnable, EvPending};

use crate::timer::Clock;

/// The UART with `RX` bytes of receive queue and `TX` bytes of transmit queue.
pub struct Uart<const RX: usize, const TX: usize> {
    state: Mutex<RefCell<State<RX, TX>>>,
}

struct State<const RX: usize, const TX: usize> {
    registers: Option<uart::Uart>,
    received: Deque<u8, RX>,
    to_send: Deque<u8, TX>,
    lost: u32,
}

impl<const RX: usize, const TX: usize> Uart<RX, TX> {
    /// A UART before [`Self::start`]: it receives no bytes, and keeps bytes to send in its queue.
    #[must_use]
    pub const fn new() -> Self {
        let state = State {
            registers: None,
            received: Deque::new(),
            to_send: Deque::new(),
            lost: 0,
        };
        Self {
            state: Mutex::new(RefCell::new(state)),
        }
    }

    /// Starts sending and receiving. The caller enables the interrupt.
    pub fn start(&self, registers: uart::Uart) {
        registers
            .ev_enable()
            .write(EvEnable::default().with_rx(true).with_tx(true));
        self.with(|state| {
            state.registers = Some(registers);
            // Earlier bytes have already raised their event, so they are received here.
            state.serve();
        });
    }

    /// Moves bytes between queues and hardware, for the interrupt handler.
    pub fn on_interrupt(&self) {
        self.with(State::serve);
    }

    /// Moves received bytes to `buffer` and returns their number, 0 if there are none.
    pub fn receive(&self, buffer: &mut [u8]) -> usize {
        self.with(|state| {
            let mut count = 0;
            for (slot, byte) in buffer
                .iter_mut()
                .zip(core::iter::from_fn(|| state.received.pop_front()))
            {
                *slot = byte;
                count += 1;
            }
            count
        })
    }

    /// Queues as many of `bytes` as fit and returns their number, possibly 0.
    pub fn send(&self, bytes: &[u8]) -> usize {
        self.with(|state| {
            let room = state.to_send.capacity() - state.to_send.len();
            let count = bytes.len().min(room);
            state.to_send.extend(bytes.iter().copied().take(count));
            state.transmit();
            count
        })
    }

    /// Whether the receive queue has bytes.
    pub fn has_received(&self) -> bool {
        self.with(|state| !state.received.is_empty())
    }

    /// Whether the transmit queue is empty.
    pub fn has_sent(&self) -> bool {
        self.with(|state| state.to_send.is_empty())
    }

    /// Number of bytes dropped since the start because the receive queue was full; saturates.
    pub fn lost(&self) -> u32 {
        self.with(|state| state.lost)
    }

    /// Returns a reader of received bytes. Each read waits at most `timeout` for its first byte.
    pub const fn reader(&self, clock: Clock, timeout: Duration) -> Reader<'_, RX, TX> {
        Reader {
            uart: self,
            clock,
            timeout,
        }
    }

    /// Returns a writer of bytes to send. Each write waits at most `timeout` for space in the queue.
    pub const fn writer(&self, clock: Clock, timeout: Duration) -> Writer<'_, RX, TX> {
        Writer {
            uart: self,
            clock,
            timeout,
        }
    }

    /// Sends the bytes in the transmit queue without interrupts, before the program ends. Stops after `PATIENCE` polls, even if bytes
    /// remain. Does nothing if the program ends inside another function of this UART, which still borrows its state.
    pub fn drain(&self) {
        critical_section::with(|token| {
            let Ok(mut state) = self.state.borrow(token).try_borrow_mut() else {
                return;
            };
            let mut patience = PATIENCE;
            while !state.to_send.is_empty() && patience > 0 {
                state.transmit();
                patience -= 1;
            }
        });
    }

    // Runs `action` on the UART's state, in a critical section. No `action` in this file calls `with` itself, so the state is
    // never borrowed twice.
    fn with<R>(&self, action: impl FnOnce(&mut State<RX, TX>) -> R) -> R {
        critical_section::with(|token| action(&mut self.state.borrow_ref_mut(token)))
    }
}

impl<const RX: usize, const TX: usize> Default for Uart<RX, TX> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const RX: usize, const TX: usize> State<RX, TX> {
    fn serve(&mut self) {
        let Some(registers) = &self.registers else {
            return;
        };
        while !registers.rxempty().read() {
            let byte = registers.rxtx().read();
            // Clearing the event removes the byte from the hardware's queue.
            registers
                .ev_pending()
                .write(EvPending::default().with_rx(true));
            if self.received.push_back(byte).is_err() {
                self.lost = self.lost.saturating_add(1);
            }
        }
        // The event is cleared before the hardware's queue is filled, so space that becomes free later raises the event again.
        registers
            .ev_pending()
            .write(EvPending::default().with_tx(true));
        self.transmit();
    }

    fn transmit(&mut self) {
        let Some(registers) = &self.registers else {
            return;
        };
        while !registers.txfull().read() {
            let Some(byte) = self.to_send.pop_front() else {
                return;
            };
            registers.rxtx().write(byte);
        }
    }
}

/// No byte could be received or sent within the timeout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimedOut;

impl fmt::Display for TimedOut {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("uart: timed out: no byte received or sent")
    }
}

impl core::error::Error for TimedOut {}

impl embedded_io::Error for TimedOut {
    fn kind(&self) -> ErrorKind {
        ErrorKind::TimedOut
    }
}

/// Calls `transfer` until it has transferred bytes, and returns their number. Most calls transfer bytes at once; these do not compute a
/// deadline, which takes a 64-bit division.
fn wait(
    clock: Clock,
    timeout: Duration,
    mut transfer: impl FnMut() -> usize,
) -> Result<usize, TimedOut> {
    let mut deadline = None;
    loop {
        match transfer() {
            0 if deadline
                .get_or_insert_with(|| clock.after(timeout))
                .passed() =>
            {
                return Err(TimedOut);
            }
            0 => {}
            count => return Ok(count),
        }
    }
}

/// Reader of the bytes that a [`Uart`] receives.
pub struct Reader<'u, const RX: usize, const TX: usize> {
    uart: &'u Uart<RX, TX>,
    clock: Clock,
    timeout: Duration,
}

impl<const RX: usize, const TX: usize> ErrorType for Reader<'_, RX, TX> {
    type Error = TimedOut;
}

impl<const RX: usize, const TX: usize> Read for Reader<'_, RX, TX> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize, TimedOut> {
        if buffer.is_empty() {
            return Ok(0);
        }
        wait(self.clock, self.timeout, || self.uart.receive(buffer))
    }
}

impl<const RX: usize, const TX: usize> ReadReady for Reader<'_, RX, TX> {
    fn read_ready(&mut self) -> Result<bool, TimedOut> {
        Ok(self.uart.has_received())
    }
}

/// Writer of the bytes that a [`Uart`] sends.
pub struct Writer<'u, const RX: usize, const TX: usize> {
    uart: &'u Uart<RX, TX>,
    clock: Clock,
    timeout: Duration,
}

impl<const RX: usize, const TX: usize> ErrorType for Writer<'_, RX, TX> {
    type Error = TimedOut;
}

impl<const RX: usize, const TX: usize> Write for Writer<'_, RX, TX> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, TimedOut> {
        if bytes.is_empty() {
            return Ok(0);
        }
        wait(self.clock, self.timeout, || self.uart.send(bytes))
    }

    /// Waits until the last byte has left the queues; the line may still be sending this byte.
    fn flush(&mut self) -> Result<(), TimedOut> {
        let deadline = self.clock.after(self.timeout);
        let sent = |state: &mut State<RX, TX>| {
            state.to_send.is_empty()
                && state
                    .registers
                    .as_ref()
                    .is_some_and(|registers| registers.txempty().read())
        };
        while !self.uart.with(sent) {
            if deadline.passed() {
                return Err(TimedOut);
            }
        }
        Ok(())
    }
}

impl<const RX: usize, const TX: usize> WriteReady for Writer<'_, RX, TX> {
    fn write_ready(&mut self) -> Result<bool, TimedOut> {
        Ok(self.uart.with(|state| !state.to_send.is_full()))
    }
}

/// Number of polls of a full transmitter after which sending is cancelled: about 0.1 s, much longer than a byte takes at 115,200
/// baud.
const PATIENCE: u32 = 1_000_000;

/// Writes text directly to the hardware, without queues or interrupts, for the messages of traps and panics.
pub struct Direct {
    registers: uart::Uart,
}

impl Direct {
    /// Returns a second handle on the UART, in addition to the handle of its owner.
    ///
    /// # Safety
    /// The output of the owner may be interrupted or incomplete from now on.
    #[must_use]
    pub const unsafe fn seize() -> Self {
        // SAFETY: the caller accepts interrupted output of the owner; sending has no other effect.
        let registers = unsafe { uart::Uart::steal() };
        Self { registers }
    }
}

impl fmt::Write for Direct {
    /// Writes text; fails if the transmitter stays full.
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            let mut patience = PATIENCE;
            while self.registers.txfull().read() {
                patience = patience.checked_sub(1).ok_or(fmt::Error)?;
            }
            self.registers.rxtx().write(byte);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
