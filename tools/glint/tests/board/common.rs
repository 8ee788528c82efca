//! A board with a console, and helpers that the tests share.

use glint::board::{self, Board, EmulatedBoard, SimulatedBoard, Simulation, built_firmware};
use glint::console::{Console, value};
use glint::convert::{self, Options};
use glint::counters::Counters;
use glint::render::{
    self, BoardRenderer, Frame, MeshSubject, Parts, Rendered, Route, Stats, Subject, TriangleCounts,
};
use glint::{generate, view};
use glint_core::colour::Shading;
use glint_core::light::{Background, Gradient};
use glint_core::mesh::Mesh;
use glint_core::object::Place;
use glint_core::picture::Size;
use glint_core::wire::{MAX_FRAME, Manifest, Sender, Timing};
use glint_core::words::Words;
use glint_model::{Object, Placement};
use std::io::Write;
use std::process::{Command, Output, Stdio};

/// Milliseconds of the board's time without output after which the firmware counts as failed.
const PATIENCE_MS: u64 = 4000;

/// A virtual board that starts with the built firmware in its memory.
pub fn running_board() -> SimulatedBoard {
    board::verilated(&built_firmware(None).unwrap()).unwrap()
}

/// An emulated board that starts with the built firmware in its memory.
pub fn emulator() -> SimulatedBoard<EmulatedBoard> {
    board::emulated(&built_firmware(None).unwrap()).unwrap()
}

/// Like [`emulator`], with the best shading of the gateware set to `capability`, and without
/// textures.
pub fn emulator_with(capability: Shading) -> SimulatedBoard<EmulatedBoard> {
    let mut board = emulator();
    board.inner().state_shading(capability);
    board.inner().state_textures(false);
    board
}

/// The console of a newly started board.
pub fn console<S: Simulation>(board: &mut SimulatedBoard<S>) -> Console<'_, SimulatedBoard<S>> {
    let mut console = Console::new(board).patience(PATIENCE_MS);
    console.greet().unwrap();
    console
}

/// The console of a newly started board that draws small pictures with one sample a pixel.
pub fn small<S: Simulation>(board: &mut SimulatedBoard<S>) -> Console<'_, SimulatedBoard<S>> {
    let mut console = console(board);
    console.command("size 320 180").unwrap();
    console.command("aa 1").unwrap();
    console
}

/// A renderer on a newly started board, with direct access to its memory.
pub fn renderer<S: Simulation>(
    board: &mut SimulatedBoard<S>,
) -> BoardRenderer<'_, SimulatedBoard<S>> {
    BoardRenderer::new(console(board)).with_route(Route::Memory)
}

/// Draws a frame on a board and by the model, and checks that colours and depths are equal. Returns the board's and the model's
/// result.
pub fn drawn_alike<B: Board>(
    renderer: &mut BoardRenderer<B>,
    frame: &Frame,
    name: &str,
) -> [Rendered; 2] {
    let expected = render::on_model(frame).unwrap();
    let found = renderer.render(frame, Parts::ALL).unwrap();
    assert!(
        found.image.colour == expected.image.colour,
        "{name}: colours"
    );
    assert!(found.image.depth == expected.image.depth, "{name}: depths");
    [found, expected]
}

/// The counts that both the model and boards provide.
pub fn counts(stats: &Stats) -> impl PartialEq + std::fmt::Debug {
    let mesh = stats.mesh.clone().map(|mesh| TriangleCounts {
        pixels_tested: None,
        ..mesh
    });
    let others = (stats.wireframe.clone(), stats.edges.clone());
    (mesh, stats.rays.clone(), others)
}

/// The colours of the sky behind meshes.
pub fn sky() -> Gradient {
    Background::Sky.gradient().unwrap()
}

/// The subject that shows a mesh with default options.
pub fn plain(mesh: &[u8]) -> MeshSubject<'_> {
    MeshSubject::new(Mesh::new_checked(mesh).unwrap())
}

/// An object with a mesh and a placement.
pub fn object<'m>(mesh: &'m [u8], place: &str) -> Object<'m> {
    let place = Place::parse(&mut Words::new(place)).unwrap();
    Object {
        subject: plain(mesh),
        placement: Placement::new(place.matrix),
        colour: place.colour,
    }
}

/// Two overlapping objects of a mesh; one of them is mirrored and coloured.
pub fn two_objects(mesh: &[u8]) -> [Object<'_>; 2] {
    [
        "scale 0.7 rotate x 20 rotate z 50 move -0.4,0.2,-0.1",
        "scale 0.5,0.5,-1 move 0.5,0.3,0.2 colour 30c0ff",
    ]
    .map(|place| object(mesh, place))
}

/// Runs a program to its end with a text on its standard input.
pub fn piped(program: &mut Command, input: &str) -> Output {
    let mut child = program
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    stdin.write_all(input.as_bytes()).unwrap();
    drop(stdin);
    child.wait_with_output().unwrap()
}

/// Reads bytes of a board's memory.
pub fn read(console: &mut Console<impl Board>, address: u32, length: usize) -> Vec<u8> {
    let mut bytes = vec![0; length];
    let memory = console.board().memory().unwrap();
    memory.read_memory(address, &mut bytes).unwrap();
    bytes
}

/// A frame of a mesh from the camera `R,THETA,PHI`.
pub fn mesh_frame<'m>(mesh: &'m [u8], camera: &str, size: Size) -> Frame<'m> {
    let mesh = Mesh::new_checked(mesh).unwrap();
    Frame::new(Subject::mesh(mesh), view::spherical(camera).unwrap(), size)
}

/// Begins an upload, and stops in the middle of a frame of the transfer, like a killed program.
pub fn begin_upload<B: Board>(console: &mut Console<B>, mesh: &[u8]) {
    let Manifest { length, crc32 } = Manifest::of(mesh);
    let command = format!("load {length} {crc32:08x}");
    console
        .command_with_transfer(&command, &mut |_| {})
        .unwrap();
    let (board, pending) = console.line();
    let mut frame = [0; MAX_FRAME];
    let mut sender = Sender::new(mesh, 1, Timing::HOST, board.now_ms());
    while sender.progress().0 < 1_000 {
        let now = board.now_ms();
        let taken = sender.on_bytes(now, pending);
        pending.drain(..taken);
        loop {
            let length = sender.poll(now, &mut frame);
            if length == 0 {
                break;
            }
            board.write(&frame[..length]).unwrap();
        }
        board.read(pending, 1).unwrap();
    }
    let length = sender.poll(board.now_ms(), &mut frame);
    board.write(&frame[..length / 2]).unwrap();
}

/// A generated mesh, converted to the board's memory layout.
pub fn mesh(name: &str) -> Vec<u8> {
    convert::convert(&generate::named(name).unwrap(), Options::default())
        .unwrap()
        .0
}

/// Removes cycles, clock, backend and engine counters from statistics, because the model does not
/// provide them.
pub fn timeless(stats: Stats) -> Stats {
    Stats {
        cycles: None,
        clock: None,
        backend: None,
        engine: Counters::default(),
        ..stats
    }
}

/// Checks that a text contains another text.
#[track_caller]
pub fn assert_has(text: &str, part: &str) {
    assert!(text.contains(part), "expected {part}, found {text}");
}

/// The first word of the value that `info` prints for `key`.
pub fn info<T: std::str::FromStr>(console: &mut Console<impl Board>, key: &str) -> T {
    let lines = console.command(&format!("info {key}")).unwrap();
    let short: Vec<String> = lines
        .iter()
        .map(|line| line.split(' ').take(2).collect::<Vec<_>>().join(" "))
        .collect();
    value("info", &short, key).unwrap()
}

/// The address that `info` prints for `key`.
pub fn address(console: &mut Console<impl Board>, key: &str) -> u32 {
    let word: String = info(console, key);
    u32::from_str_radix(word.trim_start_matches("0x"), 16).unwrap()
}
