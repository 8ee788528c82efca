//! Encoding of flash images, for hosts with a heap.

use alloc::vec::Vec;
use core::fmt;

use super::{
    CHECKSUM, CONTENTS, ENTRY, FIRMWARE, FlashError, HEADER, Image, Kind, MAGIC, MAX_FIRMWARE,
    MAX_ITEMS, list_checksum,
};
use crate::wire::crc32;

/// An item to encode.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Kind.
    pub kind: Kind,
    /// Name: 1 to 24 visible characters of ASCII.
    pub name: alloc::string::String,
    /// Contents.
    pub bytes: Vec<u8>,
}

/// Reason why an image cannot be encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncodeError {
    /// This part is too long: the largest length and its own, in bytes.
    Long(&'static str, usize, usize),
    /// Too many items: the largest number and that of the items.
    Items(usize, usize),
    /// A part that the format refuses.
    Part(FlashError),
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

/// Encodes an image, and checks it. Erased bytes, 0xff, fill the gaps between the parts; without a bitstream its slot is erased.
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
    for word in [firmware.len() as u32, crc32(firmware)] {
        image.extend(word.to_le_bytes());
    }
    image.extend(firmware);
    image.resize(CONTENTS, 0xff);
    image.extend(contents(pieces));
    Image::new_checked(&image).map_err(EncodeError::Part)?;
    Ok(image)
}

fn contents(pieces: &[Piece]) -> Vec<u8> {
    let list = HEADER + pieces.len() * ENTRY;
    let mut bytes = MAGIC.to_vec();
    bytes.resize(HEADER, 0);
    for piece in pieces {
        let length = piece.bytes.len() as u32;
        for word in [piece.kind as u32, length, crc32(&piece.bytes), 0] {
            bytes.extend(word.to_le_bytes());
        }
        let mut name = piece.name.as_bytes().to_vec();
        // A longer name has no end, and the check refuses it.
        name.resize(ENTRY - HEADER, 0);
        bytes.extend(name);
    }
    for piece in pieces {
        bytes.resize(bytes.len().next_multiple_of(HEADER), 0xff);
        bytes.extend(&piece.bytes);
    }
    let [length, count] = [bytes.len() as u32, pieces.len() as u32].map(u32::to_le_bytes);
    bytes[4..8].copy_from_slice(&length);
    bytes[8..CHECKSUM].copy_from_slice(&count);
    let checksum = list_checksum(&bytes, list);
    bytes[CHECKSUM..HEADER].copy_from_slice(&checksum.to_le_bytes());
    bytes
}
