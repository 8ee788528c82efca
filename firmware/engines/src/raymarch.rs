//! Converts the frame constants of a field to the raymarcher's registers.

use core::fmt;

use glint_core::field::{FixedCone, FixedSpheres, FlatConstants, Solid as Marched};
use glint_core::stereo::Tint;
use glint_hal::raymarch::{
    self as driver, Capabilities, Control, Counters, DepthScale, Exit, Field, Kind, Prism,
    Raymarcher, Solid, Start, Stereo, Tables, Tuning, colour,
};
use glint_model::raymarch::exits::{self, AXES, Cone, Exits, Rule};
use glint_model::raymarch::{Blend, FieldSetup, FieldStats, Form, Lights, Palette, Shine};

/// A feature that a frame needs and this build of the raymarcher lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// Sponges of more than this number of levels, the limit of this build; 0 if the build has no sponges.
    Levels(u8),
    /// Flat fields (fields with plane faces) of this kind.
    Flat(Kind),
    /// A list of spheres.
    Round,
    /// A lattice of spheres.
    Lattice,
    /// Fillets between spheres and flat fields.
    Blend,
    /// Bent unions, which no build draws.
    Bend,
    /// Solid cones.
    Cone,
    /// Cones in lattices, which no build draws.
    ConeInLattice,
    /// Spheres coloured by their normals.
    Normals,
    /// A highlight on spheres.
    Highlight,
    /// Shadows on faces.
    Shadow,
    /// Rays of two eyes in one frame.
    Stereo,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("raymarcher: this gateware has ")?;
        match self {
            Self::Levels(levels) => write!(f, "sponges of depth {levels} at most"),
            Self::Flat(kind) => write!(f, "no {}", kind.text()),
            Self::Round => f.write_str("no spheres"),
            Self::Lattice => f.write_str("no lattices"),
            Self::Blend => f.write_str("no smooth unions"),
            Self::Bend => f.write_str("no bent unions"),
            Self::Cone => f.write_str("no cones"),
            Self::ConeInLattice => f.write_str("no cones in lattices"),
            Self::Normals => f.write_str("no spheres coloured by normals"),
            Self::Highlight => f.write_str("no highlight on spheres"),
            Self::Shadow => f.write_str("no shadows"),
            Self::Stereo => f.write_str("no stereo"),
        }
    }
}

impl core::error::Error for Missing {}

impl Missing {
    /// Checks that a build with these capabilities can draw the frame with the constants `setup` and the lights of `palette`.
    ///
    /// # Errors
    /// The missing feature.
    pub fn check(
        capabilities: &Capabilities,
        setup: &FieldSetup,
        lights: &Lights,
    ) -> Result<(), Self> {
        let (kind, levels) = kind(setup);
        if u32::from(levels) >> capabilities.levels != 0 {
            return Err(Self::Levels(capabilities.levels));
        }
        // Kind 0, the sponge, is covered by the check of the levels above.
        if kind as u8 != 0 && capabilities.flat >> kind as u8 & 1 == 0 {
            return Err(Self::Flat(kind));
        }
        if let Some(spheres) = setup.spheres() {
            if spheres.cone.is_some() && spheres.repeated {
                return Err(Self::ConeInLattice);
            }
            if spheres.cone.is_some() && (!capabilities.cone || setup.marching().is_some()) {
                return Err(Self::Cone);
            }
            if spheres.repeated && !capabilities.lattice {
                return Err(Self::Lattice);
            }
            if spheres.count > usize::from(spheres.repeated) && !capabilities.round {
                return Err(Self::Round);
            }
            if lights.normals.is_some() && !capabilities.normals {
                return Err(Self::Normals);
            }
            if lights.highlight.is_some() && !capabilities.highlight {
                return Err(Self::Highlight);
            }
        }
        if setup.exits().is_some_and(|exits| exits.sun.is_some()) && !capabilities.shadow {
            return Err(Self::Shadow);
        }
        if let Form::Marching(marching) = &setup.form {
            if marching.beside.bend != 0 {
                return Err(Self::Bend);
            }
            if !capabilities.blend {
                return Err(Self::Blend);
            }
        }
        if setup.stereo.is_some() && !capabilities.stereo {
            return Err(Self::Stereo);
        }
        Ok(())
    }
}

/// Converts the raymarcher's counters to the model's statistics of rays.
#[must_use]
pub fn ray_counts(counters: &Counters) -> FieldStats {
    FieldStats {
        rays: counters.items_in,
        evaluations: counters.evaluations.into(),
        hits: counters.hits,
        misses: counters.misses,
        undecided: counters.undecided,
    }
}

/// The tables of fog and occlusion of a palette.
#[must_use]
pub const fn tables(palette: &Palette) -> Tables<'_> {
    [&palette.fog, &palette.occlusion]
}

/// Enables the field in every following raster pass with [`Raymarcher::set_field`]. With `has_tables`, the raymarcher already holds the
/// tables of the palette, so they are neither compared nor written.
///
/// # Errors
/// The missing feature; all registers are then unchanged.
// Not inlined, so that the code for a frame without a field takes fewer lines of the instruction cache.
#[inline(never)]
pub fn set_field(
    raymarcher: &mut Raymarcher,
    setup: &FieldSetup,
    palette: &Palette,
    has_tables: bool,
) -> Result<(), Missing> {
    Missing::check(&raymarcher.capabilities(), setup, &palette.lights)?;
    if !has_tables {
        raymarcher.set_tables(tables(palette));
    }
    let stereo = match setup.stereo {
        None => Stereo::Mono,
        Some(Tint::RedBlue) => Stereo::RedBlue,
        Some(Tint::RedCyan) => Stereo::RedCyan,
    };
    let (kind, levels) = kind(setup);
    let solid = with_spheres(
        raymarcher,
        setup,
        &palette.lights,
        Solid::default().with_kind(kind).with_levels(levels),
    );
    let axes = |[x, y, z, _]: [i32; AXES]| [x, y, z];
    let bounds;
    let (rays, solid, half, form) = match &setup.form {
        Form::Exits(exits) => {
            set_shadow(raymarcher, exits, palette);
            let borders = exits.solid.unwrap_or_default().borders();
            (
                exits,
                with_cones(raymarcher, exits, solid, setup.stereo.is_some()),
                half(exits),
                driver::Form::Exits { borders },
            )
        }
        Form::Marching(marching) => {
            bounds = marching.bounds();
            let form = driver::Form::March {
                tuning: Tuning::default()
                    .with_threshold(marching.threshold as u16)
                    .with_footprint(marching.footprint.saturating_sub(7) as u8)
                    .with_cap(marching.cap as u16),
                bounds: &bounds,
            };
            let half = constants(&marching.solid).half;
            (&marching.entry, solid, half, form)
        }
    };
    let (exits, prisms) = prisms(rays);
    raymarcher.set_field(&Field {
        control: Control::default().with_stereo(stereo),
        solid,
        half,
        exits,
        prisms,
        form,
        limits: [rays.far as u32, rays.near as u32],
        origins: rays.eyes.map(|eye| eye.origin),
        first: rays.eyes.map(|eye| axes(eye.first)),
        steps: rays.steps.map(axes),
        depth_scale: DepthScale::default()
            .with_mantissa(setup.depth.mantissa)
            .with_exponent(setup.depth.exponent as u8 & 0x3F),
        faces: &palette.faces,
        sky: [palette.undecided, palette.zenith, palette.horizon],
        fog_shift: palette.fog_shift as u8,
    });
    Ok(())
}

/// Half the side lengths of a solid for rays by exits (docs/raymarch-exits.md).
fn half(exits: &Exits) -> [u32; 3] {
    let solid = exits.solid.unwrap_or_default();
    solid.half().map(|half| half as u32)
}

/// The value of the register with the rule of the solid, and the empty prisms around the eyes.
fn prisms(exits: &Exits) -> (driver::Exits, [Prism; 2]) {
    let solid = exits.solid.unwrap_or_default();
    let rule = match solid.rule {
        Rule::Planes => driver::Rule::Planes,
        Rule::Sponge { .. } => driver::Rule::Sponge,
        Rule::Repeated { .. } => driver::Rule::Cubes,
        Rule::Box | Rule::Octahedron => driver::Rule::Box,
    };
    let exit = |start: &exits::Start| match start.exit {
        exits::Exit::First => Exit::First,
        exits::Exit::Second => Exit::Second,
        exits::Exit::Last => Exit::Last,
    };
    let start = |side: &exits::Side| Start {
        distance: side.distance as u32,
        there: side.is_bounded,
        away: side.is_away,
        last: side.is_last,
        next: if side.is_bounded {
            solid.code(side.next) as u16
        } else {
            0
        },
    };
    let prism = |eye: &exits::Eye| {
        let axes = |sides: &[exits::Side; AXES]| sides.each_ref().map(start);
        eye.start.sides.each_ref().map(axes)
    };
    let [left, right] = &exits.eyes;
    let register = driver::Exits::default()
        .with_rule(rule)
        .with_depth(solid.rule.levels() as u8)
        .with_left_exit(exit(&left.start))
        .with_right_exit(exit(&right.start))
        .with_shadow(exits.sun.is_some());
    (register, [prism(left), prism(right)])
}

/// Returns the solid with its spheres, and writes the constants of the spheres to registers.
fn with_spheres(
    raymarcher: &Raymarcher,
    setup: &FieldSetup,
    lights: &Lights,
    solid: Solid,
) -> Solid {
    let Some(spheres) = setup.spheres() else {
        return solid;
    };
    let blend = setup
        .marching()
        .map_or_else(Blend::default, |marching| marching.beside.blend);
    set_spheres(raymarcher, spheres, &blend, lights);
    if raymarcher.capabilities().cone {
        set_cone_light(raymarcher, spheres.cone.as_ref());
    }
    solid
        .with_is_round(true)
        .with_spheres_repeated(spheres.repeated)
        .with_last_sphere((spheres.count - 1) as u8)
        .with_last_light(lights.count.saturating_sub(1) as u8)
}

/// Returns the solid with the number of cones in which each eye sees the spheres, and writes these cones to registers. Without spheres,
/// writes one cone without pixels: in a field of rays by exits, the gateware always intersects rays with cones, and would otherwise use
/// those of the previous frame.
fn with_cones(raymarcher: &Raymarcher, exits: &Exits, solid: Solid, stereo: bool) -> Solid {
    if !raymarcher.capabilities().round {
        return solid;
    }
    let eyes = if stereo { 2 } else { 1 };
    let words = match exits.spheres.cone {
        Some(_) => Cone::WORDS,
        None => Cone::SPHERE_WORDS,
    };
    let mut last = [0; 2];
    for (eye, last) in (0..eyes).zip(&mut last) {
        let mut number = 0;
        exits.each_cone(eye.into(), &mut |cone| {
            raymarcher.set_cone(eye, number, &cone.words()[..words]);
            number += 1;
        });
        if number == 0 {
            raymarcher.set_cone(eye, 0, &Cone::unseen()[..Cone::SPHERE_WORDS]);
        }
        *last = number.saturating_sub(1) as u8;
    }
    solid
        .with_last_cone_left(last[0])
        .with_last_cone_right(last[1])
}

/// Writes the constants of the shadow rays to the first light, and the colours of faces in shadow.
fn set_shadow(raymarcher: &Raymarcher, exits: &Exits, palette: &Palette) {
    let Some(sun) = &exits.sun else {
        return;
    };
    for (axis, tint) in (0..).zip(palette.shadows) {
        raymarcher.set_constant(40 + axis, colour(tint));
    }
    for (axis, (part, inverse)) in (0..).zip(sun.direction.iter().zip(sun.inverse)) {
        let word = inverse.word();
        raymarcher.set_constant(43 + axis, u32::from(part.cast_unsigned()));
        raymarcher.set_constant(46 + axis, word & 0xFF_FFFF);
        raymarcher.set_constant(49 + axis, word >> 24);
    }
}

/// Writes the constants of the spheres, their fillet with the flat solid, and their lights.
fn set_spheres(raymarcher: &Raymarcher, spheres: &FixedSpheres, blend: &Blend, lights: &Lights) {
    let write = |entry, value| raymarcher.set_constant(entry, value);
    let numbers = |x: [i32; 3]| x.map(|x| x as u32 & 0xFF_FFFF);
    let towards = |direction| match &spheres.cone {
        Some(cone) => cone.lit_from(direction),
        None => direction,
    };
    let list = spheres.list.iter().zip(lights.materials);
    for (number, (sphere, material)) in (0..).zip(list.take(spheres.count)) {
        let place = match spheres.cone(number) {
            Some(cone) => cone.apex(),
            None => sphere.centre,
        };
        for (axis, place) in (0..).zip(numbers(place)) {
            write(axis, place);
        }
        write(3, sphere.radius as u32);
        write(4, sphere.inverse | sphere.shift << 17);
        write(8 + number, colour(material));
    }
    write(5, colour(lights.ambient));
    write(6, blend.width);
    write(7, blend.inverse);
    for (number, light) in (0..).zip(&lights.list) {
        for (axis, part) in (0..).zip(numbers(towards(light.direction))) {
            write(16 + 4 * number + axis, part);
        }
        write(19 + 4 * number, colour(light.colour));
    }
    let normals = u32::from(lights.normals.is_some());
    let lit = u32::from(lights.count != 0);
    if let Some(Shine { light, steepness }) = lights.highlight {
        for (axis, part) in (0..).zip(numbers(towards(light.direction))) {
            write(34 + axis, part);
        }
        write(38, colour(light.colour));
        write(37, normals | lit << 1 | 1 << 2 | u32::from(steepness) << 8);
    } else {
        write(37, normals | lit << 1);
    }
}

/// Writes whether there is a solid cone, and the constants that light it.
fn set_cone_light(raymarcher: &Raymarcher, cone: Option<&FixedCone>) {
    let Some(cone) = cone else {
        raymarcher.set_constant(39, 0);
        return;
    };
    let [across, _, along] = cone.lit_from([1 << 16, 0, 1 << 16]);
    raymarcher.set_constant(39, cone.lead | 1 << 4);
    raymarcher.set_constant(52, across as u32 & 0xFF_FFFF);
    raymarcher.set_constant(53, along as u32 & 0xFF_FFFF);
}

/// The kind of the flat field as a register value, and a mask of the levels of a sponge, the first level in bit 0.
fn kind(setup: &FieldSetup) -> (Kind, u8) {
    match &setup.form {
        Form::Exits(exits) => match exits.solid.map(|solid| solid.rule) {
            Some(rule @ Rule::Sponge { .. }) => (Kind::Menger, (1_u32 << rule.levels()) as u8 - 1),
            // Every build accepts a sponge without levels.
            Some(Rule::Repeated { round: true }) | None => (Kind::Menger, 0),
            Some(Rule::Octahedron) => (Kind::Octahedron, 0),
            Some(_) => (Kind::Box, 0),
        },
        Form::Marching(marching) => {
            let flat = constants(&marching.solid);
            // `Kind::ALL` contains every kind of the model, so the default `Menger` is never used.
            let kind = Kind::ALL.get(usize::from(flat.kind)).copied();
            (kind.unwrap_or(Kind::Menger), flat.levels)
        }
    }
}

/// The constants of the flat solid of marching rays.
fn constants(solid: &Marched) -> FlatConstants {
    match solid {
        Marched::Flat(flat) => flat.constants(),
        Marched::Spheres(_) => FlatConstants::default(),
    }
}
