//! The fuzz target of flash images.

use crate::image::check_contents;
use glint_core::block::Block;
use glint_core::demo::{Demo, Move};
use glint_core::flash::{self, Contents, Kind};
use glint_core::wire::crc32;
use glint_scene::{AnyBoard, Defaults, Scene, lines};

/// Parses the input as a firmware with its header, and as the contents of an image with all items.
/// Returns whether the contents are valid.
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
            match item.kind {
                Kind::Mesh | Kind::Texture | Kind::Program => drop(item.checked()),
                Kind::Scene => drop(item.text().map(run_scene)),
                Kind::List => drop(item.text().map(run_list)),
            }
        }
        check_contents(&contents)
    });
    match checked {
        Ok(Ok(())) => true,
        Ok(Err(error)) => rejected(&error.to_string()),
        Err(error) => rejected(&error.to_string()),
    }
}

/// Executes the lines of a scene like a board.
fn run_scene(text: &str) {
    let Ok(mut scene) = Scene::new(Defaults::GATEWARE) else {
        return;
    };
    for line in lines(text) {
        match line {
            Ok((_, line)) => {
                for name in [line.mesh(), line.texture(), line.program()] {
                    assert!(name.is_none_or(|name| text.contains(name)));
                }
                if let Err(error) = line.apply(&mut scene, &mut AnyBoard) {
                    rejected(&error.to_string());
                }
            }
            Err(error) => drop(rejected(&error.to_string())),
        }
    }
    assert!(Block::of_bits(scene.blocks()).count() > 0);
}

/// Plays the scenes of a list like a board; the bytes of the text determine when a scene is skipped
/// or held.
fn run_list(text: &str) {
    let count = text.lines().count();
    let mut demo = Demo::default();
    demo.start(count);
    let mut now = 0;
    for byte in text.bytes() {
        match byte % 8 {
            0 => demo.go(Move::Next),
            1 => demo.go(Move::Previous),
            2 => demo.hold(now, true),
            3 => demo.hold(now, false),
            _ => now += u64::from(byte) << 6,
        }
        let number = demo.poll(now).or(demo.number());
        assert!(number.is_none_or(|number| text.lines().nth(number).is_some()));
    }
}

fn rejected(error: &str) -> bool {
    assert!(!error.contains('\n'));
    false
}

/// Corrects the length, the checksums of the items, and the checksum of the list; otherwise nearly every mutation would be
/// rejected.
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
