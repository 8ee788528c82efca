//! States, failures and timeouts of a transfer.

use core::fmt;

/// Timeouts of a sender or receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// Time in milliseconds without a valid frame after which a transfer fails.
    pub silence_ms: u64,
    /// After a transfer, received bytes are dropped until the line was quiet for this time in milliseconds. With 0 no bytes are
    /// dropped: the caller receives the bytes.
    pub quiet_ms: u64,
}

impl Timing {
    /// Timeouts for the board, the side with the console. To simulate one second of silence, a
    /// virtual board takes about two minutes.
    pub const CONSOLE: Self = Self {
        silence_ms: 1_000,
        quiet_ms: 5,
    };
    /// Timeouts for the host, the side that uses the board's console.
    pub const HOST: Self = Self {
        silence_ms: 5_000,
        quiet_ms: 0,
    };
}

/// State of a transfer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// In progress.
    Running,
    /// Complete and verified; the other side has confirmed the end or is silent.
    Done,
    /// Failed for this cause.
    Failed(Failure),
}

/// Cause of a failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// No valid frame was received for the given number of milliseconds.
    Silence(u64),
    /// Valid frames were received, but no new block was acknowledged for the given number of milliseconds.
    Stalled(u64),
    /// The CRC-32 of the transfer was wrong in every attempt.
    Corrupt,
    /// This side cancelled the transfer.
    Aborted(Reason),
    /// The other side cancelled the transfer.
    AbortedByPeer(Reason),
}

/// Reason of a cancellation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Reason {
    /// Cancelled on request.
    Cancelled = 0,
    /// The transfer is longer than the receiver's buffer.
    TooLong = 1,
    /// The length or the CRC-32 differs from the announced length or CRC-32.
    Unannounced = 2,
    /// The CRC-32 of the transfer was wrong in every attempt.
    Corrupt = 3,
    /// No valid frame, or no new block, arrived for too long.
    NoAnswer = 4,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Silence(ms) => write!(f, "transfer: no valid frame for {ms} ms"),
            Self::Stalled(ms) => write!(f, "transfer: no new block for {ms} ms"),
            Self::Corrupt => f.write_str("transfer: wrong CRC-32 in every attempt"),
            Self::Aborted(reason) => write!(f, "transfer: cancelled by this side: {reason}"),
            Self::AbortedByPeer(reason) => {
                write!(f, "transfer: cancelled by the other side: {reason}")
            }
        }
    }
}

impl core::error::Error for Failure {}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Cancelled => "on request",
            Self::TooLong => "longer than the buffer",
            Self::Unannounced => "length or CRC-32 differs from the announced value",
            Self::Corrupt => "wrong CRC-32 in every attempt",
            Self::NoAnswer => "no valid frame, or no new block",
        })
    }
}
