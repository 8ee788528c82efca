//! Frames: messages and their bytes.
//!
//! The first byte of a frame contains the kind in bits 3–0 and the session in bits 7–4. Numbers are little-endian. A CRC-16 of
//! all earlier bytes ends the frame.

use cobs::{CobsEncoder, DestBufTooSmallError, decode_in_place};

use super::format::{BLOCK, MAX_BLOCKS, Manifest};
use super::state::Reason;

/// Overhead of a data frame on the line, in bytes: kind and session (1), frame number (1), block number (3), CRC-16 (2), COBS
/// code (1) and two zeros.
pub const OVERHEAD: usize = 10;
/// Length in bytes of the longest encoded frame, and the required length of the buffer of `poll`.
pub const MAX_FRAME: usize = OVERHEAD + (MAX_BLOCKS * BLOCK) as usize;

/// The CRC-16 of a frame, with the CCITT polynomial. The initial value is all ones, so that lost or added zeros at the start are
/// detected.
static CRC_16: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740);

/// A message between sender and receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Message<'a> {
    /// Message from the sender: length and CRC-32 of the transfer.
    Open(Manifest),
    /// Message from the sender: data blocks.
    Data(Data<'a>),
    /// Message from the receiver: map of the received blocks.
    Acknowledge(Acknowledge),
    /// Message from the receiver: all blocks have arrived; the flag states whether the CRC-32 is right.
    Complete { verified: bool },
    /// Message from the sender: the receiver's `Complete` has arrived.
    Close,
    /// Message from either side: the transfer is cancelled.
    Abort(Reason),
    /// Message from a host at the start of a session: cancels an unfinished transfer of an earlier session, with any session
    /// number.
    Reset,
}

/// The contents of a data frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Data<'a> {
    /// Number of the data frame, modulo 256.
    pub number: u8,
    /// Number of the first block.
    pub block: u32,
    /// Data of whole blocks; the last block of the transfer may be short.
    pub bytes: &'a [u8],
}

/// The contents of an acknowledgement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Acknowledge {
    /// Number of the last data frame received; 0 before the first.
    pub number: u8,
    /// Number of the first missing block.
    pub next: u32,
    /// Bit i is set if block `next` + i was received.
    pub map: u128,
}

const OPEN: u8 = 1;
const DATA: u8 = 2;
const ACKNOWLEDGE: u8 = 3;
const COMPLETE: u8 = 4;
const CLOSE: u8 = 5;
const ABORT: u8 = 6;
const RESET: u8 = 7;

/// Longest gap in milliseconds within a frame; after it the bytes of an unfinished frame are discarded.
const GAP_MS: u64 = 50;
/// The byte that the key Ctrl-C sends.
const CTRL_C: u8 = 0x03;

/// Writes the frame that cancels an unfinished transfer, and returns its length. The frame's bytes have no effect on a console
/// without a transfer.
pub fn reset(out: &mut [u8]) -> usize {
    write(0, Message::Reset, out)
}

/// Encodes a frame into `out` and returns its length; 0 if `out` is too short.
pub fn write(session: u8, message: Message, out: &mut [u8]) -> usize {
    write_body(session, message, out).unwrap_or(0)
}

fn write_body(
    session: u8,
    message: Message,
    out: &mut [u8],
) -> Result<usize, DestBufTooSmallError> {
    let (zero, rest) = out.split_first_mut().ok_or(DestBufTooSmallError)?;
    *zero = 0;
    let mut body = Body {
        encoder: CobsEncoder::new(rest),
        crc: CRC_16.digest(),
    };
    let head = |kind| kind | session << 4;
    match message {
        Message::Open(Manifest { length, crc32 }) => {
            body.push(&[head(OPEN)])?;
            body.push(&length.to_le_bytes())?;
            body.push(&crc32.to_le_bytes())?;
        }
        Message::Data(Data {
            number,
            block,
            bytes,
        }) => {
            let [low, middle, high, _] = block.to_le_bytes();
            body.push(&[head(DATA), number, low, middle, high])?;
            body.push(bytes)?;
        }
        Message::Acknowledge(Acknowledge { number, next, map }) => {
            let [low, middle, high, _] = next.to_le_bytes();
            body.push(&[head(ACKNOWLEDGE), number, low, middle, high])?;
            // The map is sent without leading and trailing zero bytes. The number of omitted lowest zero bytes precedes the map.
            let first = map.trailing_zeros() / 8;
            let past = (u128::BITS - map.leading_zeros()).div_ceil(8);
            if let Some(bytes) = map.to_le_bytes().get(first as usize..past as usize) {
                body.push(&[first as u8])?;
                body.push(bytes)?;
            }
        }
        Message::Complete { verified } => body.push(&[head(COMPLETE), verified.into()])?,
        Message::Close => body.push(&[head(CLOSE)])?,
        Message::Abort(reason) => body.push(&[head(ABORT), reason as u8])?,
        Message::Reset => body.push(&[head(RESET)])?,
    }
    let Body { mut encoder, crc } = body;
    encoder.push(&crc.finalize().to_le_bytes())?;
    let length = 1 + encoder.finalize();
    *out.get_mut(length).ok_or(DestBufTooSmallError)? = 0;
    Ok(length + 1)
}

struct Body<'a> {
    encoder: CobsEncoder<'a>,
    crc: crc::Digest<'static, u16>,
}

impl Body<'_> {
    fn push(&mut self, bytes: &[u8]) -> Result<(), DestBufTooSmallError> {
        self.crc.update(bytes);
        self.encoder.push(bytes)
    }
}

/// Splits a byte stream into frames at zero bytes.
pub struct FrameReader {
    buffer: [u8; MAX_FRAME],
    /// Number of bytes received so far of the current frame. A number above the buffer's length means that the frame is too long.
    length: usize,
    /// Time in milliseconds at which the last bytes were received.
    last_ms: u64,
}

impl FrameReader {
    pub const fn new() -> Self {
        Self {
            buffer: [0; MAX_FRAME],
            length: 0,
            last_ms: 0,
        }
    }

    /// Records the time of received bytes. After a gap the bytes do not continue a frame.
    pub fn receive(&mut self, now_ms: u64) {
        if self.has_gap(now_ms) {
            self.length = 0;
        }
        self.last_ms = now_ms;
    }

    /// Whether Ctrl-C was typed: its byte is followed by a gap. Within a frame other bytes follow at once.
    pub fn is_interrupted(&self, now_ms: u64) -> bool {
        let typed = self.buffer.get(..self.length).unwrap_or_default();
        !typed.is_empty() && typed.iter().all(|&byte| byte == CTRL_C) && self.has_gap(now_ms)
    }

    const fn has_gap(&self, now_ms: u64) -> bool {
        now_ms.saturating_sub(self.last_ms) >= GAP_MS
    }

    /// Takes bytes up to the next zero byte. Returns the number of taken bytes; if the zero byte completes a valid frame, also
    /// the frame's session and message.
    pub fn take(&mut self, bytes: &[u8]) -> (usize, Option<(u8, Message<'_>)>) {
        let zero = bytes.iter().position(|&byte| byte == 0);
        let part = bytes.get(..zero.unwrap_or(bytes.len())).unwrap_or_default();
        let end = self.length.saturating_add(part.len());
        if let Some(room) = self.buffer.get_mut(self.length..end) {
            room.copy_from_slice(part);
        }
        self.length = end;
        if zero.is_none() {
            return (bytes.len(), None);
        }
        let frame = self.buffer.get_mut(..core::mem::take(&mut self.length));
        (part.len() + 1, frame.and_then(parse))
    }
}

/// Decodes a frame: undoes COBS in place, checks the CRC-16, and returns the session and the message.
/// `None` for an invalid frame.
fn parse(frame: &mut [u8]) -> Option<(u8, Message<'_>)> {
    let length = decode_in_place(frame).ok()?;
    let (body, crc) = frame.get(..length)?.split_last_chunk()?;
    if CRC_16.checksum(body) != u16::from_le_bytes(*crc) {
        return None;
    }
    let (&head, body) = body.split_first()?;
    let message = match (head & 0xF, body) {
        (OPEN, _) => {
            let (length, crc32) = body.split_first_chunk()?;
            let crc32 = u32::from_le_bytes(crc32.try_into().ok()?);
            Message::Open(Manifest {
                length: u32::from_le_bytes(*length),
                crc32,
            })
        }
        (DATA, &[number, low, middle, high, ref bytes @ ..]) => Message::Data(Data {
            number,
            block: u32::from_le_bytes([low, middle, high, 0]),
            bytes,
        }),
        (ACKNOWLEDGE, &[number, low, middle, high, ref packed @ ..]) => {
            let mut map = [0; 16];
            if let Some((&first, bytes)) = packed.split_first() {
                let past = usize::from(first) + bytes.len();
                map.get_mut(first.into()..past)?.copy_from_slice(bytes);
            }
            let next = u32::from_le_bytes([low, middle, high, 0]);
            let map = u128::from_le_bytes(map);
            Message::Acknowledge(Acknowledge { number, next, map })
        }
        (COMPLETE, &[verified @ 0..=1]) => Message::Complete {
            verified: verified == 1,
        },
        (CLOSE, []) => Message::Close,
        (RESET, []) => Message::Reset,
        (ABORT, &[reason]) => Message::Abort(match reason {
            0 => Reason::Cancelled,
            1 => Reason::TooLong,
            2 => Reason::Unannounced,
            3 => Reason::Corrupt,
            4 => Reason::NoAnswer,
            _ => return None,
        }),
        _ => return None,
    };
    Some((head >> 4, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages() -> [Message<'static>; 10] {
        static BYTES: [u8; 240] = [0xA5; 240];
        [
            Message::Open(Manifest {
                length: 0x0102_0304,
                crc32: 0xFFEE_0011,
            }),
            Message::Data(Data {
                number: 0,
                block: 0,
                bytes: &[0; 16],
            }),
            Message::Data(Data {
                number: 255,
                block: 0xFF_FFFF,
                bytes: &BYTES,
            }),
            Message::Acknowledge(Acknowledge {
                number: 7,
                next: 0x12_3456,
                map: 1 << 127 | 2,
            }),
            Message::Acknowledge(Acknowledge {
                number: 0,
                next: 1,
                map: 0x0102_0300 << 56,
            }),
            Message::Acknowledge(Acknowledge {
                number: 255,
                next: 0,
                map: 0,
            }),
            Message::Complete { verified: true },
            Message::Close,
            Message::Abort(Reason::Unannounced),
            Message::Reset,
        ]
    }

    #[test]
    fn frames_come_back_and_fill_just_their_room() {
        for message in messages() {
            let mut out = [0xEE; MAX_FRAME];
            let length = write(9, message, &mut out);
            let mut reader = FrameReader::new();
            assert_eq!(reader.take(&out[..length]), (1, None));
            assert_eq!(
                reader.take(&out[1..length]),
                (length - 1, Some((9, message)))
            );
            assert_eq!(write(9, message, &mut out[..length - 1]), 0);
        }
        assert_eq!(write(0, messages()[2], &mut [0; MAX_FRAME]), MAX_FRAME);
    }

    #[test]
    fn no_changed_lost_or_repeated_byte_passes() {
        for message in messages() {
            let mut out = [0; MAX_FRAME];
            let length = write(3, message, &mut out);
            let frame = &out[..length];
            assert!(has_frame(frame));
            for place in 1..length - 1 {
                for change in 1..=255 {
                    let mut changed = out;
                    changed[place] ^= change;
                    assert!(!has_frame(&changed[..length]), "{place} {change}");
                }
                assert!(
                    !has_frame(&[&frame[..place], &frame[place + 1..]].concat()),
                    "{place}"
                );
                assert!(
                    !has_frame(&[&frame[..=place], &frame[place..]].concat()),
                    "{place}"
                );
            }
        }
    }

    fn has_frame(mut bytes: &[u8]) -> bool {
        let mut reader = FrameReader::new();
        let mut found = false;
        while !bytes.is_empty() {
            let (taken, message) = reader.take(bytes);
            found |= message.is_some();
            bytes = &bytes[taken..];
        }
        found
    }

    #[test]
    fn an_endless_frame_does_no_harm() {
        let mut reader = FrameReader::new();
        for _ in 0..100 {
            assert_eq!(reader.take(&[1; 100]), (100, None));
        }
        assert_eq!(reader.take(&[0]), (1, None));
        let mut out = [0; MAX_FRAME];
        let length = write(1, Message::Close, &mut out);
        reader.take(&out[..1]);
        assert_eq!(
            reader.take(&out[1..length]),
            (length - 1, Some((1, Message::Close)))
        );
    }
}
