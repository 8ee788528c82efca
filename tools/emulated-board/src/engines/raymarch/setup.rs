//! Converts the registers to the constants of a frame with a field.

use glint_core::field::{FixedBox, FixedSpheres, FixedSponge, FlatConstants, FlatSolid, Solid};
use glint_core::fixed::Q32_32;
use glint_core::picture::Size;
use glint_core::stereo::Tint;
use glint_model::DepthScale;
use glint_model::raymarch::exits::{self, Exits, Rule, Side, Start, Words};
use glint_model::raymarch::{Beside, FieldSetup, Form, Marching, Palette};
use litex_pac::raymarch::{
    Control, DepthScale as DepthScaleRegister, Exit, Exits as ExitsRegister, Rule as RuleRegister,
    Solid as SolidRegister, Stereo, Tuning as TuningRegister, offset,
};
use litex_pac::register::Value;

use super::spheres::{Spheres, colour};
use crate::engines::parameters::Parameters;

/// Table of fog, indexed by depth, and table of occlusion, indexed by the number of evaluations.
pub type Tables = [[u8; 256]; 2];

/// The smallest exponent of the depth scale for which the shifted scale fits 64 bits. The exponent of a valid frame is larger.
const LEAST_EXPONENT: i32 = -20;

/// The constants of the rays and of the solid.
pub fn field_setup(
    parameters: &Parameters,
    control: Control,
    spheres: &Spheres,
    size: Size,
) -> FieldSetup {
    let [width, height] = size.pixels();
    let stereo = match control.stereo() {
        Some(Stereo::Mono) => None,
        Some(Stereo::RedBlue) => Some(Tint::RedBlue),
        Some(Stereo::RedCyan) | None => Some(Tint::RedCyan),
    };
    let scale = DepthScaleRegister::from_bits(parameters.word(offset::DEPTH_SCALE));
    // A 6-bit number in two's complement.
    let exponent = i32::from((scale.exponent() << 2) as i8 >> 2);
    let depth = DepthScale {
        mantissa: scale.mantissa(),
        exponent: exponent.max(LEAST_EXPONENT),
        origin: None,
    };
    let exits = ExitsRegister::from_bits(parameters.word(offset::EXITS));
    let leaving = leaving(parameters, exits, spheres, [width, height]);
    let form = if exits.enable() {
        Form::Exits(leaving)
    } else {
        Form::Marching(marching(parameters, spheres, leaving))
    };
    FieldSetup {
        width,
        height,
        // The rays use neither the scale of the world nor the exponent of their directions.
        scale: Q32_32::ONE,
        exponent: 0,
        depth,
        world_depth: depth,
        stereo,
        form,
    }
}

/// The constants of rays by exits.
fn leaving(
    parameters: &Parameters,
    register: ExitsRegister,
    spheres: &Spheres,
    [width, height]: [u32; 2],
) -> Exits {
    const AXIS: u32 = offset::ORIGIN_LEFT_Y - offset::ORIGIN_LEFT_X;
    const RAY: u32 = offset::FIRST_LEFT_X - offset::ORIGIN_LEFT_X;
    let field = SolidRegister::from_bits(parameters.word(offset::SOLID));
    let rule = match register.rule() {
        RuleRegister::Planes => Rule::Planes,
        RuleRegister::Sponge => Rule::sponge(register.depth().into()),
        RuleRegister::Cubes => Rule::Repeated {
            round: register.depth() & 1 == 1,
        },
        RuleRegister::Box if register.depth() & 1 == 1 => Rule::Octahedron,
        RuleRegister::Box => Rule::Box,
    };
    let axes = |[x, y, z]: [i32; 3]| [x, y, z, 0];
    let half = [offset::HALF_X, offset::HALF_Y, offset::HALF_Z];
    let [x, y, z] = half.map(|at| 2 * i64::from(parameters.unsigned(at, 21)));
    let solid = exits::Solid {
        rule,
        // Only an octahedron has a fourth side.
        side: [x, y, z, x],
    };
    let eyes = [
        (offset::ORIGIN_LEFT_X, register.left_exit()),
        (offset::ORIGIN_RIGHT_X, register.right_exit()),
    ];
    Exits {
        words: Words::CHOSEN,
        width,
        height,
        // The rays use neither the scale of the world nor the exponent of their directions.
        scale: Q32_32::ONE,
        exponent: 0,
        eyes: eyes.map(|(first, exit)| {
            let rows = [0, AXIS, 2 * AXIS].map(|axis| first + axis);
            let [x, y, z] = rows.map(|at| i64::from(parameters.signed(at, 25)));
            let place = [x, y, z, 0];
            exits::Eye {
                first: axes(rows.map(|at| parameters.signed(at + RAY, 32))),
                start: start(parameters, &solid, first, exit),
                ..exits::Eye::placed(place, &Some(solid))
            }
        }),
        steps: [offset::ACROSS_X, offset::DOWN_X].map(|first| axes(parameters.row(first, 32))),
        near: parameters.unsigned(offset::NEAR, 28).into(),
        far: parameters.unsigned(offset::FAR, 28).into(),
        solid: Some(solid),
        sun: register.shadow().then(|| spheres.sun()),
        spheres: round(field, spheres),
        rectangles: Default::default(),
    }
}

/// The prism around an eye; the registers of the eye begin at `first`.
fn start(parameters: &Parameters, solid: &exits::Solid, first: u32, exit: Option<Exit>) -> Start {
    const START: u32 = offset::START_LEFT_X - offset::ORIGIN_LEFT_X;
    const MIRRORED: u32 = offset::START_LEFT_MIRRORED_X - offset::START_LEFT_X;
    const NEXT: u32 = offset::NEXT_LEFT_X - offset::ORIGIN_LEFT_X;
    const AXIS: u32 = offset::NEXT_LEFT_Y - offset::NEXT_LEFT_X;
    let side = |way: u32, axis: u32| {
        let plane = parameters.word(first + START + way * MIRRORED + 4 * axis);
        // Along the fourth axis, a ray always enters the slab.
        let next = match axis {
            3 => 0,
            _ => solid.interval(parameters.word(first + NEXT + axis * AXIS) >> (16 * way) & 0x1FFF),
        };
        Side {
            is_bounded: plane >> 25 & 1 == 1,
            distance: i64::from(plane & 0x1FF_FFFF),
            next,
            is_away: plane >> 26 & 1 == 1,
            is_last: plane >> 27 & 1 == 1,
        }
    };
    Start {
        exit: match exit {
            Some(Exit::First) => exits::Exit::First,
            Some(Exit::Last) => exits::Exit::Last,
            Some(Exit::Second) | None => exits::Exit::Second,
        },
        sides: [0, 1].map(|way| [0, 1, 2, 3].map(|axis| side(way, axis))),
    }
}

/// The constants of marching rays. `entry` has the constants of the rays by exits up to the
/// bounding box.
fn marching(parameters: &Parameters, spheres: &Spheres, entry: Exits) -> Marching {
    let register = SolidRegister::from_bits(parameters.word(offset::SOLID));
    let tuning = TuningRegister::from_bits(parameters.word(offset::TUNING));
    let bounds = [offset::BOUNDS_X, offset::BOUNDS_Y, offset::BOUNDS_Z];
    let [x, y, z] = bounds.map(|at| 2 * i64::from(parameters.unsigned(at, 21)));
    Marching {
        entry: Exits {
            solid: Some(exits::Solid {
                rule: Rule::Box,
                side: [x, y, z, x],
            }),
            ..entry
        },
        solid: solid(parameters, register),
        beside: Beside {
            spheres: round(register, spheres),
            blend: spheres.blend,
            bend: 0,
        },
        threshold: tuning.threshold().into(),
        footprint: u32::from(tuning.footprint()) + 7,
        cap: tuning.cap().into(),
    }
}

/// The flat solid of marching rays: a box, or a sponge with levels.
fn solid(parameters: &Parameters, register: SolidRegister) -> Solid {
    let lengths = [offset::HALF_X, offset::HALF_Y, offset::HALF_Z];
    let constants = FlatConstants {
        levels: register.levels(),
        has: 0b111,
        half: lengths.map(|at| parameters.unsigned(at, 22)),
        ..FlatConstants::default()
    };
    match constants.levels {
        0 => FixedBox::of(&constants).into(),
        _ => FixedSponge::of(&constants).into(),
    }
}

/// The constants of the spheres of a frame.
fn round(register: SolidRegister, spheres: &Spheres) -> FixedSpheres {
    let count = usize::from(register.last_sphere()) + 1;
    FixedSpheres {
        list: spheres.list,
        count,
        repeated: register.spheres_repeated(),
        cone: spheres.cone(count - 1),
    }
}

/// The colours and tables for the pixels of the field.
pub fn palette(
    parameters: &Parameters,
    spheres: &Spheres,
    tables: &Tables,
    is_stereo: bool,
) -> Palette {
    let register = SolidRegister::from_bits(parameters.word(offset::SOLID));
    let colours: [[u8; 3]; 8] =
        std::array::from_fn(|number| colour(parameters.word(offset::COLOUR_0 + 4 * number as u32)));
    let [a, b, c, d, e, f, undecided, zenith] = colours;
    let [g, h] = spheres.faces;
    let [fog, occlusion] = *tables;
    Palette {
        faces: [a, b, c, d, e, f, g, h],
        shadows: spheres.shadows,
        lights: spheres.lights(register.last_light(), is_stereo),
        undecided,
        zenith,
        horizon: colour(parameters.word(offset::HORIZON)),
        fog,
        fog_shift: parameters.unsigned(offset::FOG_SHIFT, 3),
        occlusion,
    }
}
