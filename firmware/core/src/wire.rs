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
mod format;
mod frame;
mod pace;
mod party;
mod peer;
mod receiver;
mod sender;
mod state;
mod window;

pub use format::{MAX_LENGTH, Manifest, crc32};
pub use frame::MAX_FRAME;
pub use party::Party;
pub use receiver::Receiver;
pub use sender::Sender;
pub use state::{Failure, Reason, State, Timing};
