//! Uploads and downloads over a byte stream that may lose, change or repeat bytes (docs/formats.md, "Transfers").
//!
//! [`Sender`] and [`Receiver`] are state machines without clock or transport: bytes go in, bytes come out, and the caller
//! says how late it is in milliseconds. They are the same on both sides of the line and in both directions.
//!
//! ```text
//! sender                                     receiver
//! Open (length, CRC-32)             ──▶
//!                                   ◀──      Acknowledge
//! Data (number, block, bytes) …     ──▶
//!                                   ◀──      Acknowledge (number, blocks, map) …
//!                                   ◀──      Complete (verified or not)
//! Close                             ──▶
//! ```
//!
//! * A frame is COBS between two zero bytes, so that one lost zero costs nothing, and ends in a CRC-16.
//! * Data goes in blocks of 16 bytes, 1 to 15 a frame: the sender measures how often bytes are hit and makes frames shorter
//!   on a bad line. Up to 128 blocks are on their way at once.
//! * An acknowledgement says which blocks are there, one by one, and which data frame came last. As a line never reorders, what an
//!   earlier frame carried and is not there has been lost and is sent again at once; a time-out is needed only when the
//!   newest frame or its acknowledgement is lost.
//! * The newest acknowledgement is the truth. If a damaged one gets through its CRC, the next one heals it, and
//!   damaged data is found by the CRC-32 over the whole, after which the transfer starts again.
//! * The receiver decides when the transfer is complete. It repeats its verdict until the sender has closed, so both
//!   know the end; if every `Close` is lost, it ends by itself after a silence.
//!
//! A side with a console behind its line swallows what still comes after the end, until the line is quiet
//! ([`Timing::quiet_ms`]). The other side takes as text what follows the last zero byte.

mod ending;
mod frame;
mod pace;
mod receiver;
mod sender;
mod window;

use core::fmt;

use ending::Ending;
use frame::{Message, Reader};

pub use frame::MAX_FRAME;
pub use receiver::Receiver;
pub use sender::Sender;

/// Bytes in a block, the unit of acknowledgement.
const BLOCK: u32 = 16;
/// The most blocks a frame carries.
const MAX_BLOCKS: u32 = 15;
/// Blocks that may be on their way: the bits of an acknowledgement's map.
const WINDOW: u32 = u128::BITS;

/// The longest transfer in bytes: block numbers have 24 bits.
pub const MAX_LENGTH: u32 = ((1 << 24) - 1) * BLOCK;

static CRC_32: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// The CRC-32 (IEEE 802.3, as in zlib) of a whole transfer.
pub fn crc32(data: &[u8]) -> u32 {
    CRC_32.checksum(data)
}

/// What a transfer carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Manifest {
    /// Its length in bytes, at most [`MAX_LENGTH`].
    pub length: u32,
    /// The [`crc32`] of all bytes.
    pub crc32: u32,
}

impl Manifest {
    /// Describes some data.
    pub fn of(data: &[u8]) -> Self {
        // A length that does not fit is refused by whoever looks at it.
        Self {
            length: u32::try_from(data.len()).unwrap_or(u32::MAX),
            crc32: crc32(data),
        }
    }

    /// Blocks in all, the last of which may be short.
    const fn blocks(self) -> u32 {
        self.length.div_ceil(BLOCK)
    }
}

/// Either side of a transfer, for code that carries bytes between it and a line.
///
/// The methods are those of [`Sender`] and [`Receiver`].
pub trait Party {
    /// Takes bytes that came and returns how many of them belong to the transfer.
    fn on_bytes(&mut self, now_ms: u64, bytes: &[u8]) -> usize;
    /// Writes the next frame, if there is one to send, and returns its length.
    fn poll(&mut self, now_ms: u64, out: &mut [u8]) -> usize;
    /// Gives the transfer up and tells the other side.
    fn abort(&mut self, now_ms: u64);
    /// Where the transfer is, as of the last `poll`.
    fn state(&self) -> State;
    /// Bytes that have arrived without a gap, and bytes in all.
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

/// What both sides do with what they read.
trait Peer {
    /// Acts on a valid frame.
    fn on_message(&mut self, now_ms: u64, session: u8, message: Message);
    /// The end of the transfer, once it has come.
    fn ending(&mut self) -> Option<&mut Ending>;
}

/// Gives a peer what its reader finds in some bytes; returns how many of them belong to the transfer.
fn feed(reader: &mut Reader, peer: &mut impl Peer, now_ms: u64, bytes: &[u8]) -> usize {
    let mut taken = 0;
    while let Some(rest) = bytes.get(taken..).filter(|rest| !rest.is_empty()) {
        if let Some(ending) = peer.ending() {
            return taken + ending.on_bytes(now_ms, rest);
        }
        let (length, frame) = reader.take(rest);
        taken += length;
        if let Some((session, message)) = frame {
            peer.on_message(now_ms, session, message);
        }
    }
    taken
}

/// How long to wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// A transfer has failed when no valid frame came for so long.
    pub silence_ms: u64,
    /// After its end, bytes are swallowed until none came for so long; with 0 the rest is left to the caller.
    pub quiet_ms: u64,
}

impl Timing {
    /// For the side that has a console behind its line.
    pub const CONSOLE: Self = Self {
        silence_ms: 2_000,
        quiet_ms: 5,
    };
    /// For the side that talks to a console.
    pub const HOST: Self = Self {
        silence_ms: 5_000,
        quiet_ms: 0,
    };
}

/// Where a transfer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// On its way.
    Running,
    /// Complete and verified, and both sides know it or the other one has fallen silent.
    Done,
    /// Given up.
    Failed(Failure),
}

/// Why a transfer failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// No valid frame came for so many milliseconds.
    Silence(u64),
    /// Frames came, but for so many milliseconds no new block went through.
    Stalled(u64),
    /// The CRC-32 over the whole was wrong every time it was tried.
    Corrupt,
    /// This side gave up.
    Aborted(Reason),
    /// The other side gave up.
    AbortedByPeer(Reason),
}

/// Why a side gives a transfer up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Reason {
    /// Somebody wanted it.
    Cancelled = 0,
    /// It is longer than there is room for.
    TooLong = 1,
    /// It is not the one that was announced: another length or CRC-32.
    Unannounced = 2,
    /// The CRC-32 over the whole stayed wrong.
    Corrupt = 3,
    /// Nothing was heard, or nothing new got through.
    NoAnswer = 4,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Silence(ms) => write!(f, "the transfer was cut off: no valid frame for {ms} ms"),
            Self::Stalled(ms) => write!(
                f,
                "the transfer is stuck: nothing new got through for {ms} ms"
            ),
            Self::Corrupt => {
                f.write_str("the transfer does not have the CRC-32 it was announced with")
            }
            Self::Aborted(reason) => write!(f, "the transfer was given up: {reason}"),
            Self::AbortedByPeer(reason) => {
                write!(f, "the other side gave the transfer up: {reason}")
            }
        }
    }
}

impl core::error::Error for Failure {}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Cancelled => "cancelled",
            Self::TooLong => "longer than there is room for",
            Self::Unannounced => "not of the announced length and CRC-32",
            Self::Corrupt => "the CRC-32 over the whole stayed wrong",
            Self::NoAnswer => "nothing was heard, or nothing new got through",
        })
    }
}
