//! Programs for a board: flat binaries that begin with an instruction, and ELF files, which are converted.

use crate::error::{FormatError, InputError, quote};
use crate::formats::read_up_to;
use glint_core::flash::Image;
use glint_program_image::{self as image, Places};
use std::path::Path;

/// Size in bytes of the largest main memory of the supported boards.
const MEMORY: usize = 128 << 20;

/// A program for the soft core.
#[derive(Debug)]
pub struct Program {
    /// The memory image.
    pub image: Vec<u8>,
    /// The source locations of its code; none for a flat binary.
    pub places: Places,
}

/// Reads the file at `path`, or standard input: a flat binary, which is checked, or an ELF file, which is converted.
///
/// # Errors
/// The file cannot be read, [`check`] rejects it, or the ELF file is not a program for Glint's boards.
pub fn read(path: &Path) -> Result<Program, InputError> {
    let file = read_up_to(path, MEMORY)?;
    if file.starts_with(&image::MAGIC) {
        let image = image::of_elf(&file, MEMORY as u64).map_err(|found| {
            FormatError::whole("a program for Glint's boards", found.to_string()).in_path(path)
        })?;
        let places = Places::new(file);
        return Ok(Program { image, places });
    }
    check(&file, path)?;
    Ok(Program {
        image: file,
        places: Places::default(),
    })
}

/// Checks the bytes of the file at `path`.
///
/// # Errors
/// The board cannot run the file: it is empty, too long, a text, an image of the flash, or does not begin with an instruction.
pub fn check(bytes: &[u8], path: &Path) -> Result<(), InputError> {
    let flat = "a flat binary that begins with an RV32IM instruction";
    let error =
        |expected: &str, found: String| Err(FormatError::whole(expected, found).in_path(path));
    let Some(first) = bytes.first_chunk::<4>() else {
        return error(flat, format!("a file of {} bytes", bytes.len()));
    };
    if image::is_text(bytes) {
        return error(flat, format!("the text {}", quote(first)));
    }
    if Image::new_checked(bytes).is_ok() {
        let found = "an image of the flash, which `glint flash --spi` writes";
        return error(flat, found.to_owned());
    }
    if !image::is_flat(bytes) {
        return error(flat, format!("the bytes {first:02x?}"));
    }
    image::check_length(bytes).or_else(|found| error(flat, found.to_string()))
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
        // lui x1, 0x40000
        let mut program = vec![0xb7, 0, 0, 0x40];
        assert!(check(&program, Path::new("a.bin")).is_ok());
        program.resize(image::MAX_IMAGE + 1, 0);
        let found = "found a flat binary of 7340033 bytes, which is longer than the program's part of main memory, 7340032 bytes";
        assert!(refused(&program).ends_with(found));
    }
}
