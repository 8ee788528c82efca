//! The end of a transfer.

use super::frame::{Message, write};
use super::state::{Failure, Reason, State, Timing};

/// Number of times that the last message of a transfer is sent. The message is repeated because it is not acknowledged.
const COPIES: u8 = 3;
/// Factor that lengthens the wait for a quiet line after a failure, because the other side may still be sending.
const FAILED_QUIET_FACTOR: u64 = 10;

/// Carries out the end of a transfer: sends the last message, waits for a quiet line, and then returns the outcome.
pub struct Ending {
    outcome: State,
    last_message: Option<(u8, Message<'static>)>,
    copies: u8,
    quiet_ms: u64,
    /// Time in milliseconds at which the last message was sent or the last byte was received.
    last_ms: u64,
    /// Latest time in milliseconds at which the wait for a quiet line ends.
    deadline_ms: u64,
}

impl Ending {
    /// Starts the end of a transfer, in which `last_message` (session and message), if any, is sent repeatedly.
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

    /// Starts the end of a transfer that the other side has interrupted. This end needs no wait.
    pub fn interrupted(now_ms: u64) -> Self {
        let timing = Timing {
            silence_ms: 0,
            quiet_ms: 0,
        };
        let failure = Failure::AbortedByPeer(Reason::Cancelled);
        Self::new(State::Failed(failure), None, timing, now_ms)
    }

    /// Drops received bytes, which are remains of the transfer, and returns their number. Without a wait for a quiet line no
    /// bytes are dropped, and the result is 0.
    pub fn on_bytes(&mut self, now_ms: u64, bytes: &[u8]) -> usize {
        if self.quiet_ms == 0 {
            return 0;
        }
        if !bytes.is_empty() {
            self.last_ms = now_ms;
        }
        bytes.len()
    }

    /// Writes the next frame, if any, to `out`. Returns the frame's length and the state, which is the outcome once the
    /// wait is over.
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
