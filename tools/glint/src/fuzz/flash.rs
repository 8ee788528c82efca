//! The fuzz target of flash images.

use crate::image::check_contents;
use glint_core::flash::{self, Contents};
use glint_core::wire::crc32;

/// Reads a firmware with its header, and contents with all items. Returns whether the contents are valid.
pub fn run(input: &[u8]) -> bool {
    if let Ok(firmware) = flash::firmware(input) {
        assert!(firmware.len() < input.len());
    }
    let contents = Contents::new_checked(input);
    let checked = contents.map(|contents| {
        let lengths = contents.items().map(|item| item.length());
        assert!(lengths.sum::<usize>() <= input.len());
        for item in contents.items() {
            assert!(contents.find(item.kind, item.name).is_some());
            let _ = item.text();
        }
        check_contents(&contents)
    });
    match checked {
        Ok(Ok(())) => true,
        Ok(Err(error)) => rejected(&error.to_string()),
        Err(error) => rejected(&error.to_string()),
    }
}

fn rejected(error: &str) -> bool {
    assert!(!error.contains('\n'));
    false
}

/// Corrects length, checksums of the items, and checksum of the list, by which nearly every mutation would be rejected.
pub fn repair(input: &mut [u8]) {
    const HEADER: usize = 16;
    const ENTRY: usize = 48;
    let length = input.len();
    let word = |input: &[u8], at: usize| {
        let bytes = input.get(at..)?.first_chunk()?;
        Some(u32::from_le_bytes(*bytes) as usize)
    };
    let set = |input: &mut [u8], at: usize, value: u32| {
        if let Some(field) = input.get_mut(at..at + 4) {
            field.copy_from_slice(&value.to_le_bytes());
        }
    };
    set(input, 4, length as u32);
    let count = word(input, 8).unwrap_or(0).min(64);
    let end = HEADER + count * ENTRY;
    let mut offset = end;
    for entry in (HEADER..end).step_by(ENTRY) {
        let item = word(input, entry + 4).unwrap_or(0);
        let last = offset.saturating_add(item);
        let Some(bytes) = input.get(offset..last) else {
            break;
        };
        let checksum = crc32(bytes);
        set(input, entry + 8, checksum);
        offset = last.next_multiple_of(HEADER);
    }
    let list = input.get(HEADER..end.min(length)).unwrap_or_default();
    let head = input.get(..12).unwrap_or_default();
    let checksum = crc32(&[head, list].concat());
    set(input, 12, checksum);
}
