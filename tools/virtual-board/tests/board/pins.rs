//! Tests of the preloaded start, the pins, and back-door accesses to data in the CPU's caches.

use crate::program;
use litex_pac::{buttons, digits, leds, switches};
use virtual_board::VirtualBoard;
use virtual_board::{Simulation, Uart};

/// Address of the word in DDR3 that the program reads or writes. The DDR3 row of this word holds no other data of the program.
const WORD: u32 = 0x4012_3450;

/// Upper bound on the cycles of one round of the program's loop.
const ROUND: u64 = 500;

fn board() -> VirtualBoard {
    // SAFETY: only computes addresses of registers, without an access.
    let (buttons, switches, leds) = unsafe {
        (
            buttons::Buttons::steal(),
            switches::Switches::steal(),
            leds::Leds::steal(),
        )
    };
    let mut board = program::started(
        "pins",
        &[
            ("BUTTONS_IN", buttons.in_().address() as u32),
            ("SWITCHES_IN", switches.in_().address() as u32),
            ("LEDS_OUT", leds.out().address() as u32),
            ("WORD", WORD),
        ],
    );
    board.ddr_write(WORD, &[0]).expect("main RAM");
    board.run(2000);
    board
}

#[test]
fn the_program_reads_buttons_and_switches_and_sets_the_leds() {
    let mut board = board();
    assert_eq!(board.leds(), 0);
    for bit in 0..4 {
        board.set_buttons(1 << bit);
        board.run(ROUND);
        assert_eq!(board.leds(), 0x10 << bit);
    }
    board.set_buttons(0);
    for bit in 8..16 {
        board.set_switches(1 << bit);
        board.run(ROUND);
        assert_eq!(board.leds(), 1 << bit);
    }
}

#[test]
fn the_back_door_reaches_what_the_caches_hold() {
    let mut board = board();
    // The many writes occur at every point of the program's loop. In 16 of 32 iterations, the
    // program evicts the word from the cache and loads it again. If such a load returned data from
    // before a write, the LEDs would continue to show the old data, because the word then stays in
    // the cache for 16 iterations.
    for i in 0..600_u16 {
        let value = (i * 7) & 15;
        board.ddr_write(WORD, &[value as u8]).expect("main RAM");
        board.run(250 + u64::from(i % 41));
        assert_eq!(board.leds(), value, "data of write {i}");
    }
    board.ddr_write(WORD, &[0]).expect("main RAM");
    let patch = patch_address(&mut board);
    for value in [5, 9, 3] {
        let addi_t2_t2 = value << 20 | 7 << 15 | 7 << 7 | 0x13_u32;
        board
            .ddr_write(patch, &addi_t2_t2.to_le_bytes())
            .expect("main RAM");
        board.run(ROUND);
        assert_eq!(u32::from(board.leds()), value, "an instruction");
    }
}

#[test]
fn the_back_door_sees_what_the_program_has_stored() {
    // SAFETY: only computes the address of a register, without an access.
    let leds = unsafe { leds::Leds::steal() }.out().address() as u32;
    let mut board = program::started("stores", &[("WORD", WORD), ("LEDS_OUT", leds)]);
    board.run(2000);
    for i in 0..300 {
        board.run(100 + i % 37);
        let shown = board.leds();
        let mut word = [0; 2];
        board.ddr_read(WORD, &mut word).expect("main RAM");
        let ahead = u16::from_le_bytes(word).wrapping_sub(shown);
        assert!(
            ahead < 1000,
            "read {i}: the count in memory is {ahead:#06x} ahead of the LEDs' {shown:#06x}"
        );
    }
}

#[test]
fn the_digits_show_their_registers_from_left_to_right() {
    // SAFETY: only computes addresses of registers, without an access.
    let digits = unsafe { digits::Digits::steal() };
    let mut board = program::started(
        "digits",
        &[
            ("LEFT", digits.left().address() as u32),
            ("LEFT_SHOWN", 0x8066_4f5b),
            ("RIGHT", digits.right().address() as u32),
            ("RIGHT_SHOWN", 0x7f07_7d6d),
        ],
    );
    // Slightly more than one refresh cycle of the digits.
    board.run(70_000);
    assert_eq!(
        board.digits(),
        [0x5b, 0x4f, 0x66, 0x80, 0x6d, 0x7d, 0x07, 0x7f]
    );
}

/// Returns the address of the instruction at `patch` in `programs/pins.S`, which copies the word unchanged.
fn patch_address(board: &mut VirtualBoard) -> u32 {
    const START: u32 = 0x4000_0000;
    const ADDI_T2_T2_0: u32 = 0x0003_8393;
    let mut image = [0; 128];
    board.ddr_read(START, &mut image).expect("main RAM");
    let at = image
        .chunks_exact(4)
        .position(|word| word == ADDI_T2_T2_0.to_le_bytes())
        .expect("the instruction");
    START + 4 * at as u32
}

#[test]
fn two_boards_in_one_process_share_nothing() {
    let (mut one, mut other) = (board(), board());
    one.set_buttons(1);
    other.set_buttons(8);
    one.ddr_write(WORD, &[3]).expect("main RAM");
    one.run(ROUND);
    other.run(ROUND);
    assert_eq!((one.leds(), other.leds()), (0x13, 0x80));
}

#[test]
fn the_same_calls_give_the_same_board() {
    let run = || {
        let mut board = board();
        board.set_buttons(6);
        board.run(12_345);
        let mut memory = vec![0; 256];
        board.ddr_read(0x4000_0000, &mut memory).expect("main RAM");
        (board.cycles(), board.leds(), memory)
    };
    assert_eq!(run(), run());
}

#[test]
fn the_i2c_wires_idle_high_and_a_device_can_pull_them() {
    let mut board = board();
    assert_eq!(board.i2c_wires(), 0b11);
    board.i2c_drive(0b01);
    assert_eq!(board.i2c_wires(), 0b01);
    board.i2c_drive(0b10);
    assert_eq!(board.i2c_wires(), 0b10);
}

#[test]
fn what_is_missing_or_out_of_range_is_named() {
    let missing = VirtualBoard::builder()
        .library("nowhere/libglint_soc.so")
        .build();
    let message = missing.err().expect("no library").to_string();
    assert!(
        message.contains("nowhere/libglint_soc.so") && message.contains("cargo xtask gateware"),
        "{message}"
    );
    let message = board()
        .ddr_write(0x47ff_ffff, &[0; 2])
        .expect_err("beyond main RAM")
        .to_string();
    assert!(
        message.contains("2 bytes at 0x47ffffff") && message.contains("0x40000000..0x48000000"),
        "{message}"
    );
}
