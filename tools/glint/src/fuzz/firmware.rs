//! The fuzz target of the whole firmware on the emulated board: arbitrary bytes on its serial line.

use super::transfer::{SESSION, exchange, upload_data};
use crate::board::{self, Board, EmulatedBoard, SimulatedBoard, built_firmware};
use crate::console::Console;
use glint_core::console::PROMPT;
use glint_core::wire::crc32;
use std::sync::LazyLock;

/// Silence after which the board has processed an input, in ms of the board's time.
const SILENCE_MS: u64 = 20;
/// Time after which the target stops waiting for silence, in ms of the board's time. A command of
/// the input may print endlessly.
const LIMIT_MS: u64 = 300;

/// Lengths in bytes of the meshes whose uploads are seeds.
const LENGTHS: [usize; 2] = [16, 1500];

static FIRMWARE: LazyLock<Vec<u8>> =
    LazyLock::new(|| built_firmware(None).expect("`cargo xtask firmware` has built the firmware"));

/// The bytes that the host sends in complete uploads. The data are not a mesh, so the firmware
/// refuses them after the transfer.
pub fn seeds() -> Vec<Vec<u8>> {
    let uploads = LENGTHS.map(|length| {
        let data = upload_data(length);
        let command = format!("\0load {length} {:08x}\r", crc32(&data));
        let [sent, _] = exchange(&data, SESSION);
        [command.into_bytes(), sent].concat()
    });
    uploads.into()
}

/// Sends the input to a board that has just started. The firmware must not halt, and must answer a
/// later command. Returns whether the firmware has executed a command of the input.
pub fn run(input: &[u8]) -> bool {
    let mut board = start();
    let mut said = Vec::new();
    let sent = board.write(input);
    let taken = sent.and_then(|()| {
        let end = board.now_ms() + LIMIT_MS;
        let mut heard = usize::MAX;
        while heard != said.len() && board.now_ms() < end {
            heard = said.len();
            board.read(&mut said, SILENCE_MS)?;
        }
        Ok(())
    });
    assert!(
        taken.is_ok(),
        "an emulated board has no broken line: {taken:?}"
    );
    let text = String::from_utf8_lossy(&said);
    assert!(!text.contains("halted, press Enter"), "{text}");
    let mut console = Console::new(&mut board);
    let answer = console.synchronise().and_then(|()| console.info("staging"));
    assert!(answer.is_ok(), "after {text:?}: {answer:?}");
    text.contains("\r\nok\r\n")
}

/// A board whose firmware has just started and waits for a command.
fn start() -> SimulatedBoard<EmulatedBoard> {
    let mut board = board::emulated(&FIRMWARE).expect("the firmware fits");
    let mut said = Vec::new();
    while !said.ends_with(PROMPT.as_bytes()) {
        board
            .read(&mut said, 1000)
            .expect("an emulated board has no broken line");
    }
    board
}
