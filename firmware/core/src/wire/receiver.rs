//! The receiver of a transfer.

use super::endpoint::{Endpoint, Role};
use super::format::{BLOCK, CRC_32, Digest, MAX_LENGTH, Manifest, WINDOW};
use super::frame::{Acknowledge, Data, Message, write};
use super::state::{Failure, Reason, State, Timing};

/// Receives one transfer into a borrowed buffer.
pub type Receiver<'a> = Endpoint<Receiving<&'a mut [u8]>>;

impl<B: AsRef<[u8]> + AsMut<[u8]>> Endpoint<Receiving<B>> {
    /// Waits for a transfer that fits into `buffer`. If `announced` is given, the transfer must have this length and CRC-32.
    pub fn new(buffer: B, announced: Option<Manifest>, timing: Timing, now_ms: u64) -> Self {
        let role = Receiving {
            buffer,
            announced,
            opened: None,
            reply: false,
        };
        Self::of(role, timing, now_ms)
    }

    /// The verified data, once the state is [`State::Done`].
    pub fn received(&self) -> Option<&[u8]> {
        let opened = self.role.opened.as_ref()?;
        let buffer = self.role.buffer.as_ref();
        let received = buffer.get(..opened.manifest.length as usize)?;
        (self.state() == State::Done).then_some(received)
    }

    /// Takes the buffer of a transfer that has ended.
    pub fn take_buffer(&mut self) -> B
    where
        B: Default,
    {
        core::mem::take(&mut self.role.buffer)
    }
}

/// The role of a receiver, with its buffer.
///
/// Blocks are written to the buffer in any order. The buffer's contents are valid once the state is [`State::Done`].
pub struct Receiving<B> {
    buffer: B,
    announced: Option<Manifest>,
    opened: Option<Opened>,
    /// Whether a received frame has not yet been answered.
    reply: bool,
}

/// State of a transfer whose `Open` was received.
struct Opened {
    session: u8,
    manifest: Manifest,
    /// The first missing block.
    next: u32,
    /// Bit i is set if block `next` + i was received.
    map: u128,
    /// Frame number of the last received data frame.
    number: u8,
    /// CRC-32 of the blocks before `next`.
    digest: Digest,
    /// Whether the CRC-32 of the transfer is right; `None` until all blocks were received.
    verdict: Option<bool>,
}

impl<B: AsRef<[u8]> + AsMut<[u8]>> Role for Receiving<B> {
    fn session(&self) -> Option<u8> {
        self.opened.as_ref().map(|opened| opened.session)
    }

    fn on_message(&mut self, _: u64, session: u8, message: Message) -> Option<State> {
        if let Message::Open(manifest) = message {
            return Some(self.open(session, manifest));
        }
        let opened = self.opened.as_mut();
        let opened = opened.filter(|opened| opened.session == session)?;
        match message {
            Message::Data(data) => {
                opened.store(data, self.buffer.as_mut());
                self.reply = true;
                Some(State::Running)
            }
            Message::Close => (opened.verdict == Some(true)).then_some(State::Done),
            // Only a receiver sends `Acknowledge` and `Complete`, so this message is an echo of its own frame.
            Message::Acknowledge(_)
            | Message::Complete { .. }
            | Message::Open(_)
            | Message::Abort(_)
            | Message::Reset => None,
        }
    }

    fn on_silence(&self, silence_ms: u64) -> State {
        // A silent sender may have received the verdict and ended, so a known verdict decides the outcome.
        match self.opened.as_ref().and_then(|opened| opened.verdict) {
            Some(true) => State::Done,
            Some(false) => State::Failed(Failure::Corrupt),
            None => State::Failed(Failure::Silence(silence_ms)),
        }
    }

    fn report(&self, outcome: State) -> Option<Message<'static>> {
        match outcome {
            State::Failed(Failure::Aborted(reason)) => Some(Message::Abort(reason)),
            State::Running | State::Done => None,
            State::Failed(
                Failure::Silence(_)
                | Failure::Stalled(_)
                | Failure::Corrupt
                | Failure::AbortedByPeer(_),
            ) => None,
        }
    }

    fn poll(&mut self, _: u64, out: &mut [u8]) -> Result<usize, Failure> {
        let Some(opened) = self.opened.as_ref().filter(|_| self.reply) else {
            return Ok(0);
        };
        let length = write(opened.session, opened.answer(), out);
        self.reply = length == 0;
        Ok(length)
    }

    fn progress(&self) -> (u32, u32) {
        self.opened.as_ref().map_or((0, 0), |opened| {
            let length = opened.manifest.length;
            ((opened.next * BLOCK).min(length), length)
        })
    }
}

impl<B: AsRef<[u8]>> Receiving<B> {
    fn open(&mut self, session: u8, manifest: Manifest) -> State {
        let known = |opened: &Opened| opened.session == session && opened.manifest == manifest;
        if !self.opened.as_ref().is_some_and(known) {
            self.opened = Some(Opened::new(session, manifest));
            let room = self.buffer.as_ref().len();
            let reason = if self.announced.is_some_and(|known| known != manifest) {
                Some(Reason::Unannounced)
            } else if manifest.length > MAX_LENGTH || manifest.length as usize > room {
                Some(Reason::TooLong)
            } else {
                None
            };
            if let Some(reason) = reason {
                return State::Failed(Failure::Aborted(reason));
            }
        }
        self.reply = true;
        State::Running
    }
}

impl Opened {
    fn new(session: u8, manifest: Manifest) -> Self {
        let mut opened = Self {
            session,
            manifest,
            next: 0,
            map: 0,
            number: 0,
            digest: CRC_32.digest(),
            verdict: None,
        };
        opened.judge();
        opened
    }

    /// Stores the new blocks of a data frame that are within the window.
    fn store(
        &mut self,
        Data {
            number,
            block,
            bytes,
        }: Data,
        buffer: &mut [u8],
    ) {
        let length = bytes.len() as u32;
        let Some(end) = block
            .checked_mul(BLOCK)
            .and_then(|start| start.checked_add(length))
        else {
            return;
        };
        let whole = length.is_multiple_of(BLOCK) || end == self.manifest.length;
        let past = end.div_ceil(BLOCK);
        if length == 0
            || !whole
            || end > self.manifest.length
            || past > self.next.saturating_add(WINDOW)
        {
            return;
        }
        self.number = number;
        // Blocks before `next` are part of the CRC-32 and must not change.
        let first = block.max(self.next);
        let new = bytes
            .get(((first - block) * BLOCK) as usize..)
            .unwrap_or_default();
        let Some(room) = buffer.get_mut((first * BLOCK) as usize..end as usize) else {
            return;
        };
        if past <= first || room.len() != new.len() {
            return;
        }
        room.copy_from_slice(new);
        // The frame has at most 15 new blocks, and all of them are within the bits of the map.
        self.map |= ((1 << (past - first)) - 1) << (first - self.next);
        self.advance(buffer);
    }

    /// Advances `next` and the CRC-32 over the received blocks.
    fn advance(&mut self, buffer: &[u8]) {
        let blocks = self.map.trailing_ones();
        let from = self.next * BLOCK;
        self.next += blocks;
        self.map = self.map.checked_shr(blocks).unwrap_or(0);
        let to = (self.next * BLOCK).min(self.manifest.length);
        self.digest
            .update(buffer.get(from as usize..to as usize).unwrap_or_default());
        self.judge();
    }

    /// Decides whether the CRC-32 is right, once all blocks were received.
    fn judge(&mut self) {
        if self.next >= self.manifest.blocks() && self.verdict.is_none() {
            self.verdict = Some(self.digest.clone().finalize() == self.manifest.crc32);
        }
    }

    fn answer(&self) -> Message<'static> {
        match self.verdict {
            Some(verified) => Message::Complete { verified },
            None => Message::Acknowledge(Acknowledge {
                number: self.number,
                next: self.next,
                map: self.map,
            }),
        }
    }
}
