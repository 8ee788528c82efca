//! Memory images and source locations of programs for the soft core, from their ELF files.
#![forbid(unsafe_code)]

mod place;

use std::ops::Range;
use std::path::Path;

use litex_pac::BUILD_ID;
use litex_pac::memories::{MAIN_RAM, SRAM};
use object::elf::PT_LOAD;
use object::read::elf::{ElfFile32, ProgramHeader};
use object::{Endianness, Object, ObjectSymbol};

pub use place::Places;

/// First bytes of an ELF file.
pub const MAGIC: [u8; 4] = *b"\x7fELF";

/// Address at which the BIOS loads and starts a memory image.
pub const START_ADDRESS: u32 = MAIN_RAM.base;

/// Largest length of a memory image in bytes: the program's part of a main memory of 128 MB, `PROGRAM` of `firmware/windows/128.x`.
pub const MAX_IMAGE: usize = 7 << 20;

/// Number of bytes at the start of a file that decide whether it is a text.
const START: usize = 256;

/// Symbol of the build id in a program.
const BUILD_ID_SYMBOL: &str = "GLINT_BUILD_ID";

/// Reason why a file is not a program for a board. Each text follows "found" in an error.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The file is damaged, or is not for a 32-bit processor.
    #[error("an ELF file that is damaged, or not for a 32-bit processor: {0}")]
    Elf(#[from] object::read::Error),
    /// The linker script of Glint was not used.
    #[error(
        "an ELF file without the symbol {0}: link it with the arguments -Tmemory.x and -Tlink.x"
    )]
    Symbol(&'static str),
    /// The program was built for gateware with other registers.
    #[error(
        "a program for gateware {found:#010x}, while these boards have {BUILD_ID:#010x}: build both from the same sources of Glint"
    )]
    BuildId {
        /// Build id in the program.
        found: u32,
    },
    /// The entry point is not the address to which the BIOS jumps.
    #[error("the entry point {found:#010x}, while the BIOS jumps to {base:#010x}", base = MAIN_RAM.base)]
    Entry {
        /// The entry point of the program.
        found: u64,
    },
    /// Main memory is smaller than the memory map.
    #[error("a memory map that ends at {found:#010x}, beyond the end of main memory, {end:#010x}")]
    Windows {
        /// End of the memory map.
        found: u64,
        /// End of main memory.
        end: u64,
    },
    /// Fast code is outside of the SRAM.
    #[error("fast code at {found:#x?}, outside of the SRAM, {sram:#x?}")]
    Fast {
        /// Address range of the fast code.
        found: Range<u64>,
        /// Address range of the SRAM.
        sram: Range<u64>,
    },
    /// A segment is outside of the program's part of main memory.
    #[error("a segment from {:#010x} to {:#010x}, outside of the program's part of main memory", .0.start, .0.end)]
    Segment(Range<u64>),
    /// A flat binary is longer than the program's part of main memory.
    #[error(
        "a flat binary of {0} bytes, which is longer than the program's part of main memory, {MAX_IMAGE} bytes"
    )]
    Length(usize),
    /// Two segments overlap.
    #[error("a segment at {0:#010x} that overlaps the previous segment")]
    Overlap(u64),
}

/// Length of an instruction in bytes.
const INSTRUCTION: usize = 4;

/// Values of the lowest seven bits of an RV32IM instruction.
const OPCODES: [u8; 11] = [
    0x03, 0x0f, 0x13, 0x17, 0x23, 0x33, 0x37, 0x63, 0x67, 0x6f, 0x73,
];

/// Whether the first bytes of a file can be an RV32IM instruction, as in a flat binary. The first bytes of a text can be one, too.
#[must_use]
pub fn is_flat(file: &[u8]) -> bool {
    file.first_chunk::<INSTRUCTION>()
        .is_some_and(|first| OPCODES.contains(&(first[0] & 0x7f)))
}

/// Whether the first bytes of a file are text.
#[must_use]
pub fn is_text(file: &[u8]) -> bool {
    let is_text = |byte: &u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    file.iter().take(START).all(is_text)
}

/// Whether a file can be a program: an ELF file, or a file that begins like a flat binary and whose name ends in `.bin` or has no
/// extension. The first bytes of a mesh can be an instruction, too, such as the `glTF` of a GLB file or the header of an STL file.
#[must_use]
pub fn may_be_program(name: &str, file: &[u8]) -> bool {
    let extension = Path::new(name).extension();
    let is_named = extension.is_none_or(|extension| extension.eq_ignore_ascii_case("bin"));
    file.starts_with(&MAGIC) || is_named && is_flat(file) && !is_text(file)
}

/// Returns the memory image of a program, an ELF file or a flat binary, for the boards with 128 MB of main memory.
///
/// # Errors
/// [`ImageError`].
pub fn of_file(file: &[u8]) -> Result<Vec<u8>, ImageError> {
    if file.starts_with(&MAGIC) {
        return of_elf(file, MAIN_RAM.size.into());
    }
    check_length(file)?;
    Ok(file.to_owned())
}

/// Checks the length of a flat binary.
///
/// # Errors
/// [`ImageError::Length`].
pub const fn check_length(flat: &[u8]) -> Result<(), ImageError> {
    if flat.len() > MAX_IMAGE {
        return Err(ImageError::Length(flat.len()));
    }
    Ok(())
}

/// Returns the memory image of an ELF file, from the base of main memory, for a board with `main_ram` bytes of main memory.
///
/// # Errors
/// [`ImageError`].
pub fn of_elf(elf: &[u8], main_ram: u64) -> Result<Vec<u8>, ImageError> {
    let file = ElfFile32::<Endianness>::parse(elf)?;
    let endian = file.endian();
    let (base, end) = (
        u64::from(MAIN_RAM.base),
        u64::from(MAIN_RAM.base) + main_ram,
    );
    let symbol = |name| symbol(&file, name).ok_or(ImageError::Symbol(name));
    let windows_end = symbol("_windows_end")?;
    if file.entry() != base {
        return Err(ImageError::Entry {
            found: file.entry(),
        });
    }
    if windows_end > end {
        return Err(ImageError::Windows {
            found: windows_end,
            end,
        });
    }

    let fast = symbol("_fast")?..symbol("_fast")? + symbol("_fast_size")?;
    let sram = u64::from(SRAM.base)..u64::from(SRAM.base) + u64::from(SRAM.size);
    if fast.start < sram.start || sram.end < fast.end {
        return Err(ImageError::Fast { found: fast, sram });
    }

    // A symbol of a damaged file can have any value, so the end of main memory also limits the size of the image.
    let program_end = symbol("_sample_memory")?.min(end);
    let mut image = Vec::new();
    for segment in file.elf_program_headers() {
        if segment.p_type(endian) != PT_LOAD {
            continue;
        }
        // `p_paddr` is the load address of a segment, which may differ from its address at run time.
        let address = u64::from(segment.p_paddr(endian));
        // A damaged file can have more bytes than its segment has memory.
        let size = segment.p_memsz(endian).max(segment.p_filesz(endian));
        let range = address..address + u64::from(size);
        let data = segment.data(endian, elf);
        let data = data.map_err(|()| ImageError::Segment(range.clone()))?;
        if range.start < base || program_end < range.end {
            return Err(ImageError::Segment(range));
        }
        if data.is_empty() {
            continue;
        }
        let offset = (address - base) as usize;
        if offset < image.len() {
            return Err(ImageError::Overlap(address));
        }
        image.resize(offset, 0);
        image.extend_from_slice(data);
    }
    let offset = symbol(BUILD_ID_SYMBOL)?.wrapping_sub(base) as usize;
    let found = image.get(offset..).and_then(|bytes| bytes.first_chunk());
    let found = found.map_or(0, |bytes| u32::from_le_bytes(*bytes));
    if found != BUILD_ID {
        return Err(ImageError::BuildId { found });
    }
    Ok(image)
}

/// The value of a symbol; `None` if the file has no such symbol.
#[must_use]
pub fn symbol(file: &ElfFile32<Endianness>, name: &str) -> Option<u64> {
    let found = file.symbols().find(|symbol| symbol.name() == Ok(name));
    found.map(|symbol| symbol.address())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_image_fills_the_window_of_programs() {
        let windows = include_str!("../../../firmware/windows/128.x");
        let window = "PROGRAM : ORIGIN = 0x40000000, LENGTH = 7M";
        assert!(windows.contains(window) && MAX_IMAGE == 7 << 20);
    }

    #[test]
    fn meshes_and_texts_are_no_programs() {
        let stl = [&b"glint"[..], &[0; 75], &[12, 0, 0, 0], &[0x80; 600]].concat();
        assert!(is_flat(&stl), "the header begins with an instruction");
        assert!(!may_be_program("a.stl", &stl));
        assert!(!may_be_program("a.glb", b"glTF\x02\0\0\0\xff\xff\xff\xff"));
        assert!(!may_be_program("notes", b"grey walls\n"));
        let program = [0xb7, 0, 0, 0x40, 0xff];
        for (name, is_program) in [
            ("a.bin", true),
            ("hello", true),
            ("A.BIN", true),
            ("a.ply", false),
        ] {
            assert_eq!(may_be_program(name, &program), is_program, "{name}");
        }
        assert!(may_be_program("hello.old", b"\x7fELF"));
    }
}
