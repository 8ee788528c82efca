//! Drives a whole raymarcher, and checks its pixels: each pixel must equal the model's pixel, and
//! must come exactly once, while `band_open` is high for its band.

use std::collections::HashMap;

use glint_core::colour::Rounding;
use glint_model::raymarch::{FieldSetup, FieldStats, Palette};
use glint_model::triangle::descriptor::band_rows;
use glint_vectors::Random;

use crate::raymarch::{Pixel, RayPlace, pixel, set_lights, set_paint, set_raymarcher};
use crate::{Bits, Counters, Module, Sink, Stalls};

const COUNTERS: [&str; 8] = [
    "cycles_busy",
    "cycles_idle",
    "items_out",
    "evaluations",
    "items_in",
    "hits",
    "misses",
    "undecided",
];

/// A module with a whole raymarcher.
pub struct Raymarcher {
    module: Module,
    counters: Counters,
    counted: [u64; 8],
    /// How the colours of the last frame are rounded; it alternates from frame to frame.
    rounding: Rounding,
}

/// Clocks and counters of a frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameCost {
    /// Clocks from the start of the frame to its end.
    pub clocks: u64,
    /// Number of clocks in which a lane could accept a ray but none came, summed over the lanes.
    pub idle: u64,
    /// Statistics of the model, which the module's counters have matched.
    pub stats: FieldStats,
}

impl Raymarcher {
    /// Number of lanes (parallel pipelines that evaluate the field) of the module `raymarcher`, which has all kinds of fields.
    pub const LANES: u64 = 2;

    /// Loads a module by its name, and resets it.
    ///
    /// # Panics
    /// When the module has not been built.
    #[must_use]
    pub fn new(name: &str, seed: u32) -> Self {
        let module = Module::new(name, seed);
        Self {
            counters: Counters::new(&module, "events"),
            module,
            counted: [0; 8],
            rounding: Rounding::Nearest,
        }
    }

    fn clock(&mut self) {
        self.module.settle();
        self.counters.sample(&self.module);
        self.module.clock();
    }

    fn clocks(&mut self, clocks: u32) {
        (0..clocks).for_each(|_| self.clock());
    }

    fn counted(&self) -> [u64; 8] {
        COUNTERS.map(|name| self.counters.get(name))
    }

    fn pulse(&mut self, name: &str) {
        self.module.drive(name, 1);
        self.clock();
        self.module.drive(name, 0);
    }

    fn set(&mut self, setup: &FieldSetup, palette: &Palette) {
        set_raymarcher(&mut self.module, setup);
        set_paint(&mut self.module, setup, palette);
        set_lights(&mut self.module, setup, &palette.lights);
        self.module.drive("size", setup.width / 640);
    }

    /// Draws a frame and compares its pixels with the model's. With `random`, the output stream
    /// stalls at random, and `band_open` rises after a random delay in each band.
    ///
    /// # Panics
    /// When a pixel or a counter differs from the model's.
    pub fn draw(
        &mut self,
        mut random: Option<&mut Random>,
        setup: &FieldSetup,
        palette: &Palette,
    ) -> FrameCost {
        self.set(setup, palette);
        self.rounding = match self.rounding {
            Rounding::Dithered => Rounding::Nearest,
            Rounding::Nearest => Rounding::Dithered,
        };
        let is_dithered = self.rounding == Rounding::Dithered;
        self.module.drive("dither", is_dithered);
        let lines = band_rows(setup.width);
        let eyes: u32 = if setup.stereo.is_some() { 2 } else { 1 };
        let stalls = match &mut random {
            Some(random) => Stalls::new(random.bits(), 0.3),
            None => Stalls::new(1, 0.0),
        };
        let mut sink = Sink::new(&self.module, "group", &Pixel::PAYLOAD, stalls);
        let done = self.module.port("band_done");
        let mut stats = FieldStats::default();
        let tracer = setup.tracer();
        self.pulse("start");
        for band in 0..setup.height / lines {
            let mut expected = HashMap::new();
            for y in 0..lines {
                for (x, eye) in (0..setup.width).flat_map(|x| (0..eyes).map(move |eye| (x, eye))) {
                    let place = RayPlace {
                        odd: band % 2 == 1,
                        line: y,
                        column: x,
                        eye: eye as usize,
                    };
                    let row = band * lines + y;
                    let end = tracer.trace(place.eye, x, row);
                    stats.count(&end);
                    expected.insert(
                        (eye.into(), y.into(), x.into()),
                        pixel(setup, palette, self.rounding, place, row, &end),
                    );
                }
            }
            if let Some(random) = &mut random {
                // On the board, the triangles of a band are drawn first; the delay simulates their drawing time.
                self.clocks(random.integer(0, 3000) as u32);
            }
            self.module.drive("band_open", 1);
            let begun = self.module.cycles();
            loop {
                assert!(
                    self.module.cycles() - begun < 40_000_000,
                    "the raymarcher stalls in {setup:?}"
                );
                sink.drive(&mut self.module);
                self.module.settle();
                sink.sample(&self.module);
                if self.module.is_high(done) {
                    break;
                }
                self.clock();
            }
            for item in sink.take() {
                let found = Pixel::from(std::array::from_fn(|i| item[i].number()));
                let column = 8 * found.column + u64::from(found.mask.trailing_zeros());
                let place = (found.eye, found.line, column);
                let wanted = expected.remove(&place).unwrap_or_else(|| {
                    panic!("{found:?} was output twice, or belongs to another band")
                });
                assert_eq!(found, wanted, "in band {band} of {setup:?}");
            }
            assert!(expected.is_empty(), "band {band} ended early");
            self.module.drive("band_open", 0);
            self.pulse("band_next");
        }
        let busy = self.module.port("busy");
        assert!(!self.module.is_high(busy), "busy after the last band");
        // Counters count up to four clocks after the last pixel, and then stop.
        self.clocks(4);
        let events = self.module.port("events");
        assert_eq!(
            self.module.get(events),
            Bits::default(),
            "events after the end of the frame"
        );
        let counted = self.counted();
        let [clocks, idle, counters @ ..]: [u64; 8] =
            std::array::from_fn(|i| counted[i] - self.counted[i]);
        self.counted = counted;
        assert_eq!(
            counters,
            [
                stats.rays.into(),
                stats.evaluations,
                stats.rays.into(),
                stats.hits.into(),
                stats.misses.into(),
                stats.undecided.into()
            ],
            "{:?} of {setup:?}",
            &COUNTERS[2..]
        );
        FrameCost {
            clocks,
            idle,
            stats,
        }
    }
    /// Draws a frame for a number of clocks, and cancels it.
    pub fn cancel(&mut self, setup: &FieldSetup, clocks: u32) {
        self.set(setup, &Palette::default());
        self.module.drive("band_open", 1);
        self.module.drive("group_ready", 1);
        self.pulse("start");
        self.clocks(clocks);
        self.module.drive("band_open", 0);
        self.pulse("restart");
        self.clocks(4);
        self.counted = self.counted();
    }

    /// Number of clocks so far in which the output of pixels was stalled.
    #[must_use]
    pub fn stalled(&self) -> u64 {
        self.counters.get("cycles_stalled")
    }
}
