//! Power-up of the verilated board from its SPI flash. The test takes minutes on one core. Its file
//! name makes it one of the first tests to start, so that other tests run in parallel.

use crate::power_up::read_until;
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

/// The SoC reads the flash through its pins, and the BIOS trains and tests the memory. Without a host, the board shows its first
/// scene within a second, and a button selects the next scene.
#[test]
fn the_verilated_board_runs_alone_from_its_flash() {
    let scenes = ["cubes", "wireframe"].map(|name| glint_scene_file::built_in(name).unwrap());
    let pieces = image::pieces(&scenes).unwrap();
    let image = image::make(&[], &built_firmware(None).unwrap(), &pieces).unwrap();
    let mut board = board::verilated_bios().unwrap();
    board.inner().plug_flash(Flash::new(image));
    let output = read_until(&mut board, "glint> ");
    assert!(!output.contains("error"), "{output}");
    let first = picture(&mut board);
    let cycles = board.inner().cycles() + output.len() as u64 * BYTE;
    let limit = u64::from(board.inner().clock_hz());
    assert!(
        cycles < limit,
        "{cycles} cycles, expected less than {limit}"
    );

    let contact = limit / 25;
    for buttons in [1, 0] {
        board.inner().set_buttons(buttons);
        board.inner().run(contact);
    }
    assert!(picture(&mut board) != first, "the next scene");
    let mut console = Console::new(&mut board);
    let state = console.command("demo").unwrap();
    assert_eq!(state, ["demo on", "scene 2 of 2 wireframe"]);
    // An error of the command makes the test fail.
    console.command("selftest").unwrap();
}
