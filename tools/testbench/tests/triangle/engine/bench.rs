//! Test bench of the triangle engine, with a memory.

use glint_core::camera::Projection;
use glint_core::colour::Rounding;
use glint_core::mesh::{Attribute, Mesh};
use glint_core::picture::Quarter;
use glint_model::triangle::descriptor::{Descriptor, Layout, band_rows, list_word};
use glint_model::triangle::setup::Bounds;
use glint_model::triangle::vertex_cache;
use glint_model::{MeshLight, MeshSetup, Options, Shading};
use glint_testbench::{
    Bits, Counters, Memory, Module, ReadPort, Stalls, WritePort, drive_fog, drive_sky,
};

use super::expected::{Expected, SIZES};

// Addresses in memory, in words of 16 bytes. `LISTS` and `DESCRIPTORS` have two areas each: one for
// the engine, and one for the clipper, which is the firmware on the board and the model here.
const FRAMES: [u32; 2] = [0, 0x6_0000];
const DEPTH: u32 = 0x2_0000;
pub const LISTS: [u32; 2] = [0x8_0000, 0xc_0000];
pub const DESCRIPTORS: [u32; 2] = [0x10_0000, 0x14_0000];
const EXCEPTIONS: u32 = 0x18_0000;
pub const MESH: u32 = 0x1c_0000;
/// The table of textures.
const TEXTURES: u32 = 0x1e_0000;
/// The first texture.
const TEXTURE: u32 = 0x1e_0100;
/// Number of words from one texture to the next; no texture is longer.
const TEXTURE_WORDS: u32 = 0x1000;
const WORDS: usize = 0x20_0000;
/// Base-2 logarithm of the number of words per list.
pub const LIST_SHIFT: u32 = 11;
/// Number of words after a picture that are checked to be unchanged: more than the size of a bank of the band buffer.
const BEHIND: usize = 4096;
/// Largest number of exceptions (triangles left to the clipper) that the engine may write. The descriptor area has the size of
/// this number of flat descriptors, of three words each; a smooth descriptor takes six words.
const LIMIT: u32 = 80_000;

/// Returns the byte address of a word of 16 bytes.
fn bytes(word: u32) -> u64 {
    u64::from(word) * 16
}

/// Writes the second set of lists and descriptors to memory, as the firmware does, with descriptors
/// of this layout.
fn write_set(memory: &mut Memory, width: u32, triangles: &[(Descriptor, Bounds)], layout: Layout) {
    let rows = band_rows(width);
    let mut lists = vec![Vec::new(); 64];
    for (number, (descriptor, bounds)) in (0_u32..).zip(triangles) {
        let words = descriptor.words(layout).concat();
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        memory.write(DESCRIPTORS[1] + bytes.len() as u32 / 16 * number, &bytes);
        for band in bounds.top as u32 / rows..=(bounds.bottom as u32 - 1) / rows {
            lists[band as usize].extend(number.to_le_bytes());
        }
    }
    for (band, list) in (0..).zip(&lists) {
        assert!(list.len() <= 16 << LIST_SHIFT);
        memory.write(LISTS[1] + list_word(band, LIST_SHIFT), list);
    }
    let lengths: Vec<u8> = lists
        .iter()
        .flat_map(|list| (list.len() as u32 / 4).to_le_bytes())
        .collect();
    memory.write(LISTS[1], &lengths);
}

pub struct Bench {
    pub module: Module,
    counters: Counters,
    layout: Layout,
    pub memory: Memory,
    pub reads: [ReadPort; 4],
    writes: [WritePort; 4],
    /// Whether frames are drawn, and compared, with depths.
    pub with_depth: bool,
    /// Index of the drawn frame buffer.
    pub slot: usize,
    /// For each frame buffer, the size and clear colour of its last frame; `None` before the first frame, which the engine always
    /// writes whole.
    left: [Option<((u32, u32), u16)>; 2],
}

/// Cost of a frame: clocks of the two passes, words read by the raster pass, and words of colours and depths written.
pub struct Clocks {
    pub geometry: u64,
    pub raster: u64,
    pub read: u64,
    pub written: u64,
}

impl Bench {
    /// Creates a bench with the module for flat shading; each memory port stalls in the share `stalls` of the clocks.
    pub fn new(seed: u32, stalls: f64) -> Self {
        Self::with_module("triangle_engine", Layout::FLAT, seed, stalls)
    }

    /// Creates a bench as [`new`](Self::new) does, with a variant of the module, such as `lines`:
    /// the module `triangle_engine_lines`.
    pub fn of(variant: &str, seed: u32, stalls: f64) -> Self {
        let layout = match variant {
            "smooth" | "smooth_lines" => Layout::SMOOTH,
            "texture" | "texture_fields" => Layout::TEXTURED,
            _ => Layout::FLAT,
        };
        Self::with_module(&format!("triangle_engine_{variant}"), layout, seed, stalls)
    }

    fn with_module(name: &str, layout: Layout, seed: u32, stalls: f64) -> Self {
        let module = Module::new(name, seed);
        let seed = u64::from(seed);
        Self {
            memory: Memory::new(WORDS),
            reads: ["mesh", "vertex", "raster", "texture"]
                .map(|name| ReadPort::new(&module, name, Stalls::new(seed, stalls))),
            writes: ["descriptors", "lists", "frame_even", "frame_odd"]
                .map(|name| WritePort::new(&module, name, Stalls::new(seed + 1, stalls))),
            counters: Counters::new(&module, "events"),
            module,
            layout,
            with_depth: true,
            slot: 0,
            left: [None; 2],
        }
    }

    pub fn set(&mut self, path: &str, value: impl Into<Bits>) {
        let port = self.module.port(path);
        self.module.set(port, value);
    }

    /// Returns the value of a port.
    pub fn read(&self, path: &str) -> u64 {
        self.module.read(path)
    }

    /// Returns the value of an event counter of the engine.
    pub fn count(&self, event: &str) -> u64 {
        self.counters.get(event)
    }

    pub fn clock(&mut self) {
        for read in &mut self.reads {
            read.drive(&mut self.module, &self.memory);
        }
        for write in &mut self.writes {
            write.drive(&mut self.module);
        }
        self.module.settle();
        self.counters.sample(&self.module);
        for read in &mut self.reads {
            read.sample(&self.module);
        }
        for write in &mut self.writes {
            write.sample(&self.module, &mut self.memory);
        }
        self.module.clock();
    }

    /// Runs until a port is high; returns the number of clocks.
    pub fn wait_for(&mut self, port: &str) -> u64 {
        let (port, start) = (self.module.port(port), self.module.cycles());
        while !self.module.is_high(port) {
            let clocks = self.module.cycles() - start;
            assert!(
                clocks < 2_000_000,
                "no end after {clocks} clocks: words read {:?}, words written {}, groups {}",
                self.reads.each_ref().map(|read| read.given),
                self.frame_words(),
                self.count("groups")
            );
            self.clock();
        }
        self.module.cycles() - start
    }

    /// Number of words written by all ports.
    pub fn written(&self) -> u64 {
        self.writes.iter().map(|write| write.written).sum()
    }

    /// Number of words of colours and depths written.
    fn frame_words(&self) -> u64 {
        self.writes[2].written + self.writes[3].written
    }

    pub fn pulse(&mut self, port: &str) {
        self.set(port, 1);
        self.clock();
        self.set(port, 0);
    }

    /// Waits until the engine is ready, and runs the geometry pass; returns its number of clocks.
    pub fn run_geometry(&mut self) -> u64 {
        self.wait_for("status.ready");
        self.pulse("geometry_start");
        self.wait_for("status.geometry_done")
    }

    /// Starts a pass, and cancels it after `clocks` clocks.
    pub fn cancel_after(&mut self, start: &str, clocks: u32) {
        self.pulse(start);
        (0..clocks).for_each(|_| self.clock());
        self.pulse("cancel");
    }

    /// Sets the engine's parameters: mesh, frame constants, memory map.
    pub fn configure(&mut self, mesh: &[u8], expected: &Expected) {
        let Expected { frame, options, .. } = expected;
        self.configure_geometry(mesh, frame, options);
        self.set("geometry_flags.append", 0);
        self.configure_raster(expected);
    }

    /// Sets the parameters of a geometry pass: mesh, frame constants, options, memory map.
    pub fn configure_geometry(&mut self, mesh: &[u8], frame: &MeshSetup, options: &Options) {
        self.memory.write(MESH, mesh);
        let size = SIZES
            .iter()
            .position(|&size| size == (frame.width, frame.height))
            .unwrap() as u64;
        for (path, value) in [
            // The engine's address skips the mesh's header of two words.
            ("geometry.mesh", bytes(MESH + 2)),
            (
                "geometry.mesh_bytes",
                (mesh.len() as u64).saturating_sub(32),
            ),
            ("geometry.descriptors", bytes(DESCRIPTORS[0])),
            (
                "geometry.descriptor_limit",
                (LIMIT * 12 / self.layout.words() as u32).into(),
            ),
            ("geometry.lists", bytes(LISTS[0])),
            ("geometry.list_shift", LIST_SHIFT.into()),
            ("geometry.exceptions", bytes(EXCEPTIONS)),
            ("geometry.exception_limit", LIMIT.into()),
            ("geometry_flags.size", size),
            ("geometry_flags.cull", options.cull.into()),
            (
                "geometry_flags.smooth",
                (options.shading == Shading::Smooth).into(),
            ),
            (
                "geometry_flags.orthographic",
                (frame.projection == Projection::Orthographic).into(),
            ),
            ("geometry_flags.mirror", frame.mirrors.into()),
            ("geometry_flags.recolour", options.colour.is_some().into()),
            (
                "geometry.colour",
                options.colour.unwrap_or_default().0.into(),
            ),
            ("view.scale_shift", frame.engine_shift().into()),
            ("view.near_z", frame.near as u64),
            ("view.depth_mantissa", frame.depth.mantissa.into()),
        ] {
            self.set(path, value);
        }
        self.module.drive_all("view.row_u", frame.u);
        self.module.drive_all("view.row_v", frame.v);
        self.module.drive_all("view.row_n", frame.n);
        self.module.drive_all("view.row_light", frame.light);
        let (colour, ambient) = options
            .light
            .map_or(MeshLight::PLAIN, |light| (light.colour, light.ambient));
        self.module.drive_all("geometry.light_colour", colour);
        self.module.drive_all("geometry.ambient", ambient);
        let translation = ["view.tx", "view.ty", "view.tz"];
        for (path, value) in translation.into_iter().zip(frame.translation) {
            self.module.drive(path, value);
        }
        self.module
            .drive("view.depth_exponent", frame.depth.exponent);
    }

    /// Sets the parameters of a raster pass.
    fn configure_raster(&mut self, expected: &Expected) {
        let Expected { size, options, .. } = expected;
        let code = SIZES.iter().position(|s| s == size).unwrap() as u64;
        let whole = self.left[self.slot].is_some_and(|left| left != (*size, options.clear));
        for (path, value) in [
            ("raster_flags.size", code),
            ("raster_flags.depth", self.with_depth.into()),
            ("raster_flags.slot", self.slot as u64),
            ("raster_flags.whole", whole.into()),
            ("raster.frame", bytes(FRAMES[self.slot])),
            ("raster.depth", bytes(DEPTH)),
            ("raster.clear", options.clear.into()),
            ("raster.list_shift", LIST_SHIFT.into()),
        ] {
            self.set(path, value);
        }
        let averages = expected.averages.as_ref();
        let quarter = averages.and_then(|averages| averages.quarter);
        self.set("raster_flags.average", u64::from(averages.is_some()));
        for flags in ["geometry_flags", "raster_flags"] {
            let Quarter { is_right, is_lower } = quarter.unwrap_or_default();
            let values = [
                ("quarter", quarter.is_some()),
                ("right", is_right),
                ("lower", is_lower),
            ];
            for (name, value) in values {
                self.set(&format!("{flags}.{name}"), u64::from(value));
            }
        }
        self.set("raster_flags.sky", u64::from(expected.sky.is_some()));
        if let Some(sky) = &expected.sky {
            drive_sky(&mut self.module, sky);
        }
        let is_dithered = expected.rounding == Rounding::Dithered;
        self.set("raster_flags.dither", u64::from(is_dithered));
        self.set("raster_flags.fog", u64::from(expected.fog.is_some()));
        if let Some(fog) = &expected.fog {
            drive_fog(&mut self.module, fog);
        }
        self.module.drive_all("raster.lists", LISTS.map(bytes));
        self.module
            .drive_all("raster.descriptors", DESCRIPTORS.map(bytes));
    }

    /// Selects the descriptor sets that the raster pass draws: the first set with this number of descriptors, if any, and the second set if
    /// it is not empty.
    pub fn set_sets(&mut self, first: Option<u64>, second: usize) {
        let counts = [first.unwrap_or(0), second as u64];
        self.module.drive_all("raster.count", counts);
        self.set("raster_flags.first", u64::from(first.is_some()));
        self.set("raster_flags.second", u64::from(second > 0));
    }

    /// Draws a frame and compares it with the expected frame.
    pub fn draw(&mut self, name: &str, mesh: &[u8], expected: &Expected) -> Clocks {
        self.configure(mesh, expected);
        self.wait_for("status.ready");
        let fetched = self.count("vertices");
        let geometry = self.run_geometry();
        let fetches = vertex_cache::fetches(&Mesh::new_checked(mesh).expect("a valid mesh"));
        assert_eq!(
            self.count("vertices") - fetched,
            u64::from(fetches),
            "{name}: fetches of vertices"
        );
        let counts = [
            "status.mesh_error",
            "status.full",
            "results.triangles",
            "results.exception_count",
        ]
        .map(|path| self.read(path));
        let stats = &expected.stats;
        let wanted = [0, 0, stats.triangles_in.into(), stats.clipped.into()];
        assert_eq!(
            counts, wanted,
            "{name}: mesh_error, full, triangles, exceptions"
        );

        self.draw_lists(name, expected, geometry)
    }

    /// Draws a frame from the lists of geometry passes that took `geometry` clocks, and compares it with the expected frame.
    pub fn draw_lists(&mut self, name: &str, expected: &Expected, geometry: u64) -> Clocks {
        self.configure_raster(expected);
        let clipped: Vec<_> = (expected.clipped.iter())
            .map(|(setup, colour)| (Descriptor::new(setup, *colour, None), setup.bounds))
            .collect();
        write_set(&mut self.memory, expected.size.0, &clipped, self.layout);
        self.set_sets(Some(self.read("results.descriptor_count")), clipped.len());
        self.pulse("raster_start");
        let (read, written) = (self.reads[2].given, self.frame_words());
        let raster = self.finish(name, expected);
        Clocks {
            geometry,
            raster,
            read: self.reads[2].given - read,
            written: self.frame_words() - written,
        }
    }

    /// Draws a mesh with textures, and its clipped triangles as the second set, and compares the
    /// frame with the expected frame. Returns the numbers of clocks of both passes.
    pub fn draw_textured(
        &mut self,
        name: &str,
        expected: &Expected,
        bytes_of_mesh: &[u8],
        clipped: &[(Descriptor, Bounds)],
    ) -> [u64; 2] {
        let mesh = Mesh::new_checked(bytes_of_mesh).expect("a valid mesh");
        let offset = |part: &[u8]| part.as_ptr().addr() - bytes_of_mesh.as_ptr().addr();
        let coordinates = mesh.attribute(Attribute::TextureCoordinates).unwrap();
        self.configure(bytes_of_mesh, expected);
        let records = mesh.records().as_flattened().len();
        self.set("geometry.mesh_bytes", records as u64);
        self.set("geometry_flags.textures", 1);
        self.set("geometry.first_texture", 4);
        let place = bytes(MESH) + offset(coordinates) as u64;
        self.set("geometry.coordinates", place);
        let geometry = self.run_geometry();
        let counts = ["status.mesh_error", "status.full"].map(|path| self.read(path));
        assert_eq!(counts, [0, 0], "{name}: mesh_error, full");
        write_set(&mut self.memory, expected.size.0, clipped, self.layout);
        let addresses = mesh
            .textures()
            .map(|texture| offset(texture.bytes()) as u64);
        self.write_table(addresses.map(|at| bytes(MESH) + at));
        self.set_sets(Some(self.read("results.descriptor_count")), clipped.len());
        self.pulse("raster_start");
        [geometry, self.finish(name, expected)]
    }

    /// Writes the table of textures. Its first five entries are unused.
    fn write_table(&mut self, addresses: impl Iterator<Item = u64>) {
        let table = [0; 5].into_iter().chain(addresses);
        let table: Vec<u8> = table.flat_map(|at| (at as u32).to_le_bytes()).collect();
        self.memory.write(TEXTURES, &table);
        self.set("raster.textures", bytes(TEXTURES));
    }

    /// Draws a frame that [`start_set`](Self::start_set) starts, and compares it with the expected frame. Returns the number of clocks.
    pub fn draw_set(
        &mut self,
        name: &str,
        expected: &Expected,
        triangles: &[(Descriptor, Bounds)],
        textures: &[Vec<u8>],
    ) -> u64 {
        self.start_set(expected, triangles, textures);
        self.finish(name, expected)
    }

    /// Starts a frame of the second set alone, of triangles whose texture numbers begin at 5.
    pub fn start_set(
        &mut self,
        expected: &Expected,
        triangles: &[(Descriptor, Bounds)],
        textures: &[Vec<u8>],
    ) {
        self.configure_raster(expected);
        write_set(&mut self.memory, expected.size.0, triangles, self.layout);
        let places = (0..).map(|number| TEXTURE + TEXTURE_WORDS * number);
        let places: Vec<_> = places.take(textures.len()).collect();
        for (&place, texture) in places.iter().zip(textures) {
            self.memory.write(place, texture);
        }
        self.write_table(places.into_iter().map(bytes));
        self.set_sets(None, triangles.len());
        self.wait_for("status.ready");
        self.pulse("raster_start");
    }

    /// The indices of the exceptions listed by geometry passes.
    pub fn exceptions(&self) -> Vec<u32> {
        let count = self.read("results.exception_count") as u32;
        let entry = |index| self.memory.entry(EXCEPTIONS, index);
        (0..count).map(entry).collect()
    }

    /// Waits for the end of the raster pass, and compares its frame with the expected frame. Returns the number of clocks.
    pub fn finish(&mut self, name: &str, expected: &Expected) -> u64 {
        let clocks = self.wait_for("status.raster_done");
        // After a sky, or an average, the next frame is written whole.
        let size = if expected.sky.is_some() || expected.averages.is_some() {
            (0, 0)
        } else {
            expected.size
        };
        self.left[self.slot] = Some((size, expected.options.clear));
        assert_eq!(self.read("status.list_error"), 0, "{name}: list_error");
        self.compare(name, expected);
        clocks
    }

    /// Draws a frame from valid or invalid descriptors and lists. Every band's list has the entries `list`; `lengths` has the
    /// length of each band's list.
    ///
    /// # Panics
    /// When the frame does not end, or a word after the picture changes.
    pub fn draw_raw(
        &mut self,
        name: &str,
        expected: &Expected,
        descriptors: &[u8],
        lengths: [u32; 64],
        list: &[u32],
    ) {
        self.configure(&[], expected);
        self.memory.write(DESCRIPTORS[0], descriptors);
        let table = lengths.map(u32::to_le_bytes);
        self.memory.write(LISTS[0], table.as_flattened());
        let list: Vec<_> = list.iter().flat_map(|entry| entry.to_le_bytes()).collect();
        for band in 0..64 {
            self.memory
                .write(LISTS[0] + list_word(band, LIST_SHIFT), &list);
        }
        let behind = FRAMES[self.slot] + expected.size.0 * expected.size.1 / 8;
        self.memory.write(behind, &[0x77; 16 * BEHIND]);
        self.set_sets(Some(descriptors.len() as u64 / 48), 0);
        self.wait_for("status.ready");
        self.pulse("raster_start");
        self.wait_for("status.raster_done");
        self.left[self.slot] = Some((expected.size, expected.options.clear));
        for word in 0..BEHIND as u32 {
            let found = self.memory.word(behind + word);
            assert_eq!(
                found,
                Bits::from_words(&[0x7777_7777; 4]),
                "{name}: word {word} after the picture"
            );
        }
    }

    /// Overwrites the frame buffer, whose content then counts as unknown.
    pub fn scribble(&mut self) {
        self.memory
            .write(FRAMES[self.slot], &[0x99; 1280 * 720 * 2]);
        self.left[self.slot] = Some(((0, 0), 0));
    }

    /// Compares the frame in memory with the expected frame.
    fn compare(&self, name: &str, expected: &Expected) {
        let (width, _) = expected.frame_size();
        for i in 0..expected.colour.len() as u32 {
            let (x, y) = (i % width, i / width);
            let colour = self.memory.entry(FRAMES[self.slot], i / 2) >> (16 * (i % 2)) & 0xffff;
            let has_depth = self.with_depth && expected.averages.is_none();
            let depth = has_depth.then(|| self.memory.entry(DEPTH, i));
            let wanted = (
                expected.colour[i as usize].into(),
                has_depth.then(|| expected.depth[i as usize]),
            );
            assert_eq!(
                (colour, depth),
                wanted,
                "{name}: colour and depth at {x}, {y} in slot {}",
                self.slot
            );
        }
    }
}
