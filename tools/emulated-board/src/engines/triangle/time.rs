//! Estimates the clock cycles of passes.
//!
//! The rates of the engine's parts are exact (docs/triangle.md, "Clocks of the engine alone", and docs/line.md, "Clocks"); the overlap of
//! the parts and the time of memory accesses are estimates. For a sphere similar to the sphere in docs/triangle.md, the estimates are 3,675
//! cycles for geometry and 7,151 cycles for raster; the gateware (the engine alone with a memory) takes 4,200 and 7,517 cycles.

use glint_core::colour::Shading;
use glint_core::picture::Size;
use glint_model::line::{Line, Segment};
use litex_pac::triangle::{Counters, Error};

/// Number of cycles of a refused pass, from its request to its end.
pub const REFUSAL: u64 = 20;
/// Number of cycles from `cancel` until the engine is ready again. In this time the band buffer is cleared, one row per cycle.
pub const RECOVERY: u64 = 2_100;

/// Constant number of cycles of a geometry pass, to copy the parameters and to open and close the
/// lists.
const GEOMETRY: u64 = 400;
/// Constant number of cycles of a raster pass.
const RASTER: u64 = 250;
/// Number of cycles between the last group of a band and the flush of the band.
const BAND: u64 = 16;
/// Number of cycles to start a triangle in a band.
const ENTRY: u64 = 8;

/// Results of a pass for its counters and its end.
pub struct Work {
    /// Error at the end of the pass.
    pub error: Error,
    /// Number of clock cycles of the pass.
    pub cycles: u64,
    /// Increments of the counters, except the cycle counters.
    pub counters: Counters,
}

/// Quantities that determine the time of a geometry pass.
pub struct GeometryTime {
    /// Number of triangles of the mesh.
    pub triangles: u32,
    /// Number of drawn triangles.
    pub drawn: u32,
    /// Number of fetched vertices.
    pub vertices: u32,
    /// Shading of the triangles.
    pub shading: Shading,
    /// Whether textures are drawn.
    pub has_textures: bool,
    /// Number of cycles of the line set-up.
    lines: u64,
}

impl GeometryTime {
    /// The time of a pass without work.
    pub const fn new(shading: Shading) -> Self {
        Self {
            triangles: 0,
            drawn: 0,
            vertices: 0,
            shading,
            has_textures: false,
            lines: 0,
        }
    }

    /// Adds the cycles of a segment whose line is cut into `pieces` pieces, one per band: 31 cycles for each segment, 28 more if the depth
    /// changes along the line, 1 for each pixel, and 1 for each piece.
    pub fn add_line(&mut self, segment: &Segment, pieces: u64) {
        let line = Line::new(&segment.ends);
        let division = line.is_some_and(|line| line.depth_step != 0);
        let pixels = line.map_or(0, |line| line.count as u64);
        self.lines += 31 + if division { 28 } else { 0 } + pixels + pieces;
    }

    /// Returns the estimated number of cycles: the cycles of the slowest part, plus an eighth of the cycles of the other parts, which do
    /// not overlap completely with the slowest part. A drawn triangle takes 11 cycles, or 33 with smooth shading or in a pass with
    /// textures, every triangle 3 cycles, a vertex 6 cycles.
    pub fn cycles(&self) -> u64 {
        let parts = [
            match self.shading {
                Shading::Flat if !self.has_textures => 11,
                Shading::Flat | Shading::Smooth => 33,
            } * u64::from(self.drawn),
            3 * u64::from(self.triangles),
            6 * u64::from(self.vertices),
        ];
        let slowest = parts.into_iter().fold(0, u64::max);
        let others = parts.iter().sum::<u64>() - slowest;
        GEOMETRY + slowest + others / 8 + self.lines
    }
}

/// The time of a raster pass.
#[derive(Default)]
pub struct RasterTime {
    /// Number of cycles to draw groups of pixels.
    pub walking: u64,
    cycles: u64,
    /// Number of cycles to draw the current band.
    band: u64,
    /// Number of cycles to flush the previous band.
    flush: u64,
}

impl RasterTime {
    /// Adds a triangle or a piece of a line to the current band: it has `groups` groups, and its
    /// colours take `colours` cycles.
    pub fn add(&mut self, groups: u32, colours: u32) {
        self.walking += u64::from(groups);
        self.band += u64::from(groups.max(colours)).max(ENTRY);
    }

    /// Ends a band; its flush writes `words` words in one cycle each, and takes at least one cycle per line.
    pub fn end_band(&mut self, size: Size, words: u32) {
        self.cycles += self.band.max(self.flush) + BAND;
        self.band = 0;
        self.flush = u64::from(words.max(size.band_lines()));
    }

    /// Adds the cycles of a field, or of a sky that is drawn before the triangles: they are drawn while the previous band is flushed.
    pub const fn add_background(&mut self, cycles: u64) {
        self.cycles += cycles;
    }

    /// The estimated number of cycles of the pass.
    pub const fn cycles(&self) -> u64 {
        RASTER + self.cycles + self.flush
    }
}
