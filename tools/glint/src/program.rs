//! Checks that a file can be a program for a board: a flat binary that begins with an instruction.

use crate::error::{FormatError, InputError, quote};
use crate::formats::read_up_to;
use glint_core::flash::Image;
use std::path::Path;

/// Length of an instruction in bytes.
const INSTRUCTION: usize = 4;
/// Size in bytes of the largest main memory of the supported boards.
const MEMORY: usize = 128 << 20;
/// Number of bytes at the start of a file that decide whether it is a text.
const START: usize = 256;

/// Values of the lowest seven bits of an RV32IM instruction.
const OPCODES: [u8; 11] = [
    0x03, 0x0f, 0x13, 0x17, 0x23, 0x33, 0x37, 0x63, 0x67, 0x6f, 0x73,
];

/// Reads and checks the file at `path`, or standard input.
///
/// # Errors
/// The file cannot be read, or [`check`] rejects it.
pub fn read(path: &Path) -> Result<Vec<u8>, InputError> {
    let bytes = read_up_to(path, MEMORY)?;
    check(&bytes, path)?;
    Ok(bytes)
}

/// Checks the bytes of the file at `path`.
///
/// # Errors
/// The board cannot run the file: it is empty, too long, an ELF file, a text, an image of the flash, or does not begin with an
/// instruction.
pub fn check(bytes: &[u8], path: &Path) -> Result<(), InputError> {
    let flat = "a flat binary that begins with an RV32IM instruction";
    let error =
        |expected: &str, found: String| Err(FormatError::whole(expected, found).in_path(path));
    let Some(first) = bytes.first_chunk::<INSTRUCTION>() else {
        return error(flat, format!("a file of {} bytes", bytes.len()));
    };
    if first == b"\x7fELF" {
        let flat = path.with_extension("bin");
        let expected = format!("a flat binary such as {}", flat.display());
        return error(&expected, "an ELF file".to_owned());
    }
    let start = bytes.get(..START).unwrap_or(bytes);
    if start.iter().all(|&byte| is_text(byte)) {
        return error(flat, format!("the text {}", quote(first)));
    }
    if Image::new_checked(bytes).is_ok() {
        let found = "an image of the flash, which `glint flash --spi` writes";
        return error(flat, found.to_owned());
    }
    if !OPCODES.contains(&(first[0] & 0x7f)) {
        return error(flat, format!("the bytes {first:02x?}"));
    }
    Ok(())
}

const fn is_text(byte: u8) -> bool {
    byte.is_ascii_graphic() || byte.is_ascii_whitespace()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_flat_binaries_pass() {
        let refused = |bytes: &[u8]| {
            let error = check(bytes, Path::new("target/glint.elf")).unwrap_err();
            error.to_string()
        };
        for (bytes, found) in [
            (&b""[..], "a file of 0 bytes"),
            (b"\x13\0\0", "a file of 3 bytes"),
            (b"solid cube\n", "the text 'soli'"),
            (&[0; 100], "the bytes [00, 00, 00, 00]"),
            (&[0xff; 100], "the bytes [ff, ff, ff, ff]"),
            (b"GLM\0\x01\0\0\0", "the bytes [47, 4c, 4d, 00]"),
        ] {
            let error = refused(bytes);
            assert!(error.ends_with(&format!("found {found}")), "{error}");
        }
        assert!(refused(b"\x7fELF\x01").contains("such as target/glint.bin, found an ELF file"));
        // lui x1, 0x40000
        assert!(check(&[0xb7, 0, 0, 0x40], Path::new("a.bin")).is_ok());
    }
}
