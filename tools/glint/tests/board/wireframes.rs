//! The wireframe simulator on the emulated board, with bouncing buttons, switches, commands and
//! uploads. Every frame is checked.

use crate::common::{address, console, emulator, info, mesh, renderer};
use glint::board::{EmulatedBoard, SimulatedBoard};
use glint::board::{Simulation, Uart};
use glint::console::{Console, ConsoleError};
use glint::render::{Frame, Subject, WireframeSubject, on_model};
use glint::transfer::{self, TransferError};
use glint::{generate, view, wireframe};
use glint_core::picture::{Samples, Size};
use glint_core::wireframe::{Key, Motion, Program, Requests, Viewing};

/// Number of clock cycles in a millisecond.
const MS: u64 = 81_250;
/// Addresses of the two frame buffers.
const BUFFERS: [u32; 2] = [0x4100_0000, 0x4120_0000];

fn viewing() -> Viewing {
    Viewing {
        eye: wireframe::numbers("0,0,8", "").unwrap(),
        plane: "4".parse().unwrap(),
        window: wireframe::window("-4,-2.25,4,2.25").unwrap(),
    }
}

/// The built-in program of the firmware: a cube of side 4.
fn cube() -> Vec<u8> {
    let cube = generate::named("cube").unwrap();
    wireframe::make(cube, Some(4.0), &viewing()).unwrap().bytes
}

/// A program of two segments.
fn cross() -> Vec<u8> {
    let text = "eye 0 0 4\nplane 2\nwindow -2 -1.125 2 1.125\nsegment -1 0 1 1 0.5 1\nsegment 0 -1 1 0 1 4\nend\n";
    let program = wireframe::parse(wireframe::Form::Text, text.into());
    program.unwrap().bytes
}

/// The model's picture of a program after a motion.
fn picture(program: &[u8], motion: &Motion) -> Vec<u16> {
    let subject = Subject::Wireframe(WireframeSubject {
        program: Program::new_checked(program).unwrap(),
        pose: motion.pose(),
    });
    let frame = Frame::new(subject, view::spherical("2,30,60").unwrap(), Size::W320);
    on_model(&frame).unwrap().image.colour
}

/// The pictures of a board's current and previous frame.
fn shown(console: &mut Console<SimulatedBoard<EmulatedBoard>>) -> [Vec<u16>; 2] {
    let front = address(console, "frame");
    let back = BUFFERS.into_iter().find(|&buffer| buffer != front).unwrap();
    [front, back].map(|buffer| {
        let mut bytes = vec![0; 2 * Size::W320.pixel_count()];
        let board = console.board().inner();
        board.read_memory(buffer, &mut bytes).unwrap();
        let pixels = bytes.as_chunks().0.iter();
        pixels.map(|&pixel| u16::from_le_bytes(pixel)).collect()
    })
}

/// Reads a value of the board's statistics.
fn count(stats: &[String], name: &str) -> u64 {
    let found = stats.iter().find_map(|line| line.strip_prefix(name));
    found.unwrap().trim().parse().unwrap()
}

/// Sets the buttons to each value for its number of milliseconds, then waits until the frames are
/// drawn.
fn buttons(console: &mut Console<SimulatedBoard<EmulatedBoard>>, script: &[(u8, u64)]) {
    let board = console.board().inner();
    for &(pressed, ms) in script {
        board.set_buttons(pressed);
        board.run(ms * MS);
    }
    board.set_buttons(0);
    board.run(90 * MS);
}

#[test]
fn a_session_with_buttons() {
    let mut board = emulator();
    let mut console = console(&mut board);
    let program = cube();
    let mut motion = Motion::default();
    console.command("scene wireframe").unwrap();
    console.command("quality fast").unwrap();
    let stats = console.command("render").unwrap();
    let start = picture(&program, &motion);
    assert!(shown(&mut console)[0] == start);
    for line in ["backend gateware", "segments 12", "lines 12"] {
        assert!(stats.iter().any(|found| found == line), "{line}: {stats:?}");
    }
    let by_gateware = count(&stats, "line_pixels");
    console.command("backend cpu").unwrap();
    let stats = console.command("render").unwrap();
    assert_eq!(count(&stats, "line_pixels"), by_gateware);
    assert!(shown(&mut console)[0] == start);
    console.command("backend gateware").unwrap();
    console.command("render").unwrap();

    // A press that bounces at both ends is one step, in one frame.
    let bounces = [
        (1, 1),
        (0, 1),
        (1, 2),
        (0, 1),
        (1, 3),
        (0, 2),
        (1, 40),
        (0, 1),
        (1, 1),
        (0, 2),
        (1, 2),
    ];
    buttons(&mut console, &bounces);
    assert!(motion.apply(Key::Up.step(false)));
    assert!(shown(&mut console) == [picture(&program, &motion), start]);

    // Two buttons that are pressed in one frame are two steps, in two frames.
    let mut requests = Requests::default();
    [Key::Up, Key::Right]
        .into_iter()
        .for_each(|key| requests.press(key));
    assert_eq!(requests.take(), Some(Key::Up));
    requests.press(Key::Up);
    let steps = [(); 2].map(|()| requests.take().unwrap().step(false));
    buttons(&mut console, &[(0b1001, 25)]);
    let pictures = steps.map(|step| {
        assert!(motion.apply(step));
        picture(&program, &motion)
    });
    let [first, second] = pictures;
    assert!(shown(&mut console) == [second, first]);

    // With switch 0 the keys rotate instead of pan; with switch 1 the keys up and down zoom.
    for (switches, button, step) in [
        (0b01, 1 << 2, Key::Left.step(true)),
        (0b10, 1 << 1, Key::ZoomOut.step(false)),
    ] {
        console.board().inner().set_switches(switches);
        buttons(&mut console, &[(button, 25)]);
        assert!(motion.apply(step));
        assert!(shown(&mut console)[0] == picture(&program, &motion));
    }

    // Noise shorter than the debounce time has no effect.
    buttons(&mut console, &[(4, 1), (0, 10), (4, 1), (0, 3), (4, 2)]);
    assert!(shown(&mut console)[0] == picture(&program, &motion));
}

/// Buttons 2 and 3 together read the program again, with any switches. The first of the two moves the segments until then.
#[test]
fn two_buttons_read_the_program_again() {
    let mut board = emulator();
    let mut console = console(&mut board);
    let program = cross();
    let quiet = &mut |_, _| {};
    transfer::upload_for(&mut console, "program", &program, 1, quiet, &mut |_| {}).unwrap();
    console.command("quality fast").unwrap();
    console.command("render").unwrap();
    let start = picture(&program, &Motion::default());
    for switches in 0..4 {
        console.board().inner().set_switches(switches);
        let mut motion = Motion::default();
        let rotates = switches & 1 != 0;
        buttons(&mut console, &[(1 << 2, 25)]);
        assert!(motion.apply(Key::Left.step(rotates)));
        assert!(shown(&mut console)[0] == picture(&program, &motion));
        // A third key that is pressed at the same time does not move the new start.
        let both = [(0b0100, 1), (0b1101, 1), (0b0101, 1), (0b1101, 40)];
        buttons(&mut console, &both);
        assert!(shown(&mut console)[0] == start, "{switches}");
        // One button that stays pressed moves the segments only once; the other one then reads the program again.
        buttons(&mut console, &[(1 << 3, 60), (0b1100, 25), (1 << 2, 25)]);
        assert!(shown(&mut console)[0] == start, "{switches}");
        buttons(&mut console, &[(1 << 3, 25)]);
        let mut motion = Motion::default();
        assert!(motion.apply(Key::Right.step(rotates)));
        assert!(shown(&mut console)[0] == picture(&program, &motion));
        buttons(&mut console, &[(0b1100, 25)]);
    }
    // Beside the wireframe the two buttons have no effect, not even later.
    console.board().inner().set_switches(0);
    console.command("scene cube").unwrap();
    buttons(&mut console, &[(0b1100, 25)]);
    assert_eq!(info::<String>(&mut console, "scene"), "cube");
    console.command("program").unwrap();
    console.command("press up").unwrap();
    let mut motion = Motion::default();
    assert!(motion.apply(Key::Up.step(false)));
    assert!(shown(&mut console)[0] == picture(&program, &motion));
}

/// Programs have names, as meshes and textures have, and are uploads like them.
#[test]
fn programs_with_names() {
    let mut board = emulator();
    let mut console = console(&mut board);
    let (cross, still) = (cross(), Motion::default());
    let ball = {
        let ball = generate::named("icosphere:1").unwrap();
        wireframe::make(ball, Some(4.0), &viewing()).unwrap().bytes
    };
    let upload = |console: &mut Console<SimulatedBoard<EmulatedBoard>>, bytes: &[u8], name| {
        transfer::upload_program(console, bytes, name, 3, &mut |_, _| {})
    };
    let shows = |console: &mut Console<SimulatedBoard<EmulatedBoard>>, program: &[u8]| {
        console.command("render").unwrap();
        shown(console)[0] == picture(program, &still)
    };
    console.command("quality fast").unwrap();
    upload(&mut console, &cross, Some("cross")).unwrap();
    assert!(shows(&mut console, &cross));
    upload(&mut console, &ball, Some("ball")).unwrap();
    assert!(shows(&mut console, &ball));
    let models = console.command("models").unwrap();
    for line in [
        format!("program cross segments 2 bytes {}", cross.len()),
        format!("program ball segments 30 bytes {}", ball.len()),
        "uploads 2 of 18".to_owned(),
    ] {
        assert!(models.contains(&line), "{line}: {models:?}");
    }
    for (command, program) in [
        ("program cross", &cross),
        ("program", &cross),
        ("program cube", &cube()),
        ("program ball", &ball),
    ] {
        console.command(command).unwrap();
        assert!(shows(&mut console, program), "{command}");
    }

    // The name of the program stays while another subject is shown. A new scene begins without a name.
    for (command, program) in [
        ("scene torus", &ball),
        ("scene wireframe", &cube()),
        ("scene default", &cube()),
    ] {
        console.command(command).unwrap();
        console.command("quality fast").unwrap();
        console.command("program").unwrap();
        assert!(shows(&mut console, program), "{command}");
    }
    upload(&mut console, &cross, None).unwrap();
    console.command("program ball").unwrap();
    console.command("scene wireframe").unwrap();
    console.command("quality fast").unwrap();
    assert!(shows(&mut console, &cross), "the upload without a name");

    // Refused programs and names change nothing.
    console.command("program ball").unwrap();
    for (command, expected) in [
        (
            "program net",
            "program `net`: expected cube or an uploaded program, `models` lists them",
        ),
        (
            "program 96 0 menger",
            "the name of a scene, expected another name",
        ),
        ("program net ball", "BYTES is \"net\" (column 9)"),
    ] {
        let error = console.command(command).unwrap_err().to_string();
        assert!(error.contains(expected), "{command}: {error}");
        assert!(shows(&mut console, &ball), "{command}");
    }
    let error = upload(&mut console, &ball[..40], Some("ball")).unwrap_err();
    let expected = "program: previous scene kept: wireframe program, word 3: expected a word of";
    assert!(error.to_string().contains(expected), "{error}");
    assert!(shows(&mut console, &ball));

    // The memory of a removed program is free again, and the other programs move there.
    let free = |lines: &[String]| -> u32 {
        let free = lines.iter().find_map(|line| line.strip_prefix("free "));
        free.unwrap().split(' ').next().unwrap().parse().unwrap()
    };
    let before = free(&console.command("models").unwrap());
    console.command("unload cross").unwrap();
    let models = console.command("models").unwrap();
    assert!(models.contains(&"uploads 2 of 18".to_owned()), "{models:?}");
    assert!(free(&models) > before, "{models:?}");
    assert!(shows(&mut console, &ball));
    // A mesh replaces a program of its name, which is then no longer shown.
    let mesh = mesh("icosphere:1");
    transfer::upload(&mut console, &mesh, Some("ball"), 4, &mut |_, _| {}).unwrap();
    console.command("program").unwrap();
    assert!(shows(&mut console, &cross), "the upload without a name");
    console.command("object add ball").unwrap();
    let error = upload(&mut console, &ball, Some("ball")).unwrap_err();
    let expected = "object 1 shows this mesh, expected `object remove 1` first";
    assert!(error.to_string().contains(expected), "{error}");
    console.command("unload program").unwrap();
    console.command("program").unwrap();
    assert!(shows(&mut console, &cube()));
}

#[test]
fn a_session_with_commands() {
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    let program = cross();
    let console = renderer.console();
    console.command("quality fast").unwrap();
    let refused = |error: ConsoleError| error.to_string();
    let error = refused(console.command("press up").unwrap_err());
    assert!(error.contains("expected `program` first"), "{error}");

    let upload = |console: &mut Console<SimulatedBoard<EmulatedBoard>>, bytes: &[u8]| {
        transfer::upload_for(console, "program", bytes, 3, &mut |_, _| {}, &mut |_| {})
    };
    upload(console, &program).unwrap();
    let mut motion = Motion::default();
    console.command("render").unwrap();
    assert!(shown(console)[0] == picture(&program, &motion));
    assert_eq!(info::<String>(console, "scene"), "wireframe");
    for (command, step) in [
        ("press left rotate", Key::Left.step(true)),
        ("press zoom-out", Key::ZoomOut.step(false)),
        ("press up", Key::Up.step(false)),
    ] {
        console.command(command).unwrap();
        assert!(motion.apply(step));
        assert!(shown(console)[0] == picture(&program, &motion), "{command}");
    }

    // A refused program does not replace the current program.
    let mut damaged = program.clone();
    damaged[3 * 16 + 12] = 0b011;
    let Err(TransferError::Console(error)) = upload(console, &damaged) else {
        panic!("expected a refusal");
    };
    let error = error.to_string();
    assert!(error.contains("word 4: expected an opcode"), "{error}");
    console.command("press right").unwrap();
    assert!(motion.apply(Key::Right.step(false)));
    assert!(shown(console)[0] == picture(&program, &motion));

    // Another scene ends the session; the command `program` then starts it again.
    console.command("scene cube").unwrap();
    assert!(console.command("press up").is_err());
    console.command("program").unwrap();
    console.command("render").unwrap();
    assert!(shown(console)[0] == picture(&program, &Motion::default()));
}

#[test]
fn a_script_of_keys() {
    let mut board = emulator();
    let mut renderer = renderer(&mut board);
    let program = cube();
    let script = wireframe::script("rotate,right:2,pan,up,zoom-in").unwrap();
    let drawn = renderer
        .play(&program, &script, Size::W320, Samples::One)
        .unwrap();
    let mut motion = Motion::default();
    for step in [
        Key::Right.step(true),
        Key::Right.step(true),
        Key::Up.step(false),
        Key::ZoomIn.step(false),
    ] {
        assert!(motion.apply(step));
    }
    assert!(drawn.image.colour == picture(&program, &motion));
    let counts = drawn.stats.wireframe.unwrap();
    assert_eq!((counts.segments, counts.lines), (12, 12));
}

/// Repeated frames of a wireframe have no sky and no fog, although the previous frames, of a mesh, had both.
#[test]
fn repeated_frames_after_a_sky() {
    let mut board = emulator();
    let mut console = console(&mut board);
    for line in [
        "size 320 180",
        "background sky",
        "fog 0.3",
        "bench triangle 2",
        "scene wireframe",
        "quality fast",
        // The second frame uses the memory of the mesh's second frame.
        "bench triangle 2",
    ] {
        console.command(line).unwrap();
    }
    let [_, repeated] = shown(&mut console);
    assert!(repeated == picture(&cube(), &Motion::default()));
}
