//! Helpers for tests of the firmware: its image, and boards that run it.

use std::path::{Path, PathBuf};

use litex_pac::memories::MAIN_RAM;
use object::{Object, ObjectSymbol};
use virtual_board::{Start, VirtualBoard};

/// Prompt of the firmware's console.
pub const PROMPT: &str = "glint> ";

/// Time-out of a command in cycles. It is longer than the time-out of a bus access, a million cycles.
pub const LIMIT: u64 = 30_000_000;

/// Reads the firmware's image.
pub fn image() -> Vec<u8> {
    read("glint.bin")
}

fn read(name: &str) -> Vec<u8> {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../target/firmware")
        .join(name);
    std::fs::read(&path)
        .unwrap_or_else(|error| panic!("{}: {error}; run `cargo xtask firmware`", path.display()))
}

/// Returns the address of the firmware's symbol whose mangled name contains all of `parts`.
pub fn address(parts: &[&str]) -> u32 {
    let elf = read("glint.elf");
    let file = object::File::parse(elf.as_slice()).expect("an ELF file");
    let mut found = file.symbols().filter(|symbol| {
        let name = symbol.name().unwrap_or_default();
        parts.iter().all(|part| name.contains(part))
    });
    let symbol = found
        .next()
        .unwrap_or_else(|| panic!("the firmware has no symbol with {parts:?}"));
    assert!(
        found.next().is_none(),
        "the firmware has several symbols with {parts:?}"
    );
    u32::try_from(symbol.address()).expect("32 bits")
}

/// Replaces words of the image, from `address` on as the CPU sees it.
pub fn patch(image: &mut [u8], address: u32, words: &[u32]) {
    let offset = (address - MAIN_RAM.base) as usize;
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    image[offset..][..bytes.len()].copy_from_slice(&bytes);
}

/// Starts a board with `image`; returns the board, and its output up to the first prompt.
pub fn started(image: &[u8]) -> (VirtualBoard, String) {
    let start = Start::Fast { firmware: image };
    let mut board = VirtualBoard::builder()
        .start(start)
        .build()
        .expect("a virtual board");
    let said = board.read_until(PROMPT, LIMIT).expect("a prompt");
    (board, said)
}

/// Sends a line and returns the output up to the next prompt, echo first.
pub fn command(board: &mut VirtualBoard, line: &str) -> String {
    board.uart_write(line.as_bytes());
    board.uart_write(b"\r");
    board
        .read_until(PROMPT, LIMIT)
        .unwrap_or_else(|error| panic!("`{line}`: {error}"))
}
