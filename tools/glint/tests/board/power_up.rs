//! Power-up of an emulated board with an image in its SPI flash, through the BIOS.

use glint::board::{self, Board, EmulatedBoard, SimulatedBoard, Simulation, built_firmware};
use glint::console::Console;
use glint::flash;
use glint_core::flash::{FIRMWARE, encode};
use virtual_board::virtual_flash::Flash;

/// The BIOS's prompt without colours.
const BIOS_PROMPT: &str = "litex";

/// Address of main memory, where the program begins.
const MAIN_RAM: u32 = 0x4000_0000;

/// Time-out of the board's start, in milliseconds of the board's time.
const START_MS: u64 = 3000;

/// An image with the built firmware, without a bitstream or scenes.
fn image() -> Vec<u8> {
    encode(&[], &built_firmware(None).unwrap(), &[]).unwrap()
}

/// A board before power-up, with this image in its flash.
fn board(image: Vec<u8>) -> SimulatedBoard<EmulatedBoard> {
    let mut board = board::emulated_bios().unwrap();
    board.inner().plug_flash(Flash::new(image));
    board
}

/// Runs the board until it has sent `expected`, and returns its output.
pub fn read_until<S: Simulation>(board: &mut SimulatedBoard<S>, expected: &str) -> String {
    let mut output = Vec::new();
    while !String::from_utf8_lossy(&output).contains(expected) {
        assert!(
            board.now_ms() < START_MS,
            "no {expected:?} in {:?}",
            String::from_utf8_lossy(&output)
        );
        board.read(&mut output, 1).unwrap();
    }
    String::from_utf8_lossy(&output).into_owned()
}

/// Checks that the firmware runs.
fn assert_answers(board: &mut SimulatedBoard<EmulatedBoard>) {
    let mut console = Console::new(board);
    console.greet().unwrap();
    let info = console.command("info").unwrap();
    assert!(info.iter().any(|line| line == "triangles 12"), "{info:?}");
}

/// Checks that the BIOS prints `complaint` about an image and offers its prompt, and that a host can then load the firmware.
fn assert_refused(image: Vec<u8>, complaint: &str) {
    let mut board = board(image);
    let output = read_until(&mut board, BIOS_PROMPT);
    let complaint = output.find(complaint).expect("a complaint");
    let gave_up = output
        .find("No boot medium found")
        .expect("the end of the boot");
    assert!(complaint < gave_up, "{output}");
    load(&mut board);
}

/// Loads the firmware over the serial line.
fn load(board: &mut SimulatedBoard<EmulatedBoard>) {
    let program = built_firmware(None).unwrap();
    flash::flash(board, &program, MAIN_RAM, 60_000, &mut |_, _| {}).unwrap();
    assert_answers(board);
}

#[test]
fn a_board_starts_alone_from_its_flash() {
    let mut board = board(image());
    let output = read_until(&mut board, "Liftoff");
    assert!(output.contains("Timeout"), "{output}");
    assert_answers(&mut board);
    // A host can replace the program afterwards.
    load(&mut board);
}

#[test]
fn a_host_that_answers_the_bios_goes_first() {
    load(&mut board(image()));
}

#[test]
fn firmware_with_a_damaged_byte_is_refused() {
    let mut image = image();
    image[FIRMWARE + 100_000] ^= 1;
    assert_refused(image, "CRC failed");
}

#[test]
fn firmware_that_ends_early_is_refused() {
    let mut image = image();
    image.truncate(FIRMWARE + 100_000);
    assert_refused(image, "CRC failed");
}

#[test]
fn an_erased_flash_is_refused() {
    assert_refused(Vec::new(), "Invalid image length 0xffffffff");
}

#[test]
fn a_length_beyond_the_flash_is_refused() {
    let mut image = image();
    image[FIRMWARE..FIRMWARE + 4].copy_from_slice(&(1_u32 << 24 | 1).to_le_bytes());
    assert_refused(image, "Invalid image length 0x01000001");
}
