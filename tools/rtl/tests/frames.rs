//! Whole frames: the raster unit draws from memory what glint-model draws.

use glint::{convert, generate, view};
use glint_core::camera::View;
use glint_core::mesh::Mesh;
use glint_model::descriptor::{Descriptor, band_rows};
use glint_model::setup::{Bounds, Oriented, Setup};
use glint_model::{DrawnTriangle, Options, Projected, Target, trace};
use glint_rtl::{Bits, Memory, Module, ReadPort, Stalls, WritePort};

const SIZES: [(u32, u32); 3] = glint_model::SIZES;

// Where things are in memory, by words of 16 bytes.
const FRAME: u32 = 0;
const DEPTH: u32 = 0x2_0000;
const LISTS: [u32; 2] = [0x8_0000, 0xc_0000];
const DESCRIPTORS: [u32; 2] = [0x10_0000, 0x14_0000];
const WORDS: usize = 0x18_0000;
/// Words of a list, as a power of two.
const LIST_SHIFT: u32 = 11;

/// What the model draws.
struct Expected {
    size: (u32, u32),
    colour: Vec<u16>,
    depth: Vec<u32>,
    drawn: Vec<DrawnTriangle>,
    pixels_covered: u64,
}

fn expected(mesh: &Mesh, view: &View, size: (u32, u32), cull: bool) -> Expected {
    let pixels = (size.0 * size.1) as usize;
    let (mut colour, mut depth) = (vec![0; pixels], vec![0; pixels]);
    let vertices = mesh.chunks().map(|chunk| chunk.vertex_count()).max();
    let mut scratch = vec![Projected::Behind; vertices.unwrap_or(0)];
    let mut target = Target {
        width: size.0,
        height: size.1,
        colour: &mut colour,
        depth: &mut depth,
    };
    let options = Options {
        cull,
        clear: 0x1234,
    };
    let mut drawn = Vec::new();
    let stats = trace(
        mesh,
        view,
        &mut target,
        &mut scratch,
        &options,
        |triangle| {
            drawn.push(*triangle);
        },
    )
    .unwrap();
    Expected {
        size,
        colour,
        depth,
        drawn,
        pixels_covered: stats.pixels_covered,
    }
}

/// Lists and descriptors as the geometry unit and the firmware leave them; returns which sets there are.
fn write_lists(memory: &mut Memory, expected: &Expected) -> u64 {
    let (width, height) = expected.size;
    let rows = band_rows(width);
    let mut present = 0;
    for (set, clipped) in [(0, false), (1, true)] {
        let mut lists = vec![Vec::new(); 64];
        let triangles = expected
            .drawn
            .iter()
            .filter(|triangle| triangle.clipped == clipped);
        for (number, triangle) in (0_u32..).zip(triangles) {
            let oriented = Oriented::new(triangle.vertices).unwrap();
            let bounds = Bounds::new(&oriented.vertices, width, height).unwrap();
            let setup = Setup::new(&oriented, bounds);
            let descriptor = Descriptor::new(&setup, triangle.colour);
            memory.write(DESCRIPTORS[set] + 3 * number, &descriptor.to_bytes());
            for band in bounds.top as u32 / rows..=(bounds.bottom as u32 - 1) / rows {
                lists[band as usize].extend(number.to_le_bytes());
            }
            present |= 1 << set;
        }
        for (band, list) in (0..).zip(&lists) {
            assert!(list.len() <= 16 << LIST_SHIFT);
            memory.write(LISTS[set] + 16 + (band << LIST_SHIFT), list);
        }
        let lengths: Vec<u8> = lists
            .iter()
            .flat_map(|list| (list.len() as u32 / 4).to_le_bytes())
            .collect();
        memory.write(LISTS[set], &lengths);
    }
    present
}

struct Bench {
    module: Module,
    memory: Memory,
    read: ReadPort,
    write: WritePort,
}

impl Bench {
    fn new(seed: u32, stalls: f64) -> Self {
        let module = Module::new("raster_memory", seed);
        let seed = u64::from(seed);
        Self {
            memory: Memory::new(WORDS),
            read: ReadPort::new(&module, "read_", Stalls::new(seed, stalls)),
            write: WritePort::new(&module, "write_", Stalls::new(seed + 1, stalls)),
            module,
        }
    }

    fn set(&mut self, port: &str, value: impl Into<Bits>) {
        let port = self.module.port(port);
        self.module.set(port, value);
    }

    fn count(&self, port: &str) -> u64 {
        self.module.value(self.module.port(port))
    }

    fn clock(&mut self) {
        self.read.drive(&mut self.module, &self.memory);
        self.write.drive(&mut self.module);
        self.module.settle();
        self.read.sample(&self.module);
        self.write.sample(&self.module, &mut self.memory);
        self.module.clock();
    }

    /// Clocks until a port is high.
    fn wait_for(&mut self, port: &str) -> u64 {
        let (port, start) = (self.module.port(port), self.module.cycles());
        while !self.module.is_high(port) {
            let clocks = self.module.cycles() - start;
            assert!(
                clocks < 2_000_000,
                "nothing for {clocks} clocks: busy {} given {} written {} groups {}",
                self.count("busy"),
                self.read.given,
                self.write.written,
                self.count("groups_in")
            );
            self.clock();
        }
        self.module.cycles() - start
    }

    /// Draws a frame and compares it; returns the clocks it took.
    fn draw(&mut self, name: &str, expected: &Expected) -> u64 {
        let present = write_lists(&mut self.memory, expected);
        self.set("rst", 0);
        self.set("restart", 0);
        let size = SIZES
            .iter()
            .position(|&size| size == expected.size)
            .unwrap();
        self.set("size", size as u64);
        self.set("frame_base", u64::from(FRAME));
        self.set("depth_base", u64::from(DEPTH));
        self.set("with_depth", 1);
        self.set("clear", 0x1234);
        self.set("present", present);
        self.set("list_shift", u64::from(LIST_SHIFT));
        for (port, [low, high]) in [("list_base", LISTS), ("descriptor_base", DESCRIPTORS)] {
            self.set(port, Bits::default().with(0, 23, low).with(23, 23, high));
        }
        self.wait_for("ready");
        self.set("start", 1);
        self.clock();
        self.set("start", 0);
        let clocks = self.wait_for("done");
        let pixels = expected.colour.len() as u32;
        for i in 0..pixels {
            let (x, y) = (i % expected.size.0, i / expected.size.0);
            let colour = self.memory.entry(FRAME, i / 2) >> (16 * (i % 2)) & 0xffff;
            let depth = self.memory.entry(DEPTH, i);
            let wanted = (
                expected.colour[i as usize].into(),
                expected.depth[i as usize],
            );
            assert_eq!(
                (colour, depth),
                wanted,
                "{name}: colour and depth at {x}, {y}"
            );
        }
        clocks
    }
}

fn mesh(name: &str) -> Vec<u8> {
    let model = generate::named(name).unwrap();
    convert::convert(&model, convert::Options::default())
        .unwrap()
        .0
}

#[test]
fn frames_equal_the_models() {
    let inside = r#"{"eye":[0.21,-0.1,0.05],"u":[0.6,0.8,0],"v":[0,0,-1],"n":[-0.8,0.6,0],"half_width":1.5,"near":0.05}"#;
    let inside = view::parse(inside.as_bytes()).unwrap();
    for (seed, stalls, sizes) in [(1, 0.0, &SIZES[..]), (2, 0.5, &SIZES[..1])] {
        let mut bench = Bench::new(seed, stalls);
        for name in ["icosphere:6", "sponge:1"] {
            let bytes = mesh(name);
            let mesh = Mesh::new_checked(&bytes).unwrap();
            for &size in sizes {
                for (camera, view, cull) in [
                    ("outside", view::spherical("2,30,60").unwrap(), true),
                    ("inside", inside, false),
                ] {
                    let expected = expected(&mesh, &view, size, cull);
                    let clocks = bench.draw(&format!("{name} {camera} {size:?}"), &expected);
                    let rate = expected.pixels_covered as f64 / clocks as f64;
                    println!(
                        "{name} {camera} {size:?}: {clocks} clocks, {rate:.2} pixels a clock, walking {}, empty {}",
                        bench.count("clocks_walking"),
                        bench.count("clocks_empty")
                    );
                }
            }
        }
    }
}
