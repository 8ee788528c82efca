//! Drives the rasterizer, band after band.

use glint_core::colour::Rgb565;
use glint_model::Shading;
use glint_model::triangle::descriptor::{Descriptor, Layout};
use glint_model::triangle::setup::Setup;

use crate::{Bits, Pipe, Port};

/// A module with a rasterizer.
pub struct Rasterizer {
    pipe: Pipe,
    band: [Port; 3],
    idle: Port,
}

impl Rasterizer {
    /// Names of the payload's ports in the output stream of groups.
    pub const GROUP: [&str; 6] = ["row", "mask", "codes", "colours", "line", "column"];

    /// Loads the variant of the module for flat triangles, or the variant for flat and smooth
    /// triangles.
    ///
    /// # Panics
    /// When the module has not been built.
    #[must_use]
    pub fn new(shading: Shading, seed: u32, stalls: [f64; 2]) -> Self {
        let name = match shading {
            Shading::Flat => "triangle_raster",
            Shading::Smooth => "triangle_raster_smooth",
        };
        let input = ("triangle", &["descriptor", "planes"][..]);
        let pipe = Pipe::new(name, seed, input, ("group", &Self::GROUP), stalls);
        let port = |name| pipe.module.port(name);
        Self {
            band: ["triangle_y0", "rows", "stride"].map(port),
            idle: port("idle"),
            pipe,
        }
    }

    /// A port of the module.
    #[must_use]
    pub fn port(&self, name: &str) -> Port {
        self.pipe.module.port(name)
    }

    /// Draws triangles, each with its colour, in a band. `settings` are the first line of the band,
    /// its number of lines, and the number of groups per line. Calls `each` in every clock. Returns
    /// the number of clocks and the groups.
    ///
    /// # Panics
    /// When the rasterizer does not become idle.
    pub fn band<'a>(
        &mut self,
        settings: [u32; 3],
        triangles: impl IntoIterator<Item = (&'a Setup, Rgb565)>,
        each: impl FnMut(&Pipe),
    ) -> (u64, Vec<Vec<Bits>>) {
        let pipe = &mut self.pipe;
        assert!(pipe.module.is_high(self.idle));
        for (port, value) in self.band.into_iter().zip(settings) {
            pipe.module.set(port, u64::from(value));
        }
        for (setup, colour) in triangles {
            let descriptor = Descriptor::new(setup, colour, None);
            let [first, _, planes] = descriptor.words(Layout::SMOOTH);
            let item = [first, planes].map(Bits::from_words);
            pipe.source.push(item.to_vec());
        }
        let clocks = pipe.drain(2_000_000, self.idle, each);
        (clocks, pipe.sink.take())
    }
}
