//! Uploads and downloads: `glint-core`'s transfer between a buffer and the UART.
//!
//! While one runs, the line is its own: nothing is echoed or printed. It ends when it is done, when it is given up, or
//! after a silence.

use glint_core::wire::{Failure, MAX_FRAME, Manifest, Party, Receiver, Sender, State, Timing};
use glint_hal::timer::Clock;

use crate::terminal::{ConsoleUart, Terminal};

/// Receives what `manifest` announces into `buffer`.
///
/// # Errors
/// When it does not come whole.
pub fn receive(
    uart: &ConsoleUart,
    clock: Clock,
    buffer: &mut [u8],
    manifest: Manifest,
) -> Result<(), Failure> {
    let receiver = Receiver::new(
        buffer,
        Some(manifest),
        Timing::CONSOLE,
        clock.milliseconds(),
    );
    run(uart, clock, receiver)
}

/// The side that sends, and how often it has: each transfer has another number than the one before.
pub struct Downloads {
    uart: &'static ConsoleUart,
    clock: Clock,
    session: u8,
}

impl Downloads {
    /// Nothing has been sent yet.
    pub const fn new(uart: &'static ConsoleUart, clock: Clock) -> Self {
        Self {
            uart,
            clock,
            session: 0,
        }
    }

    /// Says that it is ready, and sends `data`.
    ///
    /// # Errors
    /// When it does not arrive whole.
    pub fn send(&mut self, terminal: &mut Terminal, data: &[u8]) -> Result<(), Failure> {
        terminal.print(format_args!("ready\n"));
        self.session = self.session.wrapping_add(1);
        let now = self.clock.milliseconds();
        let sender = Sender::new(data, self.session, Timing::CONSOLE, now);
        run(self.uart, self.clock, sender)
    }
}

fn run(uart: &ConsoleUart, clock: Clock, mut party: impl Party) -> Result<(), Failure> {
    let mut received = [0; 256];
    let mut frame = [0; MAX_FRAME];
    // The part of the frame that still waits for room in the UART's queue.
    let mut unsent = 0..0;
    loop {
        let now = clock.milliseconds();
        let count = uart.receive(&mut received);
        party.on_bytes(now, received.get(..count).unwrap_or_default());
        if unsent.is_empty() {
            unsent = 0..party.poll(now, &mut frame);
        }
        unsent.start += uart.send(frame.get(unsent.clone()).unwrap_or_default());
        match party.state() {
            State::Running => {}
            _ if !unsent.is_empty() => {}
            State::Done => return Ok(()),
            State::Failed(failure) => return Err(failure),
        }
    }
}
