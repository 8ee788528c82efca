//! Power-up of the verilated board from its SPI flash. The test takes minutes on one core: it has a file whose name makes it start first,
//! so that it runs beside the others.

use crate::power_up::read_until;
use glint::board::{self, SimulatedBoard, Simulation, built_firmware};
use glint::console::Console;
use glint::image;
use virtual_board::virtual_flash::Flash;

/// Number of cycles in which a serial line of 115,200 baud sends a byte, of which the virtual board's needs one.
const BYTE: u64 = 7053;

/// The next picture on the monitor, 640×360 pixels, that is not black.
fn picture(board: &mut SimulatedBoard) -> Vec<u16> {
    loop {
        let picture = board.inner().monitor_frame(2).unwrap();
        if picture.iter().any(|colour| *colour != 0) {
            return picture;
        }
    }
}

/// The SoC reads the flash by its pins here, and the BIOS trains and tests the memory. Without a host the board shows its first scene
/// within a second, and a button chooses the next one.
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
    // An error of the command fails the test.
    console.command("selftest").unwrap();
}
