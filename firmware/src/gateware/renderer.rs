//! The passes of a frame: the geometry pass, clipping by the CPU, and the raster pass.

use glint_core::camera::Projection;
use glint_core::colour::{Shading, Winding};
use glint_core::picture::Size;
use glint_hal::frequency::Frequency;
use glint_hal::raymarch::{self, Raymarcher};
use glint_hal::triangle::{
    Counters, EngineError, Error, Geometry, Prepared, Raster, Set, TriangleEngine,
};
use glint_model::triangle::descriptor::ListWriter;
use glint_model::{
    Clip, Frame, FrameConstants, FrameStats, MeshSubject, Options, Stats, Subject, WireframeStats,
    clip_exceptions,
};
use litex_pac::cpu;

use super::buffers::{Buffers, Projected, Room, address};
use super::fallback::Fallback;
use super::watchdog::Watchdog;

/// The memory that a frame is written to.
pub struct Output<'a> {
    /// Colours in RGB565, row by row.
    pub colour: &'a mut [u16],
    /// Memory for depth codes, if they are requested.
    pub depth: Option<&'a mut [u32]>,
}

/// A frame drawn by the gateware.
pub struct Rendered {
    /// Clock cycles from the first register write of the frame to the detection of its end.
    pub cycles: u64,
    /// Counts of the frame. In a benchmark the triangle counts are those of the last frame only.
    pub stats: FrameStats,
    /// Growth of the triangle engine's counters during the frame.
    pub counters: Counters,
}

/// The step of a frame in progress: a pass of the triangle engine, or one of the CPU; or `Idle`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    Idle,
    /// The CPU projects the segments of a wireframe.
    Project,
    Geometry,
    Raster,
}

/// Time and counters at the start of a measurement.
#[derive(Default)]
struct Start {
    cycles: u64,
    engine: Counters,
    raymarcher: raymarch::Counters,
}

/// The triangle engine, the raymarcher and their memory.
pub struct GatewareRenderer {
    pub(super) engine: TriangleEngine,
    raymarcher: Option<Raymarcher>,
    draws_triangles: bool,
    draws_lines: bool,
    pub(super) shading: Shading,
    /// Memory of the frame being drawn, and, in a benchmark, of the next frame.
    pub(super) buffers: [Buffers; 2],
    /// The projected part of a wireframe.
    pub(super) projected: Projected,
    /// Address of frame buffer 0.
    first_frame_buffer: u32,
    /// Size of the picture that the engine drew last into each frame buffer; `None` if the CPU has written to the buffer
    /// since.
    drawn_sizes: [Option<Size>; 2],
    stage: Stage,
    /// Constants of the frame being drawn, and, in a benchmark, of the next frame. The index `place` of the functions below
    /// selects one of them, together with the buffers of the same index.
    constants: [FrameConstants; 2],
    watchdog: Watchdog,
    start: Start,
    /// Time at which the last pass was started: the lower half of the cycle counter.
    pass_start: u32,
}

/// Clock cycles for which [`GatewareRenderer::advance`] waits for a pass that it has started, 0.25 ms at 81.25 MHz. A pass of the main
/// loop takes 3,000 cycles and more, most of them to load its code, so a wait is faster for a short pass of the engine.
const PATIENCE: u32 = 20_000;

impl GatewareRenderer {
    /// A renderer for two frame buffers, of which the first is at `first_frame_buffer`, and a clock of `frequency`; `None` if
    /// `memory` is too small.
    pub fn new(
        engine: TriangleEngine,
        raymarcher: Option<Raymarcher>,
        mut memory: &'static mut [u32],
        first_frame_buffer: u32,
        frequency: Frequency,
    ) -> Option<Self> {
        let room = Room::of(memory.len())?;
        Some(Self {
            draws_triangles: engine.draws_triangles(),
            draws_lines: engine.draws_lines(),
            shading: engine.shading(),
            engine,
            raymarcher,
            buffers: [
                Buffers::split_off(&mut memory, room)?,
                Buffers::split_off(&mut memory, room)?,
            ],
            projected: Projected::default(),
            first_frame_buffer,
            drawn_sizes: [None; 2],
            stage: Stage::Idle,
            constants: Default::default(),
            watchdog: Watchdog::new(frequency),
            start: Start::default(),
            pass_start: 0,
        })
    }

    /// The subjects that the gateware draws, as a list for the console. The CPU draws the others.
    pub const fn subjects(&self) -> &'static str {
        match (
            self.draws_triangles,
            self.raymarcher.is_some(),
            self.draws_lines,
        ) {
            (true, true, true) => "meshes, fields, wireframes",
            (true, true, false) => "meshes, fields",
            (true, false, true) => "meshes, wireframes",
            (true, false, false) => "meshes",
            (false, true, _) => "fields",
            (false, false, _) => "none",
        }
    }

    /// Whether a frame is in progress.
    pub fn is_busy(&self) -> bool {
        self.stage != Stage::Idle
    }

    /// Whether the pass awaited by [`advance`](Self::advance) has ended.
    pub fn is_ready(&self) -> bool {
        match self.stage {
            Stage::Idle => false,
            Stage::Project => true,
            Stage::Geometry => self.engine.geometry().is_some(),
            Stage::Raster => self.engine.raster().is_some(),
        }
    }

    /// Marks the frame buffer of `colour` as written by the CPU: the engine then writes every pixel of the next frame in
    /// this buffer.
    pub fn invalidate(&mut self, colour: &[u16]) {
        let slot = usize::from(self.slot(colour));
        if let Some(size) = self.drawn_sizes.get_mut(slot) {
            *size = None;
        }
    }

    /// Starts or continues the drawing of a frame. `frame` and `output` must stay the same until the function returns a
    /// result; `None` means that a pass is still running.
    ///
    /// # Errors
    /// The gateware cannot draw the frame; the gateware is then idle.
    pub fn advance(
        &mut self,
        frame: &Frame,
        output: &mut Output,
    ) -> Option<Result<Rendered, Fallback>> {
        loop {
            let result = self.step(frame, output);
            if result.is_some() || !self.ends_soon() {
                return result;
            }
        }
    }

    /// Waits for the end of a short pass: until [`PATIENCE`] after its start. Returns whether it has ended.
    fn ends_soon(&self) -> bool {
        loop {
            if self.is_ready() {
                return true;
            }
            if cpu::cycles_low().wrapping_sub(self.pass_start) > PATIENCE {
                return false;
            }
        }
    }

    fn step(&mut self, frame: &Frame, output: &mut Output) -> Option<Result<Rendered, Fallback>> {
        let step = match (self.stage, &frame.subject) {
            (Stage::Idle, _) => return self.begin(frame, output).err().map(Err),
            (Stage::Project, Subject::Wireframe(wireframe)) => {
                match self.project(wireframe, frame.size, 0) {
                    Ok(false) => return None,
                    Ok(true) => {
                        let prepared = self.prepare_lines(frame.size, 0);
                        self.start_geometry(prepared);
                        self.stage = Stage::Geometry;
                        return None;
                    }
                    Err(error) => Err(error),
                }
            }
            (Stage::Geometry, Subject::Wireframe(_)) => match self.engine.geometry() {
                None => return self.check_progress(output).err().map(Err),
                Some(result) => result.map(|()| self.take_lines(0)),
            },
            (Stage::Geometry, Subject::Mesh(mesh) | Subject::MeshInField(mesh, _)) => {
                match self.engine.geometry() {
                    None => return self.check_progress(output).err().map(Err),
                    Some(Ok(())) => self.clip(mesh, 0),
                    Some(result) => result,
                }
            }
            _ => match self.engine.raster() {
                None => return self.check_progress(output).err().map(Err),
                Some(Ok(())) => {
                    self.stage = Stage::Idle;
                    return Some(Ok(self.rendered(frame, 0)));
                }
                Some(result) => result,
            },
        };
        match step {
            Ok(()) => {
                self.start_raster(frame, output, self.sets(0));
                self.stage = Stage::Raster;
                None
            }
            Err(error) => Some(Err(self.give_up(output, error))),
        }
    }

    fn begin(&mut self, frame: &Frame, output: &mut Output) -> Result<(), Fallback> {
        self.start_measurement(frame);
        self.update_constants(frame, 0)?;
        self.set_field(0, false)?;
        if let Some(mesh) = frame.subject.mesh_part() {
            let prepared = self.prepare_geometry(mesh, 0)?;
            self.start_geometry(prepared);
            self.stage = Stage::Geometry;
        } else if let Subject::Wireframe(_) = frame.subject {
            self.projected = Projected::default();
            self.stage = Stage::Project;
        } else {
            self.start_raster(frame, output, [None; 2]);
            self.stage = Stage::Raster;
        }
        Ok(())
    }

    /// Stores the time and the counters at the start of a measurement, and resets the watchdog.
    pub(super) fn start_measurement(&mut self, frame: &Frame) {
        self.watchdog.reset();
        self.start = Start {
            raymarcher: self.raymarcher_counters(frame).unwrap_or_default(),
            engine: self.engine.counters(),
            // Comes last, because the reading of the counters is no part of the frame.
            cycles: cpu::cycles(),
        };
    }

    /// The raymarcher's counters; `None` for a frame without a field.
    fn raymarcher_counters(&self, frame: &Frame) -> Option<raymarch::Counters> {
        frame.subject.field_part()?;
        Some(self.raymarcher.as_ref()?.counters())
    }

    /// The results of the measurement since `start_measurement`, with the triangle counts in `self.buffers[place]`.
    pub(super) fn rendered(&self, frame: &Frame, place: usize) -> Rendered {
        let cycles = cpu::cycles() - self.start.cycles;
        let counters = self.engine.counters().since(&self.start.engine);
        let field = self.raymarcher_counters(frame);
        let field = field.map(|field| field.since(&self.start.raymarcher));
        let field_pixels = field.map_or(0, |field| field.items_out);
        let mesh = frame.subject.mesh_part().map(|_| Stats {
            // In each clock that `cycles_walking` counts, the walker tests a group of eight pixels.
            pixels_tested: 8 * u64::from(counters.cycles_walking),
            pixels_covered: counters.pixels_covered.wrapping_sub(field_pixels).into(),
            pixels_drawn: counters.pixels_drawn.into(),
            ..self.buffers[place].stats
        });
        let wireframe = matches!(frame.subject, Subject::Wireframe(_)).then(|| WireframeStats {
            pixels: counters.pixels_drawn.into(),
            ..self.projected.stats
        });
        Rendered {
            cycles,
            stats: FrameStats {
                mesh,
                field: field.as_ref().map(raymarch::ray_counts),
                wireframe,
            },
            counters,
        }
    }

    /// Computes the constants of a frame into `self.constants[place]`. Fails if the engine cannot draw the frame.
    pub(super) fn update_constants(&mut self, frame: &Frame, place: usize) -> Result<(), Fallback> {
        if matches!(frame.subject, Subject::Wireframe(_)) && !self.draws_lines {
            return Err(Fallback::NoLineEngine);
        }
        if let Some(mesh) = frame.subject.mesh_part() {
            if !self.draws_triangles {
                return Err(EngineError::from(Error::Triangles).into());
            }
            if mesh.shading == Shading::Smooth && self.shading == Shading::Flat {
                return Err(EngineError::Shading.into());
            }
            if mesh.shading == Shading::Smooth
                && frame.view.projection() == Projection::Orthographic
            {
                return Err(Fallback::Orthographic);
            }
            if mesh.clip != Clip::Guard {
                return Err(Fallback::Clip);
            }
            if mesh.winding != Winding::Mesh {
                return Err(Fallback::Winding);
            }
            let sees_dark_sides = mesh.shading == Shading::Smooth && !mesh.cull;
            if sees_dark_sides && frame.mesh_lighting().ambient != [0; 3] {
                return Err(Fallback::Light);
            }
        }
        if frame.subject.objects().is_some() {
            return Err(Fallback::Objects);
        }
        Ok(self.constants[place].update(frame)?)
    }

    /// Writes the raymarcher's registers for the field of `self.constants[place]`, or switches the raymarcher off if
    /// there is no field. With `has_tables`, the raymarcher is known to hold the right tables, so they are not compared.
    pub(super) fn set_field(&mut self, place: usize, has_tables: bool) -> Result<(), Fallback> {
        match (&mut self.raymarcher, self.constants[place].field()) {
            (Some(raymarcher), Some(field)) if has_tables => {
                raymarcher.set_field_with_tables_held(&field.setup, &field.palette)?;
            }
            (Some(raymarcher), Some(field)) => {
                raymarcher.set_field(&field.setup, &field.palette)?;
            }
            (Some(raymarcher), None) => raymarcher.clear_field(),
            (None, Some(_)) => return Err(Fallback::NoRaymarcher),
            (None, None) => {}
        }
        Ok(())
    }

    /// Whether the raymarcher holds the tables of the field of `self.constants[place]`.
    pub(super) fn has_tables(&self, place: usize) -> bool {
        let both = self.raymarcher.as_ref().zip(self.constants[place].field());
        both.is_some_and(|(raymarcher, field)| raymarcher.has_tables(&field.palette))
    }

    /// Writes the registers of a geometry pass from `self.constants[place]`. The pass will write to `self.buffers[place]`.
    pub(super) fn prepare_geometry(
        &mut self,
        subject: &MeshSubject,
        place: usize,
    ) -> Result<Prepared, EngineError> {
        let setup = self.constants[place].mesh().ok_or(Error::Size)?;
        let buffers = &self.buffers[place];
        let pass = Geometry {
            mesh: &subject.mesh,
            frame: setup,
            light: self.constants[place].light(),
            cull: subject.cull,
            shading: subject.shading,
            lists: buffers.lists(self.shading),
            exceptions: address(buffers.exceptions),
            exception_limit: buffers.exceptions.len() as u32,
        };
        let shift = buffers.list_shift(setup.width) as u8;
        self.engine.prepare_geometry(&pass, shift)
    }

    pub(super) fn start_geometry(&mut self, pass: Prepared) {
        // SAFETY: the buffers belong to this renderer, are not used by an earlier pass, and are read after the end of
        // this pass; the mesh stays while the renderer is busy.
        unsafe { self.engine.start_geometry(pass) };
        self.pass_start = cpu::cycles_low();
    }

    pub(super) fn start_raster(
        &mut self,
        frame: &Frame,
        output: &mut Output,
        sets: [Option<Set>; 2],
    ) {
        let slot = self.slot(output.colour);
        let drawn_size = &mut self.drawn_sizes[usize::from(slot)];
        let pass = Raster {
            size: frame.size,
            frame: address(output.colour),
            slot,
            whole: *drawn_size != Some(frame.size),
            depth: output.depth.as_deref().map(address),
            clear: frame.clear.0,
            sets,
        };
        *drawn_size = Some(frame.size);
        // SAFETY: the lists belong to this renderer and stay until the end of the pass; the caller lends the memory of
        // colours and depth codes until then.
        unsafe { self.engine.start_raster(&pass) };
        self.pass_start = cpu::cycles_low();
    }

    /// Clips the exceptions, the triangles that need it, of the geometry pass that wrote `self.buffers[place]`.
    pub(super) fn clip(&mut self, subject: &MeshSubject, place: usize) -> Result<(), EngineError> {
        let setup = self.constants[place].mesh().ok_or(Error::Size)?;
        let buffers = &mut self.buffers[place];
        let counts = self.engine.counts();
        buffers.sets = [Some(buffers.set(counts.descriptors)), None];
        let mut clipped_drawn = 0;
        if counts.exceptions > 0 {
            cpu::flush_data_cache();
            let exceptions = buffers.exceptions.get(..counts.exceptions as usize);
            let mut numbers = exceptions.unwrap_or_default().iter().copied();
            let list_shift = buffers.list_shift(setup.width);
            let mut writer = ListWriter::new(
                buffers.clipped_descriptors,
                buffers.clipped_lists,
                setup.width,
                list_shift,
                self.shading,
            );
            let options = Options {
                cull: subject.cull,
                shading: subject.shading,
                light: self.constants[place].light(),
                ..Options::default()
            };
            let mut put = |setup: &_, colour| writer.put(setup, colour);
            clipped_drawn = clip_exceptions(&subject.mesh, setup, &options, &mut numbers, &mut put);
            let count = writer.finish().map_err(|_| Error::Full)?;
            buffers.sets[1] = Some(buffers.clipped_set(count));
        }
        let drawn = counts.descriptors + clipped_drawn;
        buffers.stats = Stats {
            triangles_in: counts.triangles,
            culled: counts.triangles.saturating_sub(drawn),
            clipped: counts.exceptions,
            drawn,
            ..Stats::default()
        };
        Ok(())
    }

    /// Cancels the frame and fails if the triangle engine has made no progress for too long.
    pub(super) fn check_progress(&mut self, output: &Output) -> Result<(), Fallback> {
        if self.watchdog.is_stuck(&self.engine.counters()) {
            return Err(self.give_up(output, EngineError::Timeout));
        }
        Ok(())
    }

    /// Cancels the running passes, and returns `error` as the reason to draw the frame by the CPU.
    pub(super) fn give_up(&mut self, output: &Output, error: EngineError) -> Fallback {
        self.engine.cancel();
        self.stage = Stage::Idle;
        self.invalidate(output.colour);
        error.into()
    }

    /// The sets of lists in `self.buffers[place]`.
    pub(super) fn sets(&self, place: usize) -> [Option<Set>; 2] {
        self.buffers[place].sets
    }

    fn slot(&self, colour: &[u16]) -> bool {
        address(colour) != self.first_frame_buffer
    }
}
