//! Common code of both sides of a transfer.

use super::ending::Ending;
use super::frame::{FrameReader, MAX_FRAME, Message};
use super::state::{Failure, Reason, State, Timing};

/// The behaviour in which a sender and a receiver differ.
pub trait Role {
    /// Session of the transfer; `None` while it is unknown.
    fn session(&self) -> Option<u8>;
    /// Processes a message other than `Reset` and `Abort`. Returns the new state; `None` if the message is ignored.
    fn on_message(&mut self, now_ms: u64, session: u8, message: Message) -> Option<State>;
    /// Outcome of a transfer without a valid frame for `silence_ms`.
    fn on_silence(&self, silence_ms: u64) -> State;
    /// The message that reports this outcome to the other side, if any.
    fn report(&self, outcome: State) -> Option<Message<'static>>;
    /// Writes the next frame, if any, to `out`, which is long enough, and returns its length.
    ///
    /// # Errors
    /// The transfer has failed.
    fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> Result<usize, Failure>;
    /// Number of bytes transferred from the start without a gap, and the total number of bytes (0 while unknown).
    fn progress(&self) -> (u32, u32);
}

/// A side of a transfer: a sender or a receiver, by its [`Role`].
pub struct Endpoint<R> {
    reader: FrameReader,
    timing: Timing,
    /// Time in milliseconds at which the last valid frame was received.
    valid_ms: u64,
    /// The end of the transfer; `None` while the transfer is in progress.
    ending: Option<Ending>,
    /// State at the last `poll`.
    state: State,
    pub(super) role: R,
}

impl<R: Role> Endpoint<R> {
    pub(super) const fn of(role: R, timing: Timing, now_ms: u64) -> Self {
        Self {
            reader: FrameReader::new(),
            timing,
            valid_ms: now_ms,
            ending: None,
            state: State::Running,
            role,
        }
    }

    /// Processes received bytes. Returns how many of the bytes belong to the transfer: all of them, until the transfer ends.
    pub fn on_bytes(&mut self, now_ms: u64, bytes: &[u8]) -> usize {
        if !bytes.is_empty() {
            self.reader.receive(now_ms);
        }
        let mut taken = 0;
        while let Some(rest) = bytes.get(taken..).filter(|rest| !rest.is_empty()) {
            if let Some(ending) = &mut self.ending {
                return taken + ending.on_bytes(now_ms, rest);
            }
            let (length, frame) = self.reader.take(rest);
            taken += length;
            let state = match frame {
                None => continue,
                // Later bytes on the line do not belong to the transfer.
                Some((_, Message::Reset)) => {
                    self.ending = Some(Ending::interrupted(now_ms));
                    continue;
                }
                Some((session, Message::Abort(reason))) => (self.role.session() == Some(session))
                    .then_some(State::Failed(Failure::AbortedByPeer(reason))),
                Some((session, message)) => self.role.on_message(now_ms, session, message),
            };
            if let Some(state) = state {
                self.valid_ms = now_ms;
                self.enter(state, now_ms);
            }
        }
        taken
    }

    /// Writes the next frame, if any, and returns its length. Call this whenever the line accepts bytes, and regularly, because
    /// timeouts are checked here. `out` needs [`MAX_FRAME`] bytes; nothing is written to a shorter buffer.
    pub fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> usize {
        if out.len() < MAX_FRAME {
            return 0;
        }
        if self.ending.is_none() && self.reader.is_interrupted(now_ms) {
            // Cancels the transfer because Ctrl-C was typed.
            self.ending = Some(Ending::interrupted(now_ms));
        }
        if let Some(ending) = &mut self.ending {
            let (length, state) = ending.poll(now_ms, out);
            self.state = state;
            return length;
        }
        let silence_ms = self.timing.silence_ms;
        if now_ms.saturating_sub(self.valid_ms) > silence_ms {
            self.enter(self.role.on_silence(silence_ms), now_ms);
            return 0;
        }
        self.role.poll(now_ms, out).unwrap_or_else(|failure| {
            self.enter(State::Failed(failure), now_ms);
            0
        })
    }

    /// Cancels the transfer and notifies the other side.
    pub fn abort(&mut self, now_ms: u64) {
        self.enter(State::Failed(Failure::Aborted(Reason::Cancelled)), now_ms);
    }

    /// Ends the transfer with the outcome `state`; does nothing for [`State::Running`], and after the end has begun.
    pub(super) fn enter(&mut self, state: State, now_ms: u64) {
        if state != State::Running && self.ending.is_none() {
            let report = self.role.session().zip(self.role.report(state));
            self.ending = Some(Ending::new(state, report, self.timing, now_ms));
        }
    }

    /// State of the transfer at the last `poll`.
    pub const fn state(&self) -> State {
        self.state
    }

    /// Whether the transfer only has to repeat its last message and to wait for a quiet line, both controlled by time.
    pub const fn is_ending(&self) -> bool {
        self.ending.is_some()
    }

    /// Number of bytes transferred from the start without a gap, and the total number of bytes (0 while unknown).
    pub fn progress(&self) -> (u32, u32) {
        self.role.progress()
    }
}
