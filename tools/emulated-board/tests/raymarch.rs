//! The raymarcher of the emulated board: the registers that the firmware's driver writes give the model's pictures.

use std::cell::RefCell;
use std::rc::Rc;

use emulated_board::{Device, MainMemory, TriangleEngine};
use glint_core::appearance::Appearance;
use glint_core::camera::View;
use glint_core::colour::Rgb565;
use glint_core::field::{Field, Primitive};
use glint_core::light::{Background, Material};
use glint_core::mesh::Mesh;
use glint_core::picture::Size;
use glint_core::quality::Quality;
use glint_core::stereo::Stereo;
use glint_engines::raymarch::{ray_counts, set_field};
use glint_engines::triangle::{MeshPass, size_code};
use glint_hal::raymarch::Raymarcher;
use glint_hal::triangle::{EngineError, Lists, Raster, Set, TriangleEngine as Driver};
use glint_model::raymarch::{Ray, RayResult, State, render_field};
use glint_model::triangle::{PreparedMesh, draw_parts};
use glint_model::{
    FieldConstants, FieldSubject, Frame, MeshSubject, Options, Projected, Shading, Subject,
};
use glint_vectors::picture::CLEAR;
use glint_vectors::{Camera, Model, Picture};
use litex_pac::bus::{Bus, connect};
use litex_pac::raymarch::{self, Raymarch};
use litex_pac::register::Value;
use litex_pac::triangle::{Geometry, Triangle, offset};

const FRAME: u32 = 0x4100_0000;
const DEPTH: u32 = 0x4140_0000;
const MESH: u32 = 0x4200_0000;
const DESCRIPTORS: u32 = 0x4600_0000;
const LISTS: u32 = 0x4700_0000;
const LIST_SHIFT: u8 = 8;

/// Both engines at their addresses.
struct Machine {
    engine: TriangleEngine,
    ram: MainMemory,
    now: u64,
}

#[derive(Clone)]
struct Shared(Rc<RefCell<Machine>>);

impl Machine {
    /// The block with the register at an address, and the register's offset.
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
}

impl Bench {
    fn new() -> Self {
        let machine = Shared(Rc::new(RefCell::new(Machine {
            engine: TriangleEngine::new(),
            ram: MainMemory::new(),
            now: 0,
        })));
        connect(machine.clone());
        // SAFETY: a model on the bus answers all accesses, so no device is affected.
        let (triangle, raymarch) = unsafe { (Triangle::steal(), Raymarch::steal()) };
        Self {
            machine,
            engine: Driver::probe(triangle).unwrap(),
            raymarcher: Raymarcher::probe(raymarch).unwrap(),
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

    /// Draws the lists of a number of descriptors, and the field. Returns colours and depths.
    fn raster(&mut self, size: Size, descriptors: Option<u32>) -> (Vec<u16>, Vec<u32>) {
        let set = descriptors.map(|count| Set {
            descriptors: DESCRIPTORS,
            count,
            lists: LISTS,
        });
        let pass = Raster {
            size: size_code(size),
            frame: FRAME,
            slot: false,
            whole: true,
            depth: Some(DEPTH),
            clear: CLEAR,
            list_shift: LIST_SHIFT,
            sets: [set, None],
        };
        // SAFETY: the memory is that of the bench, which waits for the end of the pass.
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

fn view() -> View {
    Camera::looking([1.0, -2.6, 1.2], [0.0; 3], 0.7, 0.1).rounded()
}

/// Draws a field by the engine and by the model, and compares pictures and counts.
fn check(bench: &mut Bench, subject: FieldSubject, stereo: Option<Stereo>, size: Size) {
    let name = format!("{} {size} {stereo:?} {}", subject.field, subject.prepass);
    let frame = Frame {
        stereo,
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
    let (colour, depth) = bench.raster(size, None);
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
    ];
    for (number, text) in Primitive::EXAMPLES.into_iter().chain(unions).enumerate() {
        let field = Field::parse(text).unwrap();
        let appearance = Appearance {
            material: [Material::Normal, Material::Jade][number % 2],
            background: [None, Some(Background::Sky)][number % 2],
            occlusion: number % 3 == 0,
            ..Appearance::default()
        };
        for prepass in [false, true] {
            let subject = FieldSubject {
                field: &field,
                appearance: &appearance,
                quality: Quality::default(),
                prepass,
            };
            check(&mut bench, subject, None, Size::W320);
        }
    }
}

#[test]
fn two_eyes_and_large_pictures() {
    let mut bench = Bench::new();
    let appearance = Appearance::default();
    for (text, stereo, size) in [
        ("menger:2", Some("0.05,3,red-blue"), Size::W320),
        ("sphere:0.8", Some("0.1,2,red-cyan"), Size::W640),
        ("menger:4", None, Size::W1280),
    ] {
        let field = Field::parse(text).unwrap();
        let subject = FieldSubject {
            field: &field,
            appearance: &appearance,
            quality: Quality::default(),
            prepass: stereo.is_some(),
        };
        let stereo = stereo.map(|text| Stereo::parse(text).unwrap());
        check(&mut bench, subject, stereo, size);
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
        let subject = FieldSubject {
            field: &field,
            appearance: &Appearance::default(),
            quality: Quality::default(),
            prepass: state & 1 == 1,
        };
        check(&mut bench, subject, None, Size::W320);
    }
}

/// A mesh in a field: one scale of depths, triangles first.
#[test]
fn a_mesh_in_a_field() {
    let mut bench = Bench::new();
    let bytes = Model::sphere(0.9, 10).encoded();
    let mesh = MeshSubject::new(Mesh::new_checked(&bytes).unwrap());
    let field = Field::parse("box:1,0.4,0.4").unwrap();
    let subject = FieldSubject {
        field: &field,
        appearance: &Appearance::default(),
        quality: Quality::default(),
        prepass: false,
    };
    let frame = Frame {
        clear: Rgb565(CLEAR),
        ..Frame::new(Subject::MeshInField(mesh, subject), view(), Size::W320)
    };
    let constants = frame.constants().unwrap();
    let mut expected = Picture::blank((320, 180));
    let mut scratch = vec![Projected::Behind; frame.scratch_vertices()];
    frame
        .draw(&constants, &mut expected.target(), &mut scratch, &mut || {})
        .unwrap();

    bench
        .machine
        .0
        .borrow_mut()
        .ram
        .bytes_mut(MESH, bytes.len())
        .unwrap()
        .copy_from_slice(&bytes);
    let pass = MeshPass {
        mesh: &mesh.mesh,
        size: Size::W320,
        frame: constants.mesh().unwrap(),
        light: constants.light(),
        cull: true,
        shading: Shading::Flat,
        colour: None,
        lists: Some(Lists {
            descriptors: DESCRIPTORS,
            descriptor_limit: 1000,
            lists: LISTS,
            list_shift: LIST_SHIFT,
            exceptions: LISTS + (1 << 20),
            exception_limit: 1000,
        }),
    };
    let _ = pass.prepare(&mut bench.engine);
    {
        // The mesh is at another position than that of the host.
        let Machine { engine, ram, now } = &mut *bench.machine.0.borrow_mut();
        let place = ram.bytes_mut(MESH, bytes.len()).unwrap();
        place.copy_from_slice(&bytes);
        engine.write(offset::MESH, MESH + 32, *now, ram);
        let flags = Geometry::default().with_start(true).with_cull(true);
        engine.write(offset::GEOMETRY, flags.bits(), *now, ram);
    }
    bench.wait();
    assert_eq!(bench.engine.geometry(), Some(Ok(())));
    let counts = bench.engine.counts();
    assert_eq!(counts.exceptions, 0);

    let FieldConstants { setup, palette } = constants.field().unwrap();
    set_field(&mut bench.raymarcher, setup, palette, false).unwrap();
    let before = bench.engine.counters().pixels_drawn;
    let (colour, depth) = bench.raster(Size::W320, Some(counts.descriptors));
    assert!(colour == expected.colour && depth == expected.depth);
    let drawn = bench.engine.counters().pixels_drawn - before;
    let stored: Vec<u32> = {
        let mut alone = Picture::blank((320, 180));
        let part = PreparedMesh {
            mesh: mesh.mesh,
            frame: *constants.mesh().unwrap(),
            options: Options::default(),
        };
        let mut part = |number| (number == 0).then_some(part);
        let target = &mut alone.target();
        draw_parts(&mut part, 0, target, &mut scratch, &mut |_| {}).unwrap();
        alone.depth
    };
    let mut visible = 0;
    let mut show = |x: u32, y: u32, ray: &Ray, outcome: &RayResult| {
        let code = match outcome.state {
            State::Hit(_) => setup.depth_code(ray, outcome.reached()),
            _ => 0,
        };
        visible += u32::from(code >= stored[(320 * y + x) as usize]);
    };
    let mut alone = Picture::blank((320, 180));
    render_field(setup, palette, &mut alone.target(), &mut show).unwrap();
    let triangles = stored.iter().filter(|code| **code > 0).count() as u32;
    // The sphere's front faces do not overlap.
    assert_eq!(drawn, triangles + visible);
    assert!((1000..57_000).contains(&visible));
    bench.raymarcher.clear_field();
    let (without, _) = bench.raster(Size::W320, Some(counts.descriptors));
    assert!(without != expected.colour);
}

/// Any contents of the registers draw a picture.
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
            // Few evaluations of each ray.
            let tuning = raymarch::Tuning::from_bits(random()).with_cap(20);
            block.write(raymarch::offset::TUNING, tuning.bits(), *now, ram);
            for _ in 0..500 {
                block.write(raymarch::offset::SPHERE, random(), *now, ram);
                block.write(raymarch::offset::TABLE, random(), *now, ram);
            }
            let control = random() | 1;
            block.write(raymarch::offset::CONTROL, control, *now, ram);
        }
        bench.raster(Size::W320, None);
    }
}
