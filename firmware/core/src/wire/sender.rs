//! The sender of a transfer.

use super::endpoint::{Endpoint, Role};
use super::format::{BLOCK, MAX_LENGTH, Manifest};
use super::frame::{Acknowledge, Data, Message, OVERHEAD, write};
use super::pace::{Backoff, FrameLength};
use super::state::{Failure, Reason, State, Timing};
use super::window::SendWindow;

/// Maximum number of restarts of a transfer after a wrong CRC-32.
const RESTARTS: u8 = 3;
/// Longest time without a newly acknowledged block, in multiples of `Timing::silence_ms`.
const STALL_FACTOR: u64 = 4;

/// Sends one transfer from a slice.
pub type Sender<'a> = Endpoint<Sending<&'a [u8]>>;

impl<D: AsRef<[u8]>> Endpoint<Sending<D>> {
    /// Starts to send `data`. The number `session` (modulo 16) separates this transfer from remains of the previous transfer, so the
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
        let role = Sending {
            data,
            manifest,
            session: session & 0xF,
            restarts: RESTARTS,
            window: SendWindow::new(),
            frame_length: FrameLength::new(),
            backoff: Backoff::new(),
            stall_ms: timing.silence_ms.saturating_mul(STALL_FACTOR),
            progress_ms: now_ms,
            farthest: 0,
            opened: false,
        };
        let mut sender = Self::of(role, timing, now_ms);
        if manifest.length > MAX_LENGTH {
            sender.enter(State::Failed(Failure::Aborted(Reason::TooLong)), now_ms);
        }
        sender
    }

    /// Takes the data of a transfer that has ended.
    pub fn take_data(&mut self) -> D
    where
        D: Default,
    {
        core::mem::take(&mut self.role.data)
    }
}

/// The role of a sender, with its data.
pub struct Sending<D> {
    data: D,
    manifest: Manifest,
    session: u8,
    restarts: u8,
    window: SendWindow,
    frame_length: FrameLength,
    /// Timeout after which the next acknowledgement is requested again.
    backoff: Backoff,
    /// Longest time in milliseconds in which `farthest` does not increase.
    stall_ms: u64,
    /// Time in milliseconds at which `farthest` last increased.
    progress_ms: u64,
    /// Largest number of blocks that were ever acknowledged from the start without a gap.
    farthest: u32,
    /// Whether the receiver has answered.
    opened: bool,
}

impl<D: AsRef<[u8]>> Role for Sending<D> {
    fn session(&self) -> Option<u8> {
        Some(self.session)
    }

    fn on_message(&mut self, now_ms: u64, session: u8, message: Message) -> Option<State> {
        if session != self.session {
            return None;
        }
        match message {
            Message::Acknowledge(acknowledge) => self.acknowledged(acknowledge, now_ms),
            // A verdict is valid only after the last block was sent.
            Message::Complete { .. } if self.window.end != self.manifest.blocks() => None,
            Message::Complete { verified: true } => Some(State::Done),
            Message::Complete { verified: false } => Some(self.restart(now_ms)),
            // Only a sender sends `Open`, `Data` and `Close`, so this message is an echo of its own frame.
            Message::Open(_)
            | Message::Data(_)
            | Message::Close
            | Message::Abort(_)
            | Message::Reset => None,
        }
    }

    fn on_silence(&self, silence_ms: u64) -> State {
        State::Failed(Failure::Silence(silence_ms))
    }

    fn report(&self, outcome: State) -> Option<Message<'static>> {
        Some(match outcome {
            State::Running | State::Failed(Failure::AbortedByPeer(_)) => return None,
            State::Done => Message::Close,
            State::Failed(Failure::Aborted(reason)) => Message::Abort(reason),
            State::Failed(Failure::Corrupt) => Message::Abort(Reason::Corrupt),
            State::Failed(Failure::Silence(_) | Failure::Stalled(_)) => {
                Message::Abort(Reason::NoAnswer)
            }
        })
    }

    fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> Result<usize, Failure> {
        if now_ms.saturating_sub(self.progress_ms) > self.stall_ms {
            return Err(Failure::Stalled(self.stall_ms));
        }
        let sending = self.opened && self.window.next < self.manifest.blocks();
        if sending && !self.window.is_full() {
            let length = self.send_data(self.frame_length.blocks(), now_ms, out);
            if length > 0 {
                return Ok(length);
            }
        }
        // No new block can be sent: the sender waits for an answer until the timeout.
        if self.backoff.is_waiting() && !self.backoff.is_over(now_ms) {
            return Ok(0);
        }
        if sending {
            // One block is enough to request the map of missing blocks, and a short frame is the least likely to be damaged.
            self.window.forget_first();
            return Ok(self.send_data(1, now_ms, out));
        }
        // An `Open` requests the first answer at the start of a transfer, and the verdict at its end.
        self.backoff.begin(now_ms);
        Ok(write(self.session, Message::Open(self.manifest), out))
    }

    fn progress(&self) -> (u32, u32) {
        let length = self.manifest.length;
        (self.window.next.saturating_mul(BLOCK).min(length), length)
    }
}

impl<D: AsRef<[u8]>> Sending<D> {
    /// Applies an acknowledgement; an impossible one is ignored.
    fn acknowledged(&mut self, acknowledge: Acknowledge, now_ms: u64) -> Option<State> {
        let blocks = self.frame_length.blocks();
        let fate = self.window.update(acknowledge)?;
        let bytes = (fate.arrived + fate.lost) * BLOCK;
        self.frame_length.record(
            bytes + bytes * OVERHEAD as u32 / (blocks * BLOCK),
            fate.lost_frames,
        );
        self.backoff.answered(now_ms);
        self.opened = true;
        if self.window.next > self.farthest {
            self.farthest = self.window.next;
            self.progress_ms = now_ms;
        }
        Some(State::Running)
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
        self.backoff.begin(now_ms);
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
    fn restart(&mut self, now_ms: u64) -> State {
        let Some(restarts) = self.restarts.checked_sub(1) else {
            return State::Failed(Failure::Corrupt);
        };
        self.restarts = restarts;
        self.session = (self.session + 1) & 0xF;
        self.window = SendWindow::new();
        self.opened = false;
        self.backoff = Backoff::new();
        self.farthest = 0;
        self.progress_ms = now_ms;
        State::Running
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
            if sender.role.session == mend_in_session {
                sender.role.manifest = Manifest::of(sender.role.data);
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
        sender.role.manifest.crc32 ^= 1;
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
        sender.role.manifest.crc32 ^= 1;
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
