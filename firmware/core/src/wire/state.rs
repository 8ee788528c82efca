//! States, failures and time-outs of a transfer.

use core::fmt;

/// Time-outs of a sender or receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// Time without a valid frame after which a transfer fails.
    pub silence_ms: u64,
    /// Silence that ends the dropping of bytes after a transfer; with 0 the caller gets these bytes.
    pub quiet_ms: u64,
}

impl Timing {
    /// Time-outs of the side that runs the console.
    pub const CONSOLE: Self = Self {
        silence_ms: 2_000,
        quiet_ms: 5,
    };
    /// Time-outs of the side that uses a console.
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
    /// Failed.
    Failed(Failure),
}

/// Cause of a failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// No valid frame for the given milliseconds.
    Silence(u64),
    /// Valid frames, but no new block for the given milliseconds.
    Stalled(u64),
    /// Wrong CRC-32 of the transfer in every attempt.
    Corrupt,
    /// Cancelled by this side.
    Aborted(Reason),
    /// Cancelled by the other side.
    AbortedByPeer(Reason),
}

/// Reason of a cancellation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Reason {
    /// Cancelled on request.
    Cancelled = 0,
    /// Longer than the buffer.
    TooLong = 1,
    /// Length or CRC-32 differ from the announced ones.
    Unannounced = 2,
    /// Wrong CRC-32 of the transfer in every attempt.
    Corrupt = 3,
    /// No frame, or no new block.
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
