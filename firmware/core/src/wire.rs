//! Uploads and downloads over a byte stream that may lose, change or repeat bytes.
//!
//! [`Sender`] and [`Receiver`] are state machines without clock or transport: bytes in, bytes out, a time in
//! milliseconds. They are the same on both sides of the line and for both directions.

/// The crc-32 (IEEE 802.3) that covers the whole of a transfer.
pub fn crc32(_data: &[u8]) -> u32 {
    0
}

/// The longest frame: `poll` writes nothing into less.
pub const MAX_FRAME: usize = 256;

/// How long to wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// Without a valid frame for so long, a transfer has failed.
    pub silence_ms: u64,
}

/// Where a transfer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Not at its end.
    Running,
    /// Everything has arrived and been verified.
    Done,
    /// It has failed.
    Failed(Failure),
}

/// Why a transfer failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// No valid frame came for so many milliseconds.
    Silence(u64),
}

/// The side that has the data.
pub struct Sender<'a> {
    data: &'a [u8],
}

impl<'a> Sender<'a> {
    /// Starts to send `data`. `session` tells transfers apart: take another one every time.
    pub fn new(data: &'a [u8], _session: u8, _timing: Timing, _now_ms: u64) -> Self {
        Self { data }
    }

    /// Writes the next frame, if there is one to send, and returns its length, at most [`MAX_FRAME`].
    pub fn poll(&mut self, _now_ms: u64, _out: &mut [u8]) -> usize {
        0
    }

    /// Takes bytes that came.
    pub fn on_bytes(&mut self, _now_ms: u64, _bytes: &[u8]) {}

    /// Gives the transfer up and tells the other side.
    pub fn abort(&mut self) {}

    /// Where the transfer is.
    pub fn state(&self) -> State {
        State::Running
    }

    /// Bytes that are known to have arrived, and bytes in all.
    pub fn progress(&self) -> (u32, u32) {
        (0, self.data.len() as u32)
    }
}

/// The side that wants the data.
pub struct Receiver<'a> {
    buffer: &'a mut [u8],
}

impl<'a> Receiver<'a> {
    /// Waits for a transfer of at most the buffer's length, or just the length and CRC-32 `expected`.
    pub fn new(
        buffer: &'a mut [u8],
        _expected: Option<(u32, u32)>,
        _timing: Timing,
        _now_ms: u64,
    ) -> Self {
        Self { buffer }
    }

    /// Writes the next frame, if there is one to send, and returns its length, at most [`MAX_FRAME`].
    pub fn poll(&mut self, _now_ms: u64, _out: &mut [u8]) -> usize {
        0
    }

    /// Takes bytes that came.
    pub fn on_bytes(&mut self, _now_ms: u64, _bytes: &[u8]) {}

    /// Gives the transfer up and tells the other side.
    pub fn abort(&mut self) {}

    /// Where the transfer is.
    pub fn state(&self) -> State {
        State::Running
    }

    /// Bytes that have arrived in order, and bytes in all (0 while that is unknown).
    pub fn progress(&self) -> (u32, u32) {
        (0, self.buffer.len() as u32)
    }

    /// What was received: the verified data once the state is [`State::Done`], nothing before.
    pub fn received(&self) -> Option<&[u8]> {
        None
    }
}
