//! The side that has the data.

use super::ending::Ending;
use super::frame::{Acknowledge, Data, MAX_FRAME, Message, OVERHEAD, Reader, write};
use super::pace::{FrameSize, Patience};
use super::{BLOCK, Failure, MAX_LENGTH, Manifest, Peer, Reason, State, Timing, WINDOW, feed};

/// How often a transfer starts again when its CRC-32 is wrong at the end.
const RESTARTS: u8 = 3;
/// A transfer is stuck when nothing new gets through for so many times the silence.
const STALL_FACTOR: u64 = 4;
/// Numbers of data frames are modulo 256; with no more than this on their way, older and newer stay apart.
const MAX_FRAMES: u8 = 120;

/// Sends one transfer from a slice.
pub struct Sender<'a> {
    reader: Reader,
    transfer: Transfer<'a>,
}

impl<'a> Sender<'a> {
    /// Starts to send `data`. `session` (modulo 16) tells this transfer from what is left of the one before: count it up.
    pub fn new(data: &'a [u8], session: u8, timing: Timing, now_ms: u64) -> Self {
        let mut transfer = Transfer {
            data,
            manifest: Manifest::of(data),
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
        Self {
            reader: Reader::new(),
            transfer,
        }
    }

    /// Takes bytes that came and returns how many of them belong to the transfer: less than all only after its end.
    pub fn on_bytes(&mut self, now_ms: u64, bytes: &[u8]) -> usize {
        feed(&mut self.reader, &mut self.transfer, now_ms, bytes)
    }

    /// Writes the next frame, if there is one to send, and returns its length. It also keeps the time, so it is
    /// to be called whenever the line takes more. `out` needs [`MAX_FRAME`] bytes; nothing is written into less.
    pub fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> usize {
        if out.len() < MAX_FRAME {
            0
        } else {
            self.transfer.poll(now_ms, out)
        }
    }

    /// Gives the transfer up and tells the receiver.
    pub fn abort(&mut self, now_ms: u64) {
        self.transfer
            .fail(Failure::Aborted(Reason::Cancelled), now_ms);
    }

    /// Where the transfer is, as of the last `poll`.
    pub fn state(&self) -> State {
        self.transfer.state
    }

    /// Bytes that are known to have arrived without a gap, and bytes in all.
    pub fn progress(&self) -> (u32, u32) {
        let length = self.transfer.manifest.length;
        (
            self.transfer.window.next.saturating_mul(BLOCK).min(length),
            length,
        )
    }

    /// Data bytes that frames have at present, at most 240: less on a line that damages more.
    pub fn frame_bytes(&self) -> u32 {
        self.transfer.frame_size.blocks() * BLOCK
    }
}

/// All but the reader, which lends out its frames.
struct Transfer<'a> {
    data: &'a [u8],
    manifest: Manifest,
    timing: Timing,
    session: u8,
    restarts: u8,
    window: Window,
    frame_size: FrameSize,
    /// Until an acknowledgement comes.
    patience: Patience,
    /// When the last valid frame came.
    valid_ms: u64,
    /// When `farthest` last grew.
    progress_ms: u64,
    /// The most blocks that have been acknowledged without a gap.
    farthest: u32,
    /// The receiver has answered.
    opened: bool,
    ending: Option<Ending>,
    state: State,
}

impl Peer for Transfer<'_> {
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
            // Only believable once everything has been sent.
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
            // A sender's own messages are echoes.
            _ => return,
        }
        self.valid_ms = now_ms;
    }

    fn ending(&mut self) -> Option<&mut Ending> {
        self.ending.as_mut()
    }
}

impl Transfer<'_> {
    /// Takes an acknowledgement as the truth, unless it cannot be.
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
        // All that may be on its way is.
        if self.patience.is_waiting() && !self.patience.is_over(now_ms) {
            return 0;
        }
        if sending {
            // One block is enough to be told which others are missing, and gets through soonest.
            self.window.forget_first();
            return self.send_data(1, now_ms, out);
        }
        // An `Open` asks for an answer at the start, and at the end for the verdict.
        self.patience.begin(now_ms);
        write(self.session, Message::Open(self.manifest), out)
    }

    /// Sends up to `most` of the first blocks that are to be sent.
    fn send_data(&mut self, most: u32, now_ms: u64, out: &mut [u8]) -> usize {
        let Some(run) = self.window.take(most, self.manifest.blocks()) else {
            return 0;
        };
        let start = run.block.saturating_mul(BLOCK) as usize;
        let end = start
            .saturating_add((run.blocks * BLOCK) as usize)
            .min(self.data.len());
        let bytes = self.data.get(start..end).unwrap_or_default();
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

    /// Starts again from the beginning, as the receiver found the whole damaged.
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
            let farewell = Some((self.session, Message::Abort(reason)));
            self.ending = Some(Ending::new(
                State::Failed(failure),
                farewell,
                self.timing,
                now_ms,
            ));
        }
    }
}

/// Which blocks have been sent and have arrived.
struct Window {
    /// The first block that has not arrived.
    next: u32,
    /// Past the last block that has ever been sent.
    end: u32,
    /// Bit i: block `next` + i has arrived.
    arrived: u128,
    /// Bit i: block `next` + i has been sent and not been found lost.
    sent: u128,
    /// The data frame that carried a block last, by its number modulo the window.
    carriers: [u8; WINDOW as usize],
    /// The last data frame that was sent.
    number: u8,
    /// The last data frame that is known to have arrived.
    heard: u8,
}

/// What an acknowledgement says about blocks that were on their way.
struct Fate {
    arrived: u32,
    lost: u32,
    lost_frames: u32,
}

/// Blocks to put into a frame.
struct Run {
    number: u8,
    block: u32,
    blocks: u32,
}

impl Window {
    const fn new() -> Self {
        Self {
            next: 0,
            end: 0,
            arrived: 0,
            sent: 0,
            carriers: [0; WINDOW as usize],
            number: 0,
            heard: 0,
        }
    }

    /// Takes over what has arrived; nothing, if it cannot be true.
    fn update(&mut self, Acknowledge { number, next, map }: Acknowledge) -> Option<Fate> {
        let past = next.checked_add(u128::BITS - map.leading_zeros())?;
        let unheard = self.number.wrapping_sub(self.heard);
        let far_back = self.next.saturating_sub(next) > WINDOW;
        if past > self.end || far_back || number.wrapping_sub(self.heard) > unheard {
            return None;
        }
        let shift = next.saturating_sub(self.next);
        let moved = |bits: u128| bits.checked_shr(shift).unwrap_or(0);
        let left_behind = shift.min(WINDOW) - (self.arrived & low_bits(shift)).count_ones();
        let arrived = left_behind + (map & !moved(self.arrived)).count_ones();

        // An acknowledgement that takes something back says that the one before was damaged.
        let back = self.next.saturating_sub(next);
        self.sent = moved(self.sent).checked_shl(back).unwrap_or(0);
        self.arrived = map;
        self.next = next;
        self.heard = number;

        let mut fate = Fate {
            arrived,
            lost: 0,
            lost_frames: 0,
        };
        let mut last_carrier = None;
        let mut missing = self.sent & !map;
        while missing != 0 {
            let bit = missing.trailing_zeros();
            missing &= missing - 1;
            let carrier = self.carrier(bit);
            if is_before(carrier, number) {
                self.sent &= !(1 << bit);
                fate.lost += 1;
                fate.lost_frames += u32::from(last_carrier != Some(carrier));
                last_carrier = Some(carrier);
            }
        }
        Some(fate)
    }

    /// Whether as many data frames are on their way as their numbers allow.
    const fn is_full(&self) -> bool {
        self.number.wrapping_sub(self.heard) >= MAX_FRAMES
    }

    /// Takes the first block that is on its way for lost.
    const fn forget_first(&mut self) {
        let on_the_way = self.sent & !self.arrived;
        let first = on_the_way & on_the_way.wrapping_neg();
        self.sent &= !first;
    }

    /// The next run of up to `most` blocks to send, of `total`; it counts as sent.
    fn take(&mut self, most: u32, total: u32) -> Option<Run> {
        let settled = self.sent | self.arrived;
        let first = settled.trailing_ones();
        let block = self.next.saturating_add(first);
        if first >= WINDOW || block >= total {
            return None;
        }
        let blocks = (settled >> first)
            .trailing_zeros()
            .min(most)
            .min(WINDOW - first)
            .min(total - block);
        // When all numbers are taken, a probe repeats the last one, which is never taken for lost.
        if !self.is_full() {
            self.number = self.number.wrapping_add(1);
        }
        for bit in first..first + blocks {
            self.sent |= 1 << bit;
            if let Some(carrier) = self.carriers.get_mut(((self.next + bit) % WINDOW) as usize) {
                *carrier = self.number;
            }
        }
        self.end = self.end.max(block + blocks);
        Some(Run {
            number: self.number,
            block,
            blocks,
        })
    }

    fn carrier(&self, bit: u32) -> u8 {
        self.carriers
            .get((self.next.wrapping_add(bit) % WINDOW) as usize)
            .copied()
            .unwrap_or(0)
    }
}

/// The lowest `count` bits.
const fn low_bits(count: u32) -> u128 {
    if count >= u128::BITS {
        u128::MAX
    } else {
        (1 << count) - 1
    }
}

/// Whether one number was given before another, modulo 256.
const fn is_before(number: u8, other: u8) -> bool {
    (number.wrapping_sub(other) as i8) < 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::Receiver;

    /// Lets a sender whose manifest is wrong, which is what damage that no CRC-16 finds amounts to, talk to a receiver.
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
        // Sessions 14 and 15 fail.
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

    #[test]
    fn an_acknowledgement_is_true_until_the_next_and_never_impossible() {
        let mut window = Window::new();
        for _ in 0..3 {
            window.take(4, 100);
        }
        let says = |number, next, map| Acknowledge { number, next, map };
        // Frames 1 and 3 came.
        let fate = window.update(says(3, 4, 0b1111_0000)).expect("possible");
        assert_eq!((fate.arrived, fate.lost, fate.lost_frames), (8, 4, 1));
        assert_eq!(
            window
                .take(15, 100)
                .map(|run| (run.number, run.block, run.blocks)),
            Some((4, 4, 4))
        );
        // What was never sent cannot have come.
        assert!(window.update(says(4, 13, 0)).is_none());
        assert!(window.update(says(4, 12, 1)).is_none());
        assert!(window.update(says(5, 12, 0)).is_none());
        // A damaged one that was possible is taken back by the next.
        assert!(window.update(says(4, 12, 0)).is_some());
        assert!(window.update(says(4, 4, 0b1111_0000)).is_some());
        assert_eq!(
            window.take(15, 100).map(|run| (run.block, run.blocks)),
            Some((4, 4))
        );
    }
}
