//! Driver of the raymarcher, which draws distance fields into the frames of the triangle engine's raster pass.
//!
//! [`Raymarcher::set_field`] writes a field's frame constants. Every raster pass that starts afterwards draws
//! the field, until [`Raymarcher::clear_field`]. Neither function may be called during a raster pass. The raymarcher
//! does not access memory.

use core::fmt;

use glint_core::field::{FixedSpheres, FlatConstants, Solid};
use glint_core::stereo::Tint;
use glint_model::raymarch::{Blend, FieldSetup, FieldStats, Lights, Palette};
pub use litex_pac::raymarch::Counters;
use litex_pac::raymarch::{
    self, Control, DepthScale, EvEnable, EvPending, Kind, Solid as SolidRegister, Sphere, Stereo,
    Table, Tuning,
};

use crate::Absent;

/// Build options of a raymarcher.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// Number of lanes, each of which evaluates the field once a clock.
    pub lanes: u8,
    /// Largest number of levels of a sponge that this build draws; 0 if it draws no sponges.
    pub levels: u8,
    /// Kinds of flat fields (fields with plane faces) that this build draws: bit k is 1 if it draws the kind with the value k
    /// in `Kind`.
    pub flat: u8,
    /// Whether this build draws two eyes.
    pub stereo: bool,
    /// Whether this build draws spheres.
    pub round: bool,
    /// Whether this build draws fillets between spheres and flat fields.
    pub blend: bool,
    /// Whether this build has the prepass, which marches one cone for each block of pixels before the rays.
    pub prepass: bool,
}

/// A feature that a frame needs and this build lacks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// Sponges deeper than this number of levels, which is the limit of this build; 0 if the build has no sponges.
    Levels(u8),
    /// Flat fields (fields with plane faces) of this kind.
    Flat(Kind),
    /// Spheres.
    Round,
    /// Fillets between spheres and flat fields.
    Blend,
    /// Two eyes.
    Stereo,
    /// Prepass.
    Prepass,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Levels(levels) => {
                write!(
                    f,
                    "raymarcher: this gateware has sponges of depth {levels} at most"
                )
            }
            Self::Flat(kind) => write!(f, "raymarcher: this gateware has no {}", kind.text()),
            Self::Round => f.write_str("raymarcher: this gateware has no spheres"),
            Self::Blend => f.write_str("raymarcher: this gateware has no smooth unions"),
            Self::Stereo => f.write_str("raymarcher: this gateware has no stereo"),
            Self::Prepass => f.write_str("raymarcher: this gateware has no prepass"),
        }
    }
}

impl core::error::Error for Missing {}

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

/// Driver of the raymarcher, whose presence has been checked.
pub struct Raymarcher {
    registers: raymarch::Raymarch,
    capabilities: Capabilities,
    /// The contents last written to the tables of fog and occlusion; `None` before the first write.
    tables: Option<[[u8; 256]; 2]>,
}

impl Raymarcher {
    /// Takes the registers if the SoC has the raymarcher. Its interrupt stays disabled, because the end of the raster
    /// pass also ends the raymarcher's work.
    ///
    /// # Errors
    /// [`Absent`] if the register `ident` does not identify a raymarcher.
    pub fn probe(registers: raymarch::Raymarch) -> Result<Self, Absent> {
        match registers.ident().read() {
            raymarch::Raymarch::IDENT => {
                registers.ev_enable().write(EvEnable::default());
                let caps = registers.caps().read();
                let capabilities = Capabilities {
                    lanes: caps.lanes(),
                    levels: caps.levels(),
                    flat: caps.flat(),
                    stereo: caps.stereo(),
                    round: caps.round(),
                    blend: caps.blend(),
                    prepass: caps.prepass(),
                };
                Ok(Self {
                    registers,
                    capabilities,
                    tables: None,
                })
            }
            found => Err(Absent {
                expected: raymarch::Raymarch::IDENT,
                found,
            }),
        }
    }

    /// The build options.
    #[must_use]
    pub const fn capabilities(&self) -> Capabilities {
        self.capabilities
    }

    /// Checks that this build of the raymarcher can draw the frame with the constants `setup`.
    ///
    /// # Errors
    /// The missing feature.
    pub fn check(&self, setup: &FieldSetup) -> Result<(), Missing> {
        let Capabilities {
            levels,
            flat,
            stereo,
            round,
            blend,
            prepass,
            ..
        } = self.capabilities;
        if let Solid::Flat(solid) = &setup.solid {
            let constants = solid.constants();
            if u32::from(constants.levels) >> levels != 0 {
                return Err(Missing::Levels(levels));
            }
            let kind = kind(&constants);
            // Kind 0, the sponge, is covered by the check of the levels above.
            if constants.kind != 0 && flat >> constants.kind & 1 == 0 {
                return Err(Missing::Flat(kind));
            }
        }
        if setup.is_round() && !round {
            return Err(Missing::Round);
        }
        if setup.blend().width != 0 && !blend {
            return Err(Missing::Blend);
        }
        if setup.stereo.is_some() && !stereo {
            return Err(Missing::Stereo);
        }
        if setup.cones.is_some() && !prepass {
            return Err(Missing::Prepass);
        }
        Ok(())
    }

    /// Enables the field in every following raster pass, in which it is drawn after the triangles. The picture size of
    /// these passes must equal the size in `setup`.
    ///
    /// # Errors
    /// The missing feature; all registers are then unchanged.
    pub fn set_field(&mut self, setup: &FieldSetup, palette: &Palette) -> Result<(), Missing> {
        self.check(setup)?;
        if !self.has_tables(palette) {
            self.set_tables(palette);
        }
        self.set_field_with_tables_held(setup, palette)
    }

    /// Does the same as [`set_field`](Self::set_field), for a palette whose tables the raymarcher already
    /// [holds](Self::has_tables). The palette's tables are not read.
    ///
    /// # Errors
    /// As [`set_field`](Self::set_field).
    pub fn set_field_with_tables_held(
        &mut self,
        setup: &FieldSetup,
        palette: &Palette,
    ) -> Result<(), Missing> {
        self.check(setup)?;
        let registers = &self.registers;
        let solid = match &setup.solid {
            Solid::Flat(flat) => self.set_flat(&flat.constants()),
            Solid::Spheres(_) => SolidRegister::default(),
        };
        let solid = solid.with_flat_too(setup.beside.is_some());
        registers.solid().write(match setup.spheres() {
            Some(spheres) => {
                self.set_spheres(spheres, &setup.blend(), &palette.lights);
                solid
                    .with_is_round(true)
                    .with_spheres_repeated(spheres.repeated)
                    .with_last_sphere((spheres.count - 1) as u8)
                    .with_last_light((palette.lights.count - 1) as u8)
            }
            None => solid,
        });
        registers.tuning().write(
            Tuning::default()
                .with_threshold(setup.tuning.threshold as u16)
                .with_footprint(setup.tuning.footprint as u8)
                .with_cap(setup.tuning.cap as u8),
        );
        let [left, right] = setup.eyes;
        let [across, down] = setup.steps;
        let origins =
            [left.origin, right.origin].map(|origin| origin.map(|x| x as u32 & 0x1FF_FFFF));
        let first = [left.first, right.first].map(|first| first.map(|x| x as u32));
        let (offset, spread) = setup
            .cones
            .map(|cones| (cones.offset, cones.spread))
            .unwrap_or_default();
        // The registers are written one by one, because a loop would need a table of their addresses.
        registers.far().write(setup.tuning.far);
        registers.near().write(setup.near);
        registers.origin_left_x().write(origins[0][0]);
        registers.origin_left_y().write(origins[0][1]);
        registers.origin_left_z().write(origins[0][2]);
        registers.origin_right_x().write(origins[1][0]);
        registers.origin_right_y().write(origins[1][1]);
        registers.origin_right_z().write(origins[1][2]);
        registers.outside_left_x().write(left.outside[0]);
        registers.outside_left_y().write(left.outside[1]);
        registers.outside_left_z().write(left.outside[2]);
        registers.outside_right_x().write(right.outside[0]);
        registers.outside_right_y().write(right.outside[1]);
        registers.outside_right_z().write(right.outside[2]);
        registers.first_left_x().write(first[0][0]);
        registers.first_left_y().write(first[0][1]);
        registers.first_left_z().write(first[0][2]);
        registers.first_right_x().write(first[1][0]);
        registers.first_right_y().write(first[1][1]);
        registers.first_right_z().write(first[1][2]);
        registers.bounds_x().write(setup.bounds[0]);
        registers.bounds_y().write(setup.bounds[1]);
        registers.bounds_z().write(setup.bounds[2]);
        registers.across_x().write(across[0] as u32);
        registers.across_y().write(across[1] as u32);
        registers.across_z().write(across[2] as u32);
        registers.down_x().write(down[0] as u32);
        registers.down_y().write(down[1] as u32);
        registers.down_z().write(down[2] as u32);
        registers.cone_offset_x().write(offset[0] as u32);
        registers.cone_offset_y().write(offset[1] as u32);
        registers.cone_offset_z().write(offset[2] as u32);
        registers.colour_0().write(colour(palette.faces[0]));
        registers.colour_1().write(colour(palette.faces[1]));
        registers.colour_2().write(colour(palette.faces[2]));
        registers.colour_3().write(colour(palette.faces[3]));
        registers.colour_4().write(colour(palette.faces[4]));
        registers.colour_5().write(colour(palette.faces[5]));
        registers.colour_6().write(colour(palette.undecided));
        registers.colour_7().write(colour(palette.zenith));
        registers.horizon().write(colour(palette.horizon));
        // The colours of faces 6 and 7 are entries of the register `sphere`.
        for (entry, &face) in (32..).zip(&palette.faces[6..]) {
            self.set_constant(entry, colour(face));
        }
        registers.cone_spread().write(spread as u16);
        registers.fog_shift().write(palette.fog_shift as u8);
        registers.depth_scale().write(
            DepthScale::default()
                .with_mantissa(setup.depth.mantissa)
                .with_exponent(setup.depth.exponent as u8 & 0x3F),
        );
        let stereo = match setup.stereo {
            None => Stereo::Mono,
            Some(Tint::RedBlue) => Stereo::RedBlue,
            Some(Tint::RedCyan) => Stereo::RedCyan,
        };
        self.registers.control().write(
            Control::default()
                .with_enable(true)
                .with_stereo(stereo)
                .with_prepass(setup.cones.is_some()),
        );
        Ok(())
    }

    /// Writes the lengths of a flat solid. Returns the fields of the register `solid` for the solid.
    fn set_flat(&self, constants: &FlatConstants) -> SolidRegister {
        let registers = &self.registers;
        registers.cube_half().write(constants.cube_half);
        let sides = [registers.half_x(), registers.half_y(), registers.half_z()];
        for (register, half) in sides.iter().zip(constants.half) {
            register.write(half);
        }
        SolidRegister::default()
            .with_kind(kind(constants))
            .with_levels(constants.levels)
            .with_has(constants.has)
            .with_room(constants.room)
            .with_repeated(constants.repeated)
    }

    fn set_constant(&self, entry: u8, value: u32) {
        let constant = Sphere::default().with_entry(entry).with_value(value);
        self.registers.sphere().write(constant);
    }

    /// Writes the constants of the spheres, of their fillet with the flat solid, and of the light on them.
    fn set_spheres(&self, spheres: &FixedSpheres, blend: &Blend, lights: &Lights) {
        let write = |entry, value| self.set_constant(entry, value);
        let numbers = |x: [i32; 3]| x.map(|x| x as u32 & 0xFF_FFFF);
        for (number, (sphere, material)) in (0..).zip(
            spheres
                .list
                .iter()
                .zip(lights.materials)
                .take(spheres.count),
        ) {
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

    /// Whether the raymarcher's tables of fog and occlusion equal the tables of `palette`. This comparison takes longer than
    /// writing the registers of a frame.
    #[must_use]
    pub fn has_tables(&self, palette: &Palette) -> bool {
        let held = self.tables.as_ref();
        held.is_some_and(|[fog, occlusion]| *fog == palette.fog && *occlusion == palette.occlusion)
    }

    fn set_tables(&mut self, palette: &Palette) {
        let tables = [palette.fog, palette.occlusion];
        for (entry, &part) in (0..).zip(tables.as_flattened()) {
            self.registers
                .table()
                .write(Table::default().with_entry(entry).with_part(part));
        }
        self.tables = Some(tables);
    }

    /// Disables the field in all following raster passes.
    pub fn clear_field(&mut self) {
        self.registers.control().write(Control::default());
    }

    /// The counters.
    #[must_use]
    pub fn counters(&self) -> Counters {
        Counters::read(&self.registers)
    }
}

/// The kind of a flat field as a register value. `Kind::ALL` has every kind of the model, so the default `Menger` is
/// never used.
fn kind(constants: &FlatConstants) -> Kind {
    let kind = Kind::ALL.get(usize::from(constants.kind)).copied();
    kind.unwrap_or(Kind::Menger)
}

/// A colour in the register format: red in bits 0 to 7, then green, then blue.
const fn colour([r, g, b]: [u8; 3]) -> u32 {
    u32::from_le_bytes([r, g, b, 0])
}

/// Clears the raymarcher's interrupt; its handler calls this.
pub fn acknowledge() {
    // SAFETY: only this function writes the pending register.
    let registers = unsafe { raymarch::Raymarch::steal() };
    registers
        .ev_pending()
        .write(EvPending::default().with_field(true));
}

#[cfg(test)]
mod tests;
