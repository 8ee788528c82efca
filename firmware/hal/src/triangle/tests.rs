use std::cell::RefCell;
use std::rc::Rc;
use std::vec::Vec;

use litex_pac::Peripherals;
use litex_pac::recording::{self, Block};

use super::*;

const IDENT: u32 = triangle::Triangle::IDENT;

fn registers() -> triangle::Triangle {
    // SAFETY: a model on the bus answers all accesses, so no device is affected.
    unsafe { Peripherals::steal() }.triangle
}

fn probe(ident: u32) -> (Result<TriangleEngine, Absent>, Rc<RefCell<Block>>) {
    let block = recording::connect([(registers().ident().address(), ident)]);
    (TriangleEngine::probe(registers()), block)
}

/// A geometry pass with different values in all parameters.
fn pass(options: GeometryStart) -> Geometry<'static> {
    Geometry {
        mesh: &[0; 80],
        options,
        scale_shift: 13,
        u: &[1, -2, 3],
        v: &[-4, 5, -6],
        n: &[7, -8, 9],
        light: &[-10, 11, -12],
        translation: &[-13 << 32, 14 << 33, -15],
        near: 16 << 31,
        depth_scale: DepthScale::default().with_mantissa(17).with_exponent(18),
        lights: [[256, 7, 1], [0, 255, 256]],
        colour: None,
        textures: None,
        lists: Some(LISTS),
    }
}

const LISTS: Lists = Lists {
    descriptors: 0x4600_0000,
    descriptor_limit: 77,
    lists: 0x4700_0000,
    list_shift: 9,
    exceptions: 0x4710_0000,
    exception_limit: 5,
};

#[test]
fn something_else_is_not_taken_for_the_engine() {
    for ident in [0, IDENT + 1] {
        let absent = Absent {
            expected: IDENT,
            found: ident,
        };
        assert_eq!(probe(ident).0.err(), Some(absent));
    }
    assert!(probe(IDENT).0.is_ok());
}

#[test]
fn smooth_shading_is_that_of_the_build() {
    let (engine, block) = probe(IDENT);
    let engine = engine.unwrap();
    assert!(!engine.shades_smoothly());
    let address = registers().caps().address();
    block.borrow_mut().values.insert(address, 1 << 3);
    assert!(engine.shades_smoothly());
}

#[test]
fn triangles_are_drawn_by_builds_that_say_so() {
    let (engine, block) = probe(IDENT);
    let engine = engine.unwrap();
    assert!(!engine.draws_triangles());
    let address = registers().caps().address();
    block.borrow_mut().values.insert(address, 1 << 4);
    assert!(engine.draws_triangles());
}

#[test]
fn a_pass_of_lines_has_segments_and_no_exceptions() {
    let (engine, block) = probe(IDENT);
    let mut engine = engine.unwrap();
    assert!(!engine.draws_lines());
    let address = registers().caps().address();
    block.borrow_mut().values.insert(address, 1 << 5);
    assert!(engine.draws_lines());

    let segments: [Segment; 3] = [[2; 8], [0; 8], [1; 8]];
    let prepared = engine.prepare_lines(&segments, Size::W640, &LISTS);
    let r = registers();
    assert!(!r.geometry().read().start(), "not yet");
    // SAFETY: the model has no engine that accesses memory.
    unsafe { engine.start_geometry(prepared) };
    let start = r.geometry().read();
    assert!(start.start() && start.lines());
    assert_eq!(start.size(), Some(Size::W640));
    assert_eq!(r.mesh().read(), segments.as_ptr().addr() as u32);
    assert_eq!(r.mesh_bytes().read(), 96);
    assert_eq!(
        [r.geometry_descriptors().read(), r.geometry_lists().read()],
        [0x4600_0000, 0x4700_0000]
    );
    assert_eq!(
        [r.list_shift().read().into(), r.exception_limit().read()],
        [9, 0]
    );
}

#[test]
fn a_geometry_pass_is_described_before_it_is_started() {
    let (engine, block) = probe(IDENT);
    let mut engine = engine.unwrap();
    let options = GeometryStart::default().with_cull(true).with_smooth(true);
    let pass = pass(options.with_size(Size::W640));
    let prepared = engine.prepare_geometry(&pass);

    let r = registers();
    assert!(!r.geometry().read().start(), "not yet");
    // SAFETY: the model has no engine that accesses memory.
    unsafe { engine.start_geometry(prepared) };
    let wide = |low: u32, high: u16| {
        let bits = u64::from(high) << 32 | u64::from(low);
        // Sign-extends the number from 44 bits.
        (bits << 20).cast_signed() >> 20
    };
    let translation = [
        wide(r.tx_low().read(), r.tx_high().read()),
        wide(r.ty_low().read(), r.ty_high().read()),
        wide(r.tz_low().read(), r.tz_high().read()),
    ];
    assert_eq!(&translation, pass.translation);
    let rows = [
        [r.row_u0(), r.row_u1(), r.row_u2()],
        [r.row_v0(), r.row_v1(), r.row_v2()],
        [r.row_n0(), r.row_n1(), r.row_n2()],
        [r.light_0(), r.light_1(), r.light_2()],
    ];
    // Entries of rows have 25 bits.
    let rows = rows.map(|row| row.map(|value| value.read().cast_signed() << 7 >> 7));
    assert_eq!(rows.each_ref(), [pass.u, pass.v, pass.n, pass.light]);
    assert_eq!([r.near_low().read(), r.near_high().read().into()], [0, 8]);
    assert_eq!(
        (r.scale_shift().read(), r.depth_scale().read()),
        (13, pass.depth_scale)
    );
    assert_eq!(r.light_colour().read(), 1 << 18 | 7 << 9 | 256);
    assert_eq!(r.ambient().read(), 256 << 18 | 255 << 9);
    assert_eq!(r.mesh_bytes().read(), 80, "chunks alone");
    assert_eq!(r.mesh().read(), pass.mesh.as_ptr().addr() as u32);
    assert_eq!(
        [r.geometry_descriptors().read(), r.geometry_lists().read()],
        [0x4600_0000, 0x4700_0000]
    );
    assert_eq!(r.exceptions().read(), 0x4710_0000);
    assert_eq!(
        [r.descriptor_limit().read(), r.exception_limit().read()],
        [77, 5]
    );
    assert_eq!(r.list_shift().read(), 9);
    let start = r.geometry().read();
    assert!(start.start() && start.cull() && start.smooth());
    assert!(!start.append() && !start.mirror() && !start.recolour());
    assert_eq!(start.size(), Some(Size::W640));
    assert_eq!(
        block.borrow().writes.last().map(|write| write.0),
        Some(r.geometry().address())
    );
}

#[test]
fn a_geometry_pass_continues_the_lists_of_the_pass_before() {
    let (engine, block) = probe(IDENT);
    let mut engine = engine.unwrap();
    let prepared = engine.prepare_geometry(&Geometry {
        colour: Some(0x1234),
        lists: None,
        ..pass(GeometryStart::default().with_mirror(true))
    });
    let r = registers();
    let lists = [r.geometry_descriptors(), r.geometry_lists(), r.exceptions()]
        .map(|register| register.address());
    let kept = |(address, _): &(_, _)| !lists.contains(address);
    assert!(block.borrow().writes.iter().all(kept), "their places hold");
    // SAFETY: the model has no engine that accesses memory.
    unsafe { engine.start_geometry(prepared) };
    let start = r.geometry().read();
    assert!(start.start() && start.append() && start.mirror() && start.recolour());
    assert!(!start.cull() && !start.smooth());
    assert_eq!(r.colour().read(), 0x1234);
}

#[test]
fn a_raster_pass_is_described_before_it_is_started() {
    let (engine, block) = probe(IDENT);
    let set = |number: u32| Set {
        descriptors: 0x4600_0000 + number,
        count: 10 + number,
        lists: 0x4700_0000 + number,
    };
    let mut engine = engine.unwrap();
    let pass = Raster {
        size: Size::W1280,
        average: None,
        frame: 0x4100_0000,
        slot: true,
        whole: false,
        depth: None,
        clear: 0xabcd,
        sky: None,
        fog: None,
        dither: true,
        list_shift: 11,
        input: Input {
            sets: [Some(set(0)), None],
            textures: None,
        },
    };
    let r = registers();
    for (pass, second, depth) in [
        (pass, false, false),
        (
            Raster {
                depth: Some(0x4140_0000),
                input: Input {
                    sets: [None, Some(set(16))],
                    textures: Some(0x4720_0000),
                },
                ..pass
            },
            true,
            true,
        ),
    ] {
        // SAFETY: the model has no engine that accesses memory.
        unsafe { engine.start_raster(&pass) };
        let start = r.raster().read();
        assert!(start.start() && start.slot() && !start.whole() && start.dither());
        assert_eq!(
            [start.first(), start.second(), start.depth()],
            [!second, second, depth]
        );
        assert_eq!(start.size(), Some(Size::W1280));
        assert_eq!(
            block.borrow().writes.last().map(|write| write.0),
            Some(r.raster().address())
        );
    }
    assert_eq!([r.count_0().read(), r.count_1().read()], [10, 26]);
    assert_eq!(
        [r.lists_0().read(), r.lists_1().read()],
        [0x4700_0000, 0x4700_0010]
    );
    assert_eq!(r.depth().read(), 0x4140_0000);
    assert_eq!(r.textures().read(), 0x4720_0000);
    assert_eq!(r.clear().read(), 0xabcd);
    assert_eq!(r.list_shift().read(), 11);
}

#[test]
fn a_pass_ends_with_the_error_of_its_status() {
    let (engine, block) = probe(IDENT);
    let engine = engine.unwrap();
    let address = registers().status().address();
    let named = Error::ALL.map(|code| match code {
        Error::None => (code as u32, Ok(())),
        code => (code as u32, Err(EngineError::Status(code))),
    });
    let unnamed = (0xf, Err(EngineError::Unknown));
    for (code, result) in named.into_iter().chain([unnamed]) {
        let set = |status: u32| block.borrow_mut().values.insert(address, status);
        set(code << 4 | 0b10);
        assert_eq!((engine.geometry(), engine.raster()), (Some(result), None));
        set(code << 8 | 0b01);
        assert_eq!((engine.geometry(), engine.raster()), (None, Some(result)));
    }
}

#[test]
fn counters_are_read_by_name_and_their_differences_wrap() {
    let (engine, block) = probe(IDENT);
    let r = registers();
    let read = |busy: u32, flush: u32| {
        let values = [
            (r.cycles_busy().address(), busy),
            (r.cycles_flush().address(), flush),
        ];
        block.borrow_mut().values.extend(values);
        engine.as_ref().unwrap().counters()
    };
    let earlier = read(u32::MAX, 7);
    let since = read(5, 7).since(&earlier);
    let counted: Vec<_> = since.iter().filter(|(_, value)| *value != 0).collect();
    assert_eq!(counted, [("cycles_busy", 6)]);
}
