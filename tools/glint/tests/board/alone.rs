//! Tests of a board without a host: the demo, buttons, switches, LEDs and digits.

use crate::common::assert_has;
use glint::board::{EmulatedBoard, built_firmware};
use glint::board::{Simulation, Uart};
use glint::imu::sensor;
use glint_core::console::PROMPT;
use glint_core::demo::TURN_MS;
use glint_core::digits::Display;

/// Time-out of a command in clock cycles.
pub const LIMIT: u64 = 60_000_000;

/// Number of cycles per millisecond.
pub const MS: u64 = 81_250;
/// Time in cycles after which digits and LEDs show a new state, because they change every half
/// second.
pub const PANEL: u64 = 600 * MS;

/// The scenes of the built-in list, in order.
const SCENES: [&str; 6] = [
    "holoforge",
    "wireframe",
    "simplegpu",
    "poor-mans-vr",
    "objects",
    "cubes",
];

/// A started board without a list of scenes in its flash.
fn started() -> EmulatedBoard {
    let mut board = EmulatedBoard::fast(&built_firmware(None).unwrap()).unwrap();
    board.read_until(PROMPT, LIMIT).unwrap();
    board
}

/// Sends a line, and returns the output up to the next prompt, including the echo.
pub fn command(board: &mut EmulatedBoard, line: &str) -> String {
    board.uart_write(format!("{line}\r").as_bytes());
    board.read_until(PROMPT, LIMIT).unwrap()
}

/// Presses a button for long enough to be registered.
pub fn press(board: &mut EmulatedBoard, button: u8) {
    board.set_buttons(1 << button);
    board.run(40 * MS);
    board.set_buttons(0);
    board.run(40 * MS);
}

/// The number of the demo's current scene, counted from 1, and the whole reply to `demo`.
pub fn turn(board: &mut EmulatedBoard) -> (usize, String) {
    let answer = command(board, "demo");
    let line = answer.lines().find_map(|line| line.strip_prefix("scene "));
    let number = line.and_then(|line| line.split(' ').next()?.parse().ok());
    (number.unwrap_or_else(|| panic!("{answer}")), answer)
}

/// Segments of the four digits on the right.
pub fn right(board: &EmulatedBoard) -> [u8; 4] {
    *board.digits().last_chunk().expect("eight digits")
}

/// A board that shows the first scene of the built-in demo.
fn alone() -> EmulatedBoard {
    let mut board = started();
    command(&mut board, "demo on");
    board.run(100 * MS);
    board
}

#[test]
fn scenes_take_turns() {
    let mut board = alone();
    for number in [1, 2, 3, 4, 5, 6, 1] {
        let (found, answer) = turn(&mut board);
        let name = SCENES[number - 1];
        assert_eq!(found, number);
        assert_has(&answer, &format!("scene {number} of 6 {name}\r\n"));
        assert_has(&answer, "demo on\r\n");
        board.run(TURN_MS * MS);
    }
    assert_has(&command(&mut board, "info scene"), "scene wireframe");
}

#[test]
fn commands_that_set_the_picture_stop_the_demo() {
    let mut board = alone();
    for line in [
        "info",
        "help",
        "stats",
        "overlay off",
        "imu",
        "light",
        "selftest",
        "camera",
    ] {
        let answer = command(&mut board, line);
        assert!(answer.contains(line), "{answer}");
        assert_has(&command(&mut board, "demo"), "demo on\r\n");
    }
    for line in [
        "scene menger",
        "camera 3 10 60",
        "size 320 180",
        "light 1,2,3",
    ] {
        let answer = command(&mut board, line);
        assert!(answer.ends_with("ok\r\nglint> "), "{answer}");
        assert_has(&command(&mut board, "demo"), "demo off\r\nok");
        let refused = "error: demo: off, expected `demo on` first";
        assert_has(&command(&mut board, "demo next"), refused);
        command(&mut board, "demo on");
    }
    command(&mut board, "demo off");
    let shown = command(&mut board, "info scene");
    board.run(2 * TURN_MS * MS);
    assert_eq!(command(&mut board, "info scene"), shown);
}

#[test]
fn buttons_choose_scenes_and_hold_them() {
    let mut board = alone();
    press(&mut board, 0);
    press(&mut board, 0);
    assert_eq!(turn(&mut board).0, 3);
    press(&mut board, 1);
    press(&mut board, 1);
    press(&mut board, 1);
    assert_eq!(
        turn(&mut board).0,
        6,
        "the scene before the first is the last"
    );
    press(&mut board, 2);
    assert!(turn(&mut board).1.contains("demo held\r\n"));
    board.run(2 * TURN_MS * MS);
    assert_eq!(turn(&mut board).0, 6);
    press(&mut board, 1);
    press(&mut board, 1);
    assert_eq!(
        turn(&mut board).0,
        4,
        "buttons change the scene of a held demo"
    );
    // The motion sensor steers the camera in this scene, so button 2 calibrates it.
    press(&mut board, 2);
    assert!(turn(&mut board).1.contains("demo held\r\n"));
    command(&mut board, "demo run");
    board.run((TURN_MS + 100) * MS);
    assert_eq!(turn(&mut board).0, 5);
}

#[test]
fn switches_turn_the_overlay_on_and_give_the_buttons_to_the_scene() {
    let mut board = alone();
    board.set_switches(0b100);
    board.run(100 * MS);
    assert!(command(&mut board, "overlay").contains("overlay on\r\n"));
    press(&mut board, 0);
    assert_eq!(turn(&mut board).0, 2);
    assert!(command(&mut board, "overlay").contains("overlay on\r\n"));
    board.set_switches(0b1000);
    board.run(100 * MS);
    assert!(command(&mut board, "overlay").contains("overlay off\r\n"));
    assert!(turn(&mut board).1.contains("demo held\r\n"));
    // Button 0 is the key `up` of the wireframe.
    let before = board.capture();
    press(&mut board, 0);
    board.run(100 * MS);
    assert_eq!(turn(&mut board).0, 2);
    assert!(board.capture() != before, "the wireframe moves");
    board.set_switches(0);
    board.run(100 * MS);
    press(&mut board, 0);
    let (number, answer) = turn(&mut board);
    assert!(number == 3 && answer.contains("demo on\r\n"), "{answer}");
}

#[test]
fn a_calibration_shows_on_leds_and_digits() {
    let mut board = started();
    board.plug(sensor::virtual_sensor(None));
    board.run(PANEL);
    press(&mut board, 2);
    board.run(PANEL);
    assert_eq!(board.leds() >> 8, 1, "the first eighth");
    assert_eq!(right(&board), Display::of(format_args!("CAL")).digits());
    // The calibration takes 8,192 samples, one each millisecond.
    board.run(4_000 * MS);
    assert!(
        [0xf, 0x1f].contains(&(board.leds() >> 8)),
        "{:#x}",
        board.leds()
    );
    board.run(5_000 * MS);
    assert_eq!(board.leds() >> 8, 0);
    assert_eq!(right(&board), [0; 4]);
}

#[test]
fn leds_and_digits_show_the_state() {
    let mut board = started();
    board.run(PANEL);
    // Without the demo only the first LED blinks.
    assert_eq!(board.leds() & !1, 0);
    assert_eq!(right(&board), [0; 4]);
    command(&mut board, "demo on");
    board.run(100 * MS);
    press(&mut board, 0);
    press(&mut board, 0);
    press(&mut board, 2);
    board.run(PANEL);
    assert_eq!(board.leds() & !1, 3 << 4 | 0b110, "scene 3, held, on");
    assert_eq!(right(&board), Display::number(3).digits());
    let stats = command(&mut board, "stats");
    let cycles = stats.lines().find_map(|line| line.strip_prefix("cycles "));
    let cycles: u64 = cycles.expect("cycles").parse().expect("a number");
    let rate = Display::number(u64::from(board.clock_hz()) / cycles);
    assert_eq!(board.digits()[..4], rate.digits());
    let first = board.leds() & 1;
    assert!(board.run_until(PANEL, |board| board.leds() & 1 != first));
    command(&mut board, "leds 0x8000");
    board.run(2 * PANEL);
    assert_eq!(board.leds(), 0x8000, "the LEDs are those of the command");
    command(&mut board, "demo off");
    board.run(PANEL);
    assert_eq!(right(&board), [0; 4]);
}
