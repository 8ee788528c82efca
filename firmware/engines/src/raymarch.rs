//! Converts the frame constants of a field to the raymarcher's registers.

use core::fmt;

use glint_core::field::{FixedSpheres, FlatConstants, Solid};
use glint_core::stereo::Tint;
use glint_hal::raymarch::{
    self as driver, Capabilities, Control, Counters, DepthScale, Eye, Field, Kind, Raymarcher,
    Stereo, Tables, Tuning, colour,
};
use glint_model::raymarch::{Blend, FieldSetup, FieldStats, Lights, Palette};

/// A feature that a frame needs and this build of the raymarcher lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// Sponges of more than this number of levels, the limit of this build; 0 if the build has no sponges.
    Levels(u8),
    /// Flat fields (fields with plane faces) of this kind.
    Flat(Kind),
    /// Spheres.
    Round,
    /// Fillets between spheres and flat fields.
    Blend,
    /// Two eyes.
    Stereo,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("raymarcher: this gateware has ")?;
        match self {
            Self::Levels(levels) => write!(f, "sponges of depth {levels} at most"),
            Self::Flat(kind) => write!(f, "no {}", kind.text()),
            Self::Round => f.write_str("no spheres"),
            Self::Blend => f.write_str("no smooth unions"),
            Self::Stereo => f.write_str("no stereo"),
        }
    }
}

impl core::error::Error for Missing {}

impl Missing {
    /// Checks that a build with these capabilities can draw the frame with the constants `setup`.
    ///
    /// # Errors
    /// The missing feature.
    pub fn check(capabilities: &Capabilities, setup: &FieldSetup) -> Result<(), Self> {
        if let Solid::Flat(solid) = &setup.solid {
            let constants = solid.constants();
            if u32::from(constants.levels) >> capabilities.levels != 0 {
                return Err(Self::Levels(capabilities.levels));
            }
            // Kind 0, the sponge, is covered by the check of the levels above.
            if constants.kind != 0 && capabilities.flat >> constants.kind & 1 == 0 {
                return Err(Self::Flat(kind(&constants)));
            }
        }
        if setup.is_round() && !capabilities.round {
            return Err(Self::Round);
        }
        if setup.blend().width != 0 && !capabilities.blend {
            return Err(Self::Blend);
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
    Missing::check(&raymarcher.capabilities(), setup)?;
    if !has_tables {
        raymarcher.set_tables(tables(palette));
    }
    let flat = match &setup.solid {
        Solid::Flat(flat) => flat.constants(),
        Solid::Spheres(_) => FlatConstants::default(),
    };
    let solid = driver::Solid::default()
        .with_kind(kind(&flat))
        .with_levels(flat.levels)
        .with_has(flat.has)
        .with_room(flat.room)
        .with_repeated(flat.repeated)
        .with_flat_too(setup.beside.is_some());
    let solid = match setup.spheres() {
        Some(spheres) => {
            set_spheres(raymarcher, spheres, &setup.blend(), &palette.lights);
            solid
                .with_is_round(true)
                .with_spheres_repeated(spheres.repeated)
                .with_last_sphere((spheres.count - 1) as u8)
                .with_last_light((palette.lights.count - 1) as u8)
        }
        None => solid,
    };
    let stereo = match setup.stereo {
        None => Stereo::Mono,
        Some(Tint::RedBlue) => Stereo::RedBlue,
        Some(Tint::RedCyan) => Stereo::RedCyan,
    };
    raymarcher.set_field(&Field {
        control: Control::default().with_stereo(stereo),
        solid,
        cube_half: flat.cube_half,
        half: flat.half,
        tuning: Tuning::default()
            .with_threshold(setup.tuning.threshold as u16)
            .with_footprint(setup.tuning.footprint as u8)
            .with_cap(setup.tuning.cap as u8),
        limits: [setup.tuning.far, setup.near],
        eyes: setup.eyes.each_ref().map(|eye| Eye {
            origin: &eye.origin,
            outside: &eye.outside,
            first: &eye.first,
        }),
        bounds: &setup.bounds,
        steps: setup.steps.each_ref(),
        depth_scale: DepthScale::default()
            .with_mantissa(setup.depth.mantissa)
            .with_exponent(setup.depth.exponent as u8 & 0x3F),
        faces: &palette.faces,
        sky: [palette.undecided, palette.zenith, palette.horizon],
        fog_shift: palette.fog_shift as u8,
    });
    Ok(())
}

/// Writes the constants of the spheres, their fillet with the flat solid, and their lights.
fn set_spheres(raymarcher: &Raymarcher, spheres: &FixedSpheres, blend: &Blend, lights: &Lights) {
    let write = |entry, value| raymarcher.set_constant(entry, value);
    let numbers = |x: [i32; 3]| x.map(|x| x as u32 & 0xFF_FFFF);
    let list = spheres.list.iter().zip(lights.materials);
    for (number, (sphere, material)) in (0..).zip(list.take(spheres.count)) {
        for (axis, place) in (0..).zip(numbers(sphere.centre)) {
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
        for (axis, part) in (0..).zip(numbers(light.direction)) {
            write(16 + 4 * number + axis, part);
        }
        write(19 + 4 * number, colour(light.colour));
    }
}

/// The kind of a flat field as a register value. `Kind::ALL` contains every kind of the model, so the default `Menger` is never used.
fn kind(constants: &FlatConstants) -> Kind {
    let kind = Kind::ALL.get(usize::from(constants.kind)).copied();
    kind.unwrap_or(Kind::Menger)
}
