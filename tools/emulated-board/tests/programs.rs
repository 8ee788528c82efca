//! Small programs on the whole board, for what the firmware never does.

use emulated_board::EmulatedBoard;
use litex_pac::memories::{FLASH, MAIN_RAM};
use virtual_flash::Flash;

/// Registers of the programs.
const A0: u32 = 10;
const A1: u32 = 11;
const A2: u32 = 12;

/// Where programs leave their results.
const RESULTS: u32 = MAIN_RAM.base + 0x1000;
/// Bytes of a page of decoded instructions.
const PAGE: u32 = 4096;

/// Addresses that no memory and no register has, where the CPU caches what it loads, and where it does not.
const UNUSED: u32 = 0x2000_0000;

fn lui(rd: u32, value: u32) -> u32 {
    value & 0xffff_f000 | rd << 7 | 0x37
}

fn addi(rd: u32, rs1: u32, value: u32) -> u32 {
    value << 20 | rs1 << 15 | rd << 7 | 0x13
}

fn lw(rd: u32, offset: u32, rs1: u32) -> u32 {
    offset << 20 | rs1 << 15 | 2 << 12 | rd << 7 | 0x03
}

fn sw(rs2: u32, offset: u32, rs1: u32) -> u32 {
    offset >> 5 << 25 | rs2 << 20 | rs1 << 15 | 2 << 12 | (offset & 31) << 7 | 0x23
}

/// `jalr` without a result.
fn jump(rs1: u32) -> u32 {
    rs1 << 15 | 0x67
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

/// The result at a place of the results.
fn result(board: &EmulatedBoard, place: u32) -> u32 {
    let mut word = [0; 4];
    let address = RESULTS + 4 * place;
    board.read_memory(address, &mut word).expect("main memory");
    u32::from_le_bytes(word)
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

#[test]
fn each_page_of_the_flash_runs_its_own_code() {
    let mut board = started(&[lui(A2, RESULTS), lui(A0, FLASH.base), jump(A0)]);
    for value in [1, 2] {
        // Back to main memory in each round, as the first page goes on to the second.
        let mut words = [lui(A0, FLASH.base + PAGE), jump(A0)].to_vec();
        words.resize(PAGE as usize / 4, 0);
        words.extend([
            addi(A1, 0, value),
            sw(A1, 0, A2),
            lui(A0, FLASH.base),
            jump(A0),
        ]);
        board.plug_flash(Flash::new(bytes(&words)));
        board.run(100);
        assert_eq!(result(&board, 0), value);
    }
}
