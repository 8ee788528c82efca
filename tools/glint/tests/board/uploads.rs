//! Uploads of meshes over a faulty line, and uploads of invalid meshes.

use crate::common::{address, console, emulator, info, mesh, read, running_board};
use glint::board::{Board, BoardError};
use glint::console::{Console, ConsoleError};
use glint::fuzz::Random;
use glint::transfer::{self, TransferError};
use glint_core::wire::{Failure, Manifest, Reason};

/// A faulty line: in both directions it drops, flips or repeats one byte in a hundred.
struct BadLine<'b> {
    board: &'b mut dyn Board,
    random: Random,
    hit: u32,
}

impl BadLine<'_> {
    fn pass(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut passed = Vec::with_capacity(bytes.len());
        for &byte in bytes {
            let draw = self.random.below(300);
            self.hit += u32::from(draw < 3);
            match draw {
                0 => {}
                1 => passed.push(byte ^ 1 << self.random.below(8)),
                2 => passed.extend([byte, byte]),
                _ => passed.push(byte),
            }
        }
        passed
    }
}

impl Board for BadLine<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        let bytes = self.pass(bytes);
        self.board.write(&bytes)
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        let mut read = Vec::new();
        self.board.read(&mut read, wait_ms)?;
        bytes.extend(self.pass(&read));
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.board.now_ms()
    }
}

#[test]
fn an_upload_over_a_bad_line_arrives_bit_for_bit() {
    let mesh = mesh("icosphere:4");
    let Manifest { length, crc32 } = Manifest::of(&mesh);
    let mut board = running_board();
    let mut console = console(&mut board);
    let staging = address(&mut console, "staging");
    let command = format!("load {length} {crc32:08x}");
    console
        .command_with_transfer(&command, &mut |_| {})
        .unwrap();
    {
        let (board, pending) = console.line();
        let mut line = BadLine {
            board,
            random: Random::new(1, 0),
            hit: 0,
        };
        transfer::send(&mut line, pending, &mesh, 1, &mut |_, _| {}).unwrap();
        assert!(line.hit > 100, "{} bytes were hit", line.hit);
    }
    console.reply(&command).unwrap();
    assert_eq!(info::<String>(&mut console, "scene"), "model");
    assert!(read(&mut console, staging, mesh.len()) == mesh);
}

/// Draws the scene, and reads the colours of its frame of 320×180 pixels from memory.
fn frame(console: &mut Console<impl Board>) -> Vec<u8> {
    console.command("render").unwrap();
    let address = address(console, "frame");
    read(console, address, 2 * 320 * 180)
}

#[test]
fn a_bad_upload_leaves_the_old_model() {
    let (good, other) = (mesh("cube"), mesh("icosphere:1"));
    let mut board = emulator();
    let mut console = console(&mut board);
    let quiet: &mut transfer::Progress = &mut |_, _| {};
    transfer::upload(&mut console, &good, None, 1, quiet).unwrap();
    let shown = frame(&mut console);

    // The announced CRC-32 does not match the mesh that is sent.
    let Manifest { length, crc32 } = Manifest::of(&good);
    let command = format!("load {length} {:08x}", !crc32);
    console
        .command_with_transfer(&command, &mut |_| {})
        .unwrap();
    let (line, pending) = console.line();
    let refused = transfer::send(line, pending, &other, 2, quiet).unwrap_err();
    assert!(
        matches!(
            refused,
            TransferError::Failed(Failure::AbortedByPeer(Reason::Unannounced))
        ),
        "{refused}"
    );
    assert!(matches!(
        console.reply(&command),
        Err(ConsoleError::Refused { .. })
    ));

    // Bytes that arrive undamaged but are not a mesh: a reserved byte of a chunk's header is not 0, or an index exceeds the
    // number of vertices.
    let last_triangle = other.len() - 16;
    for (number, at) in [(3, 40), (4, last_triangle + 1)] {
        let mut damaged = other.clone();
        damaged[at] ^= 0x80;
        let refused = transfer::upload(&mut console, &damaged, None, number, quiet);
        let refused = refused.unwrap_err().to_string();
        assert!(refused.contains("not a mesh"), "byte {at}: {refused}");
    }
    assert_eq!(info::<u32>(&mut console, "triangles"), 12);
    assert!(frame(&mut console) == shown);

    // A valid upload still succeeds.
    transfer::upload(&mut console, &other, None, 5, quiet).unwrap();
    assert_eq!(info::<u32>(&mut console, "triangles"), 20);
    assert!(frame(&mut console) != shown);
}
