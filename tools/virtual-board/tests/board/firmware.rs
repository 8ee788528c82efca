//! Helpers for tests of the firmware: the firmware's image, and virtual or emulated boards that run it.

use std::path::{Path, PathBuf};
use virtual_board::Uart;

use emulated_board::EmulatedBoard;
use litex_pac::memories::MAIN_RAM;
use object::{Object, ObjectSymbol};
use virtual_board::{Start, VirtualBoard};

/// Prompt of the firmware's console.
pub const PROMPT: &str = "glint> ";

/// Time-out of a command in cycles. This is longer than the time-out of a bus access, a million cycles.
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

/// Replaces words of the image, from the CPU's address `address` on.
pub fn patch(image: &mut [u8], address: u32, words: &[u32]) {
    let offset = (address - MAIN_RAM.base) as usize;
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    image[offset..][..bytes.len()].copy_from_slice(&bytes);
}

/// A board with a console.
pub trait Console: Uart + Sized {
    /// Runs until the board has sent `expected`; returns the output up to the end of `expected`.
    ///
    /// # Panics
    /// If `expected` has not arrived within [`LIMIT`]; the message contains `what`, the test's action.
    fn expect(&mut self, expected: &str, what: &str) -> String {
        self.read_until(expected, LIMIT)
            .unwrap_or_else(|error| panic!("`{what}`: {error}"))
    }
}

impl<B: Uart> Console for B {}

/// Creates a virtual board that starts with `image` in main RAM.
pub fn preloaded(image: &[u8]) -> VirtualBoard {
    let start = Start::Fast { firmware: image };
    let board = VirtualBoard::builder().start(start).build();
    board.expect("a virtual board")
}

/// Starts an emulated board with `image`; returns the board, and its output up to the first prompt.
pub fn emulated(image: &[u8]) -> (EmulatedBoard, String) {
    let mut board = EmulatedBoard::fast(image).expect("an image that fits");
    let said = board.expect(PROMPT, "start");
    (board, said)
}

/// Starts a virtual board with `image`; returns the board, and its output up to the first prompt.
pub fn started(image: &[u8]) -> (VirtualBoard, String) {
    let mut board = preloaded(image);
    let said = board.expect(PROMPT, "start");
    (board, said)
}

/// Sends a line and returns the output up to the next prompt; the output begins with the echo.
/// Skips a note on the last frame, which may come before the echo.
pub fn command(board: &mut impl Console, line: &str) -> String {
    board.uart_write(line.as_bytes());
    board.uart_write(b"\r");
    loop {
        let answer = board.expect(PROMPT, line);
        if !answer
            .trim_start_matches(['\r', '\x1b', '[', 'K'])
            .starts_with("note: ")
        {
            return answer;
        }
    }
}

/// Finds the line of `answer` that starts with `key`, and returns the rest of that line.
pub fn value<'a>(answer: &'a str, key: &str) -> &'a str {
    let mut lines = answer.lines();
    lines
        .find_map(|line| line.strip_prefix(key)?.strip_prefix(' '))
        .unwrap_or_else(|| panic!("no {key} in {answer}"))
}
