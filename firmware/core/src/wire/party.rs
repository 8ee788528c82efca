//! Common code of both sides of a transfer.

use super::ending::Ending;
use super::frame::{MAX_FRAME, Message, Reader};
use super::state::State;

/// The behaviour in which a sender and a receiver differ.
pub trait Role {
    /// Processes a valid frame.
    fn on_message(&mut self, now_ms: u64, session: u8, message: Message);
    /// Ends the transfer at once, on request of the other side. Later bytes on the line do not belong to the transfer.
    fn interrupt(&mut self, now_ms: u64);
    /// The end of the transfer; `None` while the transfer is in progress.
    fn ending(&mut self) -> Option<&mut Ending>;
    /// Writes the next frame, if any, to `out`, which is long enough, and returns its length.
    fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> usize;
    /// Cancels the transfer and notifies the other side.
    fn abort(&mut self, now_ms: u64);
    /// State of the transfer at the last `poll`.
    fn state(&self) -> State;
    /// Number of bytes transferred from the start without a gap, and the total number of bytes (0 while unknown).
    fn progress(&self) -> (u32, u32);
}

/// A side of a transfer: a sender or a receiver, by its [`Role`].
pub struct Party<R> {
    reader: Reader,
    /// All state except the reader, because received frames borrow the reader.
    pub(super) transfer: R,
}

impl<R: Role> Party<R> {
    pub(super) const fn of(transfer: R) -> Self {
        Self {
            reader: Reader::new(),
            transfer,
        }
    }

    /// Processes received bytes. Returns how many of the bytes belong to the transfer: all of them, until the transfer ends.
    pub fn on_bytes(&mut self, now_ms: u64, bytes: &[u8]) -> usize {
        if !bytes.is_empty() {
            self.reader.receive(now_ms);
        }
        let mut taken = 0;
        while let Some(rest) = bytes.get(taken..).filter(|rest| !rest.is_empty()) {
            if let Some(ending) = self.transfer.ending() {
                return taken + ending.on_bytes(now_ms, rest);
            }
            let (length, frame) = self.reader.take(rest);
            taken += length;
            match frame {
                Some((_, Message::Reset)) => self.transfer.interrupt(now_ms),
                Some((session, message)) => self.transfer.on_message(now_ms, session, message),
                None => {}
            }
        }
        taken
    }

    /// Writes the next frame, if any, and returns its length. Call this whenever the line accepts bytes, and regularly, because
    /// timeouts are checked here. `out` needs [`MAX_FRAME`] bytes; to a shorter buffer nothing is written.
    pub fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> usize {
        if out.len() < MAX_FRAME {
            return 0;
        }
        if self.transfer.ending().is_none() && self.reader.is_interrupted(now_ms) {
            // Cancels the transfer because Ctrl-C was typed.
            self.transfer.interrupt(now_ms);
        }
        self.transfer.poll(now_ms, out)
    }

    /// Cancels the transfer and notifies the other side.
    pub fn abort(&mut self, now_ms: u64) {
        self.transfer.abort(now_ms);
    }

    /// State of the transfer at the last `poll`.
    pub fn state(&self) -> State {
        self.transfer.state()
    }

    /// Whether the transfer only has to repeat its last message and to wait for a quiet line, both controlled by time.
    pub fn is_ending(&mut self) -> bool {
        self.transfer.ending().is_some()
    }

    /// Number of bytes transferred from the start without a gap, and the total number of bytes (0 while unknown).
    pub fn progress(&self) -> (u32, u32) {
        self.transfer.progress()
    }
}
