//! Tests of the full start: LiteX's BIOS on the verilated SoC, and back-door accesses to DDR3 compared with accesses of the CPU.

use virtual_board::Uart;
use virtual_board::{Start, VirtualBoard};

/// The BIOS's prompt, with its colours.
const PROMPT: &str = "\x1b[92;1mlitex\x1b[0m> ";

/// Time-out of the boot in cycles; it includes a quarter of a second in which the BIOS waits for a serial boot.
const BOOT_LIMIT: u64 = 60_000_000;

/// Time-out of a command in cycles.
const COMMAND_LIMIT: u64 = 2_000_000;

/// Starts a board; returns it at the BIOS's prompt, and its output so far.
fn booted() -> (VirtualBoard, String) {
    let mut board = VirtualBoard::builder()
        .start(Start::Full)
        .build()
        .expect("a virtual board");
    let start = board
        .read_until("Press Q or ESC to abort boot completely.", BOOT_LIMIT)
        .expect("the BIOS offers a serial boot");
    // Q skips the serial boot, which saves 20 million cycles.
    board.uart_write(b"Q");
    let rest = board.read_until(PROMPT, BOOT_LIMIT).expect("a prompt");
    (board, start + &rest)
}

/// Sends a command to the BIOS, and returns the output up to the next prompt.
fn command(board: &mut VirtualBoard, line: &str) -> String {
    board.uart_write(format!("{line}\n").as_bytes());
    board
        .read_until(PROMPT, COMMAND_LIMIT)
        .expect("an answer and a prompt")
}

/// Reads 16 bytes at `address` with the BIOS's command `mem_read`.
fn mem_read(board: &mut VirtualBoard, address: u32) -> Vec<u8> {
    let answer = command(board, &format!("mem_read {address:#010x} 16"));
    let start = format!("{address:#010x}  ");
    let dump = answer
        .split_once(&start)
        .unwrap_or_else(|| panic!("no dump in {answer:?}"))
        .1;
    dump.split_whitespace()
        .take(16)
        .map(|byte| u8::from_str_radix(byte, 16).expect("a hexadecimal byte"))
        .collect()
}

#[test]
fn the_bios_boots_and_the_back_door_is_coherent_with_the_cpu() {
    let (mut board, said) = booted();
    assert!(said.contains("Memtest OK"), "{said}");
    eprintln!(
        "{} cycles to the prompt, {:.0} cycles/s",
        board.cycles(),
        board.cycles_per_second()
    );
    both_see_the_same_memory(&mut board);
    ranges_cross_banks_and_rows_in_order(&mut board);
    a_cached_line_is_read_anew(&mut board);
}

fn both_see_the_same_memory(board: &mut VirtualBoard) {
    // One address in each of the eight banks of the DDR3, and two addresses in other rows, the second in the last row.
    let banks = (0..8).map(|bank| 0x4010_0000 + bank * 0x800 + 0x7f0);
    for (number, address) in banks.chain([0x4200_0000, 0x47ff_fff0]).enumerate() {
        let written: Vec<u8> = (0..16).map(|i| (number * 16 + i) as u8 ^ 0xa5).collect();
        board.ddr_write(address, &written).expect("main RAM");
        assert_eq!(
            mem_read(board, address),
            written,
            "{address:#x} through the back door, read by the CPU"
        );

        command(board, &format!("mem_write {:#x} 0x12345678", address + 4));
        let mut read = [0; 16];
        board.ddr_read(address, &mut read).expect("main RAM");
        let mut expected = written;
        expected[4..8].copy_from_slice(&0x1234_5678_u32.to_le_bytes());
        assert_eq!(
            read[..],
            expected,
            "{address:#x} written by the CPU, read through the back door"
        );
    }
}

fn ranges_cross_banks_and_rows_in_order(board: &mut VirtualBoard) {
    // A range with odd length that starts just before a new row of the DDR3, and crosses all banks into the row after it.
    let start = 0x4100_3fff - 5;
    let written: Vec<u8> = (0..20_001_u32)
        .map(|i| (i.wrapping_mul(0x9e37_79b1) >> 24) as u8)
        .collect();
    board.ddr_write(start, &written).expect("main RAM");
    let mut read = vec![0; written.len()];
    board.ddr_read(start, &mut read).expect("main RAM");
    assert_eq!(read, written);
    for address in [0x4100_4000, 0x4100_47f0, 0x4100_4800, 0x4100_8000] {
        let at = (address - start) as usize;
        assert_eq!(
            mem_read(board, address),
            written[at..at + 16],
            "{address:#x}"
        );
    }
}

fn a_cached_line_is_read_anew(board: &mut VirtualBoard) {
    let address = 0x4020_0040;
    board.ddr_write(address, &[0x11; 16]).expect("main RAM");
    // The first read fills the data cache line that the second read hits.
    assert_eq!(mem_read(board, address), [0x11; 16]);
    assert_eq!(mem_read(board, address), [0x11; 16]);
    board.ddr_write(address, &[0x22; 16]).expect("main RAM");
    assert_eq!(mem_read(board, address), [0x22; 16], "stale data");
}
