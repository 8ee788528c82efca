//! The verilated rasterizer for smooth triangles, for measurements of the clocks of a picture.

use glint_core::colour::Rgb565;
use glint_model::Shading;
use glint_model::triangle::descriptor::{Descriptor, GROUP, band_rows};
use glint_model::triangle::setup::Setup;
use glint_testbench::{Bits, Module, Port, Sink, Source, Stalls, exchange};

/// The rasterizer's SystemVerilog module with smooth shading, without stalls: triangles and groups are transferred immediately.
pub struct Rasterizer {
    module: Module,
    triangles: Source,
    groups: Sink,
    band: [Port; 3],
    idle: Port,
}

/// A drawn band (strip of lines) of a picture.
pub struct Band {
    /// Number of clocks from the first triangle until the rasterizer is idle.
    pub clocks: u64,
    /// The covered pixels of each group; bit 0 is the leftmost pixel.
    pub masks: Vec<u8>,
}

impl Rasterizer {
    /// Makes a rasterizer and resets it.
    ///
    /// # Panics
    /// When the module has not been built.
    #[must_use]
    pub fn new() -> Self {
        let module = Module::new("triangle_raster_smooth", 1);
        let never = || Stalls::new(1, 0.0);
        let payload = ["row", "mask", "codes", "colours", "line", "column"];
        Self {
            triangles: Source::new(&module, "triangle", &["descriptor", "planes"], never()),
            groups: Sink::new(&module, "group", &payload, never()),
            band: ["triangle_y0", "rows", "stride"].map(|name| module.port(name)),
            idle: module.port("idle"),
            module,
        }
    }

    /// Draws a picture of this width and height band by band. A triangle whose setup has light is smooth, any other is flat.
    pub fn draw(&mut self, setups: &[Setup], (width, height): (u32, u32)) -> Vec<Band> {
        let rows = band_rows(width);
        let bands = (0..height).step_by(rows as usize);
        bands
            .map(|y0| {
                let touched = setups.iter().filter(|setup| {
                    setup.bounds.top < (y0 + rows) as i32 && setup.bounds.bottom > y0 as i32
                });
                self.draw_band([y0, rows, width / GROUP as u32], touched)
            })
            .collect()
    }

    fn draw_band<'a>(
        &mut self,
        settings: [u32; 3],
        setups: impl Iterator<Item = &'a Setup>,
    ) -> Band {
        for (port, value) in self.band.into_iter().zip(settings) {
            self.module.set(port, u64::from(value));
        }
        for setup in setups {
            let descriptor = Descriptor::new(setup, Rgb565::WHITE);
            let (first, planes) = descriptor.words(Shading::Smooth).split_at(12);
            let item = [first, planes].map(Bits::from_words).to_vec();
            self.triangles.push(item);
        }
        let start = self.module.cycles();
        while !(self.triangles.is_empty() && self.module.is_high(self.idle)) {
            exchange(
                &mut self.module,
                &mut [&mut self.triangles],
                &mut [&mut self.groups],
            );
            self.module.clock();
        }
        let groups = self.groups.take().into_iter();
        Band {
            clocks: self.module.cycles() - start,
            masks: groups.map(|group| group[1].number() as u8).collect(),
        }
    }
}

impl Default for Rasterizer {
    fn default() -> Self {
        Self::new()
    }
}
