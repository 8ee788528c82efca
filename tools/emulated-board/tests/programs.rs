//! Small programs on the whole board, for what the firmware never does.

use emulated_board::EmulatedBoard;

/// Registers of the programs.
const A0: u32 = 10;
const A1: u32 = 11;

/// Addresses that no memory and no register has, where the CPU caches what it loads, and where it does not.
const UNUSED: u32 = 0x2000_0000;

fn lui(rd: u32, value: u32) -> u32 {
    value & 0xffff_f000 | rd << 7 | 0x37
}

fn lw(rd: u32, offset: u32, rs1: u32) -> u32 {
    offset << 20 | rs1 << 15 | 2 << 12 | rd << 7 | 0x03
}

/// `jal` back by one instruction, or to itself.
const BACK: u32 = 0xffdf_f06f;

fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// A board that runs `words` from the start of main memory.
fn started(words: &[u32]) -> EmulatedBoard {
    EmulatedBoard::fast(&bytes(words)).expect("a program that fits")
}

#[test]
fn frames_are_captured_while_accesses_wait_for_the_bus() {
    let mut board = started(&[lui(A0, UNUSED), lw(A1, 0, A0), BACK]);
    for _ in 0..10 {
        let before = board.blankings();
        board.capture();
        assert!(board.blankings() > before);
    }
}
