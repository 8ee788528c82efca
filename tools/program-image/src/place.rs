//! Source locations of the addresses that a program prints when it ends with an error.

use addr2line::gimli::{self, Dwarf, EndianSlice, LittleEndian, Reader, SectionId};
use addr2line::{Context, Frame, demangle_auto};
use object::read::elf::{ElfFile32, ElfSymbol32};
use object::{Endianness, Object, ObjectSection, ObjectSymbol};

/// Text before a code address in a message.
const BEFORE: &str = " at 0x";
/// Text of the line that follows the last message of a program.
const AFTER: &str = "halted, press Enter to restart";
/// Maximum number of bytes of a line that are kept.
const LINE: usize = 1024;
/// Parts of the paths of the standard library's sources: without and with installed sources.
const STANDARD_LIBRARY: [&str; 2] = ["/rustc/", "/rustlib/src/rust/"];

/// Searches the output of a program for its last message, such as `trap: illegal instruction (mcause 2) at 0x40000680, …`, and finds the
/// source location of the address.
#[derive(Debug, Default)]
pub struct Places {
    /// The file of the program.
    file: Vec<u8>,
    /// The unfinished line of the output.
    line: Vec<u8>,
    /// The address in the previous line.
    address: Option<u32>,
}

impl Places {
    /// The source locations of a program in an ELF file. A flat binary has none.
    #[must_use]
    pub fn new(file: Vec<u8>) -> Self {
        Self {
            file,
            ..Self::default()
        }
    }

    /// Processes output of the program. Returns a text with the address and its source location if the program has ended with a message.
    pub fn hear(&mut self, output: &[u8]) -> Option<String> {
        let mut found = None;
        for &byte in output {
            if byte != b'\n' {
                if self.line.len() < LINE {
                    self.line.push(byte);
                }
                continue;
            }
            let line = std::mem::take(&mut self.line);
            let line = String::from_utf8_lossy(&line);
            let before = std::mem::replace(&mut self.address, address(&line));
            if line.contains(AFTER)
                && let Some(address) = before
                && let Some(place) = place(&self.file, address)
            {
                found = Some(format!("{address:#010x} is in {place}"));
            }
        }
        found
    }
}

/// The code address in a line.
fn address(line: &str) -> Option<u32> {
    let (_, after) = line.split_once(BEFORE)?;
    u32::from_str_radix(after.get(..8)?, 16).ok()
}

/// The source location of a code address: function, file and line, such as `recurse, src/main.rs:25`. If the location is in the standard
/// library and its code is inlined, the location of the caller. Without debug information, only the function.
fn place(elf: &[u8], address: u32) -> Option<String> {
    let file = ElfFile32::<Endianness>::parse(elf).ok()?;
    line(&file, address).or_else(|| function(&file, address))
}

/// The source location of an address, from the debug information.
fn line(file: &ElfFile32, address: u32) -> Option<String> {
    let section = |id: SectionId| {
        let found = file.section_by_name(id.name());
        let data = found.and_then(|section| section.data().ok());
        Ok::<_, gimli::Error>(EndianSlice::new(data.unwrap_or_default(), LittleEndian))
    };
    let context = Context::from_dwarf(Dwarf::load(section).ok()?).ok()?;
    // From the innermost inlined function outwards.
    let mut frames = context.find_frames(address.into()).skip_all_loads().ok()?;
    while let Some(frame) = frames.next().ok()? {
        if let Some(text) = text(&frame) {
            return Some(text);
        }
    }
    None
}

/// The function of an address, from the symbol table.
fn function(file: &ElfFile32, address: u32) -> Option<String> {
    let address = u64::from(address);
    let is_there = |symbol: &ElfSymbol32| {
        let start = symbol.address();
        (start..start + symbol.size()).contains(&address)
    };
    let symbol = file.symbols().find(is_there)?;
    Some(demangle_auto(symbol.name().ok()?.into(), None).into_owned())
}

/// The text of a source location; `None` for a location in the standard library.
fn text<R: Reader>(frame: &Frame<R>) -> Option<String> {
    let (function, location) = (frame.function.as_ref()?, frame.location.as_ref()?);
    let (file, line) = (location.file?, location.line?);
    let is_standard = STANDARD_LIBRARY.iter().any(|part| file.contains(part));
    (!is_standard).then_some(format!("{}, {file}:{line}", function.demangle().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_address_of_a_message_is_found() {
        for (line, expected) in [
            (
                "trap: breakpoint (mcause 3) at 0x40000680, mtval 0x00000000",
                Some(0x4000_0680),
            ),
            ("an endless loop? at 0x4000abcd\r", Some(0x4000_abcd)),
            ("panicked at src/main.rs:3:4:", None),
            ("at 0x40000680", None),
            ("look at 0x4000", None),
        ] {
            assert_eq!(address(line), expected, "{line}");
        }
    }

    #[test]
    fn a_file_without_information_has_no_places() {
        let mut places = Places::new(b"\x13\0\0\0".to_vec());
        let message = "trap: breakpoint at 0x40000000\r\nGlint: halted, press Enter to restart\r\n";
        assert_eq!(places.hear(message.as_bytes()), None);
    }
}
