//! The end of a transfer.

use super::frame::{Message, write};
use super::state::{Failure, State, Timing};

/// Repetitions of the last message, because no side acknowledges this message.
const COPIES: u8 = 3;
/// Factor of the quiet time after a failure, which interrupts the other side's messages.
const FAILED_QUIET_FACTOR: u64 = 10;

/// Outcome of a transfer, its last message, and the wait for a quiet line.
pub struct Ending {
    outcome: State,
    last_message: Option<(u8, Message<'static>)>,
    copies: u8,
    quiet_ms: u64,
    /// Time of the last message in either direction.
    last_ms: u64,
    /// Latest end of the wait.
    deadline_ms: u64,
}

impl Ending {
    /// An ending that repeats `last_message` (session and message), if any.
    pub fn new(
        outcome: State,
        last_message: Option<(u8, Message<'static>)>,
        timing: Timing,
        now_ms: u64,
    ) -> Self {
        let factor = if outcome == State::Done {
            1
        } else {
            FAILED_QUIET_FACTOR
        };
        Self {
            outcome,
            last_message,
            copies: COPIES,
            quiet_ms: timing.quiet_ms.saturating_mul(factor),
            last_ms: now_ms,
            deadline_ms: now_ms.saturating_add(timing.silence_ms),
        }
    }

    /// The end of a failed transfer without a message.
    pub fn failed(failure: Failure, timing: Timing, now_ms: u64) -> Self {
        Self::new(State::Failed(failure), None, timing, now_ms)
    }

    /// Drops the remains of the transfer from received bytes; returns the number of dropped bytes.
    pub fn on_bytes(&mut self, now_ms: u64, bytes: &[u8]) -> usize {
        if self.quiet_ms == 0 {
            return 0;
        }
        if !bytes.is_empty() {
            self.last_ms = now_ms;
        }
        bytes.len()
    }

    /// Writes the next frame, if any, and returns the state: the outcome after the end.
    pub fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> (usize, State) {
        if let Some((session, message)) = self.last_message {
            let length = write(session, message, out);
            if length > 0 {
                self.copies = self.copies.saturating_sub(1);
                self.last_ms = now_ms;
            }
            if self.copies == 0 {
                self.last_message = None;
            }
            return (length, State::Running);
        }
        let quiet = now_ms.saturating_sub(self.last_ms) >= self.quiet_ms;
        let over = quiet || now_ms >= self.deadline_ms;
        (0, if over { self.outcome } else { State::Running })
    }
}
