//! Uploads and downloads over a byte stream that may lose, change or repeat bytes (docs/formats/transfer.md, "Transfers").
//!
//! [`Sender`] and [`Receiver`] are state machines without clock or transport: the caller passes received bytes and the time in
//! milliseconds, and takes the bytes to send. Firmware and host use the same code in both directions.
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
//! * A frame is encoded as COBS between two zero bytes, so the loss of one zero is harmless; it ends with a CRC-16.
//! * Data is sent in blocks of 16 bytes, with 1 to 15 blocks in a frame: the sender measures the error rate and shortens the
//!   frames on a bad line. Up to 128 blocks are in flight.
//! * An acknowledgement lists the received blocks and the last data frame. As a line keeps the order of frames, missing blocks of
//!   earlier frames are lost and are sent again at once. Only the loss of the newest frame or of its acknowledgement requires a
//!   timeout.
//! * Only the newest acknowledgement counts. If a damaged acknowledgement passes its CRC-16, the next acknowledgement corrects
//!   the sender's state. If damaged data passes its CRC-16, the CRC-32 of the transfer is wrong, and the transfer starts again.
//! * The receiver decides when the transfer is complete. The receiver repeats its verdict until it receives a `Close`, so both
//!   sides reach the end; if every `Close` is lost, the receiver ends after a timeout.
//!
//! At the start of a session a host sends a `Reset` ([`reset`]), which cancels an unfinished transfer at once. A typed Ctrl-C has
//! the same effect.
//!
//! A side with a console on the same line drops the bytes that it receives after the end of a transfer, until the line is quiet
//! ([`Timing::quiet_ms`]). The other side treats the bytes after the last zero byte as text.

mod ending;
mod endpoint;
mod format;
mod frame;
mod pace;
mod receiver;
mod sender;
mod state;
mod window;

pub use endpoint::{Endpoint, Role};
pub use format::{CRC_32, Digest, MAX_LENGTH, Manifest, crc_32_without, crc32};
pub use frame::{MAX_FRAME, reset};
pub use receiver::{Receiver, Receiving};
pub use sender::{Sender, Sending};
pub use state::{Failure, Reason, State, Timing};
