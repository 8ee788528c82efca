//! Driver of the raymarcher, which draws distance fields into the frames of the triangle engine's raster pass.
//!
//! [`Raymarcher::set_field`] writes a field's frame constants. Every raster pass that starts afterwards draws
//! the field, until [`Raymarcher::clear_field`]. Neither function may be called during a raster pass. The raymarcher
//! does not access memory.

use litex_pac::raymarch::{self, EvEnable, EvPending, Sphere, Table};
pub use litex_pac::raymarch::{
    Control, Counters, DepthScale, Exit, Exits, Kind, Rule, Solid, Stereo, Tuning,
};

use crate::Absent;

/// Build options of a raymarcher.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// Number of lanes, each of which evaluates the field once per clock.
    pub lanes: u8,
    /// Largest number of levels of a sponge that this build draws; 0 if it draws no sponges.
    pub levels: u8,
    /// Kinds of flat fields (fields with plane faces) that this build draws: bit k is 1 if it draws the kind with the value k
    /// in `Kind`.
    pub flat: u8,
    /// Whether this build draws stereo pictures.
    pub stereo: bool,
    /// Whether this build draws the spheres of a list.
    pub round: bool,
    /// Whether this build draws the spheres of a lattice.
    pub lattice: bool,
    /// Whether this build draws fillets between spheres and flat fields.
    pub blend: bool,
    /// Whether this build colours spheres by their normals.
    pub normals: bool,
    /// Whether this build draws a highlight on spheres.
    pub highlight: bool,
    /// Whether this build draws shadows on faces.
    pub shadow: bool,
    /// Whether this build draws a solid cone.
    pub cone: bool,
}

/// The planes of the prism around an eye, along each axis and along each mirrored axis; the fourth axis is that of an octahedron.
pub type Prism = [[Start; 4]; 2];

/// A plane of the prism around an eye, along an axis or a mirrored axis.
#[derive(Clone, Copy, Default)]
pub struct Start {
    /// Distance of the plane, u12.12.
    pub distance: u32,
    /// Whether the plane exists.
    pub there: bool,
    /// Whether rays that go forward along the axis move away from the solid.
    pub away: bool,
    /// Whether a ray has left the solid beyond the plane.
    pub last: bool,
    /// The interval above the plane (gateware/rtl/raymarch/exit_pkg.sv), 13 bits.
    pub next: u16,
}

/// The constants that depend on how rays find the solid.
#[derive(Clone, Copy)]
pub enum Form<'a> {
    /// Rays step to the exits of empty prisms.
    Exits {
        /// Coordinates of planes of the solid.
        borders: [i32; 3],
    },
    /// Rays march by distances.
    March {
        /// Threshold and step limit.
        tuning: Tuning,
        /// Half the sides of the solid's bounding box.
        bounds: &'a [i32; 3],
    },
}

/// The tables of fog and of occlusion.
pub type Tables<'a> = [&'a [u8; 256]; 2];

/// A colour: red, green, blue.
pub type Rgb = [u8; 3];

/// The constants of a field, named after their registers (docs/registers.md). Numbers have the formats of
/// docs/formats/raymarch.md.
#[derive(Clone, Copy)]
pub struct Field<'a> {
    /// Fields of the register `control`, except `enable`, which the driver sets.
    pub control: Control,
    /// The solid.
    pub solid: Solid,
    /// Half the sides of the solid; for marching rays in a sponge, half the side of its smallest cubes.
    pub half: [u32; 3],
    /// The register `exits`: the solid for rays by exits or, for marching rays, the bounding box. [`Raymarcher::set_field`] sets `enable`.
    pub exits: Exits,
    /// The prisms around the left and the right eye.
    pub prisms: [Prism; 2],
    /// Method by which rays find the solid.
    pub form: Form<'a>,
    /// Position of the left and of the right eye.
    pub origins: [[i32; 3]; 2],
    /// The far limit and the near limit of the rays.
    pub limits: [u32; 2],
    /// Direction of the first pixel's ray, of the left and of the right eye.
    pub first: [[i32; 3]; 2],
    /// Change of the direction per pixel to the right and per pixel down.
    pub steps: [[i32; 3]; 2],
    /// The scale of depth codes.
    pub depth_scale: DepthScale,
    /// The colours of the faces.
    pub faces: &'a [Rgb; 8],
    /// The colours of rays at the step limit, of the zenith and of the horizon.
    pub sky: [Rgb; 3],
    /// Exponent of the depth step of the table of fog.
    pub fog_shift: u8,
}

/// Driver of the raymarcher, whose presence has been checked.
pub struct Raymarcher {
    registers: raymarch::Raymarch,
    capabilities: Capabilities,
    /// The contents last written to the tables of fog and occlusion; `None` before the first write.
    tables: Option<[[u8; 256]; 2]>,
}

impl Raymarcher {
    /// Takes the registers if the SoC has the raymarcher. The raymarcher's interrupt stays disabled, because the end of the
    /// raster pass also ends the raymarcher's work.
    ///
    /// # Errors
    /// [`Absent`] if the register `ident` does not identify a raymarcher.
    pub fn probe(registers: raymarch::Raymarch) -> Result<Self, Absent> {
        Absent::check(registers.ident().read(), raymarch::Raymarch::IDENT)?;
        registers.ev_enable().write(EvEnable::default());
        let caps = registers.caps().read();
        let capabilities = Capabilities {
            lanes: caps.lanes(),
            levels: caps.levels(),
            flat: caps.flat(),
            stereo: caps.stereo(),
            round: caps.round(),
            lattice: caps.lattice(),
            blend: caps.blend(),
            normals: caps.normals(),
            highlight: caps.highlight(),
            shadow: caps.shadow(),
            cone: caps.cone(),
        };
        Ok(Self {
            registers,
            capabilities,
            tables: None,
        })
    }

    /// The build options.
    #[must_use]
    pub const fn capabilities(&self) -> Capabilities {
        self.capabilities
    }

    /// Enables the field in every following raster pass, which draws the field before the triangles. The constants must have been
    /// computed for the picture size of these passes, and the tables and spheres must belong to the field.
    pub fn set_field(&mut self, field: &Field) {
        let registers = &self.registers;
        registers.solid().write(field.solid);
        registers.half_x().write(field.half[0]);
        registers.half_y().write(field.half[1]);
        registers.half_z().write(field.half[2]);
        match &field.form {
            Form::Exits { borders } => {
                let border = |coordinate: i32| coordinate as u32 & 0x3F_FFFF;
                registers.exits().write(field.exits.with_enable(true));
                registers.border_x().write(border(borders[0]));
                registers.border_y().write(border(borders[1]));
                registers.border_z().write(border(borders[2]));
            }
            Form::March { tuning, bounds } => {
                registers.exits().write(field.exits.with_enable(false));
                registers.tuning().write(*tuning);
                registers.bounds_x().write(bounds[0] as u32);
                registers.bounds_y().write(bounds[1] as u32);
                registers.bounds_z().write(bounds[2] as u32);
            }
        }
        self.set_prisms(&field.prisms);
        let [left, right] = field.origins;
        registers.origin_left_x().write(place(left[0]));
        registers.origin_left_y().write(place(left[1]));
        registers.origin_left_z().write(place(left[2]));
        registers.origin_right_x().write(place(right[0]));
        registers.origin_right_y().write(place(right[1]));
        registers.origin_right_z().write(place(right[2]));
        let [left, right] = field.first;
        let [across, down] = field.steps;
        // The registers are written one by one, because a loop would need a table of their addresses.
        let [far, near] = field.limits;
        registers.far().write(far);
        registers.near().write(near);
        registers.first_left_x().write(left[0] as u32);
        registers.first_left_y().write(left[1] as u32);
        registers.first_left_z().write(left[2] as u32);
        registers.first_right_x().write(right[0] as u32);
        registers.first_right_y().write(right[1] as u32);
        registers.first_right_z().write(right[2] as u32);
        registers.across_x().write(across[0] as u32);
        registers.across_y().write(across[1] as u32);
        registers.across_z().write(across[2] as u32);
        registers.down_x().write(down[0] as u32);
        registers.down_y().write(down[1] as u32);
        registers.down_z().write(down[2] as u32);
        let [undecided, zenith, horizon] = field.sky;
        registers.colour_0().write(colour(field.faces[0]));
        registers.colour_1().write(colour(field.faces[1]));
        registers.colour_2().write(colour(field.faces[2]));
        registers.colour_3().write(colour(field.faces[3]));
        registers.colour_4().write(colour(field.faces[4]));
        registers.colour_5().write(colour(field.faces[5]));
        registers.colour_6().write(colour(undecided));
        registers.colour_7().write(colour(zenith));
        registers.horizon().write(colour(horizon));
        // The colours of faces 6 and 7 are entries of the register `sphere`.
        self.set_constant(32, colour(field.faces[6]));
        self.set_constant(33, colour(field.faces[7]));
        registers.fog_shift().write(field.fog_shift);
        registers.depth_scale().write(field.depth_scale);
        registers.control().write(field.control.with_enable(true));
    }

    fn set_prisms(&self, prisms: &[Prism; 2]) {
        let registers = &self.registers;
        let [left, right] = prisms;
        registers.start_left_x().write(left[0][0].plane());
        registers.start_left_y().write(left[0][1].plane());
        registers.start_left_z().write(left[0][2].plane());
        registers.start_left_mirrored_x().write(left[1][0].plane());
        registers.start_left_mirrored_y().write(left[1][1].plane());
        registers.start_left_mirrored_z().write(left[1][2].plane());
        registers.start_right_x().write(right[0][0].plane());
        registers.start_right_y().write(right[0][1].plane());
        registers.start_right_z().write(right[0][2].plane());
        registers
            .start_right_mirrored_x()
            .write(right[1][0].plane());
        registers
            .start_right_mirrored_y()
            .write(right[1][1].plane());
        registers
            .start_right_mirrored_z()
            .write(right[1][2].plane());
        registers.start_left_sum().write(left[0][3].sum());
        registers.start_left_mirrored_sum().write(left[1][3].sum());
        registers.next_left_x().write(next(left, 0));
        registers.next_left_y().write(next(left, 1));
        registers.next_left_z().write(next(left, 2));
        registers.start_right_sum().write(right[0][3].sum());
        registers
            .start_right_mirrored_sum()
            .write(right[1][3].sum());
        registers.next_right_x().write(next(right, 0));
        registers.next_right_y().write(next(right, 1));
        registers.next_right_z().write(next(right, 2));
    }

    /// Writes an entry of the constants of spheres and of the light on them (docs/registers.md, `sphere`).
    pub fn set_constant(&self, entry: u8, value: u32) {
        let constant = Sphere::default().with_entry(entry).with_value(value);
        self.registers.sphere().write(constant);
    }

    /// Writes the words of a cone in which an eye sees a sphere (docs/registers.md, `cone_value`).
    pub fn set_cone(&self, eye: u16, number: u16, words: &[u32]) {
        let registers = &self.registers;
        registers.cone_address().write(eye << 8 | number << 4);
        for &word in words {
            registers.cone_value().write(word);
        }
    }

    /// Whether the raymarcher's tables already have this content. The comparison takes longer than writing the registers of a
    /// frame.
    #[must_use]
    pub fn has_tables(&self, tables: Tables) -> bool {
        let held = self.tables.as_ref();
        held.is_some_and(|held| held.each_ref() == tables)
    }

    /// Writes the tables, unless the raymarcher [has](Self::has_tables) them.
    pub fn set_tables(&mut self, tables: Tables) {
        if self.has_tables(tables) {
            return;
        }
        let tables = tables.map(|table| *table);
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

/// The intervals above the planes of a prism along an axis and along the mirrored axis, as the value of a register `next`.
fn next(prism: &Prism, axis: usize) -> u32 {
    let [upward, mirrored] = [0, 1].map(|way: usize| u32::from(prism[way][axis].next));
    upward | mirrored << 16
}

impl Start {
    /// The plane as the value of a register `start`.
    const fn plane(self) -> u32 {
        let flags = self.there as u32 | (self.away as u32) << 1 | (self.last as u32) << 2;
        self.distance & 0x1FF_FFFF | flags << 25
    }

    /// The plane as the value of a register of the fourth axis.
    const fn sum(self) -> u32 {
        self.plane() & 0x7FF_FFFF
    }
}

/// A coordinate of an eye, which has 25 bits.
const fn place(coordinate: i32) -> u32 {
    coordinate as u32 & 0x1FF_FFFF
}

/// A colour in the register format: red in bits 0 to 7, then green, then blue.
#[must_use]
pub const fn colour([r, g, b]: Rgb) -> u32 {
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
