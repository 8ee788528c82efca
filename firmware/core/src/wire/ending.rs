//! The end of a transfer.

use super::frame::{Message, write};
use super::state::{Failure, State, Timing};

/// How often the last word is said, as nobody answers it.
const COPIES: u8 = 3;
/// A failed transfer ends in the middle of what the other side says, so the line must be quiet for longer.
const FAILED_QUIET_FACTOR: u64 = 10;

/// The outcome of a transfer, what is still to be said, and the wait for a quiet line.
pub struct Ending {
    outcome: State,
    farewell: Option<(u8, Message<'static>)>,
    copies: u8,
    quiet_ms: u64,
    /// When something was last said or heard.
    last_ms: u64,
    /// When the wait is over in any case.
    deadline_ms: u64,
}

impl Ending {
    /// Ends with `farewell` (its session and message), if there is something to say.
    pub fn new(
        outcome: State,
        farewell: Option<(u8, Message<'static>)>,
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
            farewell,
            copies: COPIES,
            quiet_ms: timing.quiet_ms.saturating_mul(factor),
            last_ms: now_ms,
            deadline_ms: now_ms.saturating_add(timing.silence_ms),
        }
    }

    /// The end of a transfer that failed with nobody to be told.
    pub fn failed(failure: Failure, timing: Timing, now_ms: u64) -> Self {
        Self::new(State::Failed(failure), None, timing, now_ms)
    }

    /// Swallows bytes unless they are the caller's; returns how many.
    pub fn on_bytes(&mut self, now_ms: u64, bytes: &[u8]) -> usize {
        if self.quiet_ms == 0 {
            return 0;
        }
        if !bytes.is_empty() {
            self.last_ms = now_ms;
        }
        bytes.len()
    }

    /// Writes a frame, if there is one left, and tells the state: the outcome when the end is over.
    pub fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> (usize, State) {
        if let Some((session, message)) = self.farewell {
            let length = write(session, message, out);
            if length > 0 {
                self.copies = self.copies.saturating_sub(1);
                self.last_ms = now_ms;
            }
            if self.copies == 0 {
                self.farewell = None;
            }
            return (length, State::Running);
        }
        let quiet = now_ms.saturating_sub(self.last_ms) >= self.quiet_ms;
        let over = quiet || now_ms >= self.deadline_ms;
        (0, if over { self.outcome } else { State::Running })
    }
}
