//! Compares the whole SoC, including its triangle engine, with glint-model: the pictures on the monitor, the depths in
//! memory, and the counts of triangles.
//!
//! The tests require the builds of `cargo xtask gateware` and `cargo xtask firmware`, which `cargo
//! xtask test` makes.
//!
//! The board draws a frame while the monitor captures the previous frame, so each watched scene takes the
//! time of one video frame, whose simulation takes longer than that of the drawing. The first scenes of each size are watched; the
//! frames of the others are compared in memory. In the chart, `d` stands for draw:
//!
//! ```text
//! video   |      nothing      |   scene 0   |   scene 1   |   scene 2 ...
//! board     load 0, draw 0      load 1, d 1   load 2, d 2   load 3, d 3
//! ```

mod fields;
mod objects;

use super::common::{counts, info, mesh, plain, running_board};
use glint::board::Uart;
use glint::board::{Board, BoardError, Memory, SimulatedBoard};
use glint::console::Console;
use glint::render::{
    self, BoardRenderer, Frame, MeshSubject, Parts, Rendered, Route, Stats, Subject, on_model,
};
use glint::transfer::stage;
use glint::view;
use glint_core::picture::{Samples, Size};
use glint_core::wire::Manifest;
use glint_vectors::meshes;
use glint_vectors::scenes::Scene;
use rand_pcg::Pcg64Mcg;

/// Longest accepted pause in the firmware's output, in the board's time.
const PATIENCE_MS: u64 = 2000;

/// Longest wait for a picture: the time of three video frames.
const MAX_WAIT_MS: u64 = 50;

/// A board whose pictures are compared with an expected sequence.
struct Watched {
    board: SimulatedBoard,
    /// Factor by which scan-out enlarges a frame to the picture.
    scale: usize,
    /// Names and pixels of the expected frames, in order; the first frame is black.
    expected: Vec<(String, Vec<u16>)>,
    /// Number of expected frames that the monitor has shown.
    seen: usize,
    /// Number of compared pictures.
    pictures: u64,
}

impl Watched {
    /// Appends a frame to the expected frames.
    fn expect(&mut self, name: &str, frame: Vec<u16>) {
        match self.expected.last_mut() {
            // Equal consecutive frames cannot be distinguished on the monitor, so they count as
            // one.
            Some((last, old)) if *old == frame => name.clone_into(last),
            _ => self.expected.push((name.to_owned(), frame)),
        }
    }

    /// Takes a new picture, if any, and checks that it equals the current or the next expected
    /// frame, not a mixture of both.
    fn look(&mut self) {
        let Some(picture) = self.board.inner().monitor().take_picture() else {
            return;
        };
        self.pictures += 1;
        let frame = picture.scaled_back(self.scale).unwrap();
        let next = &self.expected[self.seen - 1..];
        let Some(at) = next.iter().take(2).position(|(_, wanted)| *wanted == frame) else {
            let (name, wanted) = next.get(1).unwrap_or(&next[0]);
            let at = (0..frame.len()).find(|&i| frame[i] != wanted[i]);
            let (at, width) = (at.unwrap_or_default(), 1280 / self.scale);
            panic!(
                "{name}: the monitor shows {:#06x} at {}, {}, expected {:#06x}, or all of the frame before",
                frame[at],
                at % width,
                at / width,
                wanted[at]
            );
        };
        self.seen += at;
    }

    /// Runs the board until the monitor has shown all expected frames.
    fn see(&mut self) {
        self.run_until(|board| board.seen == board.expected.len());
    }

    /// Runs the board until the next picture of the monitor is complete.
    fn wait_for_picture(&mut self) {
        let before = self.pictures;
        self.run_until(|board| board.pictures > before);
    }

    fn run_until(&mut self, done: impl Fn(&Self) -> bool) {
        for _ in 0..MAX_WAIT_MS {
            if done(self) {
                return;
            }
            self.read(&mut Vec::new(), 1).unwrap();
        }
        let names: Vec<_> = self.expected.iter().map(|(name, _)| name).collect();
        panic!("{} of {names:?} were shown", self.seen);
    }
}

impl Board for Watched {
    fn write(&mut self, bytes: &[u8]) -> Result<(), BoardError> {
        self.board.write(bytes)
    }

    fn read(&mut self, bytes: &mut Vec<u8>, wait_ms: u64) -> Result<(), BoardError> {
        // Polls often enough to capture every picture.
        let (before, end) = (bytes.len(), self.now_ms() + wait_ms);
        while bytes.len() == before && self.now_ms() < end {
            self.board.read(bytes, 1)?;
            self.look();
        }
        Ok(())
    }

    fn now_ms(&self) -> u64 {
        self.board.now_ms()
    }

    fn memory(&mut self) -> Option<&mut dyn Memory> {
        self.board.memory()
    }
}

/// Checks that the pixels of a frame are equal.
fn assert_same<T: PartialEq + std::fmt::Debug>(
    found: &[T],
    expected: &[T],
    what: &str,
    size: Size,
) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let differs = found.iter().zip(expected).position(|(a, b)| a != b);
    if let Some(at) = differs {
        let (x, y) = (at % size.width() as usize, at / size.width() as usize);
        let (found, expected) = (&found[at], &expected[at]);
        panic!("{what} at {x}, {y}: expected {expected:?}, found {found:?}");
    }
}

/// Checks that the gateware has drawn the model's frame: colours, depths if there are some, and counts.
fn compare_frames(name: &str, size: Size, found: &Rendered, expected: &Rendered) {
    let Rendered { image, stats } = found;
    assert_eq!(stats.backend.as_deref(), Some("gateware"), "{name}");
    assert_eq!(counts(stats), counts(&expected.stats), "{name}");
    let colour = format!("{name}: colour");
    assert_same(&image.colour, &expected.image.colour, &colour, size);
    if !image.depth.is_empty() {
        let depth = format!("{name}: depth");
        assert_same(&image.depth, &expected.image.depth, &depth, size);
    }
}

/// Draws a frame by the gateware and by the model, and compares the results. The board has the
/// meshes of the frame under the name `model`. Returns the board's statistics.
fn compare(renderer: &mut BoardRenderer<SimulatedBoard>, frame: &Frame, with_depth: bool) -> Stats {
    let lines = render::commands(frame, "model", |_| "model".to_owned()).unwrap();
    let found = renderer.render_after(&lines, frame.size, parts(with_depth));
    let (found, expected) = (found.unwrap(), on_model(frame).unwrap());
    compare_frames(&lines.join(", "), frame.size, &found, &expected);
    found.stats
}

/// The colours, with the depths or without.
const fn parts(with_depth: bool) -> Parts {
    match with_depth {
        true => Parts::ALL,
        false => Parts::COLOUR,
    }
}

/// Largest size of a small mesh, in bytes.
const SMALL: usize = 256 << 10;

/// Returns the scenes with meshes of at most `SMALL` bytes, and a scene with two small chunks; without `small`, returns the
/// scenes with larger meshes.
fn scenes(small: bool) -> Vec<Scene> {
    let mut scenes = glint_vectors::scenes::scenes(mesh);
    scenes.retain(|(_, mesh, ..)| (mesh.len() <= SMALL) == small);
    if small {
        let triangles = meshes::random(&mut Pcg64Mcg::new(2), 500, 0.1);
        let mesh = meshes::mesh(&triangles, 900);
        scenes.push(("two small chunks", mesh, meshes::ahead(0.8, 0.5), false));
    }
    scenes
}

/// Number of scenes whose pictures on the monitor are compared.
const WATCHED: usize = 3;

/// Draws scenes, and compares the frames with the model's: those of the first scenes on the monitor, and all of them in memory.
fn draw(size: Size, mut scenes: Vec<Scene>) {
    let others = scenes.split_off(scenes.len().min(WATCHED));
    let mut board = Watched {
        board: running_board(),
        scale: (1280 / size.width()) as usize,
        expected: vec![("nothing".to_owned(), vec![0; size.pixel_count()])],
        seen: 1,
        pictures: 0,
    };
    watch(&mut board, size, scenes);
    let mut board = board.board;
    let mut console = Console::new(&mut board);
    console.synchronise().unwrap();
    let mut renderer = BoardRenderer::new(console).with_route(Route::Memory);
    for (name, mesh, view, cull) in others {
        println!("{name}");
        renderer.upload(&mesh, Some("model")).unwrap();
        let subject = Subject::Mesh(MeshSubject {
            cull,
            ..plain(&mesh)
        });
        compare(&mut renderer, &Frame::new(subject, view, size), true);
    }
    let board = renderer.board();
    println!(
        "{size:?}: {} cycles, {:.0} a second",
        board.inner().cycles(),
        board.inner().cycles_per_second()
    );
}

/// Draws scenes while the monitor is on, and compares the pictures on the monitor and the frames in memory with the model's.
fn watch(board: &mut Watched, size: Size, scenes: Vec<Scene>) {
    let mut console = Console::new(board).patience(PATIENCE_MS);
    console.greet().unwrap();
    console.command("backend gateware").unwrap();
    // The monitor captures its first picture in the middle of a video frame, before any frame is shown.
    console.board().board.inner().monitor().turn_on();
    let mut renderer = BoardRenderer::new(console).with_route(Route::Memory);
    let start = [render::size_command(size)];
    let shown = renderer.render_after(&start, size, Parts::COLOUR);
    let shown = shown.unwrap().image.colour;
    renderer.board().expect("the start", shown);
    // The firmware's count of video frames at the time of the last drawn scene.
    let mut drawn: u32 = info(renderer.console(), "video_frames");

    for (name, mesh, view, cull) in scenes {
        // Additional views are drawn without depths, so that the triangle engine writes only the
        // changed part of a frame.
        let others = if name == "a sphere" {
            ["2,60,100", "3,200,60"].map(view::spherical).to_vec()
        } else {
            vec![]
        };
        let views = others.into_iter().map(|view| (view.unwrap(), false));
        for (number, (view, with_depth)) in [(view, true)].into_iter().chain(views).enumerate() {
            let name = format!("{name} {number} at {size}");
            let subject = Subject::Mesh(MeshSubject {
                cull,
                ..plain(&mesh)
            });
            let frame = Frame::new(subject, view, size);
            let expected = on_model(&frame).unwrap();
            let console = renderer.console();
            let mut lines = Vec::new();
            if number == 0 {
                // `load` comes first, because it takes time to check the bytes; the picture follows the other lines quickly. The
                // bytes are already in the staging memory, so `load` finds their CRC-32 correct and skips the transfer.
                let Manifest { length, crc32 } = Manifest::of(&mesh);
                stage(console, &mesh).unwrap();
                lines.push(format!("load {length} {crc32:08x}"));
            }
            lines.extend([
                format!("cull {}", if cull { "on" } else { "off" }),
                render::size_command(size),
                render::samples_command(Samples::One),
                "background 000000".to_owned(),
                render::view_command(&view),
            ]);
            let colour = expected.image.colour.clone();
            console.board().expect(&name, colour);
            let text: String = lines.iter().map(|line| format!("{line}\r")).collect();
            console.board().write(text.as_bytes()).unwrap();
            for line in &lines {
                console.reply(line).unwrap();
            }
            // The monitor must show the last frame before `render` can replace it.
            while info::<u32>(console, "video_frames") == drawn {
                console.board().wait_for_picture();
            }
            let found = renderer.render_after(&[], size, parts(with_depth));
            compare_frames(&name, size, &found.unwrap(), &expected);
            let console = renderer.console();
            drawn = info(console, "video_frames");
            let underflows: u32 = info(console, "video_underflows");
            assert_eq!(underflows, 0, "{name}: late lines");
        }
    }
    let board = renderer.board();
    board.see();
    assert_eq!(board.board.inner().monitor().errors(), []);
}

#[test]
fn the_soc_draws_at_320x180() {
    draw(Size::W320, third(0));
}

/// Returns the sphere, which is drawn in several views, and then every third of the other scenes,
/// starting with number `first`. The tests of the triangle engine without the SoC draw all scenes
/// in all sizes.
fn third(first: usize) -> Vec<Scene> {
    let scenes = scenes(true).into_iter().enumerate();
    let chosen = scenes.filter(|(number, (name, ..))| *name == "a sphere" || number % 3 == first);
    let mut chosen: Vec<_> = chosen.map(|(_, scene)| scene).collect();
    chosen.sort_by_key(|(name, ..)| *name != "a sphere");
    chosen
}

#[test]
fn the_soc_draws_at_640x360() {
    draw(Size::W640, third(1));
}

#[test]
fn the_soc_draws_at_1280x720() {
    draw(Size::W1280, third(2));
}

#[test]
#[ignore = "takes minutes, nearly all of them for the firmware's check of the meshes"]
fn the_soc_draws_large_meshes() {
    draw(Size::W1280, scenes(false));
}
