//! Packs and unpacks values on the ports of the raymarcher's modules: frame constants, rays,
//! results of rays, and pixels. docs/raymarch.md explains the two kinds of rays: rays by exits, and
//! marching rays.

use crate::{Bits, Layout, Module, Record};
use glint_core::colour::{Rgb565, Rounding};
use glint_core::field::{FixedCone, Solid, Surface, magnitude};
use glint_model::raymarch::exits::{Beam, Cone, Cones, Exit, Exits, Eye, Inverse, Rule, Side};
use glint_model::raymarch::{
    FieldSetup, Form, Lights, MARCH_FRACTION, Marching, Palette, Ray, RayEnd, RayResult, State,
    paint,
};

/// Position of a pixel, as in the member `place` of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RayPlace {
    /// Whether the index of the pixel's band is odd.
    pub odd: bool,
    /// Line within the band.
    pub line: u32,
    /// Column in the picture.
    pub column: u32,
    /// Eye: 0 for the left or only eye, 1 for the right eye.
    pub eye: usize,
}

impl RayPlace {
    fn set(&self, record: &mut Record) {
        record.set("place.odd", self.odd);
        record.set("place.eye", self.eye as u64);
        record.set("place.line", self.line);
        record.set("place.column", self.column);
    }

    /// Packs the place into a number, as the member `place` of an `exit_pkg::ray_t`.
    #[must_use]
    pub fn bits(&self) -> u32 {
        u32::from(self.odd) << 18 | (self.eye as u32) << 17 | self.line << 11 | self.column
    }

    fn of(record: &Record) -> Self {
        Self {
            odd: record.is_set("place.odd"),
            eye: record.get("place.eye") as usize,
            line: record.get("place.line") as u32,
            column: record.get("place.column") as u32,
        }
    }
}

/// Packs a marching ray, before its first step, as a `ray_t`.
pub fn ray(layout: &Layout, place: RayPlace, ray: &Ray) -> Bits {
    let mut record = layout.record();
    record.set_all("direction", ray.direction);
    record.set("height", ray.height);
    record.set("over", ray.is_over);
    record.set("start", ray.start);
    place.set(&mut record);
    record.bits()
}

/// Packs the members of an `exit_pkg::ray_t` that a marching ray uses: place, height, the upper 18
/// bits of the direction, and the start of a ray that has not ended.
pub fn marching_ray(layout: &Layout, place: RayPlace, ray: &Ray) -> Bits {
    let mut record = layout.record();
    record.set("place", place.bits());
    record.set("height", ray.height);
    record.set("over", ray.is_over);
    if !ray.is_over {
        record.set("start", ray.start << (14 - MARCH_FRACTION));
    }
    let down = (0..3).filter(|&axis| ray.direction[axis] < 0);
    record.set("down", down.map(|axis| 1_u32 << axis).sum::<u32>());
    for (axis, part) in ray.direction.into_iter().enumerate() {
        record.set(&format!("speed[{axis}]"), magnitude(part) << 6);
    }
    record.bits()
}

/// Clears the members of an `exit_pkg::ray_t` that a marching ray does not use.
#[must_use]
pub fn marching_part(layout: &Layout, found: &Record) -> Bits {
    let mut record = layout.record();
    for name in ["place", "height", "down", "over"] {
        record.set(name, found.get(name));
    }
    if !found.is_set("over") {
        let cut = 14 - MARCH_FRACTION;
        record.set("start", found.get("start") >> cut << cut);
    }
    for axis in 0..3 {
        let name = format!("speed[{axis}]");
        record.set(&name, found.get(&name) >> 6 << 6);
    }
    record.bits()
}

/// Packs a ray by exits, before its first evaluation, as an `exit_pkg::ray_t`. In a build with
/// spheres, `cones` are the cones of both eyes, and the ray contains the sphere that it meets.
pub fn exit_ray(
    layout: &Layout,
    exits: &Exits,
    place: RayPlace,
    beam: &Beam,
    cones: Option<&[Cones; 2]>,
) -> Bits {
    let solid = exits.solid.unwrap_or_default();
    let mut record = layout.record();
    record.set("place", place.bits());
    let start = &beam.start;
    let met = cones.and_then(|cones| exits.meet(cones, beam).0);
    let round = cones.is_some();
    let limit = met.map_or(exits.far, |met| met.t);
    let is_over = exits.ends_at_start(beam, limit);
    if round {
        record.set("sphere.t", limit as u64);
        if let Some(met) = met {
            record.set("sphere.met", 1);
            record.set("sphere.number", met.number);
        }
    }
    record.set("over", is_over);
    record.set("height", beam.height());
    let down = (0..3).filter(|&axis| beam.down[axis]);
    record.set("down", down.map(|axis| 1_u32 << axis).sum::<u32>());
    for axis in 0..3 {
        record.set(&format!("speed[{axis}]"), beam.speed[axis] >> 5);
        record.set(&format!("inverse[{axis}]"), beam.inverse[axis].word());
    }
    if solid.rule.is_lattice() {
        set_length(&mut record, beam);
    }
    if solid.rule == Rule::Octahedron {
        record.set("down_sum", beam.down[3]);
    }
    // A ray that has ended has no start.
    if !is_over {
        record.set("start", start.t);
        record.set("axis", start.face as u64);
        for axis in 0..3 {
            record.set(&format!("reached[{axis}]"), solid.code(start.reached[axis]));
        }
    }
    record.bits()
}

/// Sets the members that only rays in lattices use: the square of the direction's length, and its
/// reciprocal.
fn set_length(record: &mut Record, beam: &Beam) {
    let short = (beam.square + (1 << 7)) >> 8;
    record.set("length.square", short.min((1 << 17) - 1));
    record.set("length.doublings", beam.doublings);
    let Inverse { mantissa, exponent } = beam.inverse_square;
    record.set("inverse_square.exponent", exponent + 2);
    record.set("inverse_square.mantissa", mantissa >> 4 & ((1 << 18) - 1));
}

/// Clears the members that have no meaning: the start of a ray that has ended, the sphere number of
/// a ray that meets no sphere, and the direction's length outside of lattices.
#[must_use]
pub fn with_meaning(record: &Record, exits: &Exits) -> Bits {
    let mut record = record.clone();
    if record.is_set("over") {
        for name in ["start", "axis", "reached[0]", "reached[1]", "reached[2]"] {
            record.set(name, 0);
        }
    }
    if !record.is_set("sphere.met") {
        record.set("sphere.number", 0);
    }
    if !exits.solid.is_some_and(|solid| solid.rule.is_lattice()) {
        for name in [
            "length.square",
            "length.doublings",
            "inverse_square.exponent",
            "inverse_square.mantissa",
        ] {
            record.set(name, 0);
        }
    }
    record.bits()
}

/// Final state of a ray. `NAMES` has the states' names in the SystemVerilog type `state_t`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// The ray left the box or reached the far limit.
    #[default]
    Miss,
    /// The ray reached a surface.
    Hit,
    /// The ray reached the step limit.
    Undecided,
    /// The ray reached a face in the shadow of the first light.
    Shaded,
}

impl Kind {
    const NAMES: [(Self, &str); 4] = [
        (Self::Miss, "MISS"),
        (Self::Hit, "HIT"),
        (Self::Undecided, "UNDECIDED"),
        (Self::Shaded, "SHADED"),
    ];

    fn name(self) -> &'static str {
        Self::NAMES[self as usize].1
    }

    fn of(record: &Record) -> Self {
        let name = record.name("state");
        let kinds = Self::NAMES.into_iter();
        let mut found = kinds.filter_map(|(kind, text)| (name == Some(text)).then_some(kind));
        found.next().unwrap_or_else(|| panic!("{record:?}"))
    }
}

/// End of a marching ray: the result from a lane. Unused members are 0: without a hit, all members
/// except `steps` and `t`; for an undecided ray, also `t`; at a hit on a sphere outside of fillets,
/// `face`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct End {
    /// Whether the ray missed, hit or stayed undecided.
    pub state: Kind,
    /// Number of the sphere.
    pub surface: u64,
    /// On a fillet, which joins a sphere and a flat face: axis and sign of this face.
    pub face: u64,
    /// Weight of the sphere in the surface, u0.8: 0 on a face, 255 on a sphere, between 0 and 255 on a fillet.
    pub share: u64,
    /// Ray parameter T of the hit, u14.14; after a miss, the height of the sky.
    pub t: u64,
    /// Number of evaluations of the field; 255 stands for 255 or more.
    pub steps: u64,
    /// Direction of a ray that hits.
    pub direction: [i32; 3],
}

impl End {
    /// Converts the model's result of a ray to the expected end.
    #[must_use]
    pub fn expected(ray: &Ray, outcome: &RayResult) -> Self {
        let (state, surface, t) = match outcome.state {
            State::Miss => (Kind::Miss, None, ray.height.into()),
            State::Hit(surface) => (
                Kind::Hit,
                Some(surface),
                u64::from(outcome.t) << (14 - MARCH_FRACTION),
            ),
            State::Undecided => (Kind::Undecided, None, 0),
        };
        let member = |of: fn(Surface) -> Option<u8>| surface.and_then(of).unwrap_or_default();
        Self {
            state,
            surface: member(Surface::number).into(),
            face: member(Surface::face).into(),
            share: surface.map_or(0, Surface::share).into(),
            t,
            steps: outcome.steps.min(255).into(),
            direction: surface.map_or([0; 3], |_| ray.direction),
        }
    }

    /// Unpacks the place and the end of a ray from an `end_t`; sets unused members to 0.
    #[must_use]
    pub fn of(record: &Record) -> (RayPlace, Self) {
        let state = Kind::of(record);
        let if_hit = |name| match state {
            Kind::Hit => record.get(name),
            _ => 0,
        };
        let end = Self {
            surface: if_hit("surface"),
            face: if_hit("face"),
            share: if_hit("share"),
            state,
            steps: record.get("steps"),
            t: match state {
                Kind::Undecided => 0,
                _ => record.get("t"),
            },
            direction: match state {
                Kind::Hit => ["direction[0]", "direction[1]", "direction[2]"]
                    .map(|part| record.signed(part) as i32),
                _ => [0; 3],
            },
        };
        (RayPlace::of(record), end)
    }
}

fn solid(mut solid: Record, marching: &Marching) -> Record {
    let blend = marching.beside.blend;
    solid.set("blend_inverse", blend.inverse);
    solid.set("blend_width", blend.width);
    solid.set("last_sphere", marching.spheres().count as u64 - 1);
    if let Solid::Flat(flat) = &marching.solid {
        let constants = flat.constants();
        solid.set("levels", constants.levels);
        solid.set_all("half", constants.half);
    }
    solid
}

/// Writes the spheres of the field, and their materials, to the module's tables.
fn set_spheres(module: &mut Module, setup: &FieldSetup, lights: &Lights) {
    let Some(spheres) = setup.spheres() else {
        return;
    };
    module.drive("sphere_write", 1);
    for (i, one) in spheres.list.iter().take(spheres.count).enumerate() {
        let mut sphere = module.record("sphere");
        let cone = spheres.cone(i as u8);
        sphere.set_all("centre", cone.map_or(one.centre, FixedCone::apex));
        // Rays by exits need no radius, and a radius may have more bits than the port.
        if setup.marching().is_some() {
            sphere.set("radius", one.radius);
        }
        sphere.set("inverse", one.inverse);
        sphere.set("shift", one.shift);
        sphere.set("material", colour(lights.materials[i]));
        module.drive("sphere_number", i as u64);
        module.drive_bits("sphere", sphere);
        module.clock();
    }
    module.drive("sphere_write", 0);
}

/// Drives the lights on spheres, and fills the tables of spheres.
pub fn set_lights(module: &mut Module, setup: &FieldSetup, lights: &Lights) {
    let mut record = module.record("lights");
    let cone = setup.spheres().and_then(|spheres| spheres.cone);
    let towards = |direction| cone.map_or(direction, |cone| cone.lit_from(direction));
    if let Some(cone) = &cone {
        let [across, _, along] = towards([1 << 16, 0, 1 << 16]);
        record.set("cone", 1);
        record.set("lead", cone.lead);
        record.set("across", across);
        record.set("along", along);
    }
    record.set("ambient", colour(lights.ambient));
    record.set("last_light", lights.count.saturating_sub(1) as u64);
    record.set("normals", u64::from(lights.normals.is_some()));
    record.set("lit", u64::from(lights.count != 0));
    let highlight = lights.highlight.unwrap_or_default();
    record.set("highlight", u64::from(lights.highlight.is_some()));
    record.set("steepness", highlight.steepness);
    record.set("shine", colour(highlight.light.colour));
    record.set_all("half", towards(highlight.light.direction));
    for (i, light) in lights.list.iter().enumerate() {
        record.set(&format!("colours[{i}]"), colour(light.colour));
        record.set_all(&format!("directions[{i}]"), towards(light.direction));
    }
    module.drive_bits("lights", record);
    set_spheres(module, setup, lights);
}

/// Drives a port with three numbers per eye, left eye first.
fn drive_eyes(module: &mut Module, name: &str, [left, right]: [[impl Into<i128>; 3]; 2]) {
    module.drive_all(&format!("{name}[0]"), left);
    module.drive_all(&format!("{name}[1]"), right);
}

/// Drives the frame constants of a lane for marching rays.
pub fn set_lane(module: &mut Module, setup: &FieldSetup) {
    let marching = setup.marching().expect("marching rays");
    let record = module
        .record("tuning")
        .with("cap", marching.cap)
        .with("footprint", marching.footprint - 7)
        .with("threshold", marching.threshold);
    module.drive_bits("tuning", record);
    drive_eyes(module, "origins", marching.entry.eyes.map(|eye| eye.origin));
    module.drive_all("bounds", marching.bounds());
    let solid = solid(module.record("solid"), marching);
    module.drive_bits("solid", solid);
    set_spheres(module, setup, &Palette::default().lights);
}

/// A solid of rays by exits in the gateware: the name of its rule, the number of the rule, and the
/// number of levels.
#[must_use]
pub fn rule(rule: Rule) -> (&'static str, u64, u32) {
    let (name, number) = match rule {
        Rule::Box | Rule::Octahedron => ("BOX", 0),
        Rule::Planes => ("PLANES", 1),
        Rule::Sponge { .. } => ("SPONGE", 2),
        Rule::Repeated { .. } => ("CUBES", 3),
    };
    (name, number, rule.levels())
}

/// Drives the solid for the rays by exits.
fn set_solid(module: &mut Module, exits: &Exits) {
    let solid = exits.solid.unwrap_or_default();
    let (_, number, levels) = rule(solid.rule);
    module.drive("rule", number);
    module.drive("levels", levels);
    module.drive_all("halves", solid.half());
    module.drive_all("borders", solid.borders());
}

/// Changes each cone of the first `eyes` eyes by `change`, and writes the cones to the ports whose
/// names begin with `prefix`.
pub fn set_cones(
    module: &mut Module,
    prefix: &str,
    exits: &Exits,
    eyes: usize,
    change: impl Fn(&Cone) -> Cone,
) {
    let cones = exits.cones();
    let last = |eye: usize| cones[eye].list().len().saturating_sub(1) as i64;
    module.drive_all("last_cone", [last(0), last(1)]);
    let [write, address, value] =
        ["write", "address", "value"].map(|name| module.port(&format!("{prefix}{name}")));
    module.set(write, 1);
    for (eye, cones) in cones.iter().take(eyes).enumerate() {
        let mut words: Vec<_> = cones
            .list()
            .iter()
            .map(|cone| change(cone).words())
            .collect();
        if words.is_empty() {
            words.push(Cone::unseen());
        }
        for cone in cones.list() {
            let cone = change(cone);
            // The words must contain all bits that the gateware reads.
            assert_eq!(Cone::of_words(&cone.words()), cone);
        }
        for (number, words) in words.iter().enumerate() {
            for (constant, &word) in words.iter().enumerate() {
                module.set(address, (eye << 8 | number << 4 | constant) as u64);
                module.set(value, u64::from(word));
                module.clock();
            }
        }
    }
    module.set(write, 0);
    module.clock();
}

/// Drives the prisms around the eyes.
fn set_starts(module: &mut Module, exits: &Exits) {
    let solid = exits.solid.unwrap_or_default();
    for (number, Eye { start, .. }) in exits.eyes.iter().enumerate() {
        let choice: u32 = match start.exit {
            Exit::Second => 0,
            Exit::First => 1,
            Exit::Last => 2,
        };
        module.drive(&format!("choice[{number}]"), choice);
        for (way, sides) in start.sides.iter().enumerate() {
            let at = |name: &str| format!("{name}[{number}][{way}]");
            let sides = &sides[..3];
            let bits = |is_set: fn(&Side) -> bool| -> u32 {
                let axes = (0..).zip(sides).filter(|(_, side)| is_set(side));
                axes.map(|(axis, _)| 1 << axis).sum()
            };
            module.drive_all(&at("distances"), sides.iter().map(|side| side.distance));
            module.drive(&at("there"), bits(|side| side.is_bounded));
            module.drive(&at("away"), bits(|side| side.is_away));
            module.drive(&at("last"), bits(|side| side.is_last));
            let next = sides.iter().map(|side| solid.code(side.next));
            module.drive_all(&at("nexts"), next);
        }
    }
}

/// Drives the constants of the fourth axis of an octahedron.
fn set_diagonals(module: &mut Module, exits: &Exits) {
    for (number, Eye { start, .. }) in exits.eyes.iter().enumerate() {
        let [up, down] = &start.sides;
        let bits = |is_set: fn(&Side) -> bool| {
            u32::from(is_set(&up[3])) | u32::from(is_set(&down[3])) << 1
        };
        module.drive_all(
            &format!("sum_distances[{number}]"),
            [up[3].distance, down[3].distance],
        );
        module.drive(
            &format!("sum_there[{number}]"),
            bits(|side| side.is_bounded),
        );
        module.drive(&format!("sum_away[{number}]"), bits(|side| side.is_away));
    }
}

/// Drives the frame constants of a whole raymarcher.
pub fn set_raymarcher(module: &mut Module, setup: &FieldSetup) {
    match &setup.form {
        Form::Exits(exits) => {
            let solid = module
                .record("solid")
                .with("spheres_repeated", exits.spheres.repeated);
            module.drive_bits("solid", solid);
            drive_eyes(module, "origins", exits.eyes.map(|eye| eye.origin));
            set_solid(module, exits);
            set_shadow(module, exits);
        }
        Form::Marching(marching) => {
            set_lane(module, setup);
            set_solid(module, &marching.entry);
        }
    }
    set_rays(module, setup);
}

/// Drives the constants of the rays to the first light.
pub fn set_shadow(module: &mut Module, exits: &Exits) {
    let mut record = module.record("shadow");
    record.set("enable", u64::from(exits.sun.is_some()));
    if let Some(sun) = &exits.sun {
        let joined = |parts: [i128; 3], bits: usize| {
            let [x, y, z] = parts;
            x | y << bits | z << (2 * bits)
        };
        let parts = sun.direction.map(|part| i128::from(part.cast_unsigned()));
        record.set("direction", joined(parts, 16));
        record.set(
            "inverse",
            joined(sun.inverse.map(|inverse| inverse.word().into()), 32),
        );
    }
    module.drive_bits("shadow", record);
}

/// Drives the frame constants of the ray generator, with bands of `band_lines` lines.
pub fn set_generator(module: &mut Module, setup: &FieldSetup, band_lines: u32) {
    for (name, value) in [
        ("last_column", setup.width - 1),
        ("last_line", band_lines - 1),
        ("last_band", setup.height / band_lines - 1),
        ("last_row", setup.height - 1),
    ] {
        module.drive(name, value);
    }
    let solid = setup.exits().and_then(|exits| exits.solid);
    let is_octahedron = solid.is_some_and(|solid| solid.rule == Rule::Octahedron);
    module.drive("diagonals", is_octahedron);
    set_rays(module, setup);
}

/// Drives the frame constants for the starts of the rays.
pub fn set_rays(module: &mut Module, setup: &FieldSetup) {
    module.drive("stereo", setup.stereo.is_some());
    module.drive("exits", setup.exits().is_some());
    let exits = match &setup.form {
        Form::Exits(exits) => exits,
        Form::Marching(marching) => &marching.entry,
    };
    let axes = |[x, y, z, _]: [i32; 4]| [x, y, z];
    module.drive("near_limit", exits.near as u64);
    module.drive("far_limit", exits.far as u64);
    drive_eyes(module, "first", exits.eyes.map(|eye| axes(eye.first)));
    module.drive_all("across", axes(exits.steps[0]));
    module.drive_all("down", axes(exits.steps[1]));
    set_starts(module, exits);
    set_diagonals(module, exits);
    let count = 1 + usize::from(setup.stereo.is_some());
    set_cones(module, "cone_", exits, count, |cone| *cone);
}

/// Packs the model's end of a ray, which is not on a sphere, as an `end_t`.
pub fn exit_end(layout: &Layout, place: RayPlace, end: &RayEnd) -> Bits {
    let mut record = layout.record();
    let (kind, surface, t) = match end.state {
        State::Hit(surface) => (
            if end.shadow { Kind::Shaded } else { Kind::Hit },
            surface.face().or(surface.number()).unwrap_or_default(),
            end.depth >> 7,
        ),
        _ => (Kind::Miss, 0, end.height.into()),
    };
    record.set("surface", surface);
    record.set_name("state", kind.name());
    record.set("steps", end.steps.min(255));
    record.set("t", t);
    place.set(&mut record);
    record.bits()
}

fn colour([r, g, b]: [u8; 3]) -> u64 {
    u64::from(b) << 16 | u64::from(g) << 8 | u64::from(r)
}

/// Drives the frame constants of the paint module, and fills its tables.
pub fn set_paint(module: &mut Module, setup: &FieldSetup, palette: &Palette) {
    let mut colours = module.record("palette");
    colours.set("zenith", colour(palette.zenith));
    colours.set("undecided", colour(palette.undecided));
    colours.set_all("faces", palette.faces.map(colour));
    colours.set_all("shadows", palette.shadows.map(colour));
    module.drive_bits("palette", colours);
    module.drive("horizon", colour(palette.horizon));
    module.drive("stereo", setup.stereo.is_some());
    module.drive("depth_mantissa", setup.depth.mantissa);
    module.drive("depth_exponent", setup.depth.exponent);
    module.drive("fog_shift", palette.fog_shift);
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

/// A pixel in the form of the band buffer's input: a group of eight pixels in which only this pixel
/// is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    /// Eye: 0 for the left or only eye, 1 for the right eye.
    pub eye: u64,
    /// Row (address) of the group in the band buffer.
    pub row: u64,
    /// Line within the band.
    pub line: u64,
    /// Column of the group, in units of eight pixels.
    pub column: u64,
    /// Mask of the group's eight pixels; only the bit of this pixel is set.
    pub mask: u64,
    /// Depth code of the pixel; a larger code is nearer.
    pub code: u64,
    /// RGB565 colour; in stereo, the luminance in both bytes.
    pub colour: u64,
}

impl Pixel {
    /// Names of the payload's ports in a stream of pixels, in the order of the argument of [`from`](Self::from).
    pub const PAYLOAD: [&str; 7] = ["eye", "row", "line", "column", "mask", "code", "colour"];
}

impl From<[u64; 7]> for Pixel {
    fn from([eye, row, line, column, mask, code, colour]: [u64; 7]) -> Self {
        Self {
            eye,
            row,
            line,
            column,
            mask,
            code,
            colour,
        }
    }
}

/// Computes the pixel expected from the paint module for the model's result of a ray; `row` is the pixel's line in the picture.
pub fn pixel(
    setup: &FieldSetup,
    palette: &Palette,
    rounding: Rounding,
    place: RayPlace,
    row: u32,
    end: &RayEnd,
) -> Pixel {
    let colour = paint(setup, palette, end);
    let code = setup.depth_code(end);
    let colour = match setup.stereo {
        None => {
            let colour = Rgb565::with_fractions(colour);
            Rgb565::rounded(colour, rounding, [place.column, row]).0
        }
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
