//! Tests small programs on the whole board, with operations that the firmware does not use.

use emulated_board::EmulatedBoard;
use emulated_board::{Simulation, Uart};
use litex_pac::memories::{FLASH, MAIN_RAM};
use litex_pac::register::Value;
use litex_pac::{ctrl, leds};
use virtual_flash::Flash;

/// Register numbers.
const A0: u32 = 10;
const A1: u32 = 11;
const A2: u32 = 12;

/// Address where programs store their results.
const RESULTS: u32 = MAIN_RAM.base + 0x1000;
/// Size of a page of decoded instructions, in bytes.
const PAGE: u32 = 4096;

/// Unmapped address in the cached region.
const UNUSED: u32 = 0x2000_0000;
/// Unmapped address in the uncached region.
const UNUSED_IO: u32 = 0x9000_0000;
/// Number of clock cycles until the bus answers an access to an unmapped address.
const TIMEOUT: u32 = 1_000_000;

const MTVEC: u32 = 0x305;
const MCYCLE: u32 = 0xb00;
const MINSTRET: u32 = 0xb02;
const ECALL: u32 = 0x0000_0073;

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

fn csrw(csr: u32, rs1: u32) -> u32 {
    csr << 20 | rs1 << 15 | 1 << 12 | 0x73
}

fn csrr(rd: u32, csr: u32) -> u32 {
    csr << 20 | 2 << 12 | rd << 7 | 0x73
}

/// `jal` to the previous instruction.
const BACK: u32 = 0xffdf_f06f;
/// `jal` to itself.
const LOOP: u32 = 0x0000_006f;

fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// A board that runs `words` from the start of main memory.
fn started(words: &[u32]) -> EmulatedBoard {
    EmulatedBoard::fast(&bytes(words)).expect("a program that fits")
}

/// The result with the index `place`.
fn result(board: &mut EmulatedBoard, place: u32) -> u32 {
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
        // An endless loop from the first page to the second page and back, so that the new code runs after the flash is replaced.
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
        assert_eq!(result(&mut board, 0), value);
    }
}

/// Stores the count of bus errors and the cycle as the results `place` and `place + 1`.
fn store_errors(place: u32) -> [u32; 5] {
    [
        lui(A0, ctrl::Ctrl::BASE as u32),
        lw(A1, ctrl::offset::BUS_ERRORS, A0),
        sw(A1, 4 * place, A2),
        csrr(A1, MCYCLE),
        sw(A1, 4 * place + 4, A2),
    ]
}

#[test]
fn an_access_that_fills_a_line_of_a_cache_is_eight_on_the_bus() {
    let accesses = [
        (lui(A0, UNUSED), lw(A1, 4, A0), 8),
        (lui(A0, UNUSED), sw(A1, 4, A0), 1),
        (lui(A0, UNUSED_IO), lw(A1, 4, A0), 1),
        (lui(A0, UNUSED_IO), sw(A1, 4, A0), 1),
        // The bus returns 0xffff_ffff, which is not an instruction; in this program the trap handler follows the jump.
        (lui(A0, UNUSED), jump(A0), 8),
        (lui(A0, UNUSED_IO), jump(A0), 8),
    ];
    let mut program = vec![lui(A2, RESULTS)];
    program.extend(store_errors(0));
    for ((address, access, _), place) in accesses.into_iter().zip(1..) {
        let handler = MAIN_RAM.base + 4 * (program.len() as u32 + 5);
        program.extend([lui(A0, handler), addi(A0, A0, handler % PAGE)]);
        program.extend([csrw(MTVEC, A0), address, access]);
        program.extend(store_errors(2 * place));
    }
    program.push(LOOP);
    let mut board = started(&program);
    board.run(30_000_000);
    for ((_, access, count), place) in accesses.into_iter().zip(1..) {
        let mut difference = |word: u32| {
            result(&mut board, 2 * place + word) - result(&mut board, 2 * place - 2 + word)
        };
        assert_eq!(difference(0), count, "{access:#010x}");
        assert_eq!(difference(1) / TIMEOUT, count, "{access:#010x}");
    }
}

#[test]
fn a_held_cpu_halts_and_the_devices_go_on() {
    let hold = ctrl::Reset::default().with_cpu_rst(true);
    let mut board = started(&[
        lui(A0, leds::Leds::BASE as u32),
        addi(A1, 0, 5),
        sw(A1, leds::offset::OUT, A0),
        lui(A0, ctrl::Ctrl::BASE as u32),
        addi(A1, 0, hold.bits()),
        sw(A1, ctrl::offset::RESET, A0),
        lui(A2, RESULTS),
        sw(A1, 0, A2),
        LOOP,
    ]);
    board.run(100);
    let (instructions, blankings) = (board.instructions(), board.blankings());
    board.run(5_000_000);
    assert_eq!((board.instructions(), board.leds()), (instructions, 5));
    assert!(board.blankings() > blankings + 1 && board.cycles() >= 5_000_100);
    assert_eq!(result(&mut board, 0), 0);
}

#[test]
fn an_instruction_that_traps_does_not_count() {
    let handler = MAIN_RAM.base + 4 * 6;
    let mut board = started(&[
        lui(A2, RESULTS),
        lui(A0, handler),
        addi(A0, A0, handler % PAGE),
        csrw(MTVEC, A0),
        csrr(A0, MINSTRET),
        ECALL,
        csrr(A1, MINSTRET),
        sw(A0, 0, A2),
        sw(A1, 4, A2),
        LOOP,
    ]);
    board.run(100);
    assert_eq!(result(&mut board, 1) - result(&mut board, 0), 1);
}
