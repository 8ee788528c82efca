//! Images of a board's SPI flash: bitstream, firmware, and contents (docs/formats/flash.md, "Flash image").
//!
//! [`Image::new_checked`] checks a whole image, [`Contents::new_checked`] the list of the contents alone, as a board does at start: an
//! item's bytes are checked when it is used ([`Item::checked`]).

#[cfg(feature = "alloc")]
mod encode;
mod error;

use core::str;

use crate::console::LINE_MAX;
use crate::machine;
use crate::mesh::is_name;
use crate::wire::crc32;

#[cfg(feature = "alloc")]
pub use encode::{EncodeError, Piece, encode};
pub use error::{Expected, FlashError};

/// Offset of the firmware in bytes, after the slot of the bitstream.
pub const FIRMWARE: usize = machine::FLASH_FIRMWARE as usize;
/// Offset of the contents in bytes.
pub const CONTENTS: usize = 4 << 20;
/// Largest length of an image in bytes.
pub const MAX_BYTES: usize = 16 << 20;
/// Largest number of items.
pub const MAX_ITEMS: u32 = 64;
/// The first four bytes of the contents.
pub const MAGIC: [u8; 4] = *b"GFC1";
/// Smallest length of a firmware in bytes that LiteX's BIOS boots.
pub const MIN_FIRMWARE: u32 = 32;
/// Largest length of a firmware in bytes, which follows its header.
pub const MAX_FIRMWARE: u32 = (CONTENTS - FIRMWARE - FIRMWARE_HEADER) as u32;

/// The word by which the FPGA finds the start of a bitstream.
const SYNC: [u8; 4] = [0xaa, 0x99, 0x55, 0x66];
/// Number of bytes in which a bitstream has its [`SYNC`].
const SYNC_WITHIN: usize = 4096;
/// Bytes of the firmware's header.
const FIRMWARE_HEADER: usize = 8;
/// Bytes of the contents' header, and multiple at which an item begins.
const HEADER: usize = 16;
/// Bytes of an entry of the list of items.
const ENTRY: usize = 48;
/// Place of the checksum in the header.
const CHECKSUM: usize = 12;

/// Kind of an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Kind {
    /// A mesh, in the format of an upload.
    Mesh = 1,
    /// A scene: console commands, a line each.
    Scene = 2,
    /// A list of scenes: names, a line each. The board shows the first list.
    List = 3,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Mesh, Self::Scene, Self::List];

    /// Name for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mesh => "mesh",
            Self::Scene => "scene",
            Self::List => "list",
        }
    }
}

/// An item of the contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Item<'a> {
    /// Kind.
    pub kind: Kind,
    /// Name: 1 to 24 visible characters of ASCII.
    pub name: &'a str,
    offset: usize,
    bytes: &'a [u8],
    crc32: u32,
}

impl<'a> Item<'a> {
    /// Offset of the bytes from the start of the contents.
    pub const fn offset(&self) -> usize {
        self.offset
    }

    /// Length in bytes.
    pub const fn length(&self) -> usize {
        self.bytes.len()
    }

    /// The bytes.
    ///
    /// # Errors
    /// Their checksum is wrong.
    pub fn checked(&self) -> Result<&'a [u8], FlashError> {
        let found = crc32(self.bytes);
        expect(
            CONTENTS + self.offset,
            Expected::Crc32(self.crc32),
            found,
            found == self.crc32,
        )?;
        Ok(self.bytes)
    }

    /// The text of a scene or a list, whose lines are not longer than a line of the console.
    ///
    /// # Errors
    /// The checksum is wrong, or the bytes are no such text.
    pub fn text(&self) -> Result<&'a str, FlashError> {
        let bytes = self.checked()?;
        let start = CONTENTS + self.offset;
        let is_text = |byte: &u8| matches!(byte, b'\n' | b' '..=b'~');
        if let Some(place) = bytes.iter().position(|byte| !is_text(byte)) {
            return Err(error(start + place, Expected::Text, bytes[place].into()));
        }
        let mut place = start;
        for line in bytes.split(|byte| *byte == b'\n') {
            let length = line.len();
            let limit = Expected::AtMost("bytes in a line", LINE_MAX as u32);
            expect(place, limit, length as u32, length <= LINE_MAX)?;
            place += length + 1;
        }
        // Visible ASCII is UTF-8.
        Ok(str::from_utf8(bytes).unwrap_or_default())
    }
}

/// The contents of a flash: models, scenes and lists of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contents<'a> {
    /// All bytes, with the list of the items first.
    bytes: &'a [u8],
    count: usize,
}

impl<'a> Contents<'a> {
    /// Checks the list of the items at the start of `bytes`, which may be longer than the contents. The items' bytes are not read.
    ///
    /// # Errors
    /// The first deviation from the format.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, FlashError> {
        let found = clamped(bytes.len());
        let Some((header, _)) = bytes.split_first_chunk::<HEADER>() else {
            let expected = Expected::AtLeast("bytes of contents", HEADER as u32);
            return Err(error(CONTENTS, expected, found));
        };
        let [magic, length, count, checksum] = words(header);
        let is_magic = magic == u32::from_le_bytes(MAGIC);
        expect(CONTENTS, Expected::Magic(MAGIC), magic, is_magic)?;
        let limit = Expected::AtMost("bytes of contents, as there are", found);
        expect(CONTENTS + 4, limit, length, length <= found)?;
        let limit = Expected::AtMost("items", MAX_ITEMS);
        expect(CONTENTS + 8, limit, count, count <= MAX_ITEMS)?;
        // At most 64.
        let count = count as usize;
        let list = HEADER + count * ENTRY;
        let least = Expected::AtLeast("bytes of contents, for the list of items", list as u32);
        expect(CONTENTS + 4, least, length, length as usize >= list)?;
        let contents = Self {
            bytes: bytes.get(..length as usize).unwrap_or_default(),
            count,
        };
        let sum = contents.list_checksum();
        expect(
            CONTENTS + CHECKSUM,
            Expected::Crc32(checksum),
            sum,
            sum == checksum,
        )?;
        contents.check_list()?;
        Ok(contents)
    }

    /// Number of bytes.
    pub const fn length(&self) -> usize {
        self.bytes.len()
    }

    /// The items, in order.
    pub fn items(&self) -> impl Iterator<Item = Item<'a>> + use<'a> {
        let mut offset = HEADER + self.count * ENTRY;
        let bytes = self.bytes;
        // The list has been checked, so no item is left out.
        self.entries().map_while(move |entry| {
            let [kind, length, crc32, _] = words(entry);
            let item = Item {
                kind: kind_of(kind)?,
                name: name_of(entry)?,
                offset,
                bytes: bytes.get(offset..)?.get(..length as usize)?,
                crc32,
            };
            offset = (offset + item.bytes.len()).next_multiple_of(HEADER);
            Some(item)
        })
    }

    /// The item of this kind and name.
    pub fn find(&self, kind: Kind, name: &str) -> Option<Item<'a>> {
        self.items()
            .find(|item| item.kind == kind && item.name == name)
    }

    fn entries(&self) -> impl Iterator<Item = &'a [u8; ENTRY]> + use<'a> {
        let list = self.bytes.get(HEADER..).unwrap_or_default();
        list.as_chunks().0.iter().take(self.count)
    }

    /// The checksum of header and list, without the checksum itself.
    fn list_checksum(&self) -> u32 {
        list_checksum(self.bytes, HEADER + self.count * ENTRY)
    }

    fn check_list(&self) -> Result<(), FlashError> {
        let mut offset = HEADER + self.count * ENTRY;
        for (number, entry) in self.entries().enumerate() {
            let place = CONTENTS + HEADER + number * ENTRY;
            let [kind, length, _, reserved] = words(entry);
            expect(place, Expected::Kind, kind, kind_of(kind).is_some())?;
            let rest = self.bytes.len().saturating_sub(offset);
            let limit = Expected::AtMost("bytes of an item, up to the end", clamped(rest));
            expect(place + 4, limit, length, length as usize <= rest)?;
            let zero = Expected::Exactly("(reserved)", 0);
            expect(place + 12, zero, reserved, reserved == 0)?;
            let first = entry.get(HEADER).copied().unwrap_or(0);
            let is_named = name_of(entry).is_some();
            expect(place + HEADER, Expected::Name, first.into(), is_named)?;
            offset = (offset + length as usize).next_multiple_of(HEADER);
        }
        Ok(())
    }
}

/// A whole image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Image<'a> {
    /// The bitstream of the FPGA; `None` for an empty slot.
    pub bitstream: Option<&'a [u8]>,
    /// The firmware, without its header.
    pub firmware: &'a [u8],
    /// The contents.
    pub contents: Contents<'a>,
}

impl<'a> Image<'a> {
    /// Checks an image with all of its checksums. The meshes and the commands of the scenes are not read.
    ///
    /// # Errors
    /// The first deviation from the format.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, FlashError> {
        let found = clamped(bytes.len());
        let limit = Expected::AtMost("bytes", MAX_BYTES as u32);
        expect(0, limit, found, bytes.len() <= MAX_BYTES)?;
        let least = Expected::AtLeast("bytes", (CONTENTS + HEADER) as u32);
        expect(0, least, found, bytes.len() >= CONTENTS + HEADER)?;
        let (slot, rest) = bytes.split_at_checked(FIRMWARE).unwrap_or_default();
        let firmware = firmware(rest)?;
        let contents = Contents::new_checked(bytes.get(CONTENTS..).unwrap_or_default())?;
        for item in contents.items() {
            match item.kind {
                Kind::Mesh => drop(item.checked()?),
                Kind::Scene | Kind::List => drop(item.text()?),
            }
        }
        Ok(Self {
            bitstream: bitstream(slot)?,
            firmware,
            contents,
        })
    }
}

/// The bitstream in its slot, without the erased bytes behind it; `None` for an erased slot.
fn bitstream(slot: &[u8]) -> Result<Option<&[u8]>, FlashError> {
    let Some(last) = slot.iter().rposition(|byte| *byte != 0xff) else {
        return Ok(None);
    };
    let start = slot.get(..SYNC_WITHIN).unwrap_or(slot);
    let is_bitstream = start.windows(SYNC.len()).any(|bytes| bytes == SYNC);
    let first = slot
        .first_chunk()
        .map_or(0, |bytes| u32::from_be_bytes(*bytes));
    expect(0, Expected::Bitstream, first, is_bitstream)?;
    Ok(slot.get(..=last))
}

/// The firmware with LiteX's header of flash boot at the start of `bytes`, without the header.
///
/// # Errors
/// The length is out of range, or the checksum is wrong.
pub fn firmware(bytes: &[u8]) -> Result<&[u8], FlashError> {
    let (header, rest) = bytes.split_at_checked(FIRMWARE_HEADER).unwrap_or_default();
    let [length, checksum] = words(header);
    let least = Expected::AtLeast("bytes of firmware", MIN_FIRMWARE);
    expect(FIRMWARE, least, length, length >= MIN_FIRMWARE)?;
    let most = clamped(rest.len()).min(MAX_FIRMWARE);
    let limit = Expected::AtMost("bytes of firmware", most);
    expect(FIRMWARE, limit, length, length <= most)?;
    let firmware = rest.get(..length as usize).unwrap_or_default();
    let found = crc32(firmware);
    expect(
        FIRMWARE + 4,
        Expected::Crc32(checksum),
        found,
        found == checksum,
    )?;
    Ok(firmware)
}

/// The checksum of the first `end` bytes of the contents, without the checksum itself.
fn list_checksum(contents: &[u8], end: usize) -> u32 {
    let mut digest = crate::wire::CRC_32.digest();
    digest.update(contents.get(..CHECKSUM).unwrap_or_default());
    digest.update(contents.get(HEADER..end).unwrap_or_default());
    digest.finalize()
}

fn kind_of(code: u32) -> Option<Kind> {
    Kind::ALL.into_iter().find(|kind| *kind as u32 == code)
}

/// The name of an entry, behind which all bytes are 0.
fn name_of(entry: &[u8; ENTRY]) -> Option<&str> {
    let field = entry.get(HEADER..)?;
    let end = field.iter().position(|byte| *byte == 0)?;
    let (name, rest) = field.split_at_checked(end)?;
    let name = str::from_utf8(name).ok()?;
    (is_name(name) && rest.iter().all(|byte| *byte == 0)).then_some(name)
}

/// The first `N` little-endian 32-bit words of `bytes`; words beyond the end are 0.
fn words<const N: usize>(bytes: &[u8]) -> [u32; N] {
    let mut words = [0; N];
    for (word, bytes) in words.iter_mut().zip(bytes.as_chunks().0) {
        *word = u32::from_le_bytes(*bytes);
    }
    words
}

/// A length, at most the largest number of 32 bits.
fn clamped(length: usize) -> u32 {
    u32::try_from(length).unwrap_or(u32::MAX)
}

fn error(offset: usize, expected: Expected, found: u32) -> FlashError {
    FlashError {
        offset: clamped(offset),
        expected,
        found,
    }
}

fn expect(offset: usize, expected: Expected, found: u32, holds: bool) -> Result<(), FlashError> {
    holds
        .then_some(())
        .ok_or_else(|| error(offset, expected, found))
}
