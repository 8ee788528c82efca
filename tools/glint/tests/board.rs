//! The whole machine: the virtual board, its firmware, and this crate's side of the line.
//!
//! Needs what `cargo xtask gateware` and `cargo xtask firmware` build; `cargo xtask test` sees to it.

use glint::board::{Board, BoardError, SimulatedBoard, built_firmware};
use glint::console::{Console, ConsoleError, value};
use glint::convert::{self, Options};
use glint::imu::log::Entry;
use glint::imu::replay::{self, Options as ReplayOptions, Replayed, Stage};
use glint::picture::Frame;
use glint::render::{self, FieldSubject, MeshSubject, Renderer, Route, Scene, Stats, Subject};
use glint::transfer::{self, TransferError};
use glint::{generate, view};
use glint_core::appearance::Appearance;
use glint_core::calibration::Units;
use glint_core::camera::View;
use glint_core::colour::Shading;
use glint_core::field::Field;
use glint_core::light::Material;
use glint_core::orientation::Counts;
use glint_core::picture::Backend;
use glint_core::wire::{Failure, Manifest, Reason};

/// The board's time after which a silent firmware has failed.
const PATIENCE_MS: u64 = 2000;

fn running_board() -> SimulatedBoard {
    SimulatedBoard::fast(&built_firmware(None).unwrap()).unwrap()
}

/// A renderer on a board that has just started.
fn renderer(board: &mut SimulatedBoard) -> Renderer<'_, SimulatedBoard> {
    let mut console = Console::new(board).patience(PATIENCE_MS);
    console.greet().unwrap();
    Renderer::new(console)
}

/// The cube from a place outside.
fn cube_scene<'m>(mesh: &'m [u8], camera: &str, size: (u32, u32)) -> Scene<'m> {
    Scene {
        subject: Subject::mesh(mesh),
        view: view::spherical(camera).unwrap(),
        size,
        backend: Some(Backend::Cpu),
    }
}

fn mesh(name: &str) -> Vec<u8> {
    convert::convert(&generate::named(name).unwrap(), Options::default())
        .unwrap()
        .0
}

/// Stats without what only a board has.
fn timeless(stats: Stats) -> Stats {
    Stats {
        cycles: None,
        clock: None,
        backend: None,
        engine: None,
        ..stats
    }
}

/// Smooth shading, by whoever can: the engine where the gateware has it, else the CPU, which is told.
#[test]
fn smooth_shading_is_the_models_whoever_draws() {
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    let mesh = mesh("icosphere:2");
    for backend in [None, Some(Backend::Cpu)] {
        let scene = Scene {
            subject: Subject::Mesh(MeshSubject {
                bytes: &mesh,
                cull: true,
                shading: Shading::Smooth,
            }),
            backend,
            ..cube_scene(&mesh, "2,30,60", (320, 180))
        };
        let expected = render::on_model(&scene).unwrap();
        let stats = renderer
            .show(&scene, Route::Memory, &mut |_, _| {})
            .unwrap();
        let colour = renderer
            .colour(scene.size, Route::Memory, &mut |_, _| {})
            .unwrap();
        assert!(colour == expected.frame.colour);
        let told = renderer.console().command("stats").unwrap();
        let fallback = "fallback triangle engine: this gateware has no smooth shading";
        let fell_back = told.iter().any(|line| line == fallback);
        let by_cpu = stats.backend.as_deref() == Some("cpu");
        assert_eq!(fell_back, by_cpu && backend.is_none(), "{told:#?}");
        let info = renderer.console().command("info").unwrap();
        assert!(
            info.iter().any(|line| line == "shading smooth"),
            "{info:#?}"
        );
    }
}

#[test]
fn a_field_is_the_models() {
    a_field_by(Backend::Gateware, "gateware");
}

#[test]
#[ignore = "takes minutes: the soft core takes nearly a thousand clocks for a ray, and no picture has fewer than 57,600"]
fn a_field_by_the_cpu_is_the_models() {
    a_field_by(Backend::Cpu, "cpu");
}

/// The first lines of a frame that the soft core draws, read while it goes on: a cube, and a box through it.
#[test]
fn the_cpu_draws_a_mesh_in_a_field() {
    const PIXELS: usize = 2 * 320;
    // Of no colour and no depth.
    const UNTOUCHED: [u8; 4] = 0xA5A5_A5A5_u32.to_le_bytes();
    let mesh = mesh("cube");
    // Downwards, so that both are at the top.
    let eye = r#"{"eye":[0,-6,0],"u":[1,0,0],"v":[0,-0.6,-0.8],"n":[0,0.8,-0.6],"half_width":1.4,"near":0.1}"#;
    let field = FieldSubject {
        field: &Field::parse("box:3,0.2,0.4").unwrap(),
        appearance: &Appearance {
            material: Material::Jade,
            ..Appearance::default()
        },
        stereo: None,
        prepass: false,
    };
    let triangles = MeshSubject {
        bytes: &mesh,
        cull: true,
        shading: Shading::Flat,
    };
    let scene = Scene {
        subject: Subject::Both(triangles, field),
        view: view::parse(eye.as_bytes()).unwrap(),
        size: (320, 180),
        backend: Some(Backend::Cpu),
    };
    let Frame { colour, depth, .. } = render::on_model(&scene).unwrap().frame;
    let mut seen = colour[..PIXELS].to_vec();
    seen.sort_unstable();
    seen.dedup();
    assert!(seen.len() > 2, "the mesh, the field, and what is behind");
    let colours: Vec<u8> = colour.iter().flat_map(|c| c.to_le_bytes()).collect();
    let depths: Vec<u8> = depth.iter().flat_map(|d| d.to_le_bytes()).collect();

    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    renderer
        .upload(&mesh, Route::Memory, &mut |_, _| {})
        .unwrap();
    // The next frame goes where the one before the last went.
    renderer.render().unwrap();
    let console = renderer.console();
    let [frame, depth] = ["frame", "depth"].map(|key| address(console, key));
    console.command("render").unwrap();
    let mut lines = vec![render::view_command(&scene.view), "backend cpu".to_owned()];
    lines.extend(render::field_commands(&field, true));
    let memory = console.board().memory().unwrap();
    for place in [frame, depth] {
        memory
            .write_memory(place, &UNTOUCHED.repeat(PIXELS))
            .unwrap();
    }
    // At once, so that nothing is drawn between them.
    let text: String = lines.iter().map(|line| format!("{line}\r")).collect();
    console.board().write(text.as_bytes()).unwrap();
    for line in &lines {
        console.reply(line).unwrap();
    }
    // All is cleared first, and nothing of what is seen is black.
    let mut waited = 0;
    loop {
        let drawn = read(console, frame, 2 * PIXELS);
        let last: [u8; 2] = *drawn.last_chunk().unwrap();
        if last != [0; 2] && last != [UNTOUCHED[0], UNTOUCHED[1]] {
            break;
        }
        waited += 1;
        assert!(waited < 200, "the frame is not drawn");
        console.board().read(&mut Vec::new(), 1).unwrap();
    }
    // The depth of the last one may be on its way.
    let before = PIXELS - 1;
    assert!(read(console, frame, 2 * before) == colours[..2 * before]);
    assert!(read(console, depth, 4 * before) == depths[..4 * before]);
}

fn read(console: &mut Console<SimulatedBoard>, place: u32, bytes: usize) -> Vec<u8> {
    let mut found = vec![0; bytes];
    let memory = console.board().memory().unwrap();
    memory.read_memory(place, &mut found).unwrap();
    found
}

/// A small field far away.
fn a_field_by(backend: Backend, name: &str) {
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    let eye =
        r#"{"eye":[0,-20,0],"u":[1,0,0],"v":[0,0,-1],"n":[0,1,0],"half_width":0.3,"near":0.1}"#;
    let scene = Scene {
        subject: Subject::Field(FieldSubject {
            field: &Field::parse("box:0.5,0.5,0.25").unwrap(),
            appearance: &Appearance::default(),
            stereo: None,
            prepass: false,
        }),
        view: view::parse(eye.as_bytes()).unwrap(),
        size: (320, 180),
        backend: Some(backend),
    };
    let expected = render::on_model(&scene).unwrap();
    let stats = renderer
        .show(&scene, Route::Memory, &mut |_, _| {})
        .unwrap();
    println!("{:?} cycles", stats.cycles);
    assert_eq!(stats.backend.as_deref(), Some(name));
    assert_eq!(timeless(stats), expected.stats);
    let colour = renderer
        .colour(scene.size, Route::Memory, &mut |_, _| {})
        .unwrap();
    assert!(colour == expected.frame.colour);
    let depth = renderer
        .depth(scene.size, Route::Memory, &mut |_, _| {})
        .unwrap();
    assert!(depth == expected.frame.depth);

    let shown = renderer.console().command("info scene").unwrap();
    assert_eq!(shown, ["scene box:0.5,0.5,0.25"]);
    // The mesh comes back, and refuses to be seen from so far.
    renderer.console().command("field off").unwrap();
    let error = renderer.render().unwrap_err().to_string();
    assert!(
        error.contains("expected within 8 of the origin for a mesh"),
        "{error}"
    );
    renderer.console().command("camera 2 30 60").unwrap();
    assert_eq!(renderer.render().unwrap().triangles().triangles_in, 12);
}

/// Renders a model from three places, one of them inside it, on the board and compares with the model: the monitor's
/// picture, the depth buffer, the counts.
fn the_monitor_shows_what_the_model_renders(name: &str) {
    let size = (320, 180);
    let outside = |camera: &str| (view::spherical(camera).unwrap(), true);
    let inside = r#"{"eye":[0.21,-0.1,0.05],"u":[0.6,0.8,0],"v":[0,0,-1],"n":[-0.8,0.6,0],"half_width":1.5,"near":0.3}"#;
    let inside: View = view::parse(inside.as_bytes()).unwrap();
    // From inside most of a mesh shows its back faces.
    let cameras = [outside("2,30,60"), outside("2.5,200,130"), (inside, false)];

    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    let mesh = mesh(name);
    for (number, &(view, cull)) in cameras.iter().enumerate() {
        let scene = Scene {
            subject: Subject::Mesh(MeshSubject {
                bytes: &mesh,
                cull,
                shading: Shading::Flat,
            }),
            view,
            size,
            backend: Some(Backend::Cpu),
        };
        let expected = render::on_model(&scene).unwrap();
        let stats = renderer
            .show(&scene, Route::Memory, &mut |_, _| {})
            .unwrap();
        assert_eq!(timeless(stats), expected.stats, "camera {number}");
        assert!(
            number < 2 || expected.stats.triangles().triangles_clipped > 0,
            "nothing was clipped"
        );
        assert!(
            captured(&mut renderer, 4) == expected.frame.colour,
            "camera {number}: the monitor's picture"
        );
        let depth = renderer.depth(size, Route::Memory, &mut |_, _| {}).unwrap();
        assert!(depth == expected.frame.depth, "camera {number}: the depths");
    }
    assert_eq!(renderer.board().inner().monitor().errors(), []);
}

#[test]
fn the_monitor_shows_the_cube() {
    the_monitor_shows_what_the_model_renders("cube");
}

#[test]
fn the_monitor_shows_the_icosphere() {
    the_monitor_shows_what_the_model_renders("icosphere:4");
}

#[test]
fn the_monitor_shows_the_sponge() {
    the_monitor_shows_what_the_model_renders("sponge:1");
}

#[test]
fn the_monitor_shows_the_larger_sizes() {
    let mesh = mesh("cube");
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    for (size, scale) in [((640, 360), 2), ((1280, 720), 1)] {
        let scene = cube_scene(&mesh, "2,30,60", size);
        renderer
            .show(&scene, Route::Memory, &mut |_, _| {})
            .unwrap();
        let expected = render::on_model(&scene).unwrap().frame;
        assert!(
            captured(&mut renderer, scale) == expected.colour,
            "{size:?}"
        );
    }
}

/// While the firmware draws one frame the monitor shows another: every picture is one or the other, never a part of each.
#[test]
fn no_frame_is_torn() {
    let mesh = mesh("cube");
    let mut board = running_board();
    let mut renderer = renderer(&mut board);
    let [old, new] = ["2,30,60", "2,200,100"].map(|camera| cube_scene(&mesh, camera, (320, 180)));
    renderer.show(&old, Route::Memory, &mut |_, _| {}).unwrap();
    let [old, new] = [old, new].map(|scene| {
        let frame = render::on_model(&scene).unwrap().frame;
        frame.colour
    });
    renderer.board().inner().monitor().turn_on();
    assert!(captured(&mut renderer, 4) == old);
    renderer.board().write(b"camera 2 200 100\r").unwrap();
    let mut shown = 0;
    while captured_is(&mut renderer, &old, &new) {
        shown += 1;
        assert!(shown < 20, "the new frame does not come");
    }
    assert!(shown > 0, "the frame changed before it can have been drawn");
}

/// Whether the monitor's next picture is the old one. It must be the new one otherwise.
fn captured_is(renderer: &mut Renderer<SimulatedBoard>, old: &[u16], new: &[u16]) -> bool {
    let shown = captured(renderer, 4);
    assert!(shown == old || shown == new, "a torn frame");
    shown == old
}

/// What the monitor shows, scaled back. The timing must be right.
fn captured(renderer: &mut Renderer<SimulatedBoard>, scale: usize) -> Vec<u16> {
    let board = renderer.board().inner();
    let picture = board.capture().unwrap();
    assert_eq!(board.monitor().errors(), []);
    picture.scaled_back(scale).unwrap()
}

/// A line that drops, flips and repeats a byte in a hundred, in both directions.
struct BadLine<'b> {
    board: &'b mut dyn Board,
    random: u64,
    hit: u32,
}

impl BadLine<'_> {
    fn pass(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut passed = Vec::with_capacity(bytes.len());
        for &byte in bytes {
            self.random = self
                .random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let draw = (self.random >> 33) % 300;
            self.hit += u32::from(draw < 3);
            match draw {
                0 => {}
                1 => passed.push(byte ^ 1 << (self.random >> 61)),
                2 => passed.extend([byte, byte]),
                _ => passed.push(byte),
            }
        }
        passed
    }
}

impl Board for BadLine<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        let bytes = self.pass(bytes);
        self.board.write(&bytes)
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        let mut read = Vec::new();
        self.board.read(&mut read, wait_ms)?;
        bytes.extend(self.pass(&read));
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.board.now_ms()
    }
}

#[test]
fn an_upload_over_a_bad_line_arrives_bit_for_bit() {
    let mesh = mesh("icosphere:4");
    let Manifest { length, crc32 } = Manifest::of(&mesh);
    let mut board = running_board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    let staging = address(&mut console, "staging");
    let command = format!("load {length} {crc32:08x}");
    assert!(console.command_with_transfer(&command).unwrap());
    {
        let (board, pending) = console.line();
        let mut line = BadLine {
            board,
            random: 1,
            hit: 0,
        };
        transfer::send(&mut line, pending, &mesh, 1, &mut |_, _| {}).unwrap();
        assert!(line.hit > 100, "{} bytes were hit", line.hit);
    }
    console.reply(&command).unwrap();
    assert_eq!(info::<String>(&mut console, "scene"), "model");
    let mut arrived = vec![0; mesh.len()];
    console
        .board()
        .memory()
        .unwrap()
        .read_memory(staging, &mut arrived)
        .unwrap();
    assert!(arrived == mesh);
}

/// The first word of a line of `info`.
fn info<T: std::str::FromStr>(console: &mut Console<SimulatedBoard>, key: &str) -> T {
    let lines = console.command(&format!("info {key}")).unwrap();
    let short: Vec<String> = lines
        .iter()
        .map(|line| line.split(' ').take(2).collect::<Vec<_>>().join(" "))
        .collect();
    value("info", &short, key).unwrap()
}

/// The bytes of the frame that shows the scene, 320×180 pixels.
fn frame(console: &mut Console<SimulatedBoard>) -> Vec<u8> {
    console.command("render").unwrap();
    let address = address(console, "frame");
    let mut bytes = vec![0; 2 * 320 * 180];
    let memory = console.board().memory().unwrap();
    memory.read_memory(address, &mut bytes).unwrap();
    bytes
}

/// A line of `info` that is an address.
fn address(console: &mut Console<SimulatedBoard>, key: &str) -> u32 {
    let word: String = info(console, key);
    u32::from_str_radix(word.trim_start_matches("0x"), 16).unwrap()
}

#[test]
fn a_bad_upload_leaves_the_old_model() {
    let (good, other) = (mesh("cube"), mesh("icosphere:1"));
    let mut board = running_board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    let quiet: &mut transfer::Progress = &mut |_, _| {};
    transfer::upload(&mut console, &good, 1, quiet).unwrap();
    let shown = frame(&mut console);

    // Another mesh than was announced.
    let Manifest { length, crc32 } = Manifest::of(&good);
    let command = format!("load {length} {:08x}", !crc32);
    assert!(console.command_with_transfer(&command).unwrap());
    let (line, pending) = console.line();
    let refused = transfer::send(line, pending, &other, 2, quiet).unwrap_err();
    assert!(
        matches!(
            refused,
            TransferError::Failed(Failure::AbortedByPeer(Reason::Unannounced))
        ),
        "{refused}"
    );
    assert!(matches!(
        console.reply(&command),
        Err(ConsoleError::Refused { .. })
    ));

    // Bytes that arrive well and are no mesh: a chunk without end, an index to a vertex that is not there.
    let last_triangle = other.len() - 16;
    for (number, at) in [(3, 40), (4, last_triangle + 1)] {
        let mut damaged = other.clone();
        damaged[at] ^= 0x80;
        let refused = transfer::upload(&mut console, &damaged, number, quiet)
            .unwrap_err()
            .to_string();
        assert!(refused.contains("not a mesh"), "byte {at}: {refused}");
    }
    assert_eq!(info::<u32>(&mut console, "triangles"), 12);
    assert!(frame(&mut console) == shown);

    // And the line is as good as before.
    transfer::upload(&mut console, &other, 5, quiet).unwrap();
    assert_eq!(info::<u32>(&mut console, "triangles"), 20);
    assert!(frame(&mut console) != shown);
}

/// Shows the cube by way of the line alone, and says what it looks like.
fn shown_over_the_line(board: &mut SimulatedBoard) -> (Renderer<'_, SimulatedBoard>, Frame) {
    let mesh = mesh("cube");
    let scene = cube_scene(&mesh, "3,10,80", (320, 180));
    let mut renderer = renderer(board);
    renderer
        .show(&scene, Route::Serial, &mut |_, _| {})
        .unwrap();
    (renderer, render::on_model(&scene).unwrap().frame)
}

#[test]
fn colours_come_over_the_line() {
    let mut board = running_board();
    let (mut renderer, expected) = shown_over_the_line(&mut board);
    let colour = renderer
        .colour((320, 180), Route::Serial, &mut |_, _| {})
        .unwrap();
    assert!(colour == expected.colour);
}

#[test]
fn depths_come_over_the_line() {
    let mut board = running_board();
    let (mut renderer, expected) = shown_over_the_line(&mut board);
    let depth = renderer
        .depth((320, 180), Route::Serial, &mut |_, _| {})
        .unwrap();
    assert!(depth == expected.depth);
}

/// A log with everything in it: rests, tumbling, coning, the ends of both ranges, knocks, stamps that jitter, stand still and go back, and
/// a gap.
fn eventful_log(samples: usize) -> Vec<Entry> {
    let mut random = 1_u64;
    let mut draw = move |below: u64| {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (random >> 33) % below
    };
    let mut t_us = 4_294_000_000;
    let entry = |i: usize| {
        let time = i as f64 * 0.002;
        let wave = |amplitude: f64, hertz: f64, phase: f64| {
            (amplitude * (std::f64::consts::TAU * (hertz * time + phase)).sin()) as i16
        };
        let mut noise = || draw(5) as i16 - 2;
        let [mut gyro, mut accel] = [[20, -7, 3], [-90, 40, 4_080]].map(|v| v.map(|x| x + noise()));
        match i / 500 % 4 {
            1 => {
                gyro = [
                    wave(9_000.0, 1.1, 0.0),
                    wave(12_000.0, 0.7, 0.2),
                    wave(7_000.0, 1.7, 0.4),
                ]
            }
            2 => gyro = [wave(5_000.0, 9.0, 0.0), wave(5_000.0, 9.0, 0.25), 600],
            3 => {
                gyro = [wave(60_000.0, 0.9, 0.0), 3_000, wave(60_000.0, 2.0, 0.3)];
                accel = [
                    wave(9_000.0, 1.0, 0.1),
                    wave(5_000.0, 2.0, 0.0),
                    wave(40_000.0, 0.5, 0.0),
                ];
            }
            _ => {}
        }
        t_us += match draw(40) {
            0 if i > 500 => 0,
            1 => 6_000 + draw(30_000),
            2..10 => 1_000 + draw(2_000),
            _ => 2_000,
        };
        if i == 3_700 {
            t_us += 700_000;
        }
        Entry {
            line: i + 2,
            t_us: if i % 997 == 400 { t_us - 3_000 } else { t_us },
            accel,
            gyro,
            temp: None,
        }
    };
    (0..samples).map(entry).collect()
}

const EVERYTHING: ReplayOptions = ReplayOptions {
    units: Units::MPU_6050,
    period: None,
    still: Some(900_000),
    tilt: true,
    follow_bias: true,
};

const MOVING: ReplayOptions = ReplayOptions {
    still: None,
    ..EVERYTHING
};

/// What the model makes of the log, and the board over a route. The attitudes must be the same.
fn replayed_by_both(entries: &[Entry], options: &ReplayOptions, route: Route) -> [Replayed; 2] {
    let prepared = replay::prepare(entries, options).unwrap();
    let mut board = running_board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    let mut told = 0;
    let by_board = replay::on_board(&prepared, &mut console, route, &mut |stage, done, _| {
        told = if stage == Stage::Replay { done } else { told };
    });
    let by_board = by_board.unwrap();
    assert_eq!(told > 0, entries.len() > 2_048, "{told} were told of");
    let by_model = replay::on_model(prepared).unwrap();
    assert_eq!(by_board.counts, by_model.counts);
    assert_eq!(by_board.attitudes.len(), entries.len());
    assert!(by_board.attitudes == by_model.attitudes);
    [by_model, by_board]
}

#[test]
fn attitudes_of_a_log_are_the_models() {
    let entries = eventful_log(5_000);
    let [_, board] = replayed_by_both(&entries, &EVERYTHING, Route::Memory);
    let Counts {
        steps,
        stale,
        gaps,
        saturated,
        rejected,
    } = board.counts;
    println!("{:?}, {:?} cycles a sample", board.counts, board.cycles);
    // Nothing is left out.
    assert!([stale, saturated, rejected].iter().all(|&count| count > 50));
    assert!(steps > 4_000 && gaps == 1);
}

#[test]
fn attitudes_of_a_log_come_over_the_line() {
    let entries = eventful_log(600);
    let options = ReplayOptions {
        tilt: false,
        follow_bias: false,
        ..MOVING
    };
    replayed_by_both(&entries, &options, Route::Serial);
}

#[test]
fn a_bad_log_is_refused_and_no_attitudes_are_left() {
    let prepared = replay::prepare(&eventful_log(70), &MOVING).unwrap();
    let mut board = running_board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    let quiet: &mut dyn FnMut(Stage, u64, u64) = &mut |_, _, _| {};
    replay::on_board(&prepared, &mut console, Route::Memory, quiet).unwrap();
    let mesh = mesh("cube");
    let refused = transfer::upload_for(
        &mut console,
        "replay",
        &mesh,
        1,
        &mut |_, _| {},
        &mut |_| {},
    );
    let refused = refused.unwrap_err().to_string();
    assert!(
        refused.contains("replay: log: expected \"GIMU\" at the start"),
        "{refused}"
    );
    let refused = console.command("replay").unwrap_err().to_string();
    assert!(
        refused.contains("expected an upload of a log before"),
        "{refused}"
    );
}
