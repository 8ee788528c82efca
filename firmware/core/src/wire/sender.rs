//! The sender of a transfer.

use super::ending::Ending;
use super::format::{BLOCK, MAX_LENGTH, Manifest};
use super::frame::{Acknowledge, Data, Message, OVERHEAD, write};
use super::pace::{FrameSize, Patience};
use super::party::{Party, Role};
use super::state::{Failure, Reason, State, Timing};
use super::window::Window;

/// Maximum number of restarts of a transfer after a wrong CRC-32.
const RESTARTS: u8 = 3;
/// Longest time without a newly acknowledged block, in multiples of `Timing::silence_ms`.
const STALL_FACTOR: u64 = 4;

/// Sends one transfer from a slice.
pub type Sender<'a> = Party<Sending<&'a [u8]>>;

impl<D: AsRef<[u8]>> Party<Sending<D>> {
    /// Starts to send `data`. The number `session` (modulo 16) separates this transfer from remains of the previous one, so the
    /// caller increments it for each transfer.
    pub fn new(data: D, session: u8, timing: Timing, now_ms: u64) -> Self {
        let manifest = Manifest::of(data.as_ref());
        Self::announced(data, manifest, session, timing, now_ms)
    }

    /// Starts to send `data` with a known manifest.
    pub fn announced(
        data: D,
        manifest: Manifest,
        session: u8,
        timing: Timing,
        now_ms: u64,
    ) -> Self {
        let mut transfer = Sending {
            data,
            manifest,
            timing,
            session: session & 0xF,
            restarts: RESTARTS,
            window: Window::new(),
            frame_size: FrameSize::new(),
            patience: Patience::new(),
            valid_ms: now_ms,
            progress_ms: now_ms,
            farthest: 0,
            opened: false,
            ending: None,
            state: State::Running,
        };
        if transfer.manifest.length > MAX_LENGTH {
            transfer.fail(Failure::Aborted(Reason::TooLong), now_ms);
        }
        Self::of(transfer)
    }

    /// Present number of data bytes per data frame: at most 240, and fewer on a bad line.
    pub fn frame_bytes(&self) -> u32 {
        self.transfer.frame_size.blocks() * BLOCK
    }

    /// Takes the data of a transfer that has ended.
    pub fn take_data(&mut self) -> D
    where
        D: Default,
    {
        core::mem::take(&mut self.transfer.data)
    }
}

/// The role of a sender, with its data.
pub struct Sending<D> {
    data: D,
    manifest: Manifest,
    timing: Timing,
    session: u8,
    restarts: u8,
    window: Window,
    frame_size: FrameSize,
    /// Timeout after which the next acknowledgement is requested again.
    patience: Patience,
    /// Time in milliseconds at which the last valid frame was received.
    valid_ms: u64,
    /// Time in milliseconds at which `farthest` last increased.
    progress_ms: u64,
    /// Largest number of blocks that were ever acknowledged from the start without a gap.
    farthest: u32,
    /// Whether the receiver has answered.
    opened: bool,
    ending: Option<Ending>,
    state: State,
}

impl<D: AsRef<[u8]>> Role for Sending<D> {
    fn on_message(&mut self, now_ms: u64, session: u8, message: Message) {
        if session != self.session {
            return;
        }
        match message {
            Message::Acknowledge(acknowledge) => {
                if !self.acknowledged(acknowledge, now_ms) {
                    return;
                }
            }
            // A verdict is valid only after the last block was sent.
            Message::Complete { verified } if self.window.end == self.manifest.blocks() => {
                if verified {
                    let close = Some((self.session, Message::Close));
                    self.ending = Some(Ending::new(State::Done, close, self.timing, now_ms));
                } else {
                    self.restart(now_ms);
                }
            }
            Message::Abort(reason) => {
                self.ending = Some(Ending::failed(
                    Failure::AbortedByPeer(reason),
                    self.timing,
                    now_ms,
                ));
            }
            // Only a sender sends messages of the other kinds, so such a message is an echo of a frame from this sender.
            _ => return,
        }
        self.valid_ms = now_ms;
    }

    fn interrupt(&mut self, now_ms: u64) {
        self.ending = Some(Ending::interrupted(now_ms));
    }

    fn ending(&mut self) -> Option<&mut Ending> {
        self.ending.as_mut()
    }

    fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> usize {
        if let Some(ending) = &mut self.ending {
            let (length, state) = ending.poll(now_ms, out);
            self.state = state;
            return length;
        }
        let stall_ms = self.timing.silence_ms.saturating_mul(STALL_FACTOR);
        if now_ms.saturating_sub(self.valid_ms) > self.timing.silence_ms {
            self.fail(Failure::Silence(self.timing.silence_ms), now_ms);
            return 0;
        }
        if now_ms.saturating_sub(self.progress_ms) > stall_ms {
            self.fail(Failure::Stalled(stall_ms), now_ms);
            return 0;
        }
        let sending = self.opened && self.window.next < self.manifest.blocks();
        if sending && !self.window.is_full() {
            let length = self.send_data(self.frame_size.blocks(), now_ms, out);
            if length > 0 {
                return length;
            }
        }
        // No new block can be sent: the sender waits for an answer until the timeout.
        if self.patience.is_waiting() && !self.patience.is_over(now_ms) {
            return 0;
        }
        if sending {
            // One block is enough to request the map of missing blocks, and a short frame is the least likely to be damaged.
            self.window.forget_first();
            return self.send_data(1, now_ms, out);
        }
        // An `Open` requests the first answer at the start of a transfer, and the verdict at its end.
        self.patience.begin(now_ms);
        write(self.session, Message::Open(self.manifest), out)
    }

    fn abort(&mut self, now_ms: u64) {
        self.fail(Failure::Aborted(Reason::Cancelled), now_ms);
    }

    fn state(&self) -> State {
        self.state
    }

    fn progress(&self) -> (u32, u32) {
        let length = self.manifest.length;
        (self.window.next.saturating_mul(BLOCK).min(length), length)
    }
}

impl<D: AsRef<[u8]>> Sending<D> {
    /// Applies an acknowledgement. Returns `false` for an impossible acknowledgement, which is ignored.
    fn acknowledged(&mut self, acknowledge: Acknowledge, now_ms: u64) -> bool {
        let blocks = self.frame_size.blocks();
        let Some(fate) = self.window.update(acknowledge) else {
            return false;
        };
        let bytes = (fate.arrived + fate.lost) * BLOCK;
        self.frame_size.record(
            bytes + bytes * OVERHEAD as u32 / (blocks * BLOCK),
            fate.lost_frames,
        );
        self.patience.answered(now_ms);
        self.opened = true;
        if self.window.next > self.farthest {
            self.farthest = self.window.next;
            self.progress_ms = now_ms;
        }
        true
    }

    /// Writes a data frame with the next blocks to send, at most `most`; returns its length.
    fn send_data(&mut self, most: u32, now_ms: u64, out: &mut [u8]) -> usize {
        let Some(run) = self.window.take(most, self.manifest.blocks()) else {
            return 0;
        };
        let start = run.block.saturating_mul(BLOCK) as usize;
        let end = start
            .saturating_add((run.blocks * BLOCK) as usize)
            .min(self.data.as_ref().len());
        let bytes = self.data.as_ref().get(start..end).unwrap_or_default();
        self.patience.begin(now_ms);
        write(
            self.session,
            Message::Data(Data {
                number: run.number,
                block: run.block,
                bytes,
            }),
            out,
        )
    }

    /// Restarts the transfer after a wrong CRC-32, or fails if no restart is left.
    fn restart(&mut self, now_ms: u64) {
        let Some(restarts) = self.restarts.checked_sub(1) else {
            return self.fail(Failure::Corrupt, now_ms);
        };
        self.restarts = restarts;
        self.session = (self.session + 1) & 0xF;
        self.window = Window::new();
        self.opened = false;
        self.patience = Patience::new();
        self.farthest = 0;
        self.progress_ms = now_ms;
    }

    fn fail(&mut self, failure: Failure, now_ms: u64) {
        if self.ending.is_none() {
            let reason = match failure {
                Failure::Aborted(reason) => reason,
                Failure::Corrupt => Reason::Corrupt,
                _ => Reason::NoAnswer,
            };
            let last_message = Some((self.session, Message::Abort(reason)));
            self.ending = Some(Ending::new(
                State::Failed(failure),
                last_message,
                self.timing,
                now_ms,
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::{MAX_FRAME, Receiver};

    /// Runs a transfer whose manifest has a wrong CRC-32, which simulates damage that no CRC-16 detects. From the session
    /// `mend_in_session` on, the CRC-32 is right.
    fn talk(sender: &mut Sender, receiver: &mut Receiver, mend_in_session: u8) {
        let mut frame = [0; MAX_FRAME];
        for now_ms in 0..10_000 {
            if sender.transfer.session == mend_in_session {
                sender.transfer.manifest = Manifest::of(sender.transfer.data);
            }
            let length = sender.poll(now_ms, &mut frame);
            receiver.on_bytes(now_ms, frame.get(..length).unwrap_or_default());
            let length = receiver.poll(now_ms, &mut frame);
            sender.on_bytes(now_ms, frame.get(..length).unwrap_or_default());
        }
    }

    #[test]
    fn a_transfer_that_was_damaged_on_its_way_starts_again() {
        let (data, mut buffer) = ([0x5A; 700], [0; 700]);
        let mut sender = Sender::new(&data, 14, Timing::HOST, 0);
        sender.transfer.manifest.crc32 ^= 1;
        let mut receiver = Receiver::new(&mut buffer, None, Timing::CONSOLE, 0);
        // The CRC-32 is wrong in sessions 14 and 15; in session 0 it is right.
        talk(&mut sender, &mut receiver, 0);
        assert_eq!(
            (sender.state(), receiver.state()),
            (State::Done, State::Done)
        );
        assert_eq!(receiver.received(), Some(&data[..]));
    }

    #[test]
    fn a_transfer_that_is_always_damaged_is_given_up() {
        let (data, mut buffer) = ([0x5A; 700], [0; 700]);
        let mut sender = Sender::new(&data, 3, Timing::HOST, 0);
        sender.transfer.manifest.crc32 ^= 1;
        let mut receiver = Receiver::new(&mut buffer, None, Timing::CONSOLE, 0);
        talk(&mut sender, &mut receiver, 3 + RESTARTS + 1);
        assert_eq!(sender.state(), State::Failed(Failure::Corrupt));
        assert_eq!(
            receiver.state(),
            State::Failed(Failure::AbortedByPeer(Reason::Corrupt))
        );
        assert_eq!(receiver.received(), None);
    }
}
