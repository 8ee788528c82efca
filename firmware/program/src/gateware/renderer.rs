//! The passes of a frame: the geometry passes, and the raster pass.

mod lines;
mod quarters;
mod repeat;

use glint_core::camera::Projection;
use glint_core::colour::{Rgb565, Rounding, Shading};
use glint_core::feature::{EDGES, SKY, TEXTURE, WIREFRAME};
use glint_core::picture::{Backend, Samples, Size};
use glint_engines::raymarch::{ray_counts, set_field, tables};
use glint_engines::triangle::{average, fog, layout, size_code, sky as sky_of};
use glint_hal::frequency::Frequency;
use glint_hal::raymarch::{self, Raymarcher};
use glint_hal::triangle::{Counters, EngineError, Error, Input, Prepared, Raster, TriangleEngine};
use glint_model::edges::EdgeStats;
use glint_model::triangle::descriptor::Layout;
use glint_model::{Frame, FrameConstants, FrameStats, Stats, Subject, WireframeStats};
use glint_scene::Defaults;
use litex_pac::cpu;

use super::buffers::{Buffers, Capacity, Projected, address};
use super::fallback::Fallback;
use super::geometry::{Cpu, GeometryPasses, Job};
use super::quarters::Quarters;
use super::rendered::Rendered;
use super::watchdog::Watchdog;

/// The output memory of a frame.
pub struct Output<'a> {
    /// Colours in RGB565, row by row.
    pub colour: &'a mut [u16],
    /// Memory for depth codes, if requested.
    pub depth: Option<&'a mut [u32]>,
}

/// The current step of the frame in progress: a pass of the triangle engine, a step of the CPU, or `Idle` without a frame.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    Idle,
    /// The CPU projects the segments of a wireframe.
    Project,
    Geometry,
    /// The geometry pass of the lines of a wireframe, or of a mesh's edges.
    Lines,
    Raster,
    /// Passes of two quarters run at the same time.
    Quarters,
}

/// Time and counters at the start of a measurement.
#[derive(Default)]
struct Start {
    cycles: u64,
    /// The value of `GatewareRenderer::waited` at the start.
    waited: u64,
    engine: Counters,
    raymarcher: raymarch::Counters,
}

/// Draws frames with the triangle engine and the raymarcher.
pub struct GatewareRenderer {
    engine: TriangleEngine,
    raymarcher: Option<Raymarcher>,
    draws_triangles: bool,
    draws_lines: bool,
    draws_sky: bool,
    has_fog: bool,
    averages: bool,
    /// Layout of the descriptors of this gateware.
    layout: Layout,
    /// Memory of the frame being drawn, and of the next quarter or, in a benchmark, of the next frame.
    buffers: [Buffers; 2],
    /// Progress of the projection of a wireframe.
    projected: Projected,
    /// Counts of the mesh's edges in the current frame.
    edges: EdgeStats,
    /// Address of frame buffer 0.
    first_frame_buffer: u32,
    /// Size and background of the picture that the engine drew last into each frame buffer; `None` if the CPU has written to the buffer
    /// since then, if the background was a sky, or if pixels are averages of samples.
    drawn: [Option<(Size, Rgb565)>; 2],
    stage: Stage,
    /// Progress of a divided frame.
    quarters: Quarters,
    /// Constants of the frame being drawn, and of the next quarter or, in a benchmark, of the next frame. The index `place` of the functions
    /// below selects one of them, together with the buffers of the same index.
    constants: [FrameConstants; 2],
    geometry: GeometryPasses,
    watchdog: Watchdog,
    /// Clock cycles of all waits of benchmarks.
    waited: u64,
    start: Start,
    /// Time at which the last pass was started: the lower half of the cycle counter.
    pass_start: u32,
    /// Time of the last check of the watchdog: the lower half of the cycle counter.
    checked: u32,
}

/// Largest number of clock cycles that [`GatewareRenderer::advance`] waits for a started pass: 0.25 ms at 81.25 MHz. An iteration of the
/// main loop takes at least 3,000 cycles, mostly to load its code, so waiting is faster for a short pass of the engine.
const PATIENCE: u32 = 20_000;

/// Minimum number of clock cycles between two checks of the watchdog, 13 ms at 81.25 MHz, so that every interrupt of the vertical blanking
/// (each 16.7 ms) causes a check.
const CHECK_PERIOD: u32 = 1 << 20;

impl GatewareRenderer {
    /// A renderer for two frame buffers, the first at address `first_frame_buffer`, and a clock of `frequency`; `None` if
    /// `memory` is too small.
    pub fn new(
        engine: TriangleEngine,
        raymarcher: Option<Raymarcher>,
        mut memory: &'static mut [u32],
        first_frame_buffer: u32,
        frequency: Frequency,
    ) -> Option<Self> {
        let capacity = Capacity::of(memory.len())?;
        let (layout, has_geometry) = (layout(&engine), engine.has_geometry());
        Some(Self {
            draws_triangles: engine.draws_triangles(),
            draws_lines: engine.draws_lines(),
            draws_sky: engine.draws_sky(),
            has_fog: engine.has_fog(),
            averages: engine.averages(),
            layout,
            engine,
            raymarcher,
            buffers: [
                Buffers::split_off(&mut memory, capacity)?,
                Buffers::split_off(&mut memory, capacity)?,
            ],
            projected: Projected::default(),
            edges: EdgeStats::default(),
            first_frame_buffer,
            drawn: [None; 2],
            stage: Stage::Idle,
            quarters: Quarters::default(),
            constants: Default::default(),
            geometry: GeometryPasses::new(layout, has_geometry),
            watchdog: Watchdog::new(frequency),
            waited: 0,
            start: Start::default(),
            pass_start: 0,
            checked: 0,
        })
    }

    /// Largest number of triangles of a mesh: twice the descriptors of a frame, because a closed mesh hides half of its triangles.
    pub fn most_triangles(&self) -> u32 {
        let [buffers, _] = &self.buffers;
        2 * buffers.descriptor_limit(self.layout)
    }

    /// The options of the start scene that this gateware supports.
    pub fn defaults(&self) -> Defaults {
        let plain = Defaults {
            backend: Backend::Gateware,
            ..Defaults::SOFT_CORE
        };
        let all = Defaults::GATEWARE;
        Defaults {
            samples: if self.averages {
                all.samples
            } else {
                plain.samples
            },
            background: if self.draws_sky && SKY.is_built {
                all.background
            } else {
                plain.background
            },
            ..plain
        }
    }

    /// The subjects that the gateware draws, as a list for the console. The CPU draws all other subjects.
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
            (false, true, true) => "fields, wireframes",
            (false, true, false) => "fields",
            (false, false, true) => "wireframes",
            (false, false, false) => "none",
        }
    }

    /// Whether a frame is in progress.
    pub fn is_busy(&self) -> bool {
        self.stage != Stage::Idle || self.quarters.has_drawn()
    }

    /// Whether the pass awaited by [`advance`](Self::advance) has ended.
    pub fn is_ready(&self) -> bool {
        match self.stage {
            Stage::Idle => false,
            Stage::Project => true,
            Stage::Geometry | Stage::Lines => self.engine.geometry().is_some(),
            Stage::Raster => self.engine.raster().is_some(),
            Stage::Quarters => self.quarters.is_ready(&self.engine),
        }
    }

    /// Whether [`advance`](Self::advance) can continue: the awaited pass has ended, or the watchdog must be checked.
    pub fn is_due(&self) -> bool {
        self.is_ready() || cpu::cycles_low().wrapping_sub(self.checked) > CHECK_PERIOD
    }

    /// Marks the frame buffer of `colour` as written by the CPU, so that the engine writes every pixel of the next frame in this buffer.
    pub fn invalidate(&mut self, colour: &[u16]) {
        let slot = usize::from(self.slot(colour));
        if let Some(drawn) = self.drawn.get_mut(slot) {
            *drawn = None;
        }
    }

    /// Starts or continues the drawing of a frame. `frame` and `output` must not change until the function returns a result; `None` means
    /// that a pass is still running. The call that starts a frame may take long, because the CPU computes the constants.
    ///
    /// # Errors
    /// The gateware cannot draw the frame; the gateware is then idle.
    pub fn advance(
        &mut self,
        frame: &Frame,
        output: &mut Output,
        cpu: &mut Cpu,
    ) -> Option<Result<Rendered, Fallback>> {
        if !frame.is_divided() {
            return self.advance_part(frame, output, cpu);
        }
        if has_lines(frame) {
            return self.advance_quarters(frame, output, cpu);
        }
        // A copy for all steps, because each of them sets the quarter, and a frame is large.
        let mut quarter = *frame;
        self.advance_by(|renderer| renderer.step_quarters(&mut quarter, output, cpu))
    }

    /// Starts or continues the drawing of an undivided frame, or of one quarter.
    fn advance_part(
        &mut self,
        frame: &Frame,
        output: &mut Output,
        cpu: &mut Cpu,
    ) -> Option<Result<Rendered, Fallback>> {
        self.advance_by(|renderer| renderer.step(frame, output, cpu))
    }

    /// Calls `step` after the end of each pass until `step` returns a result, or until a pass does not end soon.
    fn advance_by(
        &mut self,
        mut step: impl FnMut(&mut Self) -> Option<Result<Rendered, Fallback>>,
    ) -> Option<Result<Rendered, Fallback>> {
        if self.is_busy() {
            // This function polls for the end of short passes, because an interrupt for each of them would take 600 cycles.
            self.engine.set_interrupts(false);
        }
        loop {
            let result = step(self);
            if result.is_some() {
                return result;
            }
            if !self.ends_soon() {
                self.engine.set_interrupts(true);
                return None;
            }
        }
    }

    /// Waits for the end of a pass, at most until [`PATIENCE`] after its start. Returns whether the pass has ended.
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

    fn step(
        &mut self,
        frame: &Frame,
        output: &mut Output,
        cpu: &mut Cpu,
    ) -> Option<Result<Rendered, Fallback>> {
        let next = match (self.stage, &frame.subject) {
            (Stage::Idle, _) => return self.begin(frame, output, cpu).err().map(Err),
            (Stage::Project, Subject::Wireframe(wireframe)) if WIREFRAME.is_built => {
                match self.project(wireframe, frame, 0) {
                    Ok(false) => return None,
                    Ok(true) => {
                        let prepared = self.prepare_lines(frame.window().size, 0);
                        self.start_pass(prepared);
                        Ok(Stage::Lines)
                    }
                    Err(error) => Err(error.into()),
                }
            }
            (Stage::Geometry | Stage::Lines, _) => match self.engine.geometry() {
                None => return self.check_progress(output).err().map(Err),
                Some(Err(error)) => Err(error.into()),
                Some(Ok(())) if self.stage == Stage::Lines => {
                    self.take_lines(frame, 0);
                    Ok(Stage::Raster)
                }
                Some(Ok(())) => {
                    let runs = self.continue_geometry(frame, 0);
                    runs.map(|runs| self.after_geometry(runs, frame))
                }
            },
            (Stage::Raster | Stage::Project | Stage::Quarters, _) => match self.engine.raster() {
                None => return self.check_progress(output).err().map(Err),
                Some(Ok(())) => {
                    self.stage = Stage::Idle;
                    return Some(Ok(self.rendered(frame, 0)));
                }
                Some(Err(error)) => Err(error.into()),
            },
        };
        self.enter(next, frame, output).err().map(Err)
    }

    /// The next stage of a frame: `Geometry` if the next geometry pass `runs`. After the last geometry pass, `Lines` for a mesh's edges,
    /// whose pass this function starts, or `Raster`.
    fn after_geometry(&mut self, runs: bool, frame: &Frame) -> Stage {
        if runs {
            return Stage::Geometry;
        }
        if EDGES.is_built
            && let Subject::Edges(..) = frame.subject
        {
            self.start_edges(frame.window().size);
            return Stage::Lines;
        }
        Stage::Raster
    }

    /// Enters the stage `next`. For the stage `Raster`, starts the raster pass.
    fn enter(
        &mut self,
        next: Result<Stage, Fallback>,
        frame: &Frame,
        output: &mut Output,
    ) -> Result<(), Fallback> {
        self.stage = next.map_err(|error| self.cancel(output, error))?;
        if self.stage == Stage::Raster {
            let started = self.start_raster(frame, output, 0);
            return started.map_err(|error| self.cancel(output, error));
        }
        self.pass_start = cpu::cycles_low();
        Ok(())
    }

    fn begin(&mut self, frame: &Frame, output: &mut Output, cpu: &mut Cpu) -> Result<(), Fallback> {
        self.start_measurement(frame);
        if output.depth.is_some() && !self.engine.has_depths() {
            return Err(Fallback::NoDepths);
        }
        self.update_constants(frame, 0)?;
        self.set_field(0, false)?;
        if WIREFRAME.is_built
            && let Subject::Wireframe(_) = frame.subject
        {
            self.projected = Projected::default();
            self.stage = Stage::Project;
            return Ok(());
        }
        self.prepare_geometry(frame, 0)?;
        let runs = self.start_geometry(frame, 0, cpu);
        let next = runs.and_then(|runs| {
            if EDGES.is_built {
                self.project_edges(frame, cpu)?;
            }
            Ok(self.after_geometry(runs, frame))
        });
        self.enter(next, frame, output)
    }

    /// Stores the time and the counters at the start of a measurement, and resets the watchdog.
    fn start_measurement(&mut self, frame: &Frame) {
        self.watchdog.reset();
        self.start = Start {
            raymarcher: self.raymarcher_counters(frame).unwrap_or_default(),
            waited: self.waited,
            engine: self.engine.counters(),
            // The time is read last, because reading the counters is not part of the frame.
            cycles: cpu::cycles(),
        };
    }

    /// The raymarcher's counters; `None` for a frame without a field.
    fn raymarcher_counters(&self, frame: &Frame) -> Option<raymarch::Counters> {
        frame.subject.field_part()?;
        Some(self.raymarcher.as_ref()?.counters())
    }

    /// The results of the measurement since `start_measurement`, including the triangle counts in `self.buffers[place]`.
    fn rendered(&self, frame: &Frame, place: usize) -> Rendered {
        let cycles = cpu::cycles() - self.start.cycles;
        let counters = self.engine.counters().since(&self.start.engine);
        let field = self.raymarcher_counters(frame);
        let field = field.map(|field| field.since(&self.start.raymarcher));
        let field_pixels = field.map_or(0, |field| field.items_out);
        let mesh = self.constants[place].mesh().map(|_| Stats {
            pixels_tested: None,
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
            waited: self.waited - self.start.waited,
            stats: FrameStats {
                mesh,
                field: field.as_ref().map(ray_counts),
                wireframe,
                edges: matches!(frame.subject, Subject::Edges(..)).then_some(self.edges),
            },
            counters,
            unsupported: mesh.and_then(|_| self.geometry.unsupported()),
        }
    }

    /// The geometry passes, and their resources for `frame`, with the memory and constants of index `place`.
    fn geometry_of<'f>(
        &'f mut self,
        frame: &'f Frame<'f>,
        place: usize,
    ) -> (&'f mut GeometryPasses, Job<'f>) {
        let job = Job {
            frame,
            constants: &self.constants[place],
            engine: &mut self.engine,
            buffers: &mut self.buffers[place],
        };
        (&mut self.geometry, job)
    }

    /// Writes the registers of the first geometry pass from `self.constants[place]`. The passes will write to `self.buffers[place]`.
    fn prepare_geometry(&mut self, frame: &Frame, place: usize) -> Result<(), Fallback> {
        let (geometry, mut job) = self.geometry_of(frame, place);
        geometry.prepare(&mut job)
    }

    /// Starts a geometry pass of lines that has been prepared.
    fn start_pass(&mut self, pass: Prepared) {
        // SAFETY: the buffers belong to this renderer, are not used by an earlier pass, and are read after the end of this pass.
        unsafe { self.engine.start_geometry(pass) };
    }

    /// Starts the prepared geometry pass, if any. Returns whether a pass runs.
    fn start_geometry(
        &mut self,
        frame: &Frame,
        place: usize,
        cpu: &mut Cpu,
    ) -> Result<bool, Fallback> {
        let (geometry, mut job) = self.geometry_of(frame, place);
        geometry.start(&mut job, cpu)
    }

    /// Continues after the end of a geometry pass. Returns whether another pass runs.
    fn continue_geometry(&mut self, frame: &Frame, place: usize) -> Result<bool, Fallback> {
        let (geometry, mut job) = self.geometry_of(frame, place);
        geometry.advance(&mut job)
    }

    /// Computes the constants of a frame into `self.constants[place]`, and removes the textures of the previous frame. Returns an error if
    /// the engine cannot draw the frame.
    fn update_constants(&mut self, frame: &Frame, place: usize) -> Result<(), Fallback> {
        if has_lines(frame) && !self.draws_lines {
            return Err(Fallback::NoLineEngine);
        }
        if frame.drawn_samples() == Samples::Four && !self.averages {
            return Err(Fallback::NoAntialiasing);
        }
        for mesh in frame.subject.meshes() {
            if !self.draws_triangles {
                return Err(EngineError::from(Error::Triangles).into());
            }
            if mesh.has_textures() && mesh.shading == Shading::Smooth {
                return Err(Fallback::SmoothTextures);
            }
            if mesh.shading == Shading::Smooth && !self.layout.is_smooth {
                return Err(Fallback::NoSmoothShading);
            }
            if mesh.has_textures() && !self.layout.is_textured {
                return Err(Fallback::NoTextures);
            }
            if mesh.shading == Shading::Smooth
                && frame.view.projection() == Projection::Orthographic
            {
                return Err(Fallback::Orthographic);
            }
        }
        let has_rectangles = !frame.drawn_rectangles().is_empty();
        if has_rectangles && !self.layout.is_textured {
            return Err(Fallback::NoTextures);
        }
        if TEXTURE.is_built {
            self.buffers[place].textures.clear();
        }
        self.constants[place].update(frame)?;
        if self.constants[place].sky().is_some() && !self.draws_sky {
            return Err(Fallback::NoSky);
        }
        match self.constants[place].fog() {
            Some(_) if !self.has_fog => return Err(Fallback::NoFog),
            Some(fog) if !fog.is_in_perspective() => return Err(Fallback::OrthographicFog),
            Some(_) if has_rectangles => return Err(Fallback::RectanglesInFog),
            Some(_) | None => {}
        }
        Ok(())
    }

    /// Writes the raymarcher's registers for the field of `self.constants[place]`, or turns the raymarcher off if there is no field. With
    /// `has_tables`, the raymarcher already holds the correct tables, so the tables are not compared.
    fn set_field(&mut self, place: usize, has_tables: bool) -> Result<(), Fallback> {
        match (&mut self.raymarcher, self.constants[place].field()) {
            (Some(raymarcher), Some(field)) => {
                set_field(raymarcher, &field.setup, &field.palette, has_tables)?;
            }
            (Some(raymarcher), None) => raymarcher.clear_field(),
            (None, Some(_)) => return Err(Fallback::NoRaymarcher),
            (None, None) => {}
        }
        Ok(())
    }

    /// Whether the raymarcher holds the tables of the field of `self.constants[place]`.
    fn has_tables(&self, place: usize) -> bool {
        let both = self.raymarcher.as_ref().zip(self.constants[place].field());
        both.is_some_and(|(raymarcher, field)| raymarcher.has_tables(tables(&field.palette)))
    }

    /// Adds the frame's rectangles to the lists in `self.buffers[place]`, and starts their raster pass.
    // Inlined, so that a build without rectangles has no code for their errors.
    #[inline(always)]
    fn start_raster(
        &mut self,
        frame: &Frame,
        output: &mut Output,
        place: usize,
    ) -> Result<(), Fallback> {
        if !frame.drawn_rectangles().is_empty() {
            self.buffers[place].put_rectangles(frame, self.layout)?;
        }
        self.start_lists(frame, output, place);
        Ok(())
    }

    /// Starts the raster pass of the lists in `self.buffers[place]`.
    fn start_lists(&mut self, frame: &Frame, output: &mut Output, place: usize) {
        let buffers = &self.buffers[place];
        let slot = self.slot(output.colour);
        let drawn = &mut self.drawn[usize::from(slot)];
        let sky = self.constants[place].sky();
        let window = frame.window();
        let samples = frame.drawn_samples();
        let is_flat = sky.is_none() && samples == Samples::One;
        let this = Some((frame.size, frame.clear)).filter(|_| is_flat);
        let pass = Raster {
            size: size_code(window.size),
            average: average(samples, window),
            frame: address(output.colour),
            slot,
            // A pass with a sky, or with averages, always writes every pixel.
            whole: *drawn != this,
            depth: output.depth.as_deref().map(address),
            clear: frame.clear.0,
            sky: sky.map(|constants| sky_of(constants, buffers.textures.blends())),
            fog: self.constants[place].fog().map(fog),
            dither: frame.rounding == Rounding::Dithered,
            list_shift: buffers.list_shift(window.size),
            input: Input {
                sets: buffers.sets,
                textures: buffers.textures.address(),
            },
        };
        *drawn = this;
        // SAFETY: the lists and the table of textures belong to this renderer and are unchanged until the end of the pass; textures, like
        // meshes, are unchanged while the renderer is busy; the caller lends the memory of colours and depth codes until the end of the
        // pass.
        unsafe { self.engine.start_raster(&pass) };
        self.pass_start = cpu::cycles_low();
    }

    /// Cancels the frame, and returns an error, if the triangle engine has made no progress for too long.
    fn check_progress(&mut self, output: &Output) -> Result<(), Fallback> {
        self.checked = cpu::cycles_low();
        if self.watchdog.is_stuck(&self.engine.counters()) {
            return Err(self.cancel(output, EngineError::Timeout.into()));
        }
        Ok(())
    }

    /// Cancels the running passes, and returns `error` as the reason to draw the frame by the CPU.
    fn cancel(&mut self, output: &Output, error: Fallback) -> Fallback {
        self.engine.cancel();
        self.stage = Stage::Idle;
        self.quarters = Quarters::default();
        self.invalidate(output.colour);
        error
    }

    fn slot(&self, colour: &[u16]) -> bool {
        address(colour) != self.first_frame_buffer
    }
}

/// Whether the line engine draws the frame or a part of it.
const fn has_lines(frame: &Frame) -> bool {
    (WIREFRAME.is_built || EDGES.is_built)
        && matches!(frame.subject, Subject::Wireframe(_) | Subject::Edges(..))
}
