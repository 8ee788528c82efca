use std::cell::RefCell;
use std::rc::Rc;
use std::vec::Vec;

use glint_core::camera::View;
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, Turns, U4_28};
use glint_core::stereo::Stereo;
use glint_model::raymarch::FieldOptions;
use litex_pac::Peripherals;

use super::*;
use crate::recording::{self, Block};

const IDENT: u32 = raymarch::Raymarch::IDENT;

fn registers() -> raymarch::Raymarch {
    // SAFETY: a model on the bus answers all accesses, so no device is affected.
    unsafe { Peripherals::steal() }.raymarch
}

/// Probes a block whose registers `ident` and `caps` have the given values. Returns the result, and the block's registers.
fn probe(ident: u32, caps: u32) -> (Result<Raymarcher, Absent>, Rc<RefCell<Block>>) {
    let r = registers();
    let block = recording::connect([(r.ident().address(), ident), (r.caps().address(), caps)]);
    (Raymarcher::probe(registers()), block)
}

/// Register `caps` of a build with two lanes that draws sponges of up to six levels, boxes, spheres, fillets and two eyes,
/// and has the prepass.
const EVERYTHING: u32 = 2 | 6 << 4 | 0b1111 << 9 | 0b11 << 16;
/// Register `caps` of a build with four lanes that draws only sponges, of up to four levels.
const SPONGES: u32 = 4 | 4 << 4 | 1 << 16;

fn setup(field: &str, options: &FieldOptions) -> (FieldSetup, Palette) {
    let field = Field::parse(field).unwrap();
    let view = View::spherical(Q32_32::from_num(4), Turns(1 << 29), Turns(1 << 30)).unwrap();
    let setup = FieldSetup::new(&field, &view, (640, 360), options).unwrap();
    let palette = options.palette_for(&setup);
    (setup, palette)
}

fn cones() -> FieldOptions {
    FieldOptions {
        prepass: true,
        ..FieldOptions::default()
    }
}

fn stereo(text: &str) -> FieldOptions {
    FieldOptions {
        stereo: Some(Stereo::parse(text).unwrap()),
        ..FieldOptions::default()
    }
}

#[test]
fn something_else_is_not_taken_for_the_raymarcher() {
    for ident in [0, IDENT - 1] {
        let absent = Absent {
            expected: IDENT,
            found: ident,
        };
        assert_eq!(probe(ident, EVERYTHING).0.err(), Some(absent));
    }
    let (raymarcher, block) = probe(IDENT, EVERYTHING);
    let capabilities = Capabilities {
        lanes: 2,
        levels: 6,
        flat: 0b11,
        stereo: true,
        round: true,
        blend: true,
        prepass: true,
    };
    assert_eq!(raymarcher.unwrap().capabilities(), capabilities);
    let silent = (registers().ev_enable().address(), 0);
    assert_eq!(block.borrow().writes, [silent], "its interrupt is silent");
}

#[test]
fn what_is_not_built_is_refused_and_nothing_is_written() {
    let (raymarcher, block) = probe(IDENT, SPONGES);
    let mut raymarcher = raymarcher.unwrap();
    block.borrow_mut().writes.clear();
    for (field, options, missing) in [
        ("menger:5", FieldOptions::default(), Missing::Levels(4)),
        (
            "box:1,1,1",
            FieldOptions::default(),
            Missing::Flat(Kind::Box),
        ),
        (
            "cubes:2,0.5",
            FieldOptions::default(),
            Missing::Flat(Kind::Box),
        ),
        (
            "planes:1",
            FieldOptions::default(),
            Missing::Flat(Kind::Box),
        ),
        ("menger:4", stereo("0.05,3"), Missing::Stereo),
        ("menger:4", cones(), Missing::Prepass),
    ] {
        let (setup, palette) = setup(field, &options);
        assert_eq!(
            raymarcher.set_field(&setup, &palette),
            Err(missing),
            "{field}"
        );
        assert_eq!(block.borrow().writes, [], "{field}");
    }
    let (setup, palette) = setup("menger:4", &FieldOptions::default());
    assert_eq!(raymarcher.set_field(&setup, &palette), Ok(()));
}

#[test]
fn cones_come_before_the_rays() {
    let (raymarcher, _block) = probe(IDENT, EVERYTHING);
    let mut raymarcher = raymarcher.unwrap();
    let (setup, palette) = setup("menger:4", &cones());
    raymarcher.set_field(&setup, &palette).unwrap();
    let (cones, r) = (setup.cones.unwrap(), registers());
    assert_eq!(u32::from(r.cone_spread().read()), cones.spread);
    let offset = [r.cone_offset_x(), r.cone_offset_y(), r.cone_offset_z()];
    assert_eq!(offset.map(|x| x.read().cast_signed()), cones.offset);
    assert!(r.control().read().prepass());
}

#[test]
fn a_field_is_described_before_it_is_enabled() {
    let (raymarcher, block) = probe(IDENT, EVERYTHING);
    let mut raymarcher = raymarcher.unwrap();
    let (setup, palette) = setup("menger:3", &FieldOptions::default());
    raymarcher.set_field(&setup, &palette).unwrap();

    let r = registers();
    let solid = r.solid().read();
    assert_eq!(solid, solid.with_kind(Kind::Menger));
    assert_eq!(solid.levels(), 0b111);
    assert_eq!(r.cube_half().read(), 3 << 11, "half of the third level's 3");
    let tuning = r.tuning().read();
    assert_eq!(
        [
            u32::from(tuning.threshold()),
            tuning.footprint().into(),
            tuning.cap().into(),
            r.far().read()
        ],
        [
            setup.tuning.threshold,
            setup.tuning.footprint,
            setup.tuning.cap,
            setup.tuning.far
        ]
    );
    let eye = setup.eyes[0];
    let signed = |value: u32| value.cast_signed() << 7 >> 7;
    let origin = [r.origin_left_x(), r.origin_left_y(), r.origin_left_z()];
    assert_eq!(origin.map(|x| signed(x.read())), eye.origin, "of 25 bits");
    let first = [r.first_left_x(), r.first_left_y(), r.first_left_z()];
    assert_eq!(first.map(|x| x.read().cast_signed()), eye.first);
    let outside = [r.outside_left_x(), r.outside_left_y(), r.outside_left_z()];
    assert_eq!(outside.map(|x| x.read()), eye.outside);
    let across = [r.across_x(), r.across_y(), r.across_z()];
    assert_eq!(across.map(|x| x.read().cast_signed()), setup.steps[0]);
    let down = [r.down_x(), r.down_y(), r.down_z()];
    assert_eq!(down.map(|x| x.read().cast_signed()), setup.steps[1]);
    let bounds = [r.bounds_x(), r.bounds_y(), r.bounds_z()];
    assert_eq!(bounds.map(|x| x.read()), setup.bounds);
    assert_eq!(r.near().read(), setup.near);
    let scale = r.depth_scale().read();
    let exponent = (scale.exponent() << 2).cast_signed() >> 2;
    assert_eq!(
        (scale.mantissa(), i32::from(exponent)),
        (setup.depth.mantissa, setup.depth.exponent)
    );
    assert_eq!(r.colour_1().read(), 230 | 130 << 8 | 130 << 16, "red first");
    assert_eq!(r.colour_6().read(), 0xFF_FFFF, "undecided: the horizon");
    assert_eq!(r.horizon().read(), 0xFF_FFFF);

    let control = r.control().read();
    assert!(control.enable() && control.stereo() == Some(raymarch::Stereo::Mono));
    let last = block.borrow().writes.last().copied();
    assert_eq!(
        last.map(|(address, _)| address),
        Some(r.control().address())
    );
    raymarcher.clear_field();
    assert!(!r.control().read().enable());
}

#[test]
fn a_box_says_where_it_ends() {
    let (raymarcher, _block) = probe(IDENT, EVERYTHING);
    let mut raymarcher = raymarcher.unwrap();
    let r = registers();
    for (field, has, room, repeated, half) in [
        (
            "box:1,0.5,2",
            0b111,
            false,
            false,
            [165_888, 82_944, 331_776],
        ),
        ("cubes:2,0.5", 0b111, false, true, [65_536; 3]),
        ("planes:1", 0b100, true, false, [0, 0, 165_888]),
    ] {
        let (setup, palette) = setup(field, &FieldOptions::default());
        raymarcher.set_field(&setup, &palette).unwrap();
        let solid = r.solid().read();
        assert_eq!(solid, solid.with_kind(Kind::Box), "{field}");
        assert_eq!(
            (solid.has(), solid.room(), solid.repeated()),
            (has, room, repeated),
            "{field}"
        );
        let sides = [r.half_x(), r.half_y(), r.half_z()].map(|side| side.read());
        assert_eq!(sides, half, "{field}");
    }
}

#[test]
fn two_eyes_have_a_place_each_and_their_colours() {
    let (raymarcher, _block) = probe(IDENT, EVERYTHING);
    let mut raymarcher = raymarcher.unwrap();
    let r = registers();
    for (eyes, code) in [
        ("0.1,3", raymarch::Stereo::RedBlue),
        ("0.1,3,red-cyan", raymarch::Stereo::RedCyan),
    ] {
        let (setup, palette) = setup("menger:2", &stereo(eyes));
        raymarcher.set_field(&setup, &palette).unwrap();
        let control = r.control().read();
        assert!(control.enable());
        assert_eq!(control.stereo(), Some(code));
        let eye = setup.eyes[1];
        assert_ne!(eye, setup.eyes[0]);
        let first = [r.first_right_x(), r.first_right_y(), r.first_right_z()];
        assert_eq!(first.map(|x| x.read().cast_signed()), eye.first);
        let origin = [r.origin_right_x(), r.origin_right_y(), r.origin_right_z()];
        let signed = |value: u32| value.cast_signed() << 7 >> 7;
        assert_eq!(origin.map(|x| signed(x.read())), eye.origin);
    }
}

#[test]
fn tables_are_written_where_they_change() {
    let (raymarcher, block) = probe(IDENT, EVERYTHING);
    let mut raymarcher = raymarcher.unwrap();
    let address = registers().table().address();
    // Calls `set_field`. Returns index and value of each entry written through the register `table`, and the palette.
    let mut written = |options: &FieldOptions| {
        block.borrow_mut().writes.clear();
        let (setup, palette) = setup("menger:4", options);
        raymarcher.set_field(&setup, &palette).unwrap();
        let block = block.borrow();
        let writes = block.writes.iter().filter(|(at, _)| *at == address);
        let writes: Vec<(u32, u8)> = writes.map(|(_, word)| (word >> 8, *word as u8)).collect();
        (writes, palette)
    };
    let whole = |palette: &Palette| -> Vec<(u32, u8)> {
        let parts = palette.fog.iter().chain(&palette.occlusion).copied();
        (0..512).zip(parts).collect()
    };
    let plain = FieldOptions::default();
    let (writes, palette) = written(&plain);
    assert_eq!(writes, whole(&palette));
    assert_eq!(written(&plain).0, [], "they hold it already");
    let foggy = FieldOptions {
        fog: U4_28::ONE,
        ..plain
    };
    let (writes, palette) = written(&foggy);
    assert_eq!(writes, whole(&palette));
    assert_eq!(registers().fog_shift().read(), palette.fog_shift as u8);
}

#[test]
fn ray_counts_are_the_counters_of_rays() {
    let counters = Counters {
        items_in: 6,
        evaluations: 7,
        undecided: 8,
        ..Counters::default()
    };
    let counts = ray_counts(&counters);
    assert_eq!(
        (counts.rays, counts.evaluations, counts.undecided),
        (6, 7, 8)
    );
}
