use std::cell::RefCell;
use std::rc::Rc;
use std::vec::Vec;

use litex_pac::Peripherals;
use litex_pac::recording::{self, Block};

use super::*;

const IDENT: u32 = raymarch::Raymarch::IDENT;

fn registers() -> raymarch::Raymarch {
    // SAFETY: a model on the bus answers all accesses, so no device is affected.
    unsafe { Peripherals::steal() }.raymarch
}

/// Probes a block with the given value of the register `ident`. The block's build has two lanes, and draws sponges of up to six levels,
/// boxes, spheres, fillets and stereo pictures. Returns the result, and the block's registers.
fn probe(ident: u32) -> (Result<Raymarcher, Absent>, Rc<RefCell<Block>>) {
    let r = registers();
    let caps = 2 | 6 << 4 | 1 << 7 | 0b111_1111 << 9 | 0b11 << 16;
    let block = recording::connect([(r.ident().address(), ident), (r.caps().address(), caps)]);
    (Raymarcher::probe(registers()), block)
}

#[test]
fn something_else_is_not_taken_for_the_raymarcher() {
    for ident in [0, IDENT - 1] {
        let absent = Absent {
            expected: IDENT,
            found: ident,
        };
        assert_eq!(probe(ident).0.err(), Some(absent));
    }
    let (raymarcher, block) = probe(IDENT);
    let capabilities = Capabilities {
        lanes: 2,
        levels: 6,
        flat: 0b11,
        stereo: true,
        round: true,
        blend: true,
        lattice: true,
        normals: true,
        highlight: true,
        shadow: true,
        cone: true,
    };
    assert_eq!(raymarcher.unwrap().capabilities(), capabilities);
    let silent = (registers().ev_enable().address(), 0);
    assert_eq!(block.borrow().writes, [silent], "the interrupt is disabled");
}

/// A field whose rays have this form.
fn field(form: Form<'_>) -> Field<'_> {
    Field {
        control: Control::default().with_stereo(Stereo::RedCyan),
        solid: Solid::default().with_levels(0b111),
        half: [40, 41, 42],
        exits: Exits::default(),
        prisms: Default::default(),
        form,
        limits: [44, 45],
        origins: [[1, -2, 3], [-10, 11, -12]],
        first: [[-7, 8, -9], [16, -17, 18]],
        steps: [[22, -23, 24], [-25, 26, -27]],
        depth_scale: DepthScale::default().with_mantissa(47),
        faces: &[[230, 130, 0]; 8],
        sky: [[1; 3], [2; 3], [3; 3]],
        fog_shift: 5,
    }
}

#[test]
fn a_field_is_described_before_it_is_enabled() {
    let (raymarcher, block) = probe(IDENT);
    let mut raymarcher = raymarcher.unwrap();
    let faces = [0, 1, 2, 3, 4, 5, 6, 7].map(|face| [230, 130, face]);
    let tuning = Tuning::default().with_cap(1020);
    let bounds = [19, 20, 21];
    let field = Field {
        faces: &faces,
        ..field(Form::March {
            tuning,
            bounds: &bounds,
        })
    };
    raymarcher.set_field(&field);
    let r = registers();
    assert_eq!(r.solid().read(), field.solid);
    assert!(!r.exits().read().enable());
    let half = [r.half_x(), r.half_y(), r.half_z()];
    assert_eq!(half.map(|x| x.read()), field.half);
    assert_eq!(r.tuning().read(), tuning);
    assert_eq!([r.far().read(), r.near().read()], field.limits);
    // Coordinates of an eye have 25 bits.
    let origins = [
        [r.origin_left_x(), r.origin_left_y(), r.origin_left_z()],
        [r.origin_right_x(), r.origin_right_y(), r.origin_right_z()],
    ];
    let origins = origins.map(|row| row.map(|x| x.read().cast_signed() << 7 >> 7));
    assert_eq!(origins, field.origins);
    let first = [
        [r.first_left_x(), r.first_left_y(), r.first_left_z()],
        [r.first_right_x(), r.first_right_y(), r.first_right_z()],
    ];
    let first = first.map(|row| row.map(|x| x.read().cast_signed()));
    assert_eq!(first, field.first);
    let found = [r.bounds_x(), r.bounds_y(), r.bounds_z()];
    assert_eq!(found.map(|x| x.read() as i32), bounds);
    let steps = [
        [r.across_x(), r.across_y(), r.across_z()],
        [r.down_x(), r.down_y(), r.down_z()],
    ];
    let steps = steps.map(|step| step.map(|x| x.read().cast_signed()));
    assert_eq!(steps, field.steps);
    assert_eq!(r.depth_scale().read(), field.depth_scale);
    assert_eq!(r.colour_1().read(), 230 | 130 << 8 | 1 << 16, "red first");
    let sky = [r.colour_6(), r.colour_7(), r.horizon()];
    assert_eq!(sky.map(|x| x.read()), [0x01_0101, 0x02_0202, 0x03_0303]);
    let entry = r.sphere().read();
    assert_eq!(
        (entry.entry(), entry.value() >> 16),
        (33, 7),
        "the last face"
    );
    assert_eq!(r.fog_shift().read(), field.fog_shift);

    assert_eq!(r.control().read(), field.control.with_enable(true));
    let last = block.borrow().writes.last().copied();
    assert_eq!(
        last.map(|(address, _)| address),
        Some(r.control().address())
    );
    raymarcher.clear_field();
    assert!(!r.control().read().enable());
}

#[test]
fn rays_by_exits_have_the_prism_around_each_eye() {
    let (raymarcher, _block) = probe(IDENT);
    let exits = Exits::default()
        .with_rule(Rule::Sponge)
        .with_depth(3)
        .with_right_exit(Exit::Last);
    // Planes are numbered by eye, direction and axis.
    let start = |number: u32| Start {
        distance: 100 + number,
        there: number.is_multiple_of(2),
        away: number.is_multiple_of(3),
        last: number.is_multiple_of(5),
        next: 0x1000 | number as u16,
    };
    let prism =
        |eye: u32| [0, 1].map(|way| [0, 1, 2, 3].map(|axis| start(8 * eye + 4 * way + axis)));
    raymarcher.unwrap().set_field(&Field {
        exits,
        prisms: [prism(0), prism(1)],
        ..field(Form::Exits {
            borders: [-1, 2, -3],
        })
    });
    let r = registers();
    assert_eq!(r.exits().read(), exits.with_enable(true));
    let borders = [r.border_x(), r.border_y(), r.border_z()];
    assert_eq!(borders.map(|x| x.read()), [0x3F_FFFF, 2, 0x3F_FFFD]);
    let planes = [
        r.start_left_x(),
        r.start_left_y(),
        r.start_left_z(),
        r.start_left_sum(),
        r.start_left_mirrored_x(),
        r.start_left_mirrored_y(),
        r.start_left_mirrored_z(),
        r.start_left_mirrored_sum(),
        r.start_right_x(),
        r.start_right_y(),
        r.start_right_z(),
        r.start_right_sum(),
        r.start_right_mirrored_x(),
        r.start_right_mirrored_y(),
        r.start_right_mirrored_z(),
        r.start_right_mirrored_sum(),
    ];
    for (number, plane) in (0..).zip(planes) {
        let Start {
            distance,
            there,
            away,
            last,
            ..
        } = start(number);
        let flags = u32::from(there) | u32::from(away) << 1 | u32::from(last) << 2;
        // The fourth axis has no last flag.
        let flags = if number % 4 == 3 { flags & 3 } else { flags };
        assert_eq!(plane.read(), distance | flags << 25, "plane {number}");
    }
    let next = [
        r.next_left_x(),
        r.next_left_y(),
        r.next_left_z(),
        r.next_right_x(),
        r.next_right_y(),
        r.next_right_z(),
    ];
    let next = next.map(|next| [next.read() & 0xFFFF, next.read() >> 16]);
    let axes = [0, 1, 2, 8, 9, 10].map(|number| [0x1000 | number, 0x1000 | (number + 4)]);
    assert_eq!(next, axes);
}

#[test]
fn tables_are_written_where_they_change() {
    let (raymarcher, block) = probe(IDENT);
    let mut raymarcher = raymarcher.unwrap();
    let address = registers().table().address();
    // Returns index and value of each entry that was written.
    let mut written = |fog: u8| {
        block.borrow_mut().writes.clear();
        raymarcher.set_tables([&[fog; 256], &[3; 256]]);
        let block = block.borrow();
        let writes = block.writes.iter().filter(|(at, _)| *at == address);
        let writes = writes.map(|(_, word)| (word >> 8, *word as u8));
        writes.collect::<Vec<(u32, u8)>>()
    };
    let whole = |fog: u8| -> Vec<(u32, u8)> {
        let value = |entry| if entry < 256 { fog } else { 3 };
        (0..512).map(|entry| (entry, value(entry))).collect()
    };
    assert_eq!(written(1), whole(1));
    assert_eq!(written(1), [], "the tables already have this content");
    assert_eq!(written(2), whole(2));
}
