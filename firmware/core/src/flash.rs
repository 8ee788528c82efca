//! Images of a board's SPI flash: bitstream, firmware, and contents (docs/formats/flash.md, "Flash image").
//!
//! [`Image::new_checked`] checks a whole image. A board checks only the list of the contents at start
//! ([`Contents::new_checked`]), and the bytes of an item before it uses the item ([`Item::checked`]).

#[cfg(feature = "alloc")]
mod encode;
mod error;
mod lines;

use core::ops::Range;
use core::str;

use crate::console::LINE_MAX;
use crate::constants;
use crate::mesh::is_name;
use crate::records::{FirmwareHeader, FlashEntry, FlashHeader, WORD};
use crate::wire::crc32;

#[cfg(feature = "alloc")]
pub use encode::{EncodeError, Piece, encode};
pub use error::{Expected, FlashError};
pub use lines::{DataLines, data_lines};

/// Offset of the firmware in bytes, after the slot of the bitstream.
pub const FIRMWARE: usize = constants::FLASH_FIRMWARE as usize;
/// Offset of the contents in bytes.
pub const CONTENTS: usize = 4 << 20;
/// Largest length of an image in bytes.
pub const MAX_BYTES: usize = 16 << 20;
/// Largest number of items.
pub const MAX_ITEMS: u32 = 64;
/// The first four bytes of the contents.
pub const MAGIC: [u8; 4] = *b"GFC1";
/// Smallest length in bytes of a firmware that LiteX's BIOS boots.
pub const MIN_FIRMWARE: u32 = 32;
/// Largest length in bytes of a firmware without its header.
pub const MAX_FIRMWARE: u32 = (CONTENTS - FIRMWARE - FirmwareHeader::BYTES) as u32;

/// The synchronisation word that marks the start of a bitstream for the FPGA.
const SYNC: [u8; 4] = [0xaa, 0x99, 0x55, 0x66];
/// Number of bytes at the start of a bitstream that must contain [`SYNC`].
const SYNC_WITHIN: usize = 4096;
/// Kind of an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Kind {
    /// A mesh, in the format of an upload.
    Mesh = 1,
    /// A scene: console commands, one per line.
    Scene = 2,
    /// A list of scenes: names, one per line. The board shows the first list of the flash.
    List = 3,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Mesh, Self::Scene, Self::List];

    /// Name for messages.
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
    /// The checksum of the bytes is wrong.
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

    /// The text of a scene or a list, whose lines fit a line of the console.
    ///
    /// # Errors
    /// The checksum is wrong, or the bytes are not ASCII text with lines of this length.
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
        // The bytes are ASCII, so this conversion to UTF-8 does not fail.
        Ok(str::from_utf8(bytes).unwrap_or_default())
    }
}

/// The contents of a flash: models, scenes and lists of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contents<'a> {
    /// All bytes, beginning with the list of the items.
    bytes: &'a [u8],
    count: usize,
}

impl<'a> Contents<'a> {
    /// Checks the list of the items at the start of `bytes`, which may be longer than the contents. The check does not read the
    /// items' bytes.
    ///
    /// # Errors
    /// The first deviation from the format.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, FlashError> {
        let found = clamped(bytes.len());
        let Some((header, _)) = bytes.split_first_chunk() else {
            let expected = Expected::AtLeast("bytes of contents", FlashHeader::BYTES as u32);
            return Err(error(CONTENTS, expected, found));
        };
        let header = FlashHeader::from_bytes(header);
        let FlashHeader { length, .. } = header;
        let place = |field: Range<usize>| CONTENTS + field.start;
        expect(
            place(FlashHeader::MAGIC),
            Expected::Magic(MAGIC),
            u32::from_le_bytes(header.magic),
            header.magic == MAGIC,
        )?;
        let limit = Expected::AtMost("bytes of contents (to the end of the image)", found);
        expect(place(FlashHeader::LENGTH), limit, length, length <= found)?;
        let limit = Expected::AtMost("items", MAX_ITEMS);
        expect(
            place(FlashHeader::ITEMS),
            limit,
            header.items,
            header.items <= MAX_ITEMS,
        )?;
        // At most 64.
        let count = header.items as usize;
        let list = list_end(count);
        let least = Expected::AtLeast("bytes of contents (for the list of items)", list as u32);
        expect(
            place(FlashHeader::LENGTH),
            least,
            length,
            length as usize >= list,
        )?;
        let contents = Self {
            bytes: bytes.get(..length as usize).unwrap_or_default(),
            count,
        };
        let sum = list_checksum(contents.bytes, list);
        expect(
            place(FlashHeader::CHECKSUM),
            Expected::Crc32(header.checksum),
            sum,
            sum == header.checksum,
        )?;
        contents.check_list()?;
        Ok(contents)
    }

    /// Number of bytes.
    pub const fn length(&self) -> usize {
        self.bytes.len()
    }

    /// The items, in the order of the list.
    pub fn items(&self) -> impl Iterator<Item = Item<'a>> + use<'a> {
        let mut offset = list_end(self.count);
        let bytes = self.bytes;
        // The list has been checked, so every entry yields an item.
        self.entries().map_while(move |entry| {
            let FlashEntry {
                kind,
                length,
                checksum,
                ..
            } = FlashEntry::from_bytes(entry);
            let item = Item {
                kind: kind_of(kind)?,
                name: name_of(entry)?,
                offset,
                bytes: bytes.get(offset..)?.get(..length as usize)?,
                crc32: checksum,
            };
            offset = (offset + item.bytes.len()).next_multiple_of(WORD);
            Some(item)
        })
    }

    /// Finds the item with a kind and a name.
    pub fn find(&self, kind: Kind, name: &str) -> Option<Item<'a>> {
        self.items()
            .find(|item| item.kind == kind && item.name == name)
    }

    fn entries(&self) -> impl Iterator<Item = &'a [u8; FlashEntry::BYTES]> + use<'a> {
        let list = self.bytes.get(FlashHeader::BYTES..).unwrap_or_default();
        list.as_chunks().0.iter().take(self.count)
    }

    fn check_list(&self) -> Result<(), FlashError> {
        let mut offset = list_end(self.count);
        for (number, entry) in self.entries().enumerate() {
            let place = |field: Range<usize>| CONTENTS + list_end(number) + field.start;
            let FlashEntry {
                kind, length, name, ..
            } = FlashEntry::from_bytes(entry);
            expect(
                place(FlashEntry::KIND),
                Expected::Kind,
                kind,
                kind_of(kind).is_some(),
            )?;
            let rest = self.bytes.len().saturating_sub(offset);
            let limit = Expected::AtMost(
                "bytes of an item (to the end of the contents)",
                clamped(rest),
            );
            let is_inside = length as usize <= rest;
            expect(place(FlashEntry::LENGTH), limit, length, is_inside)?;
            let reserved = entry.get(FlashEntry::RESERVED).unwrap_or_default();
            let reserved = (reserved.first_chunk()).map_or(0, |word| u32::from_le_bytes(*word));
            let zero = Expected::Exactly("(reserved)", 0);
            expect(place(FlashEntry::RESERVED), zero, reserved, reserved == 0)?;
            let [first, ..] = name;
            let is_named = name_of(entry).is_some();
            expect(
                place(FlashEntry::NAME),
                Expected::Name,
                first.into(),
                is_named,
            )?;
            offset = (offset + length as usize).next_multiple_of(WORD);
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
    /// Checks an image with all of its checksums, but not the meshes and the commands of scenes.
    ///
    /// # Errors
    /// The first deviation from the format.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, FlashError> {
        let found = clamped(bytes.len());
        let limit = Expected::AtMost("bytes", MAX_BYTES as u32);
        expect(0, limit, found, bytes.len() <= MAX_BYTES)?;
        let least = Expected::AtLeast("bytes", (CONTENTS + FlashHeader::BYTES) as u32);
        expect(
            0,
            least,
            found,
            bytes.len() >= CONTENTS + FlashHeader::BYTES,
        )?;
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

/// The bitstream in its slot, without the erased bytes after it; `None` for an erased slot.
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

/// Reads the firmware at the start of `bytes`, which begins with LiteX's header for flash boot. Returns the firmware without this
/// header.
///
/// # Errors
/// The length is out of range, or the checksum is wrong.
pub fn firmware(bytes: &[u8]) -> Result<&[u8], FlashError> {
    let (header, rest) = bytes.split_first_chunk().unwrap_or((&[0; _], &[]));
    let FirmwareHeader { length, checksum } = FirmwareHeader::from_bytes(header);
    let least = Expected::AtLeast("bytes of firmware", MIN_FIRMWARE);
    let place = FIRMWARE + FirmwareHeader::LENGTH.start;
    expect(place, least, length, length >= MIN_FIRMWARE)?;
    let most = clamped(rest.len()).min(MAX_FIRMWARE);
    let limit = Expected::AtMost("bytes of firmware", most);
    expect(place, limit, length, length <= most)?;
    let firmware = rest.get(..length as usize).unwrap_or_default();
    let found = crc32(firmware);
    expect(
        FIRMWARE + FirmwareHeader::CHECKSUM.start,
        Expected::Crc32(checksum),
        found,
        found == checksum,
    )?;
    Ok(firmware)
}

/// Offset of the end of a list of `items` items from the start of the contents.
const fn list_end(items: usize) -> usize {
    FlashHeader::BYTES + items * FlashEntry::BYTES
}

/// Computes the checksum of header and list, which end at `end`; the checksum's own bytes are left out.
fn list_checksum(contents: &[u8], end: usize) -> u32 {
    let mut digest = crate::wire::CRC_32.digest();
    for part in [
        0..FlashHeader::CHECKSUM.start,
        FlashHeader::CHECKSUM.end..end,
    ] {
        digest.update(contents.get(part).unwrap_or_default());
    }
    digest.finalize()
}

fn kind_of(code: u32) -> Option<Kind> {
    Kind::ALL.into_iter().find(|kind| *kind as u32 == code)
}

/// Reads the name of an entry, which is padded with zeros.
fn name_of(entry: &[u8; FlashEntry::BYTES]) -> Option<&str> {
    let field = entry.get(FlashEntry::NAME)?;
    let end = field.iter().position(|byte| *byte == 0)?;
    let (name, rest) = field.split_at_checked(end)?;
    let name = str::from_utf8(name).ok()?;
    (is_name(name) && rest.iter().all(|byte| *byte == 0)).then_some(name)
}

/// Converts a length to 32 bits, saturating.
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
