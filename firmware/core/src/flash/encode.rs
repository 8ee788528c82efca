//! Encoding of flash images, for hosts with a heap.

use alloc::vec::Vec;
use core::fmt;

use super::{
    CONTENTS, FIRMWARE, Image, Kind, MAGIC, MAX_FIRMWARE, MAX_ITEMS, list_checksum, list_end,
};
use crate::deviation::Deviation;
use crate::records::{FirmwareHeader, FlashEntry, FlashHeader, WORD};
use crate::wire::crc32;

/// An item to encode.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Kind of the contents.
    pub kind: Kind,
    /// Name: 1 to 24 visible characters of ASCII.
    pub name: alloc::string::String,
    /// The bytes of the item.
    pub bytes: Vec<u8>,
}

/// Reason why an image cannot be encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncodeError {
    /// A part is too long: its name, the largest length, and its length, both in bytes.
    Long(&'static str, usize, usize),
    /// Too many items: the largest number of items, and their number.
    Items(usize, usize),
    /// A part violates its format.
    Part(Deviation),
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Long(part, limit, found) => {
                write!(f, "{part}: expected at most {limit} bytes, found {found}")
            }
            Self::Items(limit, found) => {
                write!(f, "items: expected at most {limit}, found {found}")
            }
            Self::Part(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for EncodeError {}

/// Encodes an image and validates the result. Erased bytes, 0xff, fill the gaps between the parts; without a bitstream its whole
/// slot is erased.
///
/// # Errors
/// A part is too long, or violates its format.
pub fn encode(bitstream: &[u8], firmware: &[u8], pieces: &[Piece]) -> Result<Vec<u8>, EncodeError> {
    for (part, bytes, limit) in [
        ("bitstream", bitstream, FIRMWARE),
        ("firmware", firmware, MAX_FIRMWARE as usize),
    ] {
        if bytes.len() > limit {
            return Err(EncodeError::Long(part, limit, bytes.len()));
        }
    }
    let limit = MAX_ITEMS as usize;
    if pieces.len() > limit {
        return Err(EncodeError::Items(limit, pieces.len()));
    }
    let mut image = bitstream.to_vec();
    image.resize(FIRMWARE, 0xff);
    let header = FirmwareHeader {
        length: firmware.len() as u32,
        checksum: crc32(firmware),
    };
    image.extend(header.to_bytes());
    image.extend(firmware);
    image.resize(CONTENTS, 0xff);
    image.extend(contents(pieces));
    Image::new_checked(&image).map_err(EncodeError::Part)?;
    Ok(image)
}

fn contents(pieces: &[Piece]) -> Vec<u8> {
    let list = list_end(pieces.len());
    let mut bytes = alloc::vec![0; FlashHeader::BYTES];
    for piece in pieces {
        // A name that is too long is truncated; the check then finds no terminating zero and rejects it.
        let mut name = [0; FlashEntry::NAME.end - FlashEntry::NAME.start];
        for (to, byte) in name.iter_mut().zip(piece.name.as_bytes()) {
            *to = *byte;
        }
        let entry = FlashEntry {
            kind: piece.kind as u32,
            length: piece.bytes.len() as u32,
            checksum: crc32(&piece.bytes),
            name,
        };
        bytes.extend(entry.to_bytes());
    }
    for piece in pieces {
        bytes.resize(bytes.len().next_multiple_of(WORD), 0xff);
        bytes.extend(&piece.bytes);
    }
    let mut header = FlashHeader {
        magic: MAGIC,
        length: bytes.len() as u32,
        items: pieces.len() as u32,
        checksum: 0,
    };
    bytes[..FlashHeader::BYTES].copy_from_slice(&header.to_bytes());
    header.checksum = list_checksum(&bytes, list);
    bytes[..FlashHeader::BYTES].copy_from_slice(&header.to_bytes());
    bytes
}
