//! Tests of frames that a build of the raymarcher cannot draw. The emulated board's tests compare all other frames with the model.

use glint_core::camera::View;
use glint_core::field::Field;
use glint_core::fixed::{Q32_32, Turns};
use glint_core::stereo::Stereo;
use glint_engines::raymarch::{Missing, set_field};
use glint_hal::raymarch::{Kind, Raymarcher};
use glint_model::raymarch::{FieldOptions, FieldSetup};
use litex_pac::{Peripherals, recording};

/// Register `caps` of a build with four lanes that draws only sponges, of up to four levels.
const SPONGES: u32 = 4 | 4 << 4 | 1 << 16;

#[test]
fn what_is_not_built_is_refused_and_nothing_is_written() {
    // SAFETY: a model on the bus answers all accesses, so no device is affected.
    let registers = unsafe { Peripherals::steal() }.raymarch;
    let block = recording::connect([
        (
            registers.ident().address(),
            litex_pac::raymarch::Raymarch::IDENT,
        ),
        (registers.caps().address(), SPONGES),
    ]);
    let mut raymarcher = Raymarcher::probe(registers).unwrap();
    let plain = FieldOptions::default();
    let stereo = FieldOptions {
        stereo: Some(Stereo::parse("0.05,3").unwrap()),
        ..plain
    };
    for (field, options, expected) in [
        ("menger:5", plain, Err(Missing::Levels(4))),
        ("box:1,1,1", plain, Err(Missing::Flat(Kind::Box))),
        ("cubes:2,0.5", plain, Err(Missing::Flat(Kind::Box))),
        ("planes:1", plain, Err(Missing::Flat(Kind::Box))),
        ("octahedron:1", plain, Err(Missing::Flat(Kind::Octahedron))),
        ("sphere:1", plain, Err(Missing::Round)),
        ("lattice:1,0.3", plain, Err(Missing::Lattice)),
        ("menger:4", stereo, Err(Missing::Stereo)),
        ("menger:4", plain, Ok(())),
    ] {
        block.borrow_mut().writes.clear();
        let shape = Field::parse(field).unwrap();
        let view = View::spherical(Q32_32::from_num(4), Turns(1 << 29), Turns(1 << 30)).unwrap();
        let setup = FieldSetup::new(&shape, &view, (640, 360), &options).unwrap();
        let palette = options.palette_for(&setup);
        let set = set_field(&mut raymarcher, &setup, &palette, false);
        assert_eq!(set, expected, "{field}");
        assert_eq!(block.borrow().writes.is_empty(), set.is_err(), "{field}");
    }
}

/// In a field of rays by exits, the gateware always intersects rays with cones, so a frame without spheres must replace the cones of the
/// previous frame.
#[test]
fn a_frame_without_spheres_has_a_cone_that_no_pixel_sees() {
    // SAFETY: a model on the bus answers all accesses, so no device is affected.
    let registers = unsafe { Peripherals::steal() }.raymarch;
    let [address, value] = [
        registers.cone_address().address(),
        registers.cone_value().address(),
    ];
    let block = recording::connect([
        (
            registers.ident().address(),
            litex_pac::raymarch::Raymarch::IDENT,
        ),
        (registers.caps().address(), SPONGES | 1 << 10),
    ]);
    let mut raymarcher = Raymarcher::probe(registers).unwrap();
    let field = Field::parse("menger:2").unwrap();
    let view = View::spherical(Q32_32::from_num(4), Turns(1 << 29), Turns(1 << 30)).unwrap();
    let options = FieldOptions::default();
    let setup = FieldSetup::new(&field, &view, (640, 360), &options).unwrap();
    let palette = options.palette_for(&setup);
    set_field(&mut raymarcher, &setup, &palette, false).unwrap();
    let block = block.borrow();
    let of = |register: usize| {
        let writes = block.writes.iter().filter(move |(at, _)| *at == register);
        writes.map(|(_, word)| *word).collect::<Vec<u32>>()
    };
    assert_eq!(of(address), [0]);
    assert_eq!(of(value)[0], 1, "the first column exceeds the last one");
}
