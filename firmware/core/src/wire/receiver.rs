//! The receiver of a transfer.

use super::ending::Ending;
use super::format::{BLOCK, CRC_32, Digest, MAX_LENGTH, Manifest, WINDOW};
use super::frame::{Acknowledge, Data, Message, write};
use super::party::{Party, Role};
use super::state::{Failure, Reason, State, Timing};

/// Receives one transfer into a borrowed buffer.
pub type Receiver<'a> = Party<Receiving<&'a mut [u8]>>;

impl<B: AsRef<[u8]> + AsMut<[u8]>> Party<Receiving<B>> {
    /// Waits for a transfer that fits into `buffer`. If `announced` is given, the transfer must have this length and CRC-32.
    pub fn new(buffer: B, announced: Option<Manifest>, timing: Timing, now_ms: u64) -> Self {
        Self::of(Receiving {
            buffer,
            announced,
            timing,
            opened: None,
            valid_ms: now_ms,
            reply: false,
            ending: None,
            state: State::Running,
        })
    }

    /// The verified data, once the state is [`State::Done`].
    pub fn received(&self) -> Option<&[u8]> {
        let opened = self.transfer.opened.as_ref()?;
        let buffer = self.transfer.buffer.as_ref();
        let received = buffer.get(..opened.manifest.length as usize)?;
        (self.transfer.state == State::Done).then_some(received)
    }

    /// Takes the buffer of a transfer that has ended.
    pub fn take_buffer(&mut self) -> B
    where
        B: Default,
    {
        core::mem::take(&mut self.transfer.buffer)
    }
}

/// The role of a receiver, with its buffer.
///
/// Blocks are written to the buffer in any order. The buffer's contents are valid once the state is [`State::Done`].
pub struct Receiving<B> {
    buffer: B,
    announced: Option<Manifest>,
    timing: Timing,
    opened: Option<Opened>,
    /// Time in milliseconds at which the last valid frame was received.
    valid_ms: u64,
    /// Whether a received frame has not yet been answered.
    reply: bool,
    ending: Option<Ending>,
    state: State,
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
    fn on_message(&mut self, now_ms: u64, session: u8, message: Message) {
        if let Message::Open(manifest) = message {
            self.valid_ms = now_ms;
            self.open(now_ms, session, manifest);
            return;
        }
        let Some(opened) = self
            .opened
            .as_mut()
            .filter(|opened| opened.session == session)
        else {
            return;
        };
        match message {
            Message::Data(data) => {
                opened.store(data, self.buffer.as_mut());
                self.reply = true;
            }
            Message::Close if opened.verdict == Some(true) => {
                self.ending = Some(Ending::new(State::Done, None, self.timing, now_ms));
            }
            Message::Abort(reason) => {
                self.ending = Some(Ending::failed(
                    Failure::AbortedByPeer(reason),
                    self.timing,
                    now_ms,
                ));
            }
            // Only a receiver sends messages of the other kinds, so such a message is an echo of a frame from this receiver.
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
        if now_ms.saturating_sub(self.valid_ms) > self.timing.silence_ms {
            // A silent sender may have received the verdict and ended, so a known verdict decides the outcome.
            let outcome = match self.opened.as_ref().and_then(|opened| opened.verdict) {
                Some(true) => State::Done,
                Some(false) => State::Failed(Failure::Corrupt),
                None => State::Failed(Failure::Silence(self.timing.silence_ms)),
            };
            self.ending = Some(Ending::new(outcome, None, self.timing, now_ms));
            return 0;
        }
        let Some(opened) = self.opened.as_ref().filter(|_| self.reply) else {
            return 0;
        };
        let length = write(opened.session, opened.report(), out);
        self.reply = length == 0;
        length
    }

    fn abort(&mut self, now_ms: u64) {
        self.cancel(Reason::Cancelled, now_ms);
    }

    fn state(&self) -> State {
        self.state
    }

    fn progress(&self) -> (u32, u32) {
        self.opened.as_ref().map_or((0, 0), |opened| {
            let length = opened.manifest.length;
            ((opened.next * BLOCK).min(length), length)
        })
    }
}

impl<B: AsRef<[u8]> + AsMut<[u8]>> Receiving<B> {
    fn open(&mut self, now_ms: u64, session: u8, manifest: Manifest) {
        let known = |opened: &Opened| opened.session == session && opened.manifest == manifest;
        if !self.opened.as_ref().is_some_and(known) {
            self.opened = Some(Opened::new(session, manifest));
            if self
                .announced
                .is_some_and(|announced| announced != manifest)
            {
                return self.cancel(Reason::Unannounced, now_ms);
            }
            if manifest.length > MAX_LENGTH || manifest.length as usize > self.buffer.as_ref().len()
            {
                return self.cancel(Reason::TooLong, now_ms);
            }
        }
        self.reply = true;
    }

    fn cancel(&mut self, reason: Reason, now_ms: u64) {
        if self.ending.is_none() {
            // Before an `Open` the session is unknown, so no message can be sent.
            let last_message = self
                .opened
                .as_ref()
                .map(|opened| (opened.session, Message::Abort(reason)));
            let outcome = State::Failed(Failure::Aborted(reason));
            self.ending = Some(Ending::new(outcome, last_message, self.timing, now_ms));
        }
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

    fn report(&self) -> Message<'static> {
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
