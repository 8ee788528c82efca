//! Images of a board's SPI flash: bitstream, firmware, and contents (docs/formats/flash.md, "Flash image").
//!
//! [`Image::new_checked`] checks a whole image. A board checks only the list of the contents at start
//! ([`Contents::new_checked`]), and the bytes of an item before it uses the item ([`Item::checked`]).

#[cfg(feature = "alloc")]
mod encode;
mod lines;

use core::ops::Range;
use core::str;

use crate::console::LINE_MAX;
use crate::constants;
use crate::deviation::Expected::{AtLeast, AtMost, Content, Crc32, Exactly, Magic};
use crate::deviation::{Deviation, Expected, Format};
use crate::mesh::is_name;
use crate::records::{FirmwareHeader, FlashEntry, FlashHeader, WORD};
use crate::wire::crc32;

#[cfg(feature = "alloc")]
pub use encode::{EncodeError, Piece, encode};
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
    /// A texture, in the format of an upload.
    Texture = 4,
    /// A wireframe program, in the format of an upload.
    Program = 5,
}

impl Kind {
    /// All kinds, in the order of their numbers.
    pub const ALL: [Self; 5] = [
        Self::Mesh,
        Self::Scene,
        Self::List,
        Self::Texture,
        Self::Program,
    ];

    /// Name for messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mesh => "mesh",
            Self::Scene => "scene",
            Self::List => "list",
            Self::Texture => "texture",
            Self::Program => "program",
        }
    }
}

/// An item of the contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Item<'a> {
    /// Kind of the contents.
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
    pub fn checked(&self) -> Result<&'a [u8], Deviation> {
        let found = crc32(self.bytes);
        expect(CONTENTS + self.offset, Crc32(self.crc32), found)?;
        Ok(self.bytes)
    }

    /// The text of a scene or a list, whose lines fit a line of the console.
    ///
    /// # Errors
    /// The checksum is wrong, or the bytes are not ASCII text with lines of this length.
    pub fn text(&self) -> Result<&'a str, Deviation> {
        let bytes = self.checked()?;
        let start = CONTENTS + self.offset;
        let is_text = |byte: &u8| matches!(byte, b'\n' | b' '..=b'~');
        if let Some(place) = bytes.iter().position(|byte| !is_text(byte)) {
            let text = Content("ASCII text: a visible character, a blank or a line end");
            return Err(error(start + place, text, bytes[place].into()));
        }
        let mut place = start;
        for line in bytes.split(|byte| *byte == b'\n') {
            let length = line.len();
            let limit = AtMost("bytes in a line", LINE_MAX as u32);
            expect(place, limit, length as u32)?;
            place += length + 1;
        }
        // The bytes are ASCII, so this conversion to UTF-8 does not fail.
        Ok(str::from_utf8(bytes).unwrap_or_default())
    }
}

/// The contents of a flash: meshes, textures, wireframe programs, scenes and lists of scenes.
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
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, Deviation> {
        let found = clamped(bytes.len());
        let Some((header, _)) = bytes.split_first_chunk() else {
            let expected = AtLeast("bytes of contents", FlashHeader::BYTES as u32);
            return Err(error(CONTENTS, expected, found));
        };
        let header = FlashHeader::from_bytes(header);
        let FlashHeader { length, .. } = header;
        let place = |field: Range<usize>| CONTENTS + field.start;
        let magic = u32::from_le_bytes(header.magic);
        expect(place(FlashHeader::MAGIC), Magic(MAGIC), magic)?;
        let limit = AtMost("bytes of contents (to the end of the image)", found);
        expect(place(FlashHeader::LENGTH), limit, length)?;
        let limit = AtMost("items", MAX_ITEMS);
        expect(place(FlashHeader::ITEMS), limit, header.items)?;
        // At most 64.
        let count = header.items as usize;
        let list = list_end(count);
        let least = AtLeast("bytes of contents (for the list of items)", list as u32);
        expect(place(FlashHeader::LENGTH), least, length)?;
        let contents = Self {
            bytes: bytes.get(..length as usize).unwrap_or_default(),
            count,
        };
        let sum = list_checksum(contents.bytes, list);
        expect(place(FlashHeader::CHECKSUM), Crc32(header.checksum), sum)?;
        contents.check_list()?;
        Ok(contents)
    }

    /// Length in bytes, with the list of the items.
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

    fn check_list(&self) -> Result<(), Deviation> {
        let mut offset = list_end(self.count);
        for (number, entry) in self.entries().enumerate() {
            let place = |field: Range<usize>| CONTENTS + list_end(number) + field.start;
            let FlashEntry {
                kind, length, name, ..
            } = FlashEntry::from_bytes(entry);
            if kind_of(kind).is_none() {
                let expected = Content(
                    "a kind of items: 1 (mesh), 2 (scene), 3 (list), 4 (texture) or 5 (program)",
                );
                return Err(error(place(FlashEntry::KIND), expected, kind));
            }
            let rest = clamped(self.bytes.len().saturating_sub(offset));
            let limit = AtMost("bytes of an item (to the end of the contents)", rest);
            expect(place(FlashEntry::LENGTH), limit, length)?;
            let reserved = entry.get(FlashEntry::RESERVED).unwrap_or_default();
            let reserved = (reserved.first_chunk()).map_or(0, |word| u32::from_le_bytes(*word));
            expect(
                place(FlashEntry::RESERVED),
                Exactly("(reserved)", 0),
                reserved,
            )?;
            if name_of(entry).is_none() {
                let expected = Content("a name of 1 to 24 visible characters of ASCII, then zeros");
                return Err(error(place(FlashEntry::NAME), expected, name[0].into()));
            }
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
    /// The items after the firmware.
    pub contents: Contents<'a>,
}

impl<'a> Image<'a> {
    /// Checks an image with all of its checksums, but not the meshes, the programs and the commands of scenes.
    ///
    /// # Errors
    /// The first deviation from the format.
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, Deviation> {
        let found = clamped(bytes.len());
        expect(0, AtMost("bytes", MAX_BYTES as u32), found)?;
        let least = AtLeast("bytes", (CONTENTS + FlashHeader::BYTES) as u32);
        expect(0, least, found)?;
        let (slot, rest) = bytes.split_at_checked(FIRMWARE).unwrap_or_default();
        let firmware = firmware(rest)?;
        let contents = Contents::new_checked(bytes.get(CONTENTS..).unwrap_or_default())?;
        for item in contents.items() {
            match item.kind {
                Kind::Mesh | Kind::Texture | Kind::Program => drop(item.checked()?),
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
fn bitstream(slot: &[u8]) -> Result<Option<&[u8]>, Deviation> {
    let Some(last) = slot.iter().rposition(|byte| *byte != 0xff) else {
        return Ok(None);
    };
    let start = slot.get(..SYNC_WITHIN).unwrap_or(slot);
    let is_bitstream = start.windows(SYNC.len()).any(|bytes| bytes == SYNC);
    let first = slot
        .first_chunk()
        .map_or(0, |bytes| u32::from_be_bytes(*bytes));
    if !is_bitstream {
        let expected = Content("an erased slot, or a bitstream with its word 0xaa995566");
        return Err(error(0, expected, first));
    }
    Ok(slot.get(..=last))
}

/// Reads the firmware at the start of `bytes`, which begins with LiteX's header for flash boot. Returns the firmware without this
/// header.
///
/// # Errors
/// The length is out of range, or the checksum is wrong.
pub fn firmware(bytes: &[u8]) -> Result<&[u8], Deviation> {
    let (header, rest) = bytes.split_first_chunk().unwrap_or((&[0; _], &[]));
    let FirmwareHeader { length, checksum } = FirmwareHeader::from_bytes(header);
    let place = FIRMWARE + FirmwareHeader::LENGTH.start;
    expect(place, AtLeast("bytes of firmware", MIN_FIRMWARE), length)?;
    let most = clamped(rest.len()).min(MAX_FIRMWARE);
    expect(place, AtMost("bytes of firmware", most), length)?;
    let firmware = rest.get(..length as usize).unwrap_or_default();
    let place = FIRMWARE + FirmwareHeader::CHECKSUM.start;
    expect(place, Crc32(checksum), crc32(firmware))?;
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

fn error(offset: usize, expected: Expected, found: u32) -> Deviation {
    Format::Flash.deviation(clamped(offset), expected, found)
}

fn expect(offset: usize, expected: Expected, found: u32) -> Result<(), Deviation> {
    Format::Flash.expect(clamped(offset), expected, found)
}
