//! The raymarcher: draws distance fields into the frames of the triangle engine (docs/raymarch.md), with all features.

mod cones;
mod rows;
mod setup;
mod spheres;

use glint_core::picture::Size;
use glint_model::FrameBuffer;
use glint_model::raymarch::Tracer;
use litex_pac::raymarch::{
    Caps, Control, Counters, Error, EvPending, Kind, Raymarch, Solid, Status, Table, offset,
};
use litex_pac::register::Value;

use crate::engines::parameters::Parameters;
use crate::engines::pass::{Growth, Pass, add};
use crate::{Device, Events, MainMemory};

use cones::ConeWords;
use setup::{Tables, field_setup, palette};
use spheres::Spheres;

/// Number of field evaluations per clock cycle for rays by exits; marching rays do one evaluation
/// per cycle.
const LANES: u64 = 2;

const COUNTERS: usize = ((offset::UNDECIDED - offset::CYCLES_BUSY) / 4 + 1) as usize;

/// Largest depth of a sponge.
const LEVELS: u8 = 6;

/// Number of cycles to draw a field, in addition to the cycles of its rays.
const LATENCY: u64 = 300;

/// Statistics of a drawn field.
pub struct Field {
    /// Number of cycles of the drawing.
    pub cycles: u64,
    /// Number of pixels of all eyes.
    pub pixels: u32,
}

/// The raymarcher, which the triangle engine starts.
pub struct Raymarcher {
    parameters: Parameters,
    control: Control,
    spheres: Spheres,
    cones: ConeWords,
    tables: Box<Tables>,
    events: Events,
    running: Option<Pass<COUNTERS>>,
    counters: Growth<COUNTERS>,
}

impl Raymarcher {
    /// The raymarcher after a reset.
    pub(crate) fn new() -> Self {
        Self {
            parameters: Parameters::new(),
            control: Control::default(),
            spheres: Spheres::new(),
            cones: ConeWords::default(),
            tables: Box::new([[0; 256]; 2]),
            events: Events::default(),
            running: None,
            counters: [0; COUNTERS],
        }
    }

    /// Whether the next frame contains the field.
    pub(crate) fn draws(&self) -> bool {
        self.control.enable() && self.error() == Error::None
    }

    /// Draws the field into a picture, before the triangles of the frame, starting at the cycle `now`.
    pub(crate) fn draw(&mut self, size: Size, target: &mut FrameBuffer, now: u64) -> Field {
        let setup = field_setup(&self.parameters, self.control, &self.spheres, size);
        let solid = Solid::from_bits(self.parameters.word(offset::SOLID));
        let cones = self.cones.of(solid);
        let is_stereo = setup.stereo.is_some();
        let palette = palette(&self.parameters, &self.spheres, &self.tables, is_stereo);
        let stats = rows::render(&Tracer::new(&setup, cones), &palette, target);
        let eyes = 1 + u32::from(is_stereo);
        let lanes = if setup.exits().is_some() { LANES } else { 1 };
        let work = (stats.evaluations / lanes).max(stats.rays.into());
        let cycles = work + LATENCY;
        let counters = Counters {
            cycles_busy: cycles as u32,
            items_in: stats.rays,
            items_out: stats.rays,
            evaluations: stats.evaluations as u32,
            hits: stats.hits,
            misses: stats.misses,
            undecided: stats.undecided,
            ..Counters::default()
        };
        let mut values = counters.iter();
        self.running = Some(Pass {
            start: now,
            end: now + cycles,
            growth: std::array::from_fn(|_| values.next().map_or(0, |(_, value)| value)),
        });
        let pixels = eyes * size.pixel_count() as u32;
        Field { cycles, pixels }
    }

    /// Cancels the field of a cancelled frame.
    pub(crate) fn cancel(&mut self, now: u64) {
        if let Some(pass) = self.running.take() {
            add(&mut self.counters, &pass.grown(now));
            self.events.raise(field_event());
        }
    }

    /// Ends the field if the cycle `now` has reached its end. Returns the cycle in which the running field will end, or `u64::MAX` if no
    /// field is running.
    pub(crate) fn settle(&mut self, now: u64) -> u64 {
        match self.running {
            Some(pass) if pass.end <= now => {
                self.running = None;
                add(&mut self.counters, &pass.growth);
                self.events.raise(field_event());
                u64::MAX
            }
            Some(pass) => pass.end,
            None => u64::MAX,
        }
    }

    /// Returns an error if the parameters contain an undefined kind of solid.
    fn error(&self) -> Error {
        let solid = Solid::from_bits(self.parameters.word(offset::SOLID));
        match solid.kind() {
            Some(_) => Error::None,
            None => Error::Field,
        }
    }

    fn counter(&self, number: usize, now: u64) -> u32 {
        let mut counters = self.counters;
        if let Some(pass) = &self.running {
            add(&mut counters, &pass.grown(now));
        }
        counters.get(number).copied().unwrap_or(0)
    }
}

/// Bit of the event at the end of a field.
fn field_event() -> u32 {
    EvPending::default().with_field(true).bits()
}

impl Device for Raymarcher {
    fn read(&mut self, offset: u32, now: u64) -> u32 {
        self.settle(now);
        match offset {
            offset::IDENT => Raymarch::IDENT,
            offset::CAPS => Caps::default()
                .with_lanes(LANES as u8)
                .with_levels(LEVELS)
                .with_stereo(true)
                .with_round(true)
                .with_lattice(true)
                .with_blend(true)
                .with_normals(true)
                .with_highlight(true)
                .with_cone(true)
                .with_shadow(true)
                .with_flat((1 << Kind::ALL.len()) - 1)
                .bits(),
            offset::CONTROL => self.control.bits(),
            offset::STATUS => Status::default()
                .with_busy(self.running.is_some())
                .with_error(self.error())
                .bits(),
            offset::EV_STATUS => self.events.status(),
            offset::EV_PENDING => self.events.pending(),
            offset::EV_ENABLE => self.events.enabled(),
            offset::CYCLES_BUSY..=offset::UNDECIDED => {
                self.counter(((offset - offset::CYCLES_BUSY) / 4) as usize, now)
            }
            _ => 0,
        }
    }

    fn write(&mut self, offset: u32, value: u32, now: u64, _: &mut MainMemory) {
        self.settle(now);
        match offset {
            offset::CONTROL => self.control = Control::from_bits(value),
            offset::EV_PENDING => self.events.clear(value),
            offset::EV_ENABLE => self.events.enable(value & field_event()),
            offset::TABLE => {
                let table = Table::from_bits(value);
                let entries = self.tables.as_flattened_mut();
                if let Some(entry) = entries.get_mut(usize::from(table.entry())) {
                    *entry = table.part();
                }
            }
            offset::SPHERE => self.spheres.set(value),
            offset::CONE_ADDRESS => self.cones.address(value),
            offset::CONE_VALUE => self.cones.set(value),
            _ => self.parameters.set(offset, value),
        }
    }

    fn advance(&mut self, now: u64, _: &mut MainMemory) -> u64 {
        self.settle(now)
    }

    fn interrupt(&self) -> bool {
        self.events.interrupt()
    }
}
