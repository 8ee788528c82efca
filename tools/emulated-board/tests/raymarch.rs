//! Compares the pictures of the emulated board's raymarcher, set up by the firmware's driver, with the model's.

use std::cell::RefCell;
use std::rc::Rc;

use emulated_board::{Device, MainMemory, TriangleEngine};
use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::colour::Rounding;
use glint_core::field::{Field, Primitive};
use glint_core::light::{Background, Highlight, Light, Material};
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_core::stereo::Stereo;
use glint_engines::raymarch::{Missing, ray_counts, set_field};
use glint_engines::triangle::size_code;
use glint_hal::raymarch::Raymarcher;
use glint_hal::triangle::{EngineError, Input, Raster, TriangleEngine as Driver};
use glint_model::{FieldSubject, Frame, Subject};
use glint_vectors::picture::CLEAR;
use glint_vectors::{Camera, Picture};
use litex_pac::bus::{Bus, connect};
use litex_pac::raymarch::{self, Raymarch};
use litex_pac::register::Value;
use litex_pac::triangle::Triangle;

const FRAME: u32 = 0x4100_0000;
const DEPTH: u32 = 0x4140_0000;

/// Both engines at their bus addresses.
struct Machine {
    engine: TriangleEngine,
    ram: MainMemory,
    now: u64,
}

#[derive(Clone)]
struct Shared(Rc<RefCell<Machine>>);

impl Machine {
    /// The block with the register at a bus address, and the register's offset.
    fn block(&mut self, address: usize) -> (&mut dyn Device, u32) {
        if address >= Raymarch::BASE {
            let offset = address - Raymarch::BASE;
            (&mut self.engine.raymarcher, offset as u32)
        } else {
            (&mut self.engine, (address - Triangle::BASE) as u32)
        }
    }
}

impl Bus for Shared {
    fn read(&mut self, address: usize) -> u32 {
        let mut machine = self.0.borrow_mut();
        let now = machine.now;
        let (block, offset) = machine.block(address);
        block.read(offset, now)
    }

    fn write(&mut self, address: usize, value: u32) {
        let machine = &mut *self.0.borrow_mut();
        let mut ram = std::mem::take(&mut machine.ram);
        let now = machine.now;
        let (block, offset) = machine.block(address);
        block.write(offset, value, now, &mut ram);
        machine.ram = ram;
    }
}

struct Bench {
    machine: Shared,
    engine: Driver,
    raymarcher: Raymarcher,
    /// Whether the last picture was dithered; it alternates from picture to picture.
    dither: bool,
}

impl Bench {
    fn new() -> Self {
        let machine = Shared(Rc::new(RefCell::new(Machine {
            engine: TriangleEngine::new(),
            ram: MainMemory::new(),
            now: 0,
        })));
        connect(machine.clone());
        // SAFETY: the bus is a model, so no real device is accessed.
        let (triangle, raymarch) = unsafe { (Triangle::steal(), Raymarch::steal()) };
        Self {
            machine,
            engine: Driver::probe(triangle).unwrap(),
            raymarcher: Raymarcher::probe(raymarch).unwrap(),
            dither: false,
        }
    }

    fn wait(&self) {
        let machine = &mut *self.machine.0.borrow_mut();
        loop {
            let next = machine.engine.advance(machine.now, &mut machine.ram);
            if next == u64::MAX {
                return;
            }
            machine.now = next;
        }
    }

    /// Draws the field. Returns the colours and depths.
    fn raster(&mut self, size: Size) -> (Vec<u16>, Vec<u32>) {
        let pass = Raster {
            size: size_code(size),
            average: None,
            frame: FRAME,
            slot: false,
            whole: true,
            depth: Some(DEPTH),
            clear: CLEAR,
            sky: None,
            fog: None,
            dither: self.dither,
            list_shift: 8,
            input: Input::default(),
        };
        // SAFETY: the bench owns the memory, and waits for the end of the pass.
        unsafe { self.engine.start_raster(&pass) };
        assert_eq!(self.engine.raster(), None);
        self.wait();
        assert_eq!(self.engine.raster(), Some(Ok::<(), EngineError>(())));
        let machine = self.machine.0.borrow();
        let bytes = |place, length| machine.ram.bytes(place, length).unwrap();
        let colours = bytes(FRAME, 2 * size.pixel_count()).as_chunks().0.iter();
        let depths = bytes(DEPTH, 4 * size.pixel_count()).as_chunks().0.iter();
        (
            colours.map(|bytes| u16::from_le_bytes(*bytes)).collect(),
            depths.map(|bytes| u32::from_le_bytes(*bytes)).collect(),
        )
    }
}

fn subject<'a>(field: &'a Field, appearance: &'a Appearance) -> FieldSubject<'a> {
    FieldSubject {
        field,
        appearance,
        quality: Quality::default(),
    }
}

fn view() -> View {
    Camera::looking([1.0, -2.6, 1.2], [0.0; 3], 0.7, 0.1).rounded()
}

/// Draws a field with the engine and with the model, and compares the pictures and counts.
fn check(bench: &mut Bench, subject: FieldSubject, stereo: Option<Stereo>, size: Size) {
    let name = format!("{} {size} {stereo:?}", subject.field);
    bench.dither = !bench.dither;
    let frame = Frame {
        stereo,
        rounding: Rounding::new(bench.dither),
        ..Frame::new(Subject::Field(subject), view(), size)
    };
    let constants = frame.constants().unwrap();
    let mut expected = Picture::blank(size.pixels().into());
    let stats = frame
        .draw(&constants, &mut expected.target(), &mut [], &mut || {})
        .unwrap();
    let field = constants.field().unwrap();
    set_field(&mut bench.raymarcher, &field.setup, &field.palette, false).unwrap();
    let before = bench.raymarcher.counters();
    let drawn = bench.engine.counters().pixels_drawn;
    let (colour, depth) = bench.raster(size);
    assert!(colour == expected.colour, "{name}: colours");
    assert!(depth == expected.depth, "{name}: depths");
    let grown = bench.raymarcher.counters().since(&before);
    assert_eq!(Some(ray_counts(&grown)), stats.field, "{name}");
    let drawn = bench.engine.counters().pixels_drawn.wrapping_sub(drawn);
    assert_eq!(drawn, grown.items_out, "{name}: all pixels are drawn");
}

#[test]
fn every_kind_of_field() {
    let mut bench = Bench::new();
    let unions = [
        "union:menger:3+sphere:0.9",
        "smooth:0.3,box:0.6,0.6,0.6+spheres:0.5,0,0.6,0.4;0,0,0,0.5",
        "union:cubes:1,0.2+sphere:0.9",
        "union:boxes:1,0.5,0.5,0.05+sphere:0.9",
        "union:planes:1.5+sphere:0.9",
        "union:box:1,1,0.2+cone:0.8,1.6",
        "union:cubes:2,0.4+cone:1,3",
        "union:lattice:1,0.3+spheres:0.5,0,0.6,0.4;0,0,0,0.5",
    ];
    let fields = Primitive::EXAMPLES.into_iter().chain(unions);
    let fields = fields.map(|text| Field::parse(text).unwrap());
    let fields = fields.filter(|field| !field.is_left_to_soft_core());
    for (number, field) in fields.enumerate() {
        let appearance = Appearance {
            material: [Material::Normal, Material::Jade][number % 2],
            background: [None, Some(Background::Sky)][number % 2],
            occlusion: number % 3 == 0,
            highlight: Highlight::parse("0.6,30"),
            shadow: true,
            ..Appearance::default()
        };
        check(&mut bench, subject(&field, &appearance), None, Size::W320);
    }
}

/// Colours by normals, in a light with a highlight and shadows.
fn lit() -> Appearance {
    Appearance {
        lights: Light::parse("-2,1,1.5,c0a0ff").into_iter().collect(),
        highlight: Highlight::parse("0.4,9"),
        shadow: true,
        ..Appearance::default()
    }
}

#[test]
fn bent_unions_and_cones_in_lattices_are_left_to_the_soft_core() {
    for (text, missing) in [
        ("bent:3,box:1,1,0.2+sphere:0.6", Missing::Bend),
        ("union:lattice:1,0.3+cone:0.25,1", Missing::ConeInLattice),
    ] {
        let mut bench = Bench::new();
        let (field, appearance) = (Field::parse(text).unwrap(), Appearance::default());
        let subject = Subject::Field(subject(&field, &appearance));
        let frame = Frame::new(subject, view(), Size::W320);
        let constants = frame.constants().unwrap();
        let field = constants.field().unwrap();
        let set = set_field(&mut bench.raymarcher, &field.setup, &field.palette, false);
        assert_eq!(set, Err(missing), "{text}");
    }
}

#[test]
fn two_eyes_and_large_pictures() {
    let mut bench = Bench::new();
    let appearance = lit();
    for (text, stereo, size) in [
        ("menger:2", Some("0.05,3,red-blue"), Size::W320),
        ("sphere:0.8", Some("0.1,2,red-cyan"), Size::W640),
        // The eyes are in different cells.
        (
            "union:cubes:0.5,0.1+sphere:0.8",
            Some("0.3,2,red-cyan"),
            Size::W320,
        ),
        (
            "union:lattice:0.5,0.1+sphere:0.8",
            Some("0.3,2,red-blue"),
            Size::W320,
        ),
        ("menger:4", None, Size::W1280),
    ] {
        let field = Field::parse(text).unwrap();
        let stereo = stereo.map(|text| Stereo::parse(text).unwrap());
        check(&mut bench, subject(&field, &appearance), stereo, size);
    }
}

#[test]
fn random_fields() {
    let mut bench = Bench::new();
    let mut state = 5_u64;
    for _ in 0..40 {
        let field = Field::draw(|| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 32) as u32
        });
        if field.is_left_to_soft_core() {
            continue;
        }
        check(&mut bench, subject(&field, &lit()), None, Size::W320);
    }
}

/// Draws a picture from any register contents.
#[test]
fn random_registers_do_no_harm() {
    let mut state = 9_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state
    };
    let mut bench = Bench::new();
    for _ in 0..12 {
        {
            let Machine { engine, ram, now } = &mut *bench.machine.0.borrow_mut();
            let block = &mut engine.raymarcher;
            for register in (raymarch::offset::SOLID..=raymarch::offset::FOG_SHIFT).step_by(4) {
                block.write(register, random(), *now, ram);
            }
            // Limits the evaluations of each ray, for speed.
            let tuning = raymarch::Tuning::from_bits(random()).with_cap(20);
            block.write(raymarch::offset::TUNING, tuning.bits(), *now, ram);
            for _ in 0..500 {
                block.write(raymarch::offset::SPHERE, random(), *now, ram);
                block.write(raymarch::offset::TABLE, random(), *now, ram);
            }
            let control = random() | 1;
            block.write(raymarch::offset::CONTROL, control, *now, ram);
        }
        bench.raster(Size::W320);
    }
}
