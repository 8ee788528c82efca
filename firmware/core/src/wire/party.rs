//! A trait that both the sender and the receiver of a transfer implement.

use super::receiver::Receiver;
use super::sender::Sender;
use super::state::State;

/// Either side of a transfer, for code that connects it to a line.
///
/// Each method calls the method of [`Sender`] or [`Receiver`] with the same name.
pub trait Party {
    /// Processes received bytes; returns the number of bytes that belong to the transfer.
    fn on_bytes(&mut self, now_ms: u64, bytes: &[u8]) -> usize;
    /// Writes the next frame, if any, and returns its length.
    fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> usize;
    /// Cancels the transfer and notifies the other side.
    fn abort(&mut self, now_ms: u64);
    /// State of the transfer at the last `poll`.
    fn state(&self) -> State;
    /// Number of bytes transferred from the start without a gap, and the total number of bytes.
    fn progress(&self) -> (u32, u32);
}

macro_rules! party {
    ($side:ident) => {
        impl Party for $side<'_> {
            fn on_bytes(&mut self, now_ms: u64, bytes: &[u8]) -> usize {
                $side::on_bytes(self, now_ms, bytes)
            }
            fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> usize {
                $side::poll(self, now_ms, out)
            }
            fn abort(&mut self, now_ms: u64) {
                $side::abort(self, now_ms);
            }
            fn state(&self) -> State {
                $side::state(self)
            }
            fn progress(&self) -> (u32, u32) {
                $side::progress(self)
            }
        }
    };
}

party!(Sender);
party!(Receiver);
