//! Tests of a console on a board that an earlier program has left in an intermediate state.

use crate::common::{begin_upload, console, emulator, info, mesh};
use glint::board::{Board, EmulatedBoard, SimulatedBoard};
use glint::console::{Console, ConsoleError};
use glint::transfer;

/// The console of a board in an unknown state.
fn again(board: &mut SimulatedBoard<EmulatedBoard>) -> Console<'_, SimulatedBoard<EmulatedBoard>> {
    let mut console = Console::new(board).patience(2_000);
    console.synchronise().unwrap();
    console
}

#[test]
fn a_new_conversation_begins_at_once_and_believes_its_own_replies_only() {
    let quiet: &mut transfer::Progress = &mut |_, _| {};
    let (large, small) = (mesh("icosphere:4"), mesh("icosphere:1"));
    let mut board = emulator();
    console(&mut board).command("size 320 180").unwrap();

    // The reply to an earlier program's command comes late: its `ok` is not the reply to the upload.
    board.write(b"\0orbit 3600\r").unwrap();
    board.read(&mut Vec::new(), 1).unwrap();
    let start = board.now_ms();
    transfer::upload(&mut again(&mut board), &small, None, 1, quiet).unwrap();
    assert_eq!(info::<u32>(&mut again(&mut board), "triangles"), 20);
    let took = board.now_ms() - start;
    assert!(took < 500, "{took} ms");

    // After a killed upload, the board keeps the old model, and the next upload succeeds.
    begin_upload(&mut again(&mut board), &large);
    let start = board.now_ms();
    let mut console = again(&mut board);
    assert_eq!(info::<u32>(&mut console, "triangles"), 20);
    assert!(console.board().now_ms() - start < 100);
    transfer::upload(&mut console, &large, None, 2, quiet).unwrap();
    assert_eq!(info::<u32>(&mut console, "triangles"), 320);

    // In a second upload of the same data, the board already has the data, and skips the transfer.
    transfer::upload(&mut console, &large, None, 3, quiet).unwrap();

    // A key or a program cancels a transfer that a user has started on the console.
    for command in ["load 100 0", "frame"] {
        board.write(format!("{command}\r").as_bytes()).unwrap();
        let mut said = Vec::new();
        let mut wait_for = |board: &mut SimulatedBoard<EmulatedBoard>, wanted: &[u8]| {
            let start = board.now_ms();
            while !said.windows(wanted.len()).any(|part| part == wanted) {
                board.read(&mut said, 100).unwrap();
                assert!(board.now_ms() - start < 500, "{}", said.escape_ascii());
            }
        };
        wait_for(&mut board, b"ready");
        board.write(b"\x03").unwrap();
        wait_for(&mut board, b"cancelled by the other side");
        board.write(format!("{command}\r").as_bytes()).unwrap();
        let triangles = info::<u32>(&mut again(&mut board), "triangles");
        assert_eq!(triangles, 320);
    }

    // Noise from an earlier program: a hundred lines that the board refuses.
    board.write(&b"\xff?x\r".repeat(100)).unwrap();
    let triangles = info::<u32>(&mut again(&mut board), "triangles");
    assert_eq!(triangles, 320);

    // A command that starts a transfer is an error where a reply is expected, and leaves no transfer open.
    let mut console = again(&mut board);
    let refused = console.command("load 100 0").unwrap_err();
    assert!(matches!(refused, ConsoleError::Reply { .. }), "{refused}");
    assert_eq!(info::<u32>(&mut again(&mut board), "triangles"), 320);
}
