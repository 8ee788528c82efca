//! The raymarcher's constants and items as its ports have them.

use glint_model::raymarch::{
    Cone, FieldSetup, Lights, Palette, Ray, RayResult, Solid, State, Surface, paint, rgb565,
};
use glint_testbench::{Bits, Module};

/// A pixel's place: parity of its band, line in it, column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    pub odd: bool,
    pub line: u32,
    pub column: u32,
    pub eye: usize,
}

const PLACE_BITS: usize = 19;

impl Place {
    fn number(&self) -> u64 {
        let flags = u64::from(self.odd) << 18 | (self.eye as u64) << 17;
        flags | u64::from(self.line) << 11 | u64::from(self.column)
    }

    fn of(number: u64) -> Self {
        Self {
            odd: number >> 18 & 1 == 1,
            eye: (number >> 17 & 1) as usize,
            line: (number >> 11 & 0x3F) as u32,
            column: (number & 0x7FF) as u32,
        }
    }
}

/// Three numbers of so many bits, the first in the lowest.
pub fn three(bits: usize, numbers: [i64; 3]) -> Bits {
    (0..3).fold(Bits::default(), |all, i| {
        all.with(bits * i, bits, numbers[i])
    })
}

pub fn ray(place: Place, ray: &Ray) -> Bits {
    three(18, ray.direction.map(i64::from))
        .with(54, 23, ray.start)
        .with(77, 10, ray.length)
        .with(87, PLACE_BITS, place.number())
}

/// Of a number of a cone and its eye.
impl Place {
    pub fn of_cone(eye: usize, number: u32) -> Self {
        Self {
            odd: false,
            line: number >> 11,
            column: number & 0x7FF,
            eye,
        }
    }
}

pub fn cone(place: Place, cone: &Cone) -> Bits {
    ray(place, &cone.ray).with(87 + PLACE_BITS, 16, cone.spread)
}

/// Where a ray has come to, as the end of one says. What does not count is 0: surface and slope without a hit, t of a ray
/// that was given up, a face behind a sphere, the direction of a ray that has not come to a sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct End {
    pub state: u64,
    pub round: bool,
    pub surface: u64,
    pub face: u64,
    pub share: u64,
    pub t: u64,
    pub steps: u64,
    pub length: u64,
    pub gap: u64,
    pub slope: u64,
    pub direction: [i32; 3],
}

impl End {
    pub fn expected(ray: &Ray, outcome: &RayResult) -> Self {
        let (state, surface, t) = match outcome.state {
            State::Miss => (0, None, (ray.direction[2].max(0) >> 9) as u64),
            State::Hit(surface) => (1, Some(surface), outcome.t.into()),
            State::Undecided => (2, None, 0),
        };
        let number = surface.and_then(Surface::number);
        let face = surface.and_then(Surface::face);
        let share = surface.map_or(0, Surface::share);
        Self {
            state,
            round: number.is_some(),
            surface: number.or(face).unwrap_or(0).into(),
            face: face
                .filter(|_| number.is_some() && share != 255)
                .unwrap_or(0)
                .into(),
            share: share.into(),
            t,
            steps: outcome.steps.min(255).into(),
            length: ray.length.into(),
            gap: outcome.gap.into(),
            slope: outcome.slope.into(),
            direction: number.map_or([0; 3], |_| ray.direction),
        }
    }

    /// The end of a cone: only how far it has come counts, and what that took.
    pub fn expected_of_cone(cone: &Cone, (t, steps): (u32, u32)) -> Self {
        Self {
            t: t.into(),
            steps: steps.min(255).into(),
            length: cone.ray.length.into(),
            ..Self::default()
        }
    }

    pub fn of_cone(item: &Bits) -> (Place, Self) {
        let end = Self {
            t: item.field(35, 23),
            steps: item.field(27, 8),
            length: item.field(58, 10),
            ..Self::default()
        };
        (Place::of(item.field(68, PLACE_BITS)), end)
    }

    pub fn of(item: &Bits) -> (Place, Self) {
        let state = item.field(25, 2);
        let if_hit = |value| if state == 1 { value } else { 0 };
        let round = if_hit(item.field(87, 1)) == 1;
        let share = if round { item.field(142, 8) } else { 0 };
        let end = Self {
            slope: if_hit(item.field(0, 10)),
            gap: item.field(10, 12),
            surface: if_hit(item.field(22, 3)),
            round,
            // Nothing of it is to be seen beside a whole sphere.
            face: if round && share != 255 {
                item.field(150, 3)
            } else {
                0
            },
            share,
            state,
            steps: item.field(27, 8),
            t: if state == 2 { 0 } else { item.field(35, 23) },
            length: item.field(58, 10),
            direction: if round {
                [0, 1, 2].map(|i| (item.field(88 + 18 * i, 18) as i32) << 14 >> 14)
            } else {
                [0; 3]
            },
        };
        (Place::of(item.field(68, PLACE_BITS)), end)
    }
}

fn solid(setup: &FieldSetup) -> Bits {
    let blend = setup.blend();
    let all = Bits::default()
        .with(105, 1, u8::from(setup.beside.is_some()))
        .with(106, 17, blend.inverse)
        .with(123, 17, blend.width);
    let all = setup.balls().map_or(all, |balls| {
        all.with(100, 3, balls.count as u64 - 1)
            .with(103, 1, u8::from(balls.repeated))
            .with(104, 1, 1)
    });
    match setup.solid {
        Solid::Menger { depth, half, .. } => {
            all.with(93, 6, (1_i64 << depth) - 1).with(71, 22, half)
        }
        Solid::Box {
            half,
            room,
            repeated,
        } => {
            let all = (0..3).fold(all, |all, i| {
                all.with(2 + i, 1, u8::from(half[i].is_some())).with(
                    5 + 22 * i,
                    22,
                    half[i].unwrap_or(0),
                )
            });
            all.with(0, 1, u8::from(repeated))
                .with(1, 1, u8::from(room))
                .with(99, 1, 1)
        }
        Solid::Balls(_) => all,
    }
}

/// Writes the spheres, with their materials.
fn set_balls(module: &mut Module, setup: &FieldSetup, lights: &Lights) {
    let Some(balls) = setup.balls() else { return };
    let [write, number, ball] = ["ball_write", "ball_number", "ball"].map(|name| module.port(name));
    module.set(write, 1);
    for (i, one) in (0..).zip(balls.list.iter().take(balls.count)) {
        module.set(number, i as u64);
        let bits = three(22, one.centre.map(i64::from))
            .with(66, 21, one.radius)
            .with(87, 17, one.inverse)
            .with(104, 5, one.shift)
            .with(109, 24, colour(lights.materials[i]));
        module.set(ball, bits);
        module.clock();
    }
    module.set(write, 0);
}

/// Sets what shines on spheres.
pub fn set_lights(module: &mut Module, setup: &FieldSetup, lights: &Lights) {
    let bits = (0..).zip(lights.list).fold(
        Bits::default()
            .with(312, 24, colour(lights.ambient))
            .with(336, 2, lights.count as u64 - 1),
        |all, (i, light)| {
            let all = all.with(216 + 24 * i, 24, colour(light.colour));
            (0..3).fold(all, |all, axis| {
                all.with(54 * i + 18 * axis, 18, light.direction[axis])
            })
        },
    );
    let port = module.port("lights");
    module.set(port, bits);
    set_balls(module, setup, lights);
}

/// Sets what holds during a frame, as far as a lane wants it.
pub fn set_lane(module: &mut Module, setup: &FieldSetup) {
    let [left, right] = setup.eyes.map(|eye| eye.origin.map(i64::from));
    let origins = (0..3).fold(three(25, left), |all, i| {
        all.with(75 + 25 * i, 25, right[i])
    });
    let tuning = &setup.tuning;
    let tuning = Bits::default()
        .with(0, 23, tuning.far)
        .with(23, 8, tuning.cap)
        .with(31, 4, tuning.footprint)
        .with(35, 16, tuning.threshold);
    for (name, value) in [
        ("origins", origins),
        ("bounds", three(24, setup.bounds.map(i64::from))),
        ("solid", solid(setup)),
        ("tuning", tuning),
    ] {
        let port = module.port(name);
        module.set(port, value);
    }
    set_balls(module, setup, &Palette::default().lights);
}

/// Sets what holds during a frame, as far as the generator wants it, in bands of so many lines.
pub fn set_generator(module: &mut Module, setup: &FieldSetup, band_lines: u32) {
    for (name, value) in [
        ("last_column", setup.width - 1),
        ("last_line", band_lines - 1),
        ("last_band", setup.height / band_lines - 1),
    ] {
        let port = module.port(name);
        module.set(port, u64::from(value));
    }
    set_rays(module, setup);
}

/// Sets where the rays begin.
pub fn set_rays(module: &mut Module, setup: &FieldSetup) {
    let eyes = setup.eyes;
    let both = |bits: usize, [left, right]: [[i64; 3]; 2]| {
        (0..3).fold(three(bits, left), |all, i| {
            all.with(bits * (3 + i), bits, right[i])
        })
    };
    let number = |value: u32| Bits::from(u64::from(value));
    for (name, value) in [
        ("stereo", number(setup.stereo.is_some().into())),
        ("first", both(32, eyes.map(|eye| eye.first.map(i64::from)))),
        ("across", three(32, setup.steps[0].map(i64::from))),
        ("down", three(32, setup.steps[1].map(i64::from))),
        ("near_limit", number(setup.near)),
        (
            "outside",
            both(24, eyes.map(|eye| eye.outside.map(i64::from))),
        ),
        (
            "origins",
            both(25, eyes.map(|eye| eye.origin.map(i64::from))),
        ),
    ] {
        let port = module.port(name);
        module.set(port, value);
    }
}

/// Sets what a block of pixels is in D.
pub fn set_blocks(module: &mut Module, setup: &FieldSetup, offset: &str, spread: &str) {
    let cones = setup.cones.map(|cones| (cones.offset, cones.spread));
    let (middle, widest) = cones.unwrap_or_default();
    for (name, value) in [
        (offset, three(32, middle.map(i64::from))),
        (spread, Bits::from(u64::from(widest))),
    ] {
        let port = module.port(name);
        module.set(port, value);
    }
}

/// The end of a ray.
pub fn end(place: Place, ray: &Ray, outcome: &RayResult) -> Bits {
    let End {
        state,
        round,
        surface,
        face,
        share,
        t,
        steps,
        length,
        gap,
        slope,
        direction: _,
    } = End::expected(ray, outcome);
    Bits::default()
        .with(0, 10, slope)
        .with(10, 12, gap)
        .with(22, 3, surface)
        .with(25, 2, state)
        .with(27, 8, steps)
        .with(35, 23, t)
        .with(58, 10, length)
        .with(68, PLACE_BITS, place.number())
        .with(87, 1, u8::from(round))
        .with(88, 18, ray.direction[0])
        .with(106, 18, ray.direction[1])
        .with(124, 18, ray.direction[2])
        .with(142, 8, share)
        .with(150, 3, face)
}

fn colour([r, g, b]: [u8; 3]) -> u64 {
    u64::from(b) << 16 | u64::from(g) << 8 | u64::from(r)
}

/// Sets what holds during a frame, as far as painting wants it, and fills its tables.
pub fn set_paint(module: &mut Module, setup: &FieldSetup, palette: &Palette) {
    let colours = palette
        .faces
        .into_iter()
        .chain([palette.undecided, palette.zenith]);
    let colours = (0..).zip(colours).fold(Bits::default(), |all, (i, one)| {
        all.with(24 * i, 24, colour(one))
    });
    let number = |bits: usize, value: i64| Bits::default().with(0, bits, value);
    for (name, value) in [
        ("stereo", number(2, setup.stereo.is_some().into())),
        ("depth_mantissa", number(17, setup.depth.mantissa.into())),
        ("depth_exponent", number(6, setup.depth.exponent.into())),
        ("fog_shift", number(3, palette.fog_shift.into())),
        ("palette", colours),
        ("horizon", number(24, colour(palette.horizon) as i64)),
    ] {
        let port = module.port(name);
        module.set(port, value);
    }
    let [write, entry, part] =
        ["table_write", "table_entry", "table_part"].map(|name| module.port(name));
    module.set(write, 1);
    let parts = palette.fog.iter().chain(&palette.occlusion);
    for (number, &value) in (0..).zip(parts) {
        module.set(entry, number);
        module.set(part, u64::from(value));
        module.clock();
    }
    module.set(write, 0);
}

/// A pixel as it goes to the band buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    pub eye: u64,
    pub row: u64,
    pub line: u64,
    pub column: u64,
    pub mask: u64,
    pub code: u64,
    pub colour: u64,
}

/// What painting makes of an end.
pub fn pixel(
    setup: &FieldSetup,
    palette: &Palette,
    place: Place,
    ray: &Ray,
    outcome: &RayResult,
) -> Pixel {
    let colour = paint(setup, palette, ray, outcome);
    let code = match outcome.state {
        State::Hit(_) => setup.depth_code(ray, outcome.reached()),
        _ => 0,
    };
    let colour = match setup.stereo {
        None => rgb565(colour),
        Some(_) => u16::from_le_bytes([colour[1]; 2]),
    };
    Pixel {
        eye: place.eye as u64,
        row: u64::from(place.line * setup.width / 8 + place.column / 8),
        line: place.line.into(),
        column: u64::from(place.column / 8),
        mask: 1 << (place.column % 8),
        code: code.into(),
        colour: colour.into(),
    }
}
