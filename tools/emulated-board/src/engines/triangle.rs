//! The triangle engine: geometry and raster passes of frames (docs/triangle.md), with smooth shading and lines.
//!
//! A pass computes its results at its start, with the functions of `glint_model`, and ends after the estimated time of the gateware. The
//! results in memory, the counts of triangles, groups, pixels and words, and the errors equal those of the gateware; cycle counters are
//! estimates, and counters of waiting cycles stay 0. Counters increase evenly during a pass.

mod geometry;
mod output;
mod raster;
mod region;
mod setup;
mod time;
mod walk;

use litex_pac::register::Value;
use litex_pac::triangle::{
    Caps, Control, Counters, Error, EvPending, Geometry, Raster, Status, Triangle, offset,
};

use glint_core::colour::Shading;
use glint_model::triangle::descriptor::Layout;

use crate::engines::parameters::Parameters;
use crate::engines::pass::{Growth, Pass, add};
use crate::engines::raymarch::Raymarcher;
use crate::{Device, Events, MainMemory};

use geometry::GeometryUnit;
use raster::RasterUnit;
use region::COUNT_BITS;
use time::Work;

const COUNTERS: usize = ((offset::CYCLES_FLUSH - offset::CYCLES_BUSY) / 4 + 1) as usize;

/// State of one kind of pass, geometry or raster.
struct Side {
    running: Option<Pass<COUNTERS>>,
    /// The error with which the running pass ends.
    ends_with: Error,
    /// The error in the register `status`.
    error: Error,
    /// Bit of the event at the end of the pass.
    event: u32,
}

impl Side {
    fn new(event: EvPending) -> Self {
        Self {
            running: None,
            ends_with: Error::None,
            error: Error::None,
            event: event.bits(),
        }
    }

    /// Begins a pass at `now`; a refused pass ends after a few cycles.
    fn begin(
        &mut self,
        now: u64,
        work: Result<Work, Error>,
        all_cycles: impl Fn(&mut Counters, u32),
    ) {
        let work = work.unwrap_or_else(|error| Work {
            error,
            cycles: time::REFUSAL,
            counters: Counters::default(),
        });
        let mut counters = work.counters;
        all_cycles(&mut counters, work.cycles as u32);
        self.ends_with = work.error;
        self.error = Error::None;
        self.running = Some(Pass {
            start: now,
            end: now + work.cycles,
            growth: growth(&counters),
        });
    }
}

/// The counters in the order of their registers.
fn growth(counters: &Counters) -> Growth<COUNTERS> {
    let mut values = counters.iter();
    std::array::from_fn(|_| values.next().map_or(0, |(_, value)| value))
}

/// The triangle engine.
pub struct TriangleEngine {
    /// The optional parts of descriptors of this build.
    layout: Layout,
    parameters: Parameters,
    events: Events,
    geometry: Side,
    raster: Side,
    /// The slot (frame buffer) of the raster pass.
    slot: bool,
    geometry_unit: GeometryUnit,
    raster_unit: RasterUnit,
    /// The raymarcher, which draws into the frames of the triangle engine. It has its own register window and interrupt line.
    pub raymarcher: Raymarcher,
    counters: Growth<COUNTERS>,
    /// The cycle up to which `cycles_busy` has been counted.
    counted: u64,
    /// The cycle from which the engine is ready after a cancelled pass.
    ready: u64,
}

impl Default for TriangleEngine {
    fn default() -> Self {
        Self::new()
    }
}

impl TriangleEngine {
    /// The engine with smooth shading and textures, after a reset.
    #[must_use]
    pub fn new() -> Self {
        Self {
            layout: Layout::WHOLE,
            parameters: Parameters::new(),
            events: Events::default(),
            geometry: Side::new(EvPending::default().with_geometry(true)),
            raster: Side::new(EvPending::default().with_raster(true)),
            slot: false,
            geometry_unit: GeometryUnit::new(),
            raster_unit: RasterUnit::new(),
            raymarcher: Raymarcher::new(),
            counters: [0; COUNTERS],
            counted: 0,
            ready: 0,
        }
    }

    /// Sets the best shading of the engine, which must be idle.
    pub const fn set_shading(&mut self, best: Shading) {
        self.layout.is_smooth = matches!(best, Shading::Smooth);
    }

    /// Sets whether the engine, which must be idle, draws textures.
    pub const fn set_textures(&mut self, is_textured: bool) {
        self.layout.is_textured = is_textured;
    }

    /// Resets the engine.
    pub fn reset(&mut self) {
        *self = Self {
            layout: self.layout,
            ..Self::new()
        };
    }

    fn status(&self) -> Status {
        Status::default()
            .with_geometry_busy(self.geometry.running.is_some())
            .with_raster_busy(self.raster.running.is_some())
            .with_geometry_error(self.geometry.error)
            .with_raster_error(self.raster.error)
    }

    fn start_geometry(&mut self, flags: Geometry, now: u64, ram: &mut MainMemory) {
        if self.geometry.running.is_some() {
            self.geometry.error = Error::Busy;
            return;
        }
        let work = self
            .geometry_unit
            .run(flags, &self.parameters, self.layout, ram);
        let start = now.max(self.ready);
        self.geometry.begin(start, work, |counters, cycles| {
            counters.cycles_geometry = cycles;
        });
    }

    fn start_raster(&mut self, flags: Raster, now: u64, ram: &mut MainMemory) {
        if self.raster.running.is_some() {
            self.raster.error = Error::Busy;
            return;
        }
        self.slot = flags.slot();
        let start = now.max(self.ready);
        let (parameters, raymarcher) = (&self.parameters, &mut self.raymarcher);
        let work = self
            .raster_unit
            .run(flags, parameters, self.layout, raymarcher, start, ram);
        self.raster.begin(start, work, |counters, cycles| {
            counters.cycles_raster = cycles;
        });
    }

    fn cancel(&mut self, now: u64) {
        self.geometry_unit.cancel();
        self.raymarcher.cancel(now);
        if self.raster.running.is_some() {
            self.raster_unit.cancel(self.slot);
        }
        for side in [&mut self.geometry, &mut self.raster] {
            if let Some(pass) = side.running.take() {
                add(&mut self.counters, &pass.grown(now));
                side.error = Error::Cancelled;
                self.events.raise(side.event);
            }
        }
        self.ready = now + time::RECOVERY;
    }

    /// Counts the busy cycles up to `now`.
    fn count_busy(&mut self, now: u64) {
        let passes = [self.geometry.running, self.raster.running];
        let passes = passes.iter().flatten();
        let first = passes.clone().map(|pass| pass.start).min();
        let last = passes.map(|pass| pass.end).max();
        if let (Some(first), Some(last)) = (first, last) {
            let busy = last.min(now).saturating_sub(first.max(self.counted));
            self.counters[0] = self.counters[0].wrapping_add(busy as u32);
        }
        self.counted = self.counted.max(now);
    }

    /// Ends the passes that are due, and returns the cycle in which the next pass ends.
    fn settle(&mut self, now: u64) -> u64 {
        self.count_busy(now);
        let mut next = u64::MAX;
        for side in [&mut self.geometry, &mut self.raster] {
            let Some(pass) = side.running else {
                continue;
            };
            if pass.end > now {
                next = next.min(pass.end);
                continue;
            }
            side.running = None;
            add(&mut self.counters, &pass.growth);
            // A request that was refused during the pass has set `error`. An error of the pass itself replaces this error.
            if side.ends_with != Error::None {
                side.error = side.ends_with;
            }
            self.events.raise(side.event);
        }
        next
    }

    /// The counter with the index `number` at the cycle `now`.
    fn counter(&self, number: usize, now: u64) -> u32 {
        let mut counters = self.counters;
        for pass in [&self.geometry.running, &self.raster.running]
            .into_iter()
            .flatten()
        {
            add(&mut counters, &pass.grown(now));
        }
        counters.get(number).copied().unwrap_or(0)
    }
}

impl Device for TriangleEngine {
    fn read(&mut self, offset: u32, now: u64) -> u32 {
        self.settle(now);
        let results = &self.geometry_unit.results;
        match offset {
            offset::IDENT => Triangle::IDENT,
            offset::CAPS => Caps::default()
                .with_sizes(0b111)
                .with_triangles(true)
                .with_lines(true)
                .with_gouraud(self.layout.is_smooth)
                .with_textures(self.layout.is_textured)
                .with_sky(true)
                .with_fog(true)
                .with_average(true)
                .with_depths(true)
                .with_geometry(true)
                .with_count_bits(COUNT_BITS as u8)
                .bits(),
            offset::STATUS => self.status().bits(),
            offset::EV_STATUS => self.events.status(),
            offset::EV_PENDING => self.events.pending(),
            offset::EV_ENABLE => self.events.enabled(),
            offset::TRIANGLES => results.triangles,
            offset::UNSEEN => results.unseen,
            offset::CULLED => results.culled,
            offset::DESCRIPTOR_COUNT => results.descriptor_count,
            offset::EXCEPTION_COUNT => results.exception_count,
            offset::CYCLES_BUSY..=offset::CYCLES_FLUSH => {
                self.counter(((offset - offset::CYCLES_BUSY) / 4) as usize, now)
            }
            _ => 0,
        }
    }

    fn write(&mut self, offset: u32, value: u32, now: u64, ram: &mut MainMemory) {
        self.settle(now);
        match offset {
            offset::CONTROL if Control::from_bits(value).cancel() => self.cancel(now),
            offset::EV_PENDING => self.events.clear(value),
            offset::EV_ENABLE => self.events.enable(value & EVENTS),
            offset::GEOMETRY => {
                let flags = Geometry::from_bits(value);
                if flags.start() {
                    self.start_geometry(flags, now, ram);
                }
            }
            offset::RASTER => {
                let flags = Raster::from_bits(value);
                if flags.start() {
                    self.start_raster(flags, now, ram);
                }
            }
            _ => self.parameters.set(offset, value),
        }
    }

    fn advance(&mut self, now: u64, _: &mut MainMemory) -> u64 {
        self.settle(now).min(self.raymarcher.settle(now))
    }

    fn interrupt(&self) -> bool {
        self.events.interrupt()
    }
}

/// Bits of all events.
const EVENTS: u32 = 0b11;
