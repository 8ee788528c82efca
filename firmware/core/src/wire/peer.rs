//! Extracts frames from received bytes, and passes them to the sender or receiver of a transfer.

use super::ending::Ending;
use super::frame::{Message, Reader};

/// Reactions of a sender or receiver to received frames.
pub trait Peer {
    /// Processes a valid frame.
    fn on_message(&mut self, now_ms: u64, session: u8, message: Message);
    /// Ends the transfer at once, on request of the other side. What follows on the line does not belong to it.
    fn interrupt(&mut self, now_ms: u64);
    /// The end of the transfer; `None` while the transfer is in progress.
    fn ending(&mut self) -> Option<&mut Ending>;
}

/// Passes the frames in `bytes` to the sender or receiver `peer`. Returns the number of bytes that belong to the transfer.
pub fn feed(reader: &mut Reader, peer: &mut impl Peer, now_ms: u64, bytes: &[u8]) -> usize {
    if !bytes.is_empty() {
        reader.receive(now_ms);
    }
    let mut taken = 0;
    while let Some(rest) = bytes.get(taken..).filter(|rest| !rest.is_empty()) {
        if let Some(ending) = peer.ending() {
            return taken + ending.on_bytes(now_ms, rest);
        }
        let (length, frame) = reader.take(rest);
        taken += length;
        match frame {
            Some((_, Message::Reset)) => peer.interrupt(now_ms),
            Some((session, message)) => peer.on_message(now_ms, session, message),
            None => {}
        }
    }
    taken
}

/// Interrupts the transfer if a person has typed Ctrl-C.
pub fn check_interrupt(reader: &Reader, peer: &mut impl Peer, now_ms: u64) {
    if peer.ending().is_none() && reader.is_interrupted(now_ms) {
        peer.interrupt(now_ms);
    }
}
