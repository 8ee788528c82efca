//! Driver of the triangle engine, which draws meshes from memory to frames in memory.
//!
//! A frame needs one geometry pass per mesh, and one raster pass. A geometry pass writes descriptors and band lists of a
//! mesh, and a list of the triangles that need clipping. The raster pass draws a frame from these lists, and from a second set
//! that the program may write (docs/formats/triangle.md, "Descriptors and band lists"). A geometry and a raster pass may run at the same
//! time, for two frames.
//!
//! The engine accesses memory by address and bypasses the CPU's data cache, so starting a pass is unsafe: see
//! [`TriangleEngine::start_geometry`] and [`TriangleEngine::start_raster`]. The engine sees earlier writes of the CPU;
//! the CPU sees writes of the engine after `litex_pac::cpu::flush_data_cache`.

use core::fmt;
use core::sync::atomic::{Ordering, compiler_fence};
use core::time::Duration;

use litex_pac::triangle::{self, Control, EvEnable, EvPending, Raster as RasterStart};
pub use litex_pac::triangle::{Counters, DepthScale, Error, Geometry as GeometryStart, Size};

use crate::Absent;
use crate::timer::whole_millis;

/// Reason why a pass failed or was not started.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EngineError {
    /// An error code of the register `status`, also used by the driver's own checks.
    Status(Error),
    /// The register `status` has an error code without a name.
    Unknown,
    /// No progress for longer than [`TIMEOUT`].
    Timeout,
}

/// Longest time that a pass may run without progress.
pub const TIMEOUT: Duration = Duration::from_millis(100);

impl EngineError {
    fn check(code: Option<Error>) -> Result<(), Self> {
        match code {
            Some(Error::None) => Ok(()),
            Some(code) => Err(Self::Status(code)),
            None => Err(Self::Unknown),
        }
    }
}

impl From<Error> for EngineError {
    fn from(code: Error) -> Self {
        Self::Status(code)
    }
}

impl fmt::Display for EngineError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("triangle engine: ")?;
        match self {
            Self::Status(code) => f.write_str(code.text()),
            Self::Unknown => f.write_str("unknown error code"),
            Self::Timeout => write!(f, "timed out: no progress for {} ms", whole_millis(TIMEOUT)),
        }
    }
}

impl core::error::Error for EngineError {}

/// Memory for the output of a frame's geometry passes; every address is a multiple of 16.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lists {
    /// Address of the descriptors, which are longer if the engine [shades smoothly](TriangleEngine::shades_smoothly).
    pub descriptors: u32,
    /// Largest number of descriptors that fit the memory at `descriptors`.
    pub descriptor_limit: u32,
    /// Address of the band lists.
    pub lists: u32,
    /// In these passes and in the raster pass, the capacity of a band list is 4 << `list_shift` entries.
    pub list_shift: u8,
    /// Address of the list of exceptions, the triangles that need clipping. An entry is the triangle's number in its mesh, 4
    /// bytes.
    pub exceptions: u32,
    /// Largest number of exceptions that fit the memory at `exceptions`.
    pub exception_limit: u32,
}

/// A segment of a line, or the header of a list of segments: 8 words.
pub type Segment = [u32; 8];

/// A geometry pass. docs/formats/camera.md, "Frame constants", defines the numbers.
#[derive(Clone, Copy)]
pub struct Geometry<'a> {
    /// The records of the mesh.
    pub mesh: &'a [u8],
    /// Size of the picture, and options of the mesh. The driver sets `start`, `append` and `recolour`.
    pub options: GeometryStart,
    /// The register `scale_shift`.
    pub scale_shift: u8,
    /// Row u of the camera's frame constants.
    pub u: &'a [i32; 3],
    /// Row v of the camera's frame constants.
    pub v: &'a [i32; 3],
    /// Row n of the camera's frame constants.
    pub n: &'a [i32; 3],
    /// Row of the light's direction.
    pub light: &'a [i32; 3],
    /// The translation, s44.
    pub translation: &'a [i64; 3],
    /// The near plane, 37 fraction bits.
    pub near: i64,
    /// The scale of depth codes.
    pub depth_scale: DepthScale,
    /// Light and ambient light, u1.8 for each channel, at most 1; a pass without `lists` leaves them unchanged. With smooth
    /// shading and without `cull`, the ambient light must be 0.
    pub lights: [[u16; 3]; 2],
    /// Colour that replaces the colours of the mesh, RGB565.
    pub colour: Option<u16>,
    /// The textures of the mesh, if they are drawn. Smooth shading, and gateware without textures, draw none.
    pub textures: Option<Textures<'a>>,
    /// Output of the pass, initially empty; `None` appends to the output of the previous pass, which must have an equal picture
    /// size and equal light colours.
    pub lists: Option<Lists>,
}

/// The textures of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Textures<'a> {
    /// The texture coordinates of the mesh's vertices, aligned to 16 bytes.
    pub coordinates: &'a [u8],
    /// Number of textures in the frame's table before the textures of this mesh.
    pub before: u8,
}

/// A geometry pass whose registers have been written, ready to start.
#[must_use]
pub struct Prepared {
    start: GeometryStart,
}

/// A set of descriptors and band lists that a raster pass draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Set {
    /// Address of the descriptors.
    pub descriptors: u32,
    /// Number of descriptors.
    pub count: u32,
    /// Address of the band lists.
    pub lists: u32,
}

/// A raster pass.
#[derive(Clone, Copy, Debug)]
pub struct Raster {
    /// Size of the picture. With [`average`](Self::average), the size of the picture of the samples.
    pub size: Size,
    /// Four samples a pixel; only for gateware that [averages them](TriangleEngine::averages).
    pub average: Option<Average>,
    /// Address of the frame to write.
    pub frame: u32,
    /// The frame buffer that the pass writes: `false` for 0, `true` for 1.
    pub slot: bool,
    /// Whether every pixel of the frame buffer is written, because its contents are unknown.
    pub whole: bool,
    /// Address to which depth codes are written, if they are requested.
    pub depth: Option<u32>,
    /// Colour of pixels without a triangle, RGB565.
    pub clear: u16,
    /// The sky, which replaces `clear`, in a pass without a field; only for gateware that [draws it](TriangleEngine::draws_sky).
    pub sky: Option<Sky>,
    /// The fog on triangles; only for gateware that [has it](TriangleEngine::has_fog).
    pub fog: Option<Fog>,
    /// Whether colours are dithered.
    pub dither: bool,
    /// The capacity of a band list is 4 << `list_shift` entries; the next geometry pass must have an equal [`Lists::list_shift`].
    pub list_shift: u8,
    /// Input of the pass.
    pub input: Input,
}

/// Four samples a pixel in a raster pass, which then writes every pixel and no depth codes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Average {
    /// The quarter of the frame to which the samples belong; `None` for the whole frame.
    pub quarter: Option<Quarter>,
}

/// A quarter of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Quarter {
    /// Whether the quarter is on the right side.
    pub is_right: bool,
    /// Whether the quarter is at the bottom.
    pub is_lower: bool,
}

/// The sky behind the triangles of a raster pass (docs/formats/triangle.md, "Sky"): heights above the horizon, s8.23, and colours.
#[derive(Clone, Copy, Debug)]
pub struct Sky {
    /// Height of the first eight pixels in the line above the picture.
    pub above: i32,
    /// Change of the height over eight pixels.
    pub across: i32,
    /// Change of the height from a line to the next.
    pub down: i32,
    /// Colour at the zenith: red, green, blue.
    pub zenith: [u8; 3],
    /// Colour at the horizon.
    pub horizon: [u8; 3],
    /// Colour at the nadir.
    pub nadir: [u8; 3],
    /// Whether the sky is drawn before the triangles of each band, so that textures can be blended with the sky. Otherwise the sky is drawn
    /// during the flush, which takes no additional time.
    pub is_first: bool,
}

/// The fog on the triangles of a raster pass (docs/formats/triangle.md, "Fog").
#[derive(Clone, Copy, Debug)]
pub struct Fog {
    /// The number that is subtracted from 128·log2 of a depth code, s13.
    pub offset: i32,
    /// Colour: red u5.3, green u6.2, blue u5.3.
    pub colour: [u8; 3],
}

/// Input of a raster pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Input {
    /// The sets of descriptors and band lists, drawn in this order in each band.
    pub sets: [Option<Set>; 2],
    /// Address of the table of the textures' addresses, if the descriptors name textures.
    pub textures: Option<u32>,
}

/// Counts of the last geometry pass, and of the earlier passes to whose output the last pass was appended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Number of triangles of the mesh of the last pass.
    pub triangles: u32,
    /// Number of descriptors from all passes.
    pub descriptors: u32,
    /// Number of triangles that need clipping, in all passes.
    pub exceptions: u32,
}

/// Result of the last started pass; `None` while the pass runs.
pub type PassResult = Option<Result<(), EngineError>>;

/// Driver of the triangle engine, whose presence in this SoC has been checked.
pub struct TriangleEngine {
    registers: triangle::Triangle,
}

impl TriangleEngine {
    /// Takes the registers if the SoC has the triangle engine. No pass raises an interrupt until
    /// [`set_interrupts`](Self::set_interrupts).
    ///
    /// # Errors
    /// The block is absent.
    pub fn probe(registers: triangle::Triangle) -> Result<Self, Absent> {
        Absent::check(registers.ident().read(), triangle::Triangle::IDENT)?;
        Ok(Self { registers })
    }

    /// Sets whether the end of a pass raises an interrupt. A pass that has already ended raises no interrupt, so check its result
    /// afterwards.
    pub fn set_interrupts(&mut self, on: bool) {
        acknowledge();
        let events = EvEnable::default().with_geometry(on).with_raster(on);
        self.registers.ev_enable().write(events);
    }

    /// Whether this gateware draws triangles. If not, [`Error::Triangles`] ends each geometry pass of a mesh. If this gateware draws no
    /// lines either, this error ends each raster pass with a [`Set`], too; a raster pass without sets draws a raymarcher's field.
    #[must_use]
    pub fn draws_triangles(&self) -> bool {
        self.registers.caps().read().triangles()
    }

    /// Whether this gateware draws lines. If not, [`Error::Lines`] ends each geometry pass of lines.
    #[must_use]
    pub fn draws_lines(&self) -> bool {
        self.registers.caps().read().lines()
    }

    /// Whether this gateware has geometry passes. If not, [`Error::Geometry`] ends each geometry pass; a raster pass draws the [`Set`]s
    /// that the program has written.
    #[must_use]
    pub fn has_geometry(&self) -> bool {
        self.registers.caps().read().geometry()
    }

    /// Whether this gateware has a depth memory. If not, a raster pass writes depth codes of 0.
    #[must_use]
    pub fn has_depths(&self) -> bool {
        self.registers.caps().read().depths()
    }

    /// Whether this gateware draws textures, which makes descriptors longer.
    #[must_use]
    pub fn draws_textures(&self) -> bool {
        self.registers.caps().read().textures()
    }

    /// Whether this gateware draws the sky behind triangles.
    #[must_use]
    pub fn draws_sky(&self) -> bool {
        self.registers.caps().read().sky()
    }

    /// Whether this gateware has fog on triangles.
    #[must_use]
    pub fn has_fog(&self) -> bool {
        self.registers.caps().read().fog()
    }

    /// Whether this gateware averages four samples a pixel.
    #[must_use]
    pub fn averages(&self) -> bool {
        self.registers.caps().read().average()
    }

    /// Whether this gateware supports smooth shading, which makes descriptors longer.
    #[must_use]
    pub fn shades_smoothly(&self) -> bool {
        self.registers.caps().read().gouraud()
    }

    /// Writes the registers of a geometry pass in advance, so that the start itself is short. The previous pass may still run if
    /// it was started at least 128 clock cycles ago, because the engine has then copied its registers.
    pub fn prepare_geometry(&mut self, pass: &Geometry) -> Prepared {
        let registers = &self.registers;
        registers.mesh().write(pass.mesh.as_ptr().addr() as u32);
        registers.mesh_bytes().write(pass.mesh.len() as u32);
        if let Some(lists) = &pass.lists {
            self.write_output(lists);
            registers.exceptions().write(lists.exceptions);
            registers.exception_limit().write(lists.exception_limit);
            registers.light_colour().write(packed(pass.lights[0]));
            registers.ambient().write(packed(pass.lights[1]));
        }
        if let Some(colour) = pass.colour {
            registers.colour().write(colour);
        }
        if let Some(textures) = pass.textures {
            let coordinates = textures.coordinates.as_ptr().addr() as u32;
            registers.coordinates().write(coordinates);
            registers.first_texture().write(textures.before);
        }
        registers.scale_shift().write(pass.scale_shift);
        // Each register has its own write, because a loop would need a table of addresses.
        registers.row_u0().write(pass.u[0] as u32);
        registers.row_u1().write(pass.u[1] as u32);
        registers.row_u2().write(pass.u[2] as u32);
        registers.row_v0().write(pass.v[0] as u32);
        registers.row_v1().write(pass.v[1] as u32);
        registers.row_v2().write(pass.v[2] as u32);
        registers.row_n0().write(pass.n[0] as u32);
        registers.row_n1().write(pass.n[1] as u32);
        registers.row_n2().write(pass.n[2] as u32);
        registers.light_0().write(pass.light[0] as u32);
        registers.light_1().write(pass.light[1] as u32);
        registers.light_2().write(pass.light[2] as u32);
        let [x, y, z] = *pass.translation;
        registers.tx_low().write(x as u32);
        registers.tx_high().write((x >> 32) as u16);
        registers.ty_low().write(y as u32);
        registers.ty_high().write((y >> 32) as u16);
        registers.tz_low().write(z as u32);
        registers.tz_high().write((z >> 32) as u16);
        registers.near_low().write(pass.near as u32);
        registers.near_high().write((pass.near >> 32) as u8);
        registers.depth_scale().write(pass.depth_scale);
        Prepared {
            start: pass
                .options
                .with_start(true)
                .with_append(pass.lists.is_none())
                .with_recolour(pass.colour.is_some())
                .with_textures(pass.textures.is_some()),
        }
    }

    /// Writes the registers of a geometry pass of lines in advance, under the same condition as
    /// [`prepare_geometry`](Self::prepare_geometry). `segments` begins with the header of their list (docs/formats).
    pub fn prepare_lines(&mut self, segments: &[Segment], size: Size, lists: &Lists) -> Prepared {
        let registers = &self.registers;
        registers.mesh().write(segments.as_ptr().addr() as u32);
        registers.mesh_bytes().write(size_of_val(segments) as u32);
        self.write_output(lists);
        // Lines have no exceptions: the list has a valid address, because the engine checks it, and the capacity 0.
        registers.exceptions().write(lists.lists);
        registers.exception_limit().write(0);
        Prepared {
            start: GeometryStart::default()
                .with_start(true)
                .with_lines(true)
                .with_size(size),
        }
    }

    /// Writes the registers with the output addresses of a geometry pass.
    fn write_output(&self, lists: &Lists) {
        let registers = &self.registers;
        registers.geometry_descriptors().write(lists.descriptors);
        registers.descriptor_limit().write(lists.descriptor_limit);
        registers.geometry_lists().write(lists.lists);
        registers.list_shift().write(lists.list_shift);
    }

    /// Starts the prepared geometry pass.
    ///
    /// # Safety
    /// Until the pass has ended, its mesh with texture coordinates, or its segments, must not be written and its output must not be
    /// accessed. The output is overwritten.
    pub unsafe fn start_geometry(&mut self, pass: Prepared) {
        // Writes of the CPU to memory must precede the start of the engine.
        compiler_fence(Ordering::SeqCst);
        self.registers.geometry().write(pass.start);
    }

    /// Starts a raster pass.
    ///
    /// # Safety
    /// Until the pass has ended, lists, descriptors, the table of textures and its textures must not be written, and frame and depth
    /// codes must not be accessed. Frame and depth codes are overwritten.
    pub unsafe fn start_raster(&mut self, pass: &Raster) {
        let registers = &self.registers;
        registers.frame().write(pass.frame);
        registers.depth().write(pass.depth.unwrap_or(0));
        registers.clear().write(pass.clear);
        registers.list_shift().write(pass.list_shift);
        let [first, second] = pass.input.sets;
        if let Some(set) = first {
            registers.lists_0().write(set.lists);
            registers.descriptors_0().write(set.descriptors);
            registers.count_0().write(set.count);
        }
        if let Some(set) = second {
            registers.lists_1().write(set.lists);
            registers.descriptors_1().write(set.descriptors);
            registers.count_1().write(set.count);
        }
        if let Some(table) = pass.input.textures {
            registers.textures().write(table);
        }
        if let Some(sky) = &pass.sky {
            self.write_sky(sky);
        }
        if let Some(fog) = &pass.fog {
            registers.fog_offset().write(fog.offset as u16);
            registers.fog_colour().write(packed_colour(fog.colour));
        }
        let quarter = pass.average.and_then(|average| average.quarter);
        compiler_fence(Ordering::SeqCst);
        registers.raster().write(
            RasterStart::default()
                .with_start(true)
                .with_size(pass.size)
                .with_first(first.is_some())
                .with_second(second.is_some())
                .with_depth(pass.depth.is_some())
                .with_slot(pass.slot)
                .with_whole(pass.whole)
                .with_sky(pass.sky.is_some())
                .with_sky_first(pass.sky.is_some_and(|sky| sky.is_first))
                .with_fog(pass.fog.is_some())
                .with_average(pass.average.is_some())
                .with_quarter(quarter.is_some())
                .with_right(quarter.is_some_and(|quarter| quarter.is_right))
                .with_lower(quarter.is_some_and(|quarter| quarter.is_lower))
                .with_dither(pass.dither),
        );
    }

    fn write_sky(&self, sky: &Sky) {
        let registers = &self.registers;
        registers.sky_above().write(sky.above as u32);
        registers.sky_across().write(sky.across as u32);
        registers.sky_down().write(sky.down as u32);
        registers.sky_zenith().write(packed_colour(sky.zenith));
        registers.sky_horizon().write(packed_colour(sky.horizon));
        registers.sky_nadir().write(packed_colour(sky.nadir));
    }

    /// Result of the last geometry pass.
    #[must_use]
    pub fn geometry(&self) -> PassResult {
        let status = self.registers.status().read();
        (!status.geometry_busy()).then(|| EngineError::check(status.geometry_error()))
    }

    /// Result of the last raster pass.
    #[must_use]
    pub fn raster(&self) -> PassResult {
        let status = self.registers.status().read();
        (!status.raster_busy()).then(|| EngineError::check(status.raster_error()))
    }

    /// Cancels the running passes. The next raster pass to the frame buffer of a cancelled pass must write all pixels
    /// ([`Raster::whole`]).
    pub fn cancel(&mut self) {
        self.registers
            .control()
            .write(Control::default().with_cancel(true));
    }

    /// Counts of the geometry passes.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let registers = &self.registers;
        Counts {
            triangles: registers.triangles().read(),
            descriptors: registers.descriptor_count().read(),
            exceptions: registers.exception_count().read(),
        }
    }

    /// The free-running counters of the triangle engine.
    #[must_use]
    pub fn counters(&self) -> Counters {
        Counters::read(&self.registers)
    }
}

/// Clears the triangle engine's interrupt, for the interrupt handler.
pub fn acknowledge() {
    // SAFETY: only this function writes the pending register. Clearing both events loses no information, because `status` keeps
    // the states of the passes.
    let registers = unsafe { triangle::Triangle::steal() };
    registers
        .ev_pending()
        .write(EvPending::default().with_geometry(true).with_raster(true));
}

/// Register value of three channels of 8 bits each.
fn packed_colour([red, green, blue]: [u8; 3]) -> u32 {
    u32::from_le_bytes([red, green, blue, 0])
}

/// Register value of three channels, u1.8 each.
fn packed([red, green, blue]: [u16; 3]) -> u32 {
    u32::from(red) | u32::from(green) << 9 | u32::from(blue) << 18
}

#[cfg(test)]
mod tests;
