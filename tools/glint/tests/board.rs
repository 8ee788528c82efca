//! The whole machine: the virtual board, its firmware, and this crate's side of the line.
//!
//! Needs what `cargo xtask gateware` and `cargo xtask firmware` build; `cargo xtask test` sees to it.

use glint::board::{Board, BoardError, SimulatedBoard, built_firmware};
use glint::console::{Console, ConsoleError, value};
use glint::convert::{self, Options};
use glint::render::{self, Renderer, Route, Scene, Stats};
use glint::transfer::{self, TransferError};
use glint::{flash, generate, view};
use glint_core::camera::View;
use glint_core::console::Backend;
use glint_core::wire::{Failure, Manifest, Reason};

/// The board's time after which a silent firmware has failed.
const PATIENCE_MS: u64 = 2000;
const MAIN_RAM: u32 = 0x4000_0000;

fn running_board() -> SimulatedBoard {
    SimulatedBoard::fast(&built_firmware(None).unwrap()).unwrap()
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
        ..stats
    }
}

/// Renders three models from three places on the board and compares with the model: the monitor's picture, the depth
/// buffer, the counts.
#[test]
fn the_monitor_shows_what_the_model_renders() {
    let size = (320, 180);
    let outside = |camera: &str| (view::spherical(camera).unwrap(), true);
    let inside = r#"{"eye":[0.21,-0.1,0.05],"u":[0.6,0.8,0],"v":[0,0,-1],"n":[-0.8,0.6,0],"half_width":1.5,"near":0.3}"#;
    let inside: View = view::parse(inside.as_bytes()).unwrap();
    // From inside most of a mesh shows its back faces.
    let cameras = [outside("2,30,60"), outside("2.5,200,130"), (inside, false)];

    let mut board = running_board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    let mut renderer = Renderer::new(console);
    for name in ["cube", "icosphere:4", "sponge:1"] {
        let mesh = mesh(name);
        for (number, &(view, cull)) in cameras.iter().enumerate() {
            let scene = Scene {
                mesh: &mesh,
                view,
                size,
                cull,
                backend: Backend::Cpu,
            };
            let expected = render::on_model(&scene).unwrap();
            let stats = renderer
                .show(&scene, Route::Memory, &mut |_, _| {})
                .unwrap();
            assert_eq!(timeless(stats), expected.stats, "{name}, camera {number}");
            assert!(
                number < 2 || expected.stats.triangles_clipped > 0,
                "{name}: nothing was clipped"
            );
            let shown = renderer
                .board()
                .inner()
                .capture()
                .unwrap()
                .scaled_back(4)
                .unwrap();
            assert!(
                shown == expected.frame.colour,
                "{name}, camera {number}: the monitor's picture"
            );
            let depth = renderer.depth(size, Route::Memory, &mut |_, _| {}).unwrap();
            assert!(
                depth == expected.frame.depth,
                "{name}, camera {number}: the depths"
            );
        }
    }
    assert_eq!(renderer.board().inner().monitor().error_count(), 0);
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
    let staging: String = info(&mut console, "staging");
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
    let address = u32::from_str_radix(staging.trim_start_matches("0x"), 16).unwrap();
    let mut arrived = vec![0; mesh.len()];
    console
        .board()
        .memory()
        .unwrap()
        .read_memory(address, &mut arrived)
        .unwrap();
    assert!(arrived == mesh);
}

/// The first word of a line of `info`.
fn info<T: std::str::FromStr>(console: &mut Console<SimulatedBoard>, key: &str) -> T {
    let lines = console.command("info").unwrap();
    let short: Vec<String> = lines
        .iter()
        .map(|line| line.split(' ').take(2).collect::<Vec<_>>().join(" "))
        .collect();
    value("info", &short, key).unwrap()
}

#[test]
fn a_bad_upload_leaves_the_old_model() {
    let (good, other) = (mesh("cube"), mesh("icosphere:1"));
    let mut board = running_board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    let quiet: &mut transfer::Progress = &mut |_, _| {};
    transfer::upload(&mut console, &good, 1, quiet).unwrap();

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

    // Bytes that arrive well and are no mesh.
    let mut damaged = other.clone();
    damaged[40] ^= 0x80;
    let refused = transfer::upload(&mut console, &damaged, 3, quiet)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("not a mesh"), "{refused}");
    assert_eq!(info::<u32>(&mut console, "triangles"), 12);

    // And the line is as good as before.
    transfer::upload(&mut console, &other, 4, quiet).unwrap();
    assert_eq!(info::<u32>(&mut console, "triangles"), 20);
}

#[test]
fn pictures_come_over_the_line() {
    let mesh = mesh("cube");
    let mut board = running_board();
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    let mut renderer = Renderer::new(console);
    let view = view::spherical("3,10,80").unwrap();
    let scene = Scene {
        mesh: &mesh,
        view,
        size: (320, 180),
        cull: true,
        backend: Backend::Cpu,
    };
    renderer
        .show(&scene, Route::Serial, &mut |_, _| {})
        .unwrap();
    let expected = render::on_model(&scene).unwrap().frame;
    assert!(
        renderer
            .colour(scene.size, Route::Serial, &mut |_, _| {})
            .unwrap()
            == expected.colour
    );
}

#[test]
fn the_flash_command_boots_through_the_bios() {
    let firmware = built_firmware(None).unwrap();
    let mut board = SimulatedBoard::full().unwrap();
    let report =
        flash::flash(&mut board, &firmware, MAIN_RAM, PATIENCE_MS, &mut |_, _| {}).unwrap();
    assert_eq!(
        report.retries, 0,
        "the line of the virtual board loses nothing"
    );
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.hear(&report.said);
    let banner = console.greet().unwrap();
    assert!(
        banner.contains("Liftoff") && banner.contains("Glint"),
        "{banner}"
    );
    assert_eq!(
        info::<String>(&mut console, "firmware_id"),
        info::<String>(&mut console, "gateware_id")
    );
}
