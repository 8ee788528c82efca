//! Power-up of the verilated board from its SPI flash. The test takes most of a minute on one core. Its file
//! name makes it one of the first tests to start, so that other tests run in parallel.

use crate::common::running_board;
use crate::power_up::read_until;
use crate::serial_boot::printer;
use glint::board::Uart;
use glint::board::{self, SimulatedBoard, Simulation, built_firmware};
use glint::console::Console;
use glint::image;
use virtual_board::virtual_flash::Flash;

/// Number of cycles of a byte at 115,200 baud. On the virtual board a byte takes only one cycle.
const BYTE: u64 = 7053;

/// Returns the next picture on the monitor that is not black, of 640×360 pixels.
fn picture(board: &mut SimulatedBoard) -> Vec<u16> {
    loop {
        let picture = board.inner().monitor_frame(2).unwrap();
        if picture.iter().any(|colour| *colour != 0) {
            return picture;
        }
    }
}

/// A flash with two scenes and `program`.
fn flash(program: &[u8]) -> Flash {
    let scenes = ["cubes", "wireframe"].map(|name| glint_scene_file::built_in(name).unwrap());
    let pieces = image::pieces(&scenes).unwrap();
    Flash::new(image::make(&[], program, &pieces).unwrap())
}

/// The SoC reads the flash through its pins, and the BIOS trains and tests the memory. Without a host, the board shows its first
/// scene within a second, and a button selects the next scene.
///
/// The simulation of the whole start would take a minute, most of it for checksum and copy of the firmware. The BIOS therefore
/// starts a short program, which takes the same time per byte.
#[test]
fn the_verilated_board_runs_alone_from_its_flash() {
    let mut program = printer("Program runs");
    program.resize(32 << 10, 0);
    let mut board = board::verilated_bios().unwrap();
    board.inner().plug_flash(flash(&program));
    let mut output = read_until(&mut board, "Booting from flash");
    let before = board.inner().cycles();
    output += &read_until(&mut board, "Program runs");
    let loading = board.inner().cycles() - before;

    let firmware = built_firmware(None).unwrap();
    let mut board = running_board();
    board.inner().plug_flash(flash(&firmware));
    output += &read_until(&mut board, "glint> ");
    assert!(!output.contains("error"), "{output}");
    let own = board.inner().cycles();
    let first = picture(&mut board);

    let programs = firmware.len().div_ceil(program.len()) as u64;
    let cycles = before + programs * loading + own + output.len() as u64 * BYTE;
    let limit = u64::from(board.inner().clock_hz());
    assert!(
        cycles < limit,
        "{cycles} cycles, expected less than {limit}"
    );

    // The button is released when the next scene is on the monitor.
    board.inner().set_buttons(1);
    let pressed = board.inner().cycles();
    while picture(&mut board) == first {
        let cycles = board.inner().cycles() - pressed;
        assert!(cycles < limit / 8, "no next scene in {cycles} cycles");
    }
    board.inner().set_buttons(0);
    let mut console = Console::new(&mut board);
    let state = console.command("demo").unwrap();
    assert_eq!(state, ["demo on", "scene 2 of 2 wireframe"]);
    // An error of the command makes the test fail.
    console.command("selftest").unwrap();
}
