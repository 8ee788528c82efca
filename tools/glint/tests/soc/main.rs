//! Compares the whole SoC, including its triangle engine, with glint-model: the pictures on the monitor, the depths in
//! memory, and the counts of triangles.
//!
//! The tests require the builds of `cargo xtask gateware` and `cargo xtask firmware`; `cargo xtask test` makes them too.
//!
//! The board draws a frame while the monitor captures the previous frame, so each scene takes the time of one video frame. Video
//! frames take most of the test's time. In the chart, `d` stands for draw:
//!
//! ```text
//! video   |      nothing      |   scene 0   |   scene 1   |   scene 2 ...
//! board     load 0, draw 0      load 1, d 1   load 2, d 2   load 3, d 3
//! ```

mod fields;
mod objects;

use glint::board::{self, Board, BoardError, Memory, SimulatedBoard, built_firmware};
use glint::console::{Console, value};
use glint::render::{self, Frame, MeshSubject, Rendered, Stats, Subject};
use glint::{convert, generate, view};
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_core::wire::Manifest;
use glint_vectors::meshes;
use glint_vectors::scenes::Scene;
use rand_pcg::Pcg64Mcg;

/// Returns the bytes of the generated mesh `name`.
fn generated(name: &str) -> Vec<u8> {
    let model = generate::named(name).expect("a model");
    let converted = convert::convert(&model, convert::Options::default());
    converted.expect("a mesh").0
}

/// Longest accepted pause in the firmware's output, in the board's time.
const PATIENCE_MS: u64 = 2000;

/// Longest wait for a picture: the time of three video frames.
const MOST_WAIT_MS: u64 = 50;

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
            // Equal consecutive frames look like one frame on the monitor.
            Some((last, old)) if *old == frame => name.clone_into(last),
            _ => self.expected.push((name.to_owned(), frame)),
        }
    }

    /// Takes a new picture, if any, and checks that it equals the current or the next expected frame, and never a mix of both.
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
        for _ in 0..MOST_WAIT_MS {
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

/// Lines of the firmware's replies, each with a key and a value.
struct Replies {
    lines: Vec<String>,
}

impl Replies {
    fn text(&self, key: &str) -> String {
        let line = |line: &String| line.starts_with(&format!("{key} "));
        let lines: Vec<String> = self
            .lines
            .iter()
            .filter(|l| line(l))
            .take(1)
            .cloned()
            .collect();
        value("render", &lines, key).unwrap_or_else(|_| panic!("{key} in {:#?}", self.lines))
    }

    fn number(&self, key: &str) -> u32 {
        self.text(key).parse().unwrap()
    }

    fn address(&self, key: &str) -> u32 {
        let text = self.text(key);
        let digits = text.trim_start_matches("0x").split(' ').next().unwrap();
        u32::from_str_radix(digits, 16).unwrap()
    }
}

/// Compares the counts of triangles in the firmware's replies with the model's.
fn compare_triangles(replies: &Replies, name: &str, stats: &Stats) {
    let counts =
        ["in", "culled", "clipped", "drawn"].map(|key| replies.number(&format!("triangles_{key}")));
    let triangles = stats.triangles();
    let expected = [
        triangles.triangles_in,
        triangles.triangles_culled,
        triangles.triangles_clipped,
        triangles.triangles_drawn,
    ];
    assert_eq!(
        counts, expected,
        "{name}: triangles in, culled, clipped, drawn"
    );
}

/// Sends all lines in one write, so that no frame is drawn between them, and collects the replies.
fn send<B: Board>(console: &mut Console<B>, lines: &[String]) -> Replies {
    let text: String = lines.iter().map(|line| format!("{line}\r")).collect();
    console.board().write(text.as_bytes()).unwrap();
    let replies = lines.iter().map(|line| console.reply(line).unwrap());
    Replies {
        lines: replies.flatten().collect(),
    }
}

fn read<B: Board>(console: &mut Console<B>, address: u32, length: usize) -> Vec<u8> {
    let mut bytes = vec![0; length];
    let memory = console.board().memory().unwrap();
    memory.read_memory(address, &mut bytes).unwrap();
    bytes
}

/// Largest size of a small mesh, in bytes.
const SMALL: usize = 256 << 10;

/// Returns the scenes with meshes of at most `SMALL` bytes, and a scene with two small chunks; without `small`, returns the
/// scenes with larger meshes.
fn scenes(small: bool) -> Vec<Scene> {
    let mut scenes = glint_vectors::scenes::scenes(generated);
    scenes.retain(|(_, mesh, ..)| (mesh.len() <= SMALL) == small);
    if small {
        let triangles = meshes::random(&mut Pcg64Mcg::new(2), 500, 0.1);
        let mesh = meshes::mesh(&triangles, 900);
        scenes.push(("two small chunks", mesh, meshes::ahead(0.8, 0.5), false));
    }
    scenes
}

fn draw(size: Size, scenes: Vec<Scene>) {
    let board = board::verilated(&built_firmware(None).unwrap()).unwrap();
    let mut board = Watched {
        board,
        scale: (1280 / size.width()) as usize,
        expected: vec![("nothing".to_owned(), vec![0; size.pixel_count()])],
        seen: 1,
        pictures: 0,
    };
    let mut console = Console::new(&mut board).patience(PATIENCE_MS);
    console.greet().unwrap();
    send(&mut console, &["backend gateware".to_owned()]);
    // The monitor captures its first picture in the middle of a video frame, before any frame is shown.
    console.board().board.inner().monitor().turn_on();
    let start = [&render::size_command(size), "render", "info"];
    let mut replies = send(&mut console, &start.map(str::to_owned));
    let bytes = read(
        &mut console,
        replies.address("frame"),
        2 * size.pixel_count(),
    );
    let pixels = bytes.chunks_exact(2);
    let pixels = pixels.map(|pixel| u16::from_le_bytes([pixel[0], pixel[1]]));
    console.board().expect("the start", pixels.collect());
    // The firmware's count of video frames at the last drawn scene.
    let mut drawn = replies.number("video_frames");

    for (name, mesh, view, cull) in scenes {
        // Further views are drawn without depths, so that the triangle engine writes only the changed part of a frame.
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
                ..MeshSubject::new(Mesh::new_checked(&mesh).unwrap())
            });
            let frame = Frame::new(subject, view, size);
            let Rendered { image, stats } = render::on_model(&frame).unwrap();
            let mut lines = Vec::new();
            if number == 0 {
                // `load` comes first, because it takes time to check the bytes; the picture follows the other lines quickly. The
                // bytes are already in the staging memory, so `load` finds their CRC-32 correct and skips the transfer.
                let Manifest { length, crc32 } = Manifest::of(&mesh);
                let memory = console.board().memory().unwrap();
                memory
                    .write_memory(replies.address("staging"), &mesh)
                    .unwrap();
                lines.push(format!("load {length} {crc32:08x}"));
            }
            lines.extend([
                format!("cull {}", if cull { "on" } else { "off" }),
                render::size_command(size),
                render::view_command(&view),
                "info".to_owned(),
            ]);
            console.board().expect(&name, image.colour);
            replies = send(&mut console, &lines);
            // Waits until the monitor shows the last frame; otherwise `render` would replace it first.
            while replies.number("video_frames") == drawn {
                console.board().wait_for_picture();
                replies = send(&mut console, &["info".to_owned()]);
            }
            let render = format!("render{}", if with_depth { " depth" } else { "" });
            replies = send(&mut console, &[render, "info".to_owned()]);
            drawn = replies.number("video_frames");

            assert_eq!(
                replies.text("backend"),
                "gateware",
                "{name}: {:#?}",
                replies.lines
            );
            compare_triangles(&replies, &name, &stats);
            let place = |at: usize| (at as u32 % size.width(), at as u32 / size.width());
            let bytes = read(
                &mut console,
                replies.address("frame"),
                2 * image.depth.len(),
            );
            let (_, colour) = console.board().expected.last().unwrap();
            for (at, (found, &wanted)) in bytes.chunks_exact(2).zip(colour).enumerate() {
                let found = u16::from_le_bytes([found[0], found[1]]);
                assert_eq!(found, wanted, "{name}: the colour at {:?}", place(at));
            }
            if with_depth {
                let bytes = read(
                    &mut console,
                    replies.address("depth"),
                    4 * image.depth.len(),
                );
                for (at, (found, &wanted)) in bytes.chunks_exact(4).zip(&image.depth).enumerate() {
                    let found = u32::from_le_bytes([found[0], found[1], found[2], found[3]]);
                    assert_eq!(found, wanted, "{name}: the depth at {:?}", place(at));
                }
            }
            assert_eq!(replies.number("video_underflows"), 0, "{name}: late lines");
        }
    }
    let board = console.board();
    board.see();
    assert_eq!(board.board.inner().monitor().errors(), []);
    let board = board.board.inner();
    println!(
        "{size:?}: {} cycles, {:.0} a second",
        board.cycles(),
        board.cycles_per_second()
    );
}

#[test]
fn the_soc_draws_at_320x180() {
    draw(Size::W320, third(0));
}

/// Returns the sphere, which is drawn in several views, and every third of the other scenes, starting with number `first`. The
/// test of the triangle engine alone draws all scenes in all sizes.
fn third(first: usize) -> Vec<Scene> {
    let scenes = scenes(true).into_iter().enumerate();
    let chosen = scenes.filter(|(number, (name, ..))| *name == "a sphere" || number % 3 == first);
    chosen.map(|(_, scene)| scene).collect()
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
#[ignore = "takes minutes, nearly all of them for the firmware's look at the meshes"]
fn the_soc_draws_large_meshes() {
    draw(Size::W1280, scenes(false));
}
