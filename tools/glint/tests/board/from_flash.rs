//! Tests of a board with scenes, lists and meshes in its flash.

use crate::alone::{LIMIT, MS, PANEL, command, press, right, turn};
use crate::common::mesh;
use glint::board::{EmulatedBoard, built_firmware};
use glint::board::{Simulation, Uart};
use glint::fuzz::{Inputs, Target};
use glint::image;
use glint::scene::{self, Changes};
use glint_core::block::Block;
use glint_core::console::PROMPT;
use glint_core::demo::TURN_MS;
use glint_core::digits::Display;
use glint_core::flash::{CONTENTS, Kind, Piece, encode};
use glint_scene_file::SceneFile;
use virtual_board::virtual_flash::Flash;

/// A scene with a mesh from the flash.
const LAMP: &str = "title = \"A lamp\"\nmodel = \"icosphere:2\"\ncamera = \"3 10 70\"\n";

fn piece(kind: Kind, name: &str, bytes: impl Into<Vec<u8>>) -> Piece {
    let (name, bytes) = (name.to_owned(), bytes.into());
    Piece { kind, name, bytes }
}

fn flash(pieces: &[Piece]) -> Vec<u8> {
    encode(&[], &[0x13; 32], pieces).unwrap()
}

/// Starts a board with these bytes in its flash, and returns the board and its output.
fn powered_up(flash: Vec<u8>, prepare: impl FnOnce(&mut EmulatedBoard)) -> (EmulatedBoard, String) {
    let mut board = EmulatedBoard::fast(&built_firmware(None).unwrap()).unwrap();
    board.plug_flash(Flash::new(flash));
    prepare(&mut board);
    board.run(700 * MS);
    let mut said = Vec::new();
    board.uart_read(&mut said);
    let said = String::from_utf8(said).unwrap();
    assert!(said.ends_with(PROMPT), "{said}");
    (board, said)
}

fn is_black(board: &mut EmulatedBoard) -> bool {
    board.capture().pixels.iter().all(|colour| *colour == 0)
}

/// Offset of an item's bytes in the flash image.
fn place(flash: &[u8], name: &str) -> usize {
    let image = glint_core::flash::Image::new_checked(flash).unwrap();
    let mut items = image.contents.items();
    CONTENTS + items.find(|item| item.name == name).unwrap().offset()
}

#[test]
fn a_board_with_a_list_runs_alone() {
    let lamp = SceneFile::parse("lamp", "lamp.toml", LAMP).unwrap();
    let scenes = [glint_scene_file::built_in("cubes").unwrap(), lamp];
    let pieces = image::pieces(&scenes).unwrap();
    let flash = image::make(&[], &[0x13; 32], &pieces).unwrap();
    let (mut board, said) = powered_up(flash, |_| ());
    // The host has not sent any bytes yet.
    assert!(!said.contains("error"), "{said}");
    assert_eq!(right(&board), Display::number(1).digits());
    assert_eq!(board.leds() & !1, 1 << 4 | 0b10);
    let cubes = board.capture();
    assert!(!is_black(&mut board));
    board.run(TURN_MS * MS);
    assert_eq!(right(&board), Display::number(2).digits());
    let lamp = board.capture();
    assert!(lamp != cubes && !is_black(&mut board));
    press(&mut board, 1);
    board.run(PANEL);
    assert!(board.capture() == cubes, "the first scene again");
    press(&mut board, 0);
    board.run(PANEL);
    assert!(
        board.capture() == lamp,
        "the mesh is taken from the flash once"
    );

    let (number, answer) = turn(&mut board);
    assert!(number == 2 && answer.contains("of 2 lamp\r\n"), "{answer}");
    let answer = command(&mut board, "info");
    assert!(answer.contains("scene icosphere:2\r\n"), "{answer}");
    assert!(answer.contains("triangles 80\r\n"), "{answer}");
    let answer = command(&mut board, "selftest");
    assert!(answer.contains("selftest flash ok\r\n"), "{answer}");
    assert!(answer.ends_with("ok\r\nglint> "), "{answer}");
    assert!(
        turn(&mut board).1.contains("demo on\r\n"),
        "selftest leaves the demo on"
    );
    let answer = command(&mut board, "scene");
    for line in [
        "lamp flash",
        "start flash",
        "icosphere:2 shown",
        "cubes flash",
        "menger there",
    ] {
        assert!(
            answer.contains(&format!("scene {line}\r\n")),
            "{line}: {answer}"
        );
    }
    assert_eq!(answer.matches("scene cubes ").count(), 1, "{answer}");
}

/// For a scene without a camera, a board computes the same camera from the mesh in its flash as the
/// host.
#[test]
fn a_board_fits_the_camera_of_a_scene() {
    let text = "title = \"Fitted\"\nmodel = \"icosphere:2\"\nup = \"y\"\nfov = 40\nzoom = 1.5\n";
    let scene = SceneFile::parse("fitted", "fitted.toml", text).unwrap();
    let pieces = image::pieces(std::slice::from_ref(&scene)).unwrap();
    let flash = image::make(&[], &[0x13; 32], &pieces).unwrap();
    let (mut board, _) = powered_up(flash, |_| ());
    command(&mut board, "scene fitted");
    let view = scene::draw(&scene, &Changes::default(), |frame| frame.view).unwrap();
    let answer = command(&mut board, "view");
    assert!(answer.contains(&format!("view {view}\r\n")), "{answer}");
}

#[test]
fn items_of_the_flash_come_before_built_in_ones_and_after_uploads() {
    let flash = flash(&[
        piece(Kind::Mesh, "torus", mesh("icosphere:1")),
        piece(Kind::Scene, "menger", "size 320 180\nobject add torus\n"),
        piece(Kind::List, "both", "spheres\nmenger\n"),
    ]);
    let (mut board, _) = powered_up(flash, |_| ());
    let info = |board: &mut EmulatedBoard| command(board, "info");
    assert!(
        info(&mut board).contains("scene spheres:"),
        "a built-in scene of a list"
    );
    command(&mut board, "scene menger");
    let answer = info(&mut board);
    assert!(
        answer.contains("scene objects\r\n") && answer.contains("triangles 20\r\n"),
        "{answer}"
    );
    command(&mut board, "scene both");
    assert!(
        info(&mut board).contains("scene spheres:"),
        "the first scene of the list"
    );
    command(&mut board, "scene torus");
    assert!(info(&mut board).contains("triangles 20\r\n"));
    command(&mut board, "unload torus");
    assert!(command(&mut board, "models").contains("flash torus bytes "));
    let answer = command(&mut board, "load 16 0 both");
    assert!(answer.contains("the name of a scene"), "{answer}");
}

#[test]
fn without_a_list_the_board_starts_as_without_a_flash() {
    let pieces = [piece(Kind::Scene, "a", "field menger:2\n")];
    for flash in [Vec::new(), vec![0; 5 << 20], flash(&[]), flash(&pieces)] {
        let (mut board, said) = powered_up(flash, |_| ());
        assert!(!said.contains("demo"), "{said}");
        assert!(command(&mut board, "demo").contains("demo off\r\nok"));
        assert!(command(&mut board, "info scene").contains("scene cube\r\n"));
    }
}

/// Starts a board with a damaged flash, and checks that the board prints the error once, shows the
/// number of the error on the digits, and runs the built-in demo.
fn runs_the_built_in_demo(flash: Vec<u8>, number: u8, error: &str) {
    let (mut board, said) = powered_up(flash, |_| ());
    let line = format!("demo: error {number}: {error}");
    assert_eq!(said.matches("demo: error").count(), 1, "{said}");
    assert!(said.contains(&line), "expected {line}, found {said}");
    let shown = Display::error(number).digits();
    assert!(board.run_until(PANEL, |board| right(board) == shown));
    assert!(board.run_until(PANEL, |board| right(board) == Display::number(1).digits()));
    assert_eq!(board.leds() & 0b1000, 0b1000);
    let (_, answer) = turn(&mut board);
    assert!(answer.contains("scene 1 of 5 holoforge\r\n"), "{answer}");
    assert!(!is_black(&mut board));
    let answer = command(&mut board, "selftest");
    assert!(answer.ends_with("ok\r\nglint> "), "{answer}");
}

#[test]
fn the_built_in_demo_runs_without_valid_contents() {
    let valid = flash(&[
        piece(Kind::Scene, "a", "field menger:2\n"),
        piece(Kind::List, "start", "a\n"),
    ]);
    let mut list = valid.clone();
    list[CONTENTS + 16 + 17] ^= 1;
    runs_the_built_in_demo(list, 1, "flash: flash byte 0x40000c: expected the CRC-32 ");
    let mut length = valid.clone();
    length[CONTENTS + 7] = 0x7f;
    runs_the_built_in_demo(
        length,
        1,
        "flash: flash byte 0x400004: expected at most 12582912 bytes",
    );
    let mut item = valid.clone();
    let start = place(&valid, "start");
    item[start] ^= 1;
    runs_the_built_in_demo(item, 2, "start: flash byte ");
    // The writing of the flash was interrupted.
    let mut cut = valid;
    cut.truncate(start);
    runs_the_built_in_demo(cut, 2, "start: flash byte ");
}

/// A board with the scenes `good`, `bad` and `also`. At the second scene it prints the error, shows
/// the number of the error on the digits, and keeps the previous picture. It then shows the third
/// scene.
fn keeps_the_scene(pieces: &[Piece], blocks: u32, number: u8, error: &str) {
    let mut all = vec![
        piece(Kind::Scene, "good", "size 320 180\nfield menger:1\n"),
        piece(Kind::Scene, "also", "backend cpu\nfield box:1,1,1\n"),
        piece(Kind::List, "start", "good\nbad\nalso\n"),
    ];
    all.extend_from_slice(pieces);
    let mut flash = flash(&all);
    if error.contains("CRC-32") {
        let place = place(&flash, "bad");
        flash[place] ^= 1;
    }
    let (mut board, said) = powered_up(flash, |board| board.state_blocks(blocks));
    assert!(!said.contains("error"), "{said}");
    let good = board.capture();
    board.run(TURN_MS * MS);
    let mut said = Vec::new();
    board.uart_read(&mut said);
    let said = String::from_utf8(said).unwrap();
    let line = format!("demo: error {number}: {error}");
    assert!(said.contains(&line), "expected {line}, found {said}");
    assert!(board.capture() == good, "the picture");
    assert!(!is_black(&mut board));
    assert!(board.run_until(PANEL, |board| right(board)
        == Display::error(number).digits()));
    board.run(TURN_MS * MS);
    let (found, answer) = turn(&mut board);
    assert_eq!(found, 3);
    assert!(answer.contains(&format!("error {number}\r\n")), "{answer}");
    assert!(command(&mut board, "info scene").contains("scene box:1,1,1"));
    let answer = command(&mut board, "scene bad");
    assert!(answer.contains(&format!("error: {error}")), "{answer}");
}

#[test]
fn a_scene_that_cannot_be_shown_is_left_out() {
    let all = Block::ALL.iter().fold(0, |bits, block| bits | block.bit());
    let scene = |text: &str| piece(Kind::Scene, "bad", text);
    let check = |pieces: &[Piece], number, error: &str| {
        keeps_the_scene(pieces, all, number, error);
    };
    check(
        &[scene("field menger:2\n")],
        2,
        "bad: flash byte 0x400120: expected the CRC-32 ",
    );
    check(&[], 3, "scene `bad`: expected cube or ");
    let missing = scene("size 640 360\nscene gear\n");
    check(
        std::slice::from_ref(&missing),
        4,
        "scene bad: no mesh `gear`, expected a built-in one, or one of the flash",
    );
    let damaged = piece(Kind::Mesh, "gear", vec![0; 64]);
    check(
        &[missing, damaged],
        4,
        "mesh gear of the flash: mesh byte 0: expected ",
    );
    check(
        &[scene("frobnicate\n")],
        7,
        "scene bad: line 1: \"frobnicate\" (column 1): expected a command",
    );
    check(
        &[scene("fov 60\nreboot\n")],
        7,
        "scene bad: line 2: expected a command that sets the picture",
    );
    let lacks = all & !Block::Line.bit();
    keeps_the_scene(
        &[scene("program\n")],
        lacks,
        5,
        "scene bad: this gateware lacks line, expected a build by `cargo xtask gateware --scene bad`",
    );
    let failing = scene("field box:1,1,1\nedges over\n");
    keeps_the_scene(&[failing], all, 8, "edges: not available for objects");
}

#[test]
fn the_console_answers_beside_an_error() {
    let flash = flash(&[
        piece(Kind::Scene, "good", "field menger:1\n"),
        piece(Kind::List, "start", "good\nbad\n"),
    ]);
    let (mut board, _) = powered_up(flash, |_| ());
    board.uart_write(b"info sc");
    board.run(TURN_MS * MS);
    board.uart_write(b"ene\r");
    let said = board.read_until("ok\r\n", LIMIT).unwrap();
    assert!(said.contains("demo: error 3: scene `bad`: "), "{said}");
    assert!(
        said.ends_with("glint> info scene\r\nscene menger:1\r\nok\r\n"),
        "{said}"
    );
}

/// With damaged contents of any kind, the console and the demo continue to run.
#[test]
fn a_board_with_mutated_contents_answers() {
    let inputs = Inputs::new(Target::Flash, 0xa10e);
    let mut alone = 0;
    // An error of the demo and its prompt may precede the reply.
    let reply = |board: &mut EmulatedBoard, line: &str| {
        board.uart_write(format!("{line}\r").as_bytes());
        board.read_until("ok\r\nglint> ", LIMIT).unwrap()
    };
    for number in 0..60 {
        let mut flash = vec![0xff; CONTENTS];
        flash.extend(inputs.input(number));
        let (mut board, _) = powered_up(flash, |_| ());
        alone += usize::from(reply(&mut board, "demo").contains("demo on\r\n"));
        for _ in 0..3 {
            press(&mut board, 0);
        }
        let answer = reply(&mut board, "info uptime_ms");
        assert!(answer.contains("uptime_ms "), "input {number}: {answer}");
    }
    assert!((30..57).contains(&alone), "{alone} boards run alone");
}

/// The first picture shows the first scene, and appears at the fourth vertical blanking at the latest.
#[test]
fn the_first_picture_is_the_first_scene() {
    for name in [
        "holoforge",
        "wireframe",
        "simplegpu",
        "poor-mans-vr",
        "cubes",
    ] {
        let pieces = image::pieces(&[glint_scene_file::built_in(name).unwrap()]).unwrap();
        let flash = image::make(&[], &[0x13; 32], &pieces).unwrap();
        let mut board = EmulatedBoard::fast(&built_firmware(None).unwrap()).unwrap();
        board.plug_flash(Flash::new(flash));
        let mut pictures = (0..4).map(|_| board.capture());
        let first = pictures.find(|picture| picture.pixels.iter().any(|colour| *colour != 0));
        let first = first.unwrap_or_else(|| panic!("{name}: no picture"));
        board.run(200 * MS);
        assert!(board.capture() == first, "{name}");
    }
}
