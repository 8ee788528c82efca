//! A triangle engine with main memory, which the bench operates like the firmware.

use emulated_board::{Device, MainMemory, TriangleEngine};
use glint_core::camera::{Projection, View};
use glint_core::colour::{Rounding, Shading};
use glint_core::mesh::{Mesh, Rgb565};
use glint_core::picture::Size;
use glint_model::triangle::PreparedMesh;
use glint_model::triangle::descriptor::{Layout, ListCounts, ListWriter, list_word};
use glint_model::triangle::setup::Setup;
use glint_model::triangle::textured::Textured;
use glint_model::{DrawnTriangle, MeshLight, MeshSetup, Options, clip_exceptions};
use glint_vectors::Picture;
use litex_pac::register::Value;
use litex_pac::triangle::{
    Control, DepthScale, Error, EvEnable, Geometry, Raster, Size as SizeCode, Status, offset,
};

pub const MESH: u32 = 0x4200_0000;
pub const FRAMES: [u32; 2] = [0x4100_0000, 0x4120_0000];
pub const DEPTH: u32 = 0x4140_0000;
/// Addresses of the descriptors of the engine and of the clipper.
pub const DESCRIPTORS: [u32; 2] = [0x4600_0000, 0x4680_0000];
/// Addresses of the lists of the engine and of the clipper.
pub const LISTS: [u32; 2] = [0x4700_0000, 0x4740_0000];
pub const EXCEPTIONS: u32 = 0x4780_0000;
pub const LIMIT: u32 = 100_000;
pub const LIST_SHIFT: u32 = 11;
/// Size in bytes of a mesh's header, before the chunks.
const HEADER: u32 = 32;
/// A colour that is neither a drawn colour nor the background.
pub const UNTOUCHED: u16 = 0x7777;

/// Layout of the engine's descriptors.
pub const LAYOUT: Layout = Layout::WHOLE;

/// Size of a descriptor in bytes.
pub const DESCRIPTOR_BYTES: usize = 4 * LAYOUT.words();

/// Kind of a pass.
#[derive(Clone, Copy)]
pub enum Kind {
    Geometry,
    Raster,
}

pub struct Bench {
    pub engine: TriangleEngine,
    pub ram: MainMemory,
    pub now: u64,
    /// How frames are rounded.
    pub rounding: Rounding,
}

impl Bench {
    pub fn new() -> Self {
        let mut bench = Self {
            engine: TriangleEngine::new(),
            ram: MainMemory::new(),
            now: 0,
            rounding: Rounding::Dithered,
        };
        let events = EvEnable::default().with_geometry(true).with_raster(true);
        bench.set(offset::EV_ENABLE, events.bits());
        bench
    }

    pub fn read(&mut self, offset: u32) -> u32 {
        self.engine.read(offset, self.now)
    }

    pub fn set(&mut self, offset: u32, value: u32) {
        self.engine.write(offset, value, self.now, &mut self.ram);
    }

    pub fn set_all(&mut self, values: impl IntoIterator<Item = (u32, u32)>) {
        for (offset, value) in values {
            self.set(offset, value);
        }
    }

    pub fn status(&mut self) -> Status {
        Status::from_bits(self.read(offset::STATUS))
    }

    pub fn write(&mut self, address: u32, bytes: &[u8]) {
        let place = self.ram.bytes_mut(address, bytes.len());
        place.expect("main memory").copy_from_slice(bytes);
    }

    pub fn words(&self, address: u32, count: usize) -> Vec<u32> {
        let bytes = self.ram.bytes(address, 4 * count).expect("main memory");
        let words = bytes.as_chunks().0.iter();
        words.map(|word| u32::from_le_bytes(*word)).collect()
    }

    /// Starts a pass, and runs it to its end. Returns its error.
    pub fn pass(&mut self, kind: Kind, flags: u32) -> Error {
        self.set(
            match kind {
                Kind::Geometry => offset::GEOMETRY,
                Kind::Raster => offset::RASTER,
            },
            flags,
        );
        self.finish(kind)
    }

    /// Runs until all passes have ended; an event must then be pending. Returns the error of the
    /// last pass of this kind.
    pub fn finish(&mut self, kind: Kind) -> Error {
        while self.status().geometry_busy() || self.status().raster_busy() {
            assert!(!self.engine.interrupt());
            self.now = self.engine.advance(self.now, &mut self.ram);
        }
        assert!(self.engine.interrupt());
        assert_eq!(self.engine.advance(self.now, &mut self.ram), u64::MAX);
        let pending = self.read(offset::EV_PENDING);
        self.set(offset::EV_PENDING, pending);
        assert!(!self.engine.interrupt());
        let status = self.status();
        let error = match kind {
            Kind::Geometry => status.geometry_error(),
            Kind::Raster => status.raster_error(),
        };
        error.expect("a known error")
    }

    pub fn cancel(&mut self) {
        self.set(offset::CONTROL, Control::default().with_cancel(true).bits());
    }

    /// Sets the addresses and sizes of a geometry pass's output.
    pub fn set_output(&mut self) {
        self.set_all([
            (offset::GEOMETRY_DESCRIPTORS, DESCRIPTORS[0]),
            (offset::DESCRIPTOR_LIMIT, LIMIT),
            (offset::GEOMETRY_LISTS, LISTS[0]),
            (offset::LIST_SHIFT, LIST_SHIFT),
            (offset::EXCEPTIONS, EXCEPTIONS),
            (offset::EXCEPTION_LIMIT, LIMIT),
        ]);
    }

    /// Writes a mesh to memory, and sets the parameters of its geometry pass. Returns the start flags.
    pub fn prepare(&mut self, part: &PreparedMesh) -> Geometry {
        let PreparedMesh {
            mesh,
            frame,
            options,
        } = part;
        self.write(MESH, mesh.bytes());
        self.set_output();
        self.set_mesh(mesh.bytes().len() as u32);
        self.set_frame(frame, options.light);
        self.set(offset::COLOUR, options.colour.unwrap_or_default().0.into());
        geometry_flags(frame, options)
    }

    /// Sets the address and length of the mesh.
    pub fn set_mesh(&mut self, bytes: u32) {
        self.set(offset::MESH, MESH + HEADER);
        self.set(offset::MESH_BYTES, bytes.saturating_sub(HEADER));
    }

    fn set_frame(&mut self, frame: &MeshSetup, light: Option<&MeshLight>) {
        for (first, row) in [
            (offset::ROW_U0, frame.u),
            (offset::ROW_V0, frame.v),
            (offset::ROW_N0, frame.n),
            (offset::LIGHT_0, frame.light),
        ] {
            self.set_all((first..).step_by(4).zip(row.map(|part| part as u32)));
        }
        let [x, y, z] = frame.translation;
        let depth = DepthScale::default()
            .with_mantissa(frame.depth.mantissa)
            .with_exponent(frame.depth.exponent as u8);
        let packed = |colour: [u16; 3]| {
            let [red, green, blue] = colour.map(u32::from);
            red | green << 9 | blue << 18
        };
        let (colour, ambient) =
            light.map_or(MeshLight::PLAIN, |light| (light.colour, light.ambient));
        self.set_all([
            (offset::SCALE_SHIFT, frame.engine_shift()),
            (offset::TX_LOW, x as u32),
            (offset::TX_HIGH, (x >> 32) as u32),
            (offset::TY_LOW, y as u32),
            (offset::TY_HIGH, (y >> 32) as u32),
            (offset::TZ_LOW, z as u32),
            (offset::TZ_HIGH, (z >> 32) as u32),
            (offset::NEAR_LOW, frame.near as u32),
            (offset::NEAR_HIGH, (frame.near >> 32) as u32),
            (offset::DEPTH_SCALE, depth.bits()),
            (offset::LIGHT_COLOUR, packed(colour)),
            (offset::AMBIENT, packed(ambient)),
        ]);
    }

    /// The exceptions from index `first` on.
    pub fn exceptions(&mut self, first: u32) -> Vec<u32> {
        let count = self.read(offset::EXCEPTION_COUNT);
        self.words(EXCEPTIONS + 4 * first, (count - first) as usize)
    }

    /// Sets the parameters of the raster pass of a frame that has `clipped` triangles in the second set, and returns the start
    /// flags, with depths.
    pub fn prepare_raster(
        &mut self,
        size: Size,
        slot: bool,
        clipped: &[(Setup, Rgb565)],
    ) -> Raster {
        let descriptors = self.read(offset::DESCRIPTOR_COUNT);
        let count = self.write_clipped(size, clipped);
        self.set_all([
            (offset::FRAME, FRAMES[usize::from(slot)]),
            (offset::DEPTH, DEPTH),
            (offset::CLEAR, glint_vectors::picture::CLEAR.into()),
            (offset::LIST_SHIFT, LIST_SHIFT),
            (offset::LISTS_0, LISTS[0]),
            (offset::DESCRIPTORS_0, DESCRIPTORS[0]),
            (offset::COUNT_0, descriptors),
            (offset::LISTS_1, LISTS[1]),
            (offset::DESCRIPTORS_1, DESCRIPTORS[1]),
            (offset::COUNT_1, count),
        ]);
        Raster::default()
            .with_start(true)
            .with_size(code(size))
            .with_first(true)
            .with_second(count > 0)
            .with_slot(slot)
            .with_depth(true)
            .with_dither(self.rounding == Rounding::Dithered)
    }

    fn write_clipped(&mut self, size: Size, clipped: &[(Setup, Rgb565)]) -> u32 {
        if clipped.is_empty() {
            return 0;
        }
        let mut descriptors = vec![0; LAYOUT.words() * clipped.len()];
        let mut lists = vec![0; 4 * list_word(size.bands(), LIST_SHIFT) as usize];
        let mut counts = ListCounts::EMPTY;
        let mut writer = ListWriter::new(
            &mut descriptors,
            &mut lists,
            &mut counts,
            size.width(),
            LIST_SHIFT,
            LAYOUT,
        );
        for (setup, colour) in clipped {
            writer.put(setup, *colour, None);
        }
        let count = writer.finish().expect("room");
        for (place, words) in [(DESCRIPTORS[1], descriptors), (LISTS[1], lists)] {
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            self.write(place, &bytes);
        }
        count
    }

    /// Draws parts, each by a geometry pass, and returns the numbers of off-screen and culled triangles.
    pub fn draw(&mut self, size: Size, slot: bool, parts: &[PreparedMesh]) -> [u32; 2] {
        let (mut clipped, mut listed, mut left_out) = (vec![], 0, [0; 2]);
        for (number, part) in parts.iter().enumerate() {
            let flags = self.prepare(part).with_append(number > 0);
            assert_eq!(self.pass(Kind::Geometry, flags.bits()), Error::None);
            assert_eq!(self.read(offset::TRIANGLES), part.mesh.triangle_count());
            left_out[0] += self.read(offset::UNSEEN);
            left_out[1] += self.read(offset::CULLED);
            let numbers = self.exceptions(listed);
            listed += numbers.len() as u32;
            let mut put = |triangle: &DrawnTriangle, setup: &Setup, _: Option<&Textured>| {
                clipped.push((*setup, triangle.colour));
            };
            let (frame, options) = (&part.frame, &part.options);
            clip_exceptions(
                &part.mesh,
                frame,
                options,
                &mut numbers.into_iter(),
                &mut put,
            );
        }
        let flags = self.prepare_raster(size, slot, &clipped);
        assert_eq!(self.pass(Kind::Raster, flags.bits()), Error::None);
        left_out
    }

    /// The picture in memory.
    pub fn picture(&self, size: Size, slot: bool) -> (Vec<u16>, Vec<u32>) {
        let pixels = size.pixel_count();
        let frame = self.words(FRAMES[usize::from(slot)], pixels / 2);
        let colour = frame
            .iter()
            .flat_map(|word| [*word as u16, (word >> 16) as u16]);
        (colour.collect(), self.words(DEPTH, pixels))
    }

    /// Compares the picture in memory with the model's.
    pub fn compare(&self, name: &str, size: Size, slot: bool, expected: &Picture) {
        let (colour, depth) = self.picture(size, slot);
        assert!(colour == expected.colour, "{name}: colours");
        assert!(depth == expected.depth, "{name}: depths");
    }
}

pub fn code(size: Size) -> SizeCode {
    SizeCode::ALL[size as usize]
}

pub fn geometry_flags(frame: &MeshSetup, options: &Options) -> Geometry {
    let size = Size::of(frame.width, frame.height).expect("a size");
    Geometry::default()
        .with_start(true)
        .with_cull(options.cull)
        .with_smooth(options.shading == Shading::Smooth)
        .with_size(code(size))
        .with_mirror(frame.mirrors)
        .with_recolour(options.colour.is_some())
        .with_orthographic(frame.projection == Projection::Orthographic)
}

/// Prepares a mesh for a frame of this mesh only.
pub fn alone<'a>(mesh: &'a [u8], view: &View, size: Size, cull: bool) -> PreparedMesh<'a> {
    let mesh = Mesh::new_checked(mesh).expect("a mesh");
    let [width, height] = size.pixels();
    PreparedMesh {
        mesh,
        frame: MeshSetup::new(view, width, height, mesh.radius()).expect("a frame"),
        options: Options {
            cull,
            clear: glint_vectors::picture::CLEAR,
            ..Options::default()
        },
    }
}
