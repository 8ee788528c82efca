//! Deviations of bytes from the formats of meshes, textures and flash images.

use core::fmt;

/// A binary format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The format of a mesh in memory.
    Mesh,
    /// The format of a texture in memory.
    Texture,
    /// A texture of a mesh, which begins at this byte of the mesh.
    TextureAt(u32),
    /// The format of a flash image.
    Flash,
}

/// Reason why bytes do not conform to a format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Deviation {
    /// The format that the bytes should have.
    pub format: Format,
    /// Offset of the deviation in bytes from the start of the mesh, texture or flash image.
    pub offset: u32,
    /// The content that was expected at the offset.
    pub expected: Expected,
    /// The number found at the offset.
    pub found: u32,
}

/// The content that bytes of a format should have. A variant with a count also contains the name of
/// the counted items.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// These four bytes.
    Magic([u8; 4]),
    /// Exactly this number of items.
    Exactly(&'static str, u32),
    /// One item, or this number of items.
    OneOr(&'static str, u32),
    /// At least this number of items.
    AtLeast(&'static str, u32),
    /// At most this number of items.
    AtMost(&'static str, u32),
    /// A number with this meaning, at least the first number and at most the second.
    Within(&'static str, u32, u32),
    /// An index below this number of items.
    Below(&'static str, u32),
    /// A multiple of this number of items.
    MultipleOf(&'static str, u32),
    /// The stated CRC-32.
    Crc32(u32),
    /// Content with this description.
    Content(&'static str),
}

impl Expected {
    /// Whether a number is as expected; `false` for a [`Content`](Self::Content).
    #[inline]
    const fn holds(self, found: u32) -> bool {
        match self {
            Self::Magic(bytes) => found == u32::from_le_bytes(bytes),
            Self::Exactly(_, count) | Self::Crc32(count) => found == count,
            Self::OneOr(_, count) => found == 1 || found == count,
            Self::AtLeast(_, count) => found >= count,
            Self::AtMost(_, count) => found <= count,
            Self::Within(_, least, most) => least <= found && found <= most,
            Self::Below(_, count) => found < count,
            Self::MultipleOf(_, count) => found.is_multiple_of(count),
            Self::Content(_) => false,
        }
    }
}

impl Format {
    /// Checks a number found at byte `offset`.
    ///
    /// # Errors
    /// The number is not as expected.
    // Inlined, so that a check that passes consists only of the comparison.
    #[inline]
    pub(crate) const fn expect(
        self,
        offset: u32,
        expected: Expected,
        found: u32,
    ) -> Result<(), Deviation> {
        if expected.holds(found) {
            return Ok(());
        }
        Err(self.deviation(offset, expected, found))
    }

    /// Makes a deviation at byte `offset`.
    pub(crate) const fn deviation(self, offset: u32, expected: Expected, found: u32) -> Deviation {
        Deviation {
            format: self,
            offset,
            expected,
            found,
        }
    }
}

impl Deviation {
    /// Writes the found content.
    ///
    /// # Errors
    /// The errors of `f`.
    pub fn write_found(&self, f: &mut impl fmt::Write) -> fmt::Result {
        let found = self.found;
        match self.expected {
            Expected::Magic(_) => write!(f, "\"{}\"", found.to_le_bytes().escape_ascii()),
            Expected::Crc32(_) => write!(f, "{found:#010x}"),
            Expected::Content(_) => write!(f, "{found:#04x}"),
            Expected::Exactly(..)
            | Expected::OneOr(..)
            | Expected::AtLeast(..)
            | Expected::AtMost(..)
            | Expected::Within(..)
            | Expected::Below(..)
            | Expected::MultipleOf(..) => write!(f, "{found}"),
        }
    }
}

impl fmt::Display for Deviation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self {
            offset, expected, ..
        } = self;
        match self.format {
            Format::Mesh => write!(f, "mesh byte {offset}")?,
            Format::Texture => write!(f, "texture byte {offset}")?,
            Format::TextureAt(start) => {
                write!(f, "mesh byte {offset}: texture byte {}", offset - start)?;
            }
            Format::Flash => write!(f, "flash byte {offset:#x}")?,
        }
        write!(f, ": expected {expected}, found ")?;
        self.write_found(f)
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Magic(bytes) => write!(f, "\"{}\"", bytes.escape_ascii()),
            Self::Exactly(what, count) => write!(f, "{count} {what}"),
            Self::OneOr(what, count) => write!(f, "1 or {count} {what}"),
            Self::AtLeast(what, count) => write!(f, "at least {count} {what}"),
            Self::AtMost(what, count) => write!(f, "at most {count} {what}"),
            Self::Within(what, least, most) => write!(f, "{least} to {most}, {what}"),
            Self::Below(what, count) => write!(f, "an index below {count}, the number of {what}"),
            Self::MultipleOf(what, count) => write!(f, "a multiple of {count} {what}"),
            Self::Crc32(stated) => write!(f, "the CRC-32 {stated:#010x} as stated"),
            Self::Content(what) => f.write_str(what),
        }
    }
}

impl core::error::Error for Deviation {}
