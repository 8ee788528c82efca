//! Test bench of the rasterizer: draws band after band, and composes the picture from the output groups.

use glint_core::colour::Rounding;
use glint_model::triangle::descriptor::band_rows;
use glint_model::triangle::raster::draw;
use glint_model::{FrameBuffer, Shading};
use glint_testbench::{Bits, Port, Rasterizer};

use crate::raster::triangles::{LANES, Triangle};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pixel {
    pub colour: u16,
    pub depth: u32,
}

/// Numbers of clocks, groups, pixels and triangles of a drawing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    pub clocks: u64,
    /// Number of clocks in which the rasterizer visited a group (`cycles_walking`).
    pub walked: u64,
    /// Number of clocks of `walked` that output no group (`cycles_empty`).
    pub empty: u64,
    /// Number of groups at the output.
    pub groups: u64,
    pub pixels: u64,
    /// Number of triangles, counted once per band.
    pub entries: u64,
}

pub struct Bench {
    module: Rasterizer,
    walking: Port,
    empty: Port,
    pub counts: Counts,
}

impl Bench {
    /// Creates a bench of a module variant. Flat triangles are identified by their colours.
    pub fn new(shading: Shading, seed: u32, stalls: [f64; 2]) -> Self {
        let module = Rasterizer::new(shading, seed, stalls);
        Self {
            walking: module.port("events.cycles_walking"),
            empty: module.port("events.cycles_empty"),
            module,
            counts: Counts::default(),
        }
    }

    /// Draws a band until the rasterizer is idle; returns the band's groups.
    pub fn band<'a>(
        &mut self,
        settings: [u32; 3],
        triangles: impl Iterator<Item = &'a Triangle>,
    ) -> Vec<Vec<Bits>> {
        let counts = &mut self.counts;
        let [mut walked, mut empty] = [0; 2];
        let triangles = triangles.map(|triangle| (&triangle.setup, triangle.colour));
        let triangles = triangles.inspect(|_| counts.entries += 1);
        let (clocks, groups) = self.module.band(settings, triangles, |pipe| {
            walked += pipe.module.value(self.walking);
            empty += pipe.module.value(self.empty);
        });
        counts.clocks += clocks;
        counts.walked += walked;
        counts.empty += empty;
        groups
    }

    /// Draws triangles in all their bands, and compares the picture with the model's.
    pub fn check(&mut self, name: &str, size: (u32, u32), triangles: &[Triangle]) -> Counts {
        let (width, height) = size;
        let blank = Pixel {
            colour: 0,
            depth: 0,
        };
        let mut picture = vec![blank; (width * height) as usize];
        // Index of the last triangle drawn at each pixel.
        let mut last = vec![None; picture.len()];
        let all_flat = triangles.iter().all(|t| t.setup.light.is_none());
        self.counts = Counts::default();
        let (stride, band_rows) = (width / LANES as u32, band_rows(width));
        for y0 in (0..height).step_by(band_rows as usize) {
            let rows = band_rows.min(height - y0);
            let here = triangles.iter().filter(|triangle| {
                let bounds = triangle.setup.bounds;
                bounds.top < (y0 + rows) as i32 && bounds.bottom > y0 as i32
            });
            let mut previous = 0;
            for group in self.band([y0, rows, stride], here) {
                let row = group[0].number() as usize;
                let mask = group[1].number();
                let [line, column] = [group[4].number(), group[5].number()];
                assert!(
                    line < u64::from(rows) && column < u64::from(stride),
                    "{name}: line {line}, column {column}"
                );
                assert_eq!(row as u64, line * u64::from(stride) + column, "{name}: row");
                assert_ne!(mask, 0, "{name}: a group without a pixel");
                self.counts.groups += 1;
                for lane in (0..LANES).filter(|lane| mask >> lane & 1 == 1) {
                    let colour = group[3].element(16, lane) as u16;
                    let depth = group[2].element(18, lane) as u32;
                    let corners = || triangles.get(usize::from(colour)).map(|t| t.corners);
                    assert_ne!(depth, 0, "{name}: {:?}", corners());
                    let at = (y0 * width) as usize + LANES * row + lane;
                    if all_flat {
                        assert!(colour >= previous, "{name}: out of order: {:?}", corners());
                        previous = colour;
                        assert_ne!(
                            last[at],
                            Some(colour),
                            "{name}: {at} twice: {:?}",
                            corners()
                        );
                        last[at] = Some(colour);
                    }
                    self.counts.pixels += 1;
                    if depth >= picture[at].depth {
                        picture[at] = Pixel { colour, depth };
                    }
                }
            }
        }
        self.compare(name, size, triangles, &picture);
        self.counts
    }

    pub fn compare(&self, name: &str, size: (u32, u32), triangles: &[Triangle], picture: &[Pixel]) {
        let (mut colour, mut depth) = (vec![0; picture.len()], vec![0; picture.len()]);
        let mut target = FrameBuffer {
            width: size.0,
            height: size.1,
            colour: &mut colour,
            depth: &mut depth,
            // The module's input `dither` stays low.
            rounding: Rounding::Nearest,
        };
        let covered: u64 = triangles
            .iter()
            .map(|t| u64::from(draw(&t.setup, t.colour, &mut target).covered))
            .sum();
        for (at, &found) in picture.iter().enumerate() {
            let expected = Pixel {
                colour: colour[at],
                depth: depth[at],
            };
            let (x, y) = (at as u32 % size.0, at as u32 / size.0);
            let possible = || {
                let there = |t: &&Triangle| {
                    let bounds = t.setup.bounds;
                    (bounds.left..bounds.right).contains(&(x as i32))
                        && (bounds.top..bounds.bottom).contains(&(y as i32))
                };
                triangles
                    .iter()
                    .filter(there)
                    .map(|t| (t.corners, t.colour, t.setup.light))
                    .collect::<Vec<_>>()
            };
            assert_eq!(
                found,
                expected,
                "{name} at {x}, {y}, one of {:#?}",
                possible()
            );
        }
        assert_eq!(
            self.counts.pixels, covered,
            "{name}: total number of pixels"
        );
    }
}
