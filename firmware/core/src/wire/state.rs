//! States, failures and time-outs of a transfer.

use core::fmt;

/// Time-outs of a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// Time without a valid frame after which a transfer fails.
    pub silence_ms: u64,
    /// Silence until which bytes after the end are dropped; with 0 the caller gets them.
    pub quiet_ms: u64,
}

impl Timing {
    /// For a side with a console behind its line.
    pub const CONSOLE: Self = Self {
        silence_ms: 2_000,
        quiet_ms: 5,
    };
    /// For the side that uses a console.
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
    /// Complete and verified; both sides know it, or the other one is silent.
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
    /// Wrong CRC-32 of the whole in every attempt.
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
    /// On request.
    Cancelled = 0,
    /// Longer than the buffer.
    TooLong = 1,
    /// Length or CRC-32 differ from the announced ones.
    Unannounced = 2,
    /// Wrong CRC-32 of the whole in every attempt.
    Corrupt = 3,
    /// No frame, or no new block.
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
