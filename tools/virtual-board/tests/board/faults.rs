//! Tests of the firmware on the gateware of another build, and of its reports of traps.

use crate::firmware::{LIMIT, PROMPT, address, command, emulated, image, patch, started};
use emulated_board::EmulatedBoard;
use litex_pac::BUILD_ID;
use litex_pac::memories::MAIN_RAM;
use virtual_board::{Simulation, Uart};

#[test]
fn gateware_of_another_build_is_reported_and_the_console_works() {
    let mut image = image();
    // Changes the firmware's build id, as if the firmware had been built for another gateware.
    patch(&mut image, address(&["GLINT_BUILD_ID"]), &[!BUILD_ID]);
    let (mut board, said) = emulated(&image);
    let (found, expected) = (
        format!("gateware {BUILD_ID:#010x}"),
        format!("built for gateware {:#010x}", !BUILD_ID),
    );
    assert!(
        said.contains(&found) && said.contains("MISMATCH") && said.contains(&expected),
        "{said}"
    );
    let info = command(&mut board, "info");
    assert!(
        info.contains(&format!(
            "firmware_id {:#010x}\r\ngateware_id {BUILD_ID:#010x}",
            !BUILD_ID
        )),
        "{info}"
    );
    // The firmware now only uses the registers of the console: `render` works on the CPU, and commands for devices
    // fail.
    assert!(command(&mut board, "render").contains("triangles_drawn 6\r\n"));
    assert!(command(&mut board, "leds 1").contains("error: "));
    assert_eq!(board.leds(), 0);
    assert!(command(&mut board, "selftest").contains("selftest identity FAILED"));
}

#[test]
fn firmware_for_more_memory_than_the_board_has_is_refused() {
    let mut image = image();
    // Changes the end of the firmware's memory map from 128 MB to 256 MB.
    let end = MAIN_RAM.base + 2 * MAIN_RAM.size;
    patch(&mut image, address(&["GLINT_WINDOWS_END"]), &[end]);
    let mut board = EmulatedBoard::fast(&image).expect("an image that fits");
    let said = board
        .read_until("press Enter to restart\r\n", LIMIT)
        .expect("a message that refuses to start");
    let refusal = "\r\ncannot start: main memory: this firmware expects at least 256 MB, the board has 128 MB; build the firmware of \
                   this board with `cargo xtask firmware --board BOARD`, or a program with GLINT_MAIN_RAM_MB=32\r\n";
    assert!(said.contains(refusal), "{said}");
}

/// For each trap: its cause, machine code that triggers it, and the trap value. (An access to an address without a device
/// is not a trap: LiteX's bus answers after a time-out.)
const TRAPS: [(&str, &[u32], u32); 2] = [
    ("illegal instruction (mcause 2)", &[0x0000_0000], 0),
    // li a0, 1; lw a0, 0(a0)
    (
        "load address misaligned (mcause 4)",
        &[0x0010_0513, 0x0005_2503],
        1,
    ),
];

#[test]
fn a_trap_reports_its_cause_and_address_and_enter_restarts() {
    let reboot = address(&["commands", "reboot"]);
    let mut image = image();
    for (cause, code, value) in TRAPS {
        patch(&mut image, reboot, code);
        let (mut board, _) = emulated(&image);
        board.uart_write(b"reboot\r");
        let said = board
            .read_until("press Enter to restart\r\n", LIMIT)
            .expect("a report of the trap");
        let place = reboot + 4 * (code.len() as u32 - 1);
        let trap = format!("trap: {cause} at {place:#010x}, mtval {value:#010x}");
        assert!(said.contains(&trap), "expected {trap:?} in {said}");
        assert!(
            said.contains(&format!("build id {BUILD_ID:#010x}")),
            "{said}"
        );
        board.uart_write(b"x\r");
        board
            .read_until("Glint ", LIMIT)
            .expect("a banner after the restart");
    }
}

#[test]
fn reboot_starts_again() {
    let (mut board, _) = started(&image());
    board.uart_write(b"reboot\r");
    board.read_until("ok\r\n", LIMIT).expect("an answer");
    board.read_until("Glint ", LIMIT).expect("a banner");
    board.read_until(PROMPT, LIMIT).expect("a prompt");
}
