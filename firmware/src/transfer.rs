//! Uploads and downloads: `glint-core`'s transfer between a buffer and the UART.
//!
//! During a transfer the line carries no other text. A transfer ends when it is complete, when the other side cancels it,
//! or after a timeout.

use glint_core::wire::{Failure, MAX_FRAME, Manifest, Party, Receiver, Sender, State, Timing};
use glint_hal::timer::Clock;

use crate::terminal::{ConsoleUart, Terminal};

/// Receives the upload that `manifest` announces into `buffer`.
///
/// # Errors
/// The upload is incomplete.
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

/// The sender of downloads. Each transfer has a session number, one more than that of the previous transfer, modulo 256.
pub struct Downloads {
    uart: &'static ConsoleUart,
    clock: Clock,
    session: u8,
}

impl Downloads {
    /// A sender before its first transfer.
    pub const fn new(uart: &'static ConsoleUart, clock: Clock) -> Self {
        Self {
            uart,
            clock,
            session: 0,
        }
    }

    /// Prints `ready` and sends `data`.
    ///
    /// # Errors
    /// The download is incomplete.
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
    // The range of `frame` that has not been put into the UART's queue, because the queue was full.
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
