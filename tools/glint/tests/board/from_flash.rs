//! Tests of a board with scenes, lists and meshes in its flash.

use crate::alone::{LIMIT, MS, PANEL, command, press, right, turn};
use crate::common::{assert_has, mesh};
use glint::board::{EmulatedBoard, built_firmware};
use glint::board::{Simulation, Uart};
use glint::fuzz::{Inputs, Target};
use glint::image;
use glint::render::{Frame, Subject, WireframeSubject, on_model};
use glint::scene::{self, Changes};
use glint::wireframe::{self, Form};
use glint_core::block::Block;
use glint_core::console::PROMPT;
use glint_core::demo::TURN_MS;
use glint_core::digits::Display;
use glint_core::flash::{CONTENTS, Kind, Piece, encode};
use glint_core::texture::{self, Source};
use glint_core::wireframe::{CUBE, Key, Motion};
use glint_scene_file::SceneFile;
use std::path::{Path, PathBuf};
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
    // The mesh is taken from the flash only once.
    assert!(board.capture() == lamp);

    let (number, answer) = turn(&mut board);
    assert!(number == 2 && answer.contains("of 2 lamp\r\n"), "{answer}");
    let answer = command(&mut board, "info");
    assert_has(&answer, "scene icosphere:2\r\n");
    assert_has(&answer, "triangles 80\r\n");
    let answer = command(&mut board, "selftest");
    assert_has(&answer, "selftest flash ok\r\n");
    assert!(answer.ends_with("ok\r\nglint> "), "{answer}");
    // The self-test leaves the demo on.
    assert_has(&turn(&mut board).1, "demo on\r\n");
    let answer = command(&mut board, "scene");
    let lines = "lamp flash,start flash,icosphere:2 shown,cubes flash,menger there";
    for line in lines.split(',') {
        assert_has(&answer, &format!("scene {line}\r\n"));
    }
    assert_eq!(answer.matches("scene cubes ").count(), 1, "{answer}");
}

/// A texture of the flash is copied to the uploads when a scene or a command names it.
#[test]
fn a_scene_has_its_texture_from_the_flash() {
    let texture = texture::encode(&Source {
        size_log2: [3, 3],
        levels: vec![vec![0xF800; 64]],
        ..Source::default()
    });
    let flash = flash(&[
        piece(Kind::Texture, "red", texture.unwrap()),
        piece(Kind::Texture, "bad", vec![0; 64]),
        piece(Kind::Scene, "box", "scene crate\ntexture red\n"),
        piece(Kind::Scene, "broken", "scene crate\ntexture bad\n"),
    ]);
    let (mut board, _) = powered_up(flash, |_| ());
    assert_has(
        &command(&mut board, "models"),
        "flash texture red bytes 160\r\n",
    );
    command(&mut board, "scene box");
    assert_has(&command(&mut board, "texture"), "texture red\r\n");
    assert_has(
        &command(&mut board, "models"),
        "texture red size 8 8 bytes 160\r\n",
    );
    let answer = command(&mut board, "scene broken");
    assert_has(
        &answer,
        "texture bad of the flash: texture byte 0: expected ",
    );
    assert_has(&command(&mut board, "texture"), "texture red\r\n");
    command(&mut board, "unload red");
    assert_has(&command(&mut board, "texture"), "texture own\r\n");
    command(&mut board, "texture red");
    assert_has(&command(&mut board, "texture"), "texture red\r\n");
}

/// The folder of a test's scene files.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// A wireframe program that a scene file names is in the flash, and the board shows it from power-up on, as the model draws it on the host.
/// The buttons then move it, and read it again.
#[test]
fn a_scene_has_its_wireframe_program_from_the_flash() {
    const NET: &str = "eye 0 0 4\nplane 2\nwindow -2 -1.125 2 1.125\nsegment -1 0 1 1 0.5 1\nsegment 0 -1 1 0 1 4\nend\nignored\n";
    let folder = folder("from-flash-wireframe");
    std::fs::write(folder.join("net.wft"), NET).unwrap();
    let binary = wireframe::parse(Form::Text, NET.into()).unwrap().bytes;
    std::fs::write(folder.join("net.wfb"), &binary).unwrap();
    let start = Motion::default();
    let mut moved = start;
    assert!(moved.apply(Key::Up.step(false)));
    for program in ["net.wft", "net.wfb"] {
        let file = folder.join("net.toml");
        let text = format!(
            "title = \"A net\"\nprogram = \"{program}\"\nsteer = \"buttons\"\nquality = \"fast\"\n"
        );
        let scene = SceneFile::parse("net", file.to_str().unwrap(), &text).unwrap();
        let cubes = glint_scene_file::built_in("wireframe").unwrap();
        let pieces = image::pieces(&[scene.clone(), cubes]).unwrap();
        let found: Vec<_> = pieces
            .iter()
            .map(|piece| (piece.kind, &piece.name))
            .collect();
        assert_eq!(found[0], (Kind::Program, &program.to_owned()));
        assert_eq!(pieces[0].bytes, binary);
        let flash = image::make(&[], &[0x13; 32], &pieces).unwrap();
        let pictures = scene::draw(&scene, &Changes::default(), |frame| {
            let Subject::Wireframe(subject) = frame.subject else {
                panic!("{program}: no wireframe");
            };
            [start, moved].map(|motion| {
                let pose = motion.pose();
                let subject = Subject::Wireframe(WireframeSubject { pose, ..subject });
                let frame = Frame { subject, ..*frame };
                on_model(&frame).unwrap().image.colour
            })
        });
        let [at_start, after_up] = pictures.unwrap();
        // Switch 3 holds the demo, so the buttons are the keys.
        let (mut board, said) = powered_up(flash, |board| board.set_switches(1 << 3));
        assert!(!said.contains("error"), "{said}");
        assert!(board.capture().pixels == at_start, "{program}");
        press(&mut board, 0);
        board.run(PANEL);
        assert!(board.capture().pixels == after_up, "{program}");
        board.set_buttons(0b1100);
        board.run(40 * MS);
        board.set_buttons(0);
        board.run(PANEL);
        assert!(board.capture().pixels == at_start, "{program}");

        let models = command(&mut board, "models");
        let bytes = binary.len();
        assert_has(
            &models,
            &format!("flash program {program} bytes {bytes}\r\n"),
        );
        let uploaded = format!("program {program} segments 2 bytes {bytes}\r\n");
        assert_has(&models, &format!("\n{uploaded}"));
        let answer = command(&mut board, "program n\t");
        assert_has(&answer, &format!("program {program} \r\n"));
        command(&mut board, &format!("unload {program}"));
        assert!(!command(&mut board, "models").contains(&uploaded));
        // The program is copied again at its next use.
        for line in [format!("program {program}"), "scene net".to_owned()] {
            command(&mut board, &line);
            command(&mut board, "render");
            assert!(board.capture().pixels == at_start, "{line}");
        }
        // The built-in scene has no program of the flash.
        command(&mut board, "scene wireframe");
        command(&mut board, "quality fast");
        command(&mut board, "render");
        assert!(board.capture().pixels != at_start);
    }
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
    assert_has(&command(&mut board, "view"), &format!("view {view}\r\n"));
}

#[test]
fn items_of_the_flash_come_before_built_in_ones_and_after_uploads() {
    let flash = flash(&[
        piece(Kind::Mesh, "torus", mesh("icosphere:1")),
        piece(Kind::Scene, "menger", "size 320 180\nobject add torus\n"),
        piece(Kind::List, "both", "spheres\nmenger\n"),
    ]);
    let (mut board, _) = powered_up(flash, |_| ());
    // A list contains a built-in scene.
    assert_has(&command(&mut board, "info"), "scene spheres:");
    command(&mut board, "scene menger");
    let answer = command(&mut board, "info");
    assert_has(&answer, "scene objects\r\n");
    assert_has(&answer, "triangles 20\r\n");
    command(&mut board, "scene both");
    // The first scene of the list is shown.
    assert_has(&command(&mut board, "info"), "scene spheres:");
    command(&mut board, "scene torus");
    assert_has(&command(&mut board, "info"), "triangles 20\r\n");
    command(&mut board, "unload torus");
    assert_has(&command(&mut board, "models"), "flash torus bytes ");
    assert_has(
        &command(&mut board, "load 16 0 both"),
        "the name of a scene",
    );
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
    assert_eq!(said.matches("demo: error").count(), 1, "{said}");
    assert_has(&said, &format!("demo: error {number}: {error}"));
    let shown = Display::error(number).digits();
    assert!(board.run_until(PANEL, |board| right(board) == shown));
    assert!(board.run_until(PANEL, |board| right(board) == Display::number(1).digits()));
    assert_eq!(board.leds() & 0b1000, 0b1000);
    assert_has(&turn(&mut board).1, "scene 1 of 6 holoforge\r\n");
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
    let error = "flash: flash byte 0x400004: expected at most 12582912 bytes";
    runs_the_built_in_demo(length, 1, error);
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
        piece(
            Kind::Scene,
            "also",
            "backend cpu\nsize 320 180\nfield box:1,1,1\n",
        ),
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
    assert_has(&said, &format!("demo: error {number}: {error}"));
    assert!(board.capture() == good, "the picture");
    assert!(!is_black(&mut board));
    let digits = Display::error(number).digits();
    assert!(board.run_until(PANEL, |board| right(board) == digits));
    board.run(TURN_MS * MS);
    let (found, answer) = turn(&mut board);
    assert_eq!(found, 3);
    assert_has(&answer, &format!("error {number}\r\n"));
    assert_has(&command(&mut board, "info scene"), "scene box:1,1,1");
    assert_has(
        &command(&mut board, "scene bad"),
        &format!("error: {error}"),
    );
}

#[test]
fn a_scene_that_cannot_be_shown_is_left_out() {
    let all = Block::ALL.iter().fold(0, |bits, block| bits | block.bit());
    let scene = |text: &str| piece(Kind::Scene, "bad", text);
    let missing = scene("size 640 360\nscene gear\n");
    let damaged = piece(Kind::Mesh, "gear", vec![0; 64]);
    let program = scene("size 640 360\nprogram net.wfb\n");
    let endless = piece(Kind::Program, "net.wfb", CUBE[..15].as_flattened());
    let no_program = "program `net.wfb`: expected cube or an uploaded program, `models` lists them";
    let no_end = "program net.wfb of the flash: wireframe program, word 16: expected end, found the end of the input";
    let failing = scene("field box:1,1,1\nedges over\n");
    let no_mesh = "scene bad: no mesh `gear`, expected a built-in mesh or a mesh of the flash";
    let no_command = "scene bad: line 1: \"frobnicate\" (column 1): expected a command";
    let no_picture = "scene bad: line 2: expected a command that sets the picture";
    for (pieces, number, error) in [
        (
            vec![scene("field menger:2\n")],
            2,
            "bad: flash byte 0x400130: expected the CRC-32 ",
        ),
        (vec![], 3, "scene `bad`: expected cube or "),
        (vec![missing.clone()], 4, no_mesh),
        (
            vec![missing, damaged],
            4,
            "mesh gear of the flash: mesh byte 0: expected ",
        ),
        (vec![program.clone()], 4, no_program),
        (vec![program, endless], 4, no_end),
        (vec![scene("frobnicate\n")], 7, no_command),
        (vec![scene("fov 60\nreboot\n")], 7, no_picture),
        (vec![failing], 8, "edges: not available for objects"),
    ] {
        keeps_the_scene(&pieces, all, number, error);
    }
    let lacks = all & !Block::Line.bit();
    let error = "scene bad: this gateware lacks line, expected a build by `cargo xtask gateware --scene bad`";
    keeps_the_scene(&[scene("program\n")], lacks, 5, error);
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
    assert_has(&said, "demo: error 3: scene `bad`: ");
    let reply = "glint> info scene\r\nscene menger:1\r\nok\r\n";
    assert!(said.ends_with(reply), "{said}");
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
        assert_has(&reply(&mut board, "info uptime_ms"), "uptime_ms ");
    }
    assert!((30..57).contains(&alone), "{alone} boards run alone");
}

/// The first picture shows the first scene, and appears at the fourth vertical blanking at the latest. The soft core of this board would take
/// longer to draw `objects`.
#[test]
fn the_first_picture_is_the_first_scene() {
    for name in "holoforge wireframe simplegpu poor-mans-vr cubes".split(' ') {
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
