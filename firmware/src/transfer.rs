//! Uploads and downloads as tasks: runs `glint-core`'s transfers between lent memory and the UART, one part per turn.
//!
//! During a transfer the serial line carries no other text. A transfer ends when it is complete, when the other side cancels it,
//! or after a timeout.

use core::mem;
use core::ops::Range;

use glint_core::tasks::Turn;
use glint_core::wire::{
    CRC_32, Digest, Endpoint, Failure, MAX_FRAME, Manifest, Receiving, Role, Sending, State, Timing,
};
use glint_hal::timer::Clock;
use glint_program::serial::ConsoleUart;
use glint_scene::Name;

use crate::arena::Loan;
use crate::terminal::Terminal;

/// Number of bytes added to the CRC-32 per turn.
const SUMMED: usize = 4 << 10;
/// Largest number of exchanges with the UART's queues per turn. An exchange has up to 256 received bytes.
const EXCHANGES: u32 = 8;

/// Timeouts, which are the same for all transfers.
const TIMING: Timing = Timing::CONSOLE;

/// The purpose of a transfer.
pub enum Purpose {
    /// An upload of a mesh or a texture under this name.
    Upload(Name),
    /// An upload of a wireframe program under this name.
    Program(Name),
    /// An upload of a log of sensor samples.
    Log,
    /// A download of any data.
    Download,
}

/// A transfer in progress.
pub struct Transfer {
    /// The transferred data, and the direction of the transfer.
    pub purpose: Purpose,
    /// The length and CRC-32 that the host has announced for an upload.
    announced: Option<Manifest>,
    /// The session number of the download.
    session: u8,
    stage: Stage,
    line: Line,
}

enum Stage {
    /// Computes the CRC-32 of the memory: of a download's data, or of the bytes in the memory before an upload. The memory may already
    /// contain the announced data, because a tool has written them directly to memory, or because a previous transfer was interrupted near
    /// its end.
    Sum(Sum),
    Receive(Endpoint<Receiving<Loan>>),
    Send(Endpoint<Sending<Loan>>),
    Over(Loan, Result<(), Failure>),
}

impl Transfer {
    /// Creates an upload of the data that `manifest` announces. `memory` must have the announced length.
    pub fn upload(
        purpose: Purpose,
        manifest: Manifest,
        memory: Loan,
        terminal: &mut Terminal,
    ) -> Self {
        Self::begin(purpose, Some(manifest), 0, memory, terminal)
    }

    fn begin(
        purpose: Purpose,
        announced: Option<Manifest>,
        session: u8,
        memory: Loan,
        terminal: &mut Terminal,
    ) -> Self {
        // All bytes that the host sends from now on belong to the transfer.
        terminal.lend(true);
        Self {
            purpose,
            announced,
            session,
            stage: Stage::Sum(Sum::new(memory)),
            line: Line::new(terminal.uart()),
        }
    }

    /// Runs one turn of the transfer.
    pub fn poll(&mut self, terminal: &mut Terminal, clock: Clock) -> Turn {
        let now = clock.milliseconds();
        let (turn, next) = match &mut self.stage {
            Stage::Sum(sum) => {
                let next = sum.advance().map(|(memory, found)| {
                    terminal.lend(false);
                    let next = match self.announced {
                        Some(announced) if announced == found => {
                            terminal.print(format_args!("present\n"));
                            Stage::Over(memory, Ok(()))
                        }
                        Some(announced) => {
                            terminal.print(format_args!("ready\n"));
                            let announced = Some(announced);
                            Stage::Receive(Endpoint::<Receiving<_>>::new(
                                memory, announced, TIMING, now,
                            ))
                        }
                        None => {
                            terminal.print(format_args!("ready\n"));
                            Stage::Send(Endpoint::announced(
                                memory,
                                found,
                                self.session,
                                TIMING,
                                now,
                            ))
                        }
                    };
                    terminal.lend(true);
                    next
                });
                (Turn::Again, next)
            }
            Stage::Receive(endpoint) => {
                let (turn, result) = self.line.exchange(endpoint, now);
                let over = result.map(|result| Stage::Over(endpoint.take_buffer(), result));
                (turn, over)
            }
            Stage::Send(endpoint) => {
                let (turn, result) = self.line.exchange(endpoint, now);
                let over = result.map(|result| Stage::Over(endpoint.take_data(), result));
                (turn, over)
            }
            Stage::Over(..) => (Turn::Wait, None),
        };
        if let Some(next) = next {
            self.stage = next;
        }
        turn
    }

    /// Whether the transfer has ended.
    pub const fn is_over(&self) -> bool {
        matches!(self.stage, Stage::Over(..))
    }

    /// Returns the memory and the result of a transfer that has ended.
    pub fn take_result(&mut self) -> Option<(Loan, Result<(), Failure>)> {
        match &mut self.stage {
            Stage::Over(memory, result) => Some((mem::take(memory), *result)),
            Stage::Sum(_) | Stage::Receive(_) | Stage::Send(_) => None,
        }
    }
}

/// Computes the CRC-32 of memory, a part at a time.
struct Sum {
    memory: Loan,
    done: usize,
    digest: Digest,
}

impl Sum {
    fn new(memory: Loan) -> Self {
        Self {
            memory,
            done: 0,
            digest: CRC_32.digest(),
        }
    }

    /// Adds the next part to the CRC-32. After the last part, returns the memory, its length and its CRC-32.
    fn advance(&mut self) -> Option<(Loan, Manifest)> {
        let bytes = self.memory.as_ref();
        let length = bytes.len();
        let end = length.min(self.done + SUMMED);
        self.digest
            .update(bytes.get(self.done..end).unwrap_or_default());
        self.done = end;
        (end == length).then(|| {
            let manifest = Manifest {
                // The memory has less than 2^32 bytes, so the conversion does not fail.
                length: length as u32,
                crc32: self.digest.clone().finalize(),
            };
            (mem::take(&mut self.memory), manifest)
        })
    }
}

/// The connection of a transfer to the UART's queues.
struct Line {
    uart: &'static ConsoleUart,
    frame: [u8; MAX_FRAME],
    /// The range of `frame` that is not yet in the UART's queue, because the queue was full.
    unsent: Range<usize>,
}

impl Line {
    const fn new(uart: &'static ConsoleUart) -> Self {
        Self {
            uart,
            frame: [0; MAX_FRAME],
            unsent: 0..0,
        }
    }

    /// Exchanges bytes with the queues. Returns the result of the transfer after its end.
    fn exchange(
        &mut self,
        endpoint: &mut Endpoint<impl Role>,
        now: u64,
    ) -> (Turn, Option<Result<(), Failure>>) {
        let mut received = [0; 256];
        let mut has_worked = false;
        for _ in 0..EXCHANGES {
            // Reads all waiting bytes before the timeout is checked. Bytes after the end do not belong to the transfer.
            let mut count = 0;
            while endpoint.state() == State::Running {
                let next = self.uart.receive(&mut received);
                endpoint.on_bytes(now, received.get(..next).unwrap_or_default());
                count += next;
                if next < received.len() {
                    break;
                }
            }
            if self.unsent.is_empty() {
                self.unsent = 0..endpoint.poll(now, &mut self.frame);
            }
            let unsent = self.frame.get(self.unsent.clone()).unwrap_or_default();
            let sent = self.uart.send(unsent);
            self.unsent.start += sent;
            if count == 0 && sent == 0 {
                break;
            }
            has_worked = true;
        }
        let result = match endpoint.state() {
            State::Done if self.unsent.is_empty() => Some(Ok(())),
            State::Failed(failure) if self.unsent.is_empty() => Some(Err(failure)),
            State::Running | State::Done | State::Failed(_) => None,
        };
        // At its end, a transfer waits a few milliseconds until the line is idle, and no interrupt ends this time. Longer timeouts are
        // checked after each vertical blanking interrupt.
        (Turn::worked(has_worked || endpoint.is_ending()), result)
    }
}

/// The sender of downloads. Each transfer has a session number, the previous transfer's number plus one, modulo 256.
#[derive(Default)]
pub struct Downloads {
    session: u8,
    /// Memory for a copy of the downloaded data; empty while the memory is lent.
    copy: Loan,
}

impl Downloads {
    /// Creates a sender with memory for copies.
    pub const fn new(copy: &'static mut [u8]) -> Self {
        let copy = Loan::new(copy);
        Self { session: 0, copy }
    }

    /// Begins to send the contents of lent memory.
    pub fn send(&mut self, memory: Loan, terminal: &mut Terminal) -> Transfer {
        self.session = self.session.wrapping_add(1);
        Transfer::begin(Purpose::Download, None, self.session, memory, terminal)
    }

    /// Begins to send a copy of `data`, which may then change. The memory for copies suffices for every picture.
    pub fn send_copy(&mut self, data: &[u8], terminal: &mut Terminal) -> Transfer {
        let mut copy = mem::take(&mut self.copy);
        copy.narrow(0..data.len());
        if copy.as_ref().len() == data.len() {
            copy.as_mut().copy_from_slice(data);
        }
        self.send(copy, terminal)
    }

    /// Takes back the memory for copies.
    pub fn give_back(&mut self, copy: Loan) {
        self.copy = copy;
    }
}
