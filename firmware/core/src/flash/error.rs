//! Errors of flash images.

use core::fmt;

/// Reason why bytes are not a flash image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlashError {
    /// Offset of the error in bytes from the start of the flash.
    pub offset: u32,
    /// The number or value that was expected at this position.
    pub expected: Expected,
    /// The number found in the image.
    pub found: u32,
}

/// The content that an image should have at the offset. A variant with a count also contains the name of the counted items.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// These four bytes.
    Magic([u8; 4]),
    /// Exactly this number of items.
    Exactly(&'static str, u32),
    /// At least this number of items.
    AtLeast(&'static str, u32),
    /// At most this number of items.
    AtMost(&'static str, u32),
    /// The stated CRC-32.
    Crc32(u32),
    /// The code of a kind of items.
    Kind,
    /// A first character of a name.
    Name,
    /// A character of a text.
    Text,
    /// A bitstream.
    Bitstream,
}

impl fmt::Display for FlashError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self {
            offset, expected, ..
        } = self;
        write!(f, "flash byte {offset:#x}: expected {expected}, found ")?;
        self.write_found(f)
    }
}

impl FlashError {
    /// Writes the found content.
    ///
    /// # Errors
    /// The errors of `f`.
    pub fn write_found(&self, f: &mut impl fmt::Write) -> fmt::Result {
        let found = self.found;
        match self.expected {
            Expected::Magic(_) => write!(f, "\"{}\"", found.to_le_bytes().escape_ascii()),
            Expected::Crc32(_) | Expected::Bitstream => write!(f, "{found:#010x}"),
            Expected::Name | Expected::Text => write!(f, "{found:#04x}"),
            Expected::Exactly(..)
            | Expected::AtLeast(..)
            | Expected::AtMost(..)
            | Expected::Kind => {
                write!(f, "{found}")
            }
        }
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Magic(bytes) => write!(f, "\"{}\"", bytes.escape_ascii()),
            Self::Exactly(what, count) => write!(f, "{count} {what}"),
            Self::AtLeast(what, count) => write!(f, "at least {count} {what}"),
            Self::AtMost(what, count) => write!(f, "at most {count} {what}"),
            Self::Crc32(stated) => write!(f, "the CRC-32 {stated:#010x} as stated"),
            Self::Kind => f.write_str("a kind of items: 1 (mesh), 2 (scene) or 3 (list)"),
            Self::Name => f.write_str("a name of 1 to 24 visible characters of ASCII, then zeros"),
            Self::Text => f.write_str("ASCII text: a visible character, a blank or a line end"),
            Self::Bitstream => {
                f.write_str("an erased slot, or a bitstream with its word 0xaa995566")
            }
        }
    }
}

impl core::error::Error for FlashError {}
