//! The verilated raymarcher, for measurements of the clocks and distance evaluations of a picture.

use glint_model::raymarch::{FieldSetup, Palette, Rays};
use glint_model::triangle::descriptor::band_rows;
use glint_testbench::raymarch::{
    Pixel, RayPlace, pixel, set_blocks, set_lane, set_paint, set_rays,
};
use glint_testbench::{Counters, Module, Port};

/// The raymarcher's SystemVerilog module, built with all kinds of fields. The environment never stalls it: every band (strip of
/// lines) may be drawn immediately, and every pixel is accepted immediately.
pub struct Raymarcher {
    module: Module,
    group: [Port; Pixel::PAYLOAD.len()],
    counters: Counters,
    /// Values of the counters at the end of the previous picture.
    counted: Taken,
}

/// Clocks and distance evaluations of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Taken {
    /// Number of clocks from the start of the picture to its end.
    pub clocks: u64,
    /// Number of evaluations of the field's distance.
    pub evaluations: u64,
}

impl Raymarcher {
    /// Number of lanes (parallel pipelines for evaluations of the field) of the built raymarcher.
    pub const LANES: u32 = 2;

    /// Makes a raymarcher and resets it.
    ///
    /// # Panics
    /// When the module has not been built.
    #[must_use]
    pub fn new() -> Self {
        let mut module = Module::new("raymarcher", 1);
        let group = Pixel::PAYLOAD.map(|name| module.port(&format!("group_{name}")));
        module.drive("group_ready", 1);
        Self {
            counters: Counters::new(&module, "events"),
            module,
            group,
            counted: Taken::default(),
        }
    }

    /// Draws a picture, compares each pixel with the model, and returns the clocks and evaluations of the picture.
    ///
    /// # Panics
    /// When a pixel differs from the model's.
    pub fn draw(&mut self, setup: &FieldSetup) -> Taken {
        let palette = Palette::default();
        set_lane(&mut self.module, setup);
        set_rays(&mut self.module, setup);
        set_paint(&mut self.module, setup, &palette);
        set_blocks(&mut self.module, setup, "cone_offset", "cone_spread");
        self.module.drive("prepass", setup.cones.is_some());
        self.module.drive("size", setup.width / 640);
        let [valid, done] = ["group_valid", "band_done"].map(|name| self.module.port(name));
        let lines = band_rows(setup.width);
        let eyes = if setup.stereo.is_some() { 2 } else { 1 };
        let mut rays = Rays::new(setup);
        let rays: Vec<_> = (0..setup.height * eyes * setup.width)
            .map(|i| {
                let (line, x) = (i / setup.width, i % setup.width);
                rays.ray((line % eyes) as usize, x, line / eyes)
            })
            .collect();
        self.pulse("start");
        for band in 0..setup.height / lines {
            let mut left = lines * setup.width * eyes;
            self.module.drive("band_open", 1);
            while !self.module.is_high(done) {
                if self.module.is_high(valid) {
                    let found = self.pixel();
                    let place = RayPlace {
                        odd: band % 2 == 1,
                        line: found.line as u32,
                        column: (8 * found.column) as u32 + found.mask.trailing_zeros(),
                        eye: found.eye as usize,
                    };
                    let line = (band * lines + place.line) * eyes + place.eye as u32;
                    let ray = &rays[(line * setup.width + place.column) as usize];
                    let wanted = pixel(setup, &palette, place, ray, &setup.march(ray));
                    assert_eq!(found, wanted, "in band {band} of {setup:?}");
                    left -= 1;
                }
                self.clock();
            }
            assert_eq!(left, 0, "missing pixels in band {band} of {setup:?}");
            self.module.drive("band_open", 0);
            self.pulse("band_next");
        }
        // The counters count the last events a few clocks after the end of the picture.
        (0..4).for_each(|_| self.clock());
        let counted = Taken {
            clocks: self.counters.get("cycles_busy"),
            evaluations: self.counters.get("evaluations"),
        };
        let before = std::mem::replace(&mut self.counted, counted);
        Taken {
            clocks: counted.clocks - before.clocks,
            evaluations: counted.evaluations - before.evaluations,
        }
    }

    fn pixel(&self) -> Pixel {
        Pixel::from(self.group.map(|port| self.module.value(port)))
    }

    fn pulse(&mut self, name: &str) {
        self.module.drive(name, 1);
        self.clock();
        self.module.drive(name, 0);
    }

    fn clock(&mut self) {
        self.module.settle();
        self.counters.sample(&self.module);
        self.module.clock();
    }
}

impl Default for Raymarcher {
    fn default() -> Self {
        Self::new()
    }
}
