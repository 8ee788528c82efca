//! The work of passes, and estimates of their clock cycles.
//!
//! The rates of the engine's parts are exact (docs/triangle.md, "Clocks of the engine alone", and docs/line.md, "Clocks"); how far parts
//! overlap, and what memory costs, is not. A sphere like that of docs/triangle.md takes 3,675 clocks of geometry and 7,151 of raster here,
//! the gateware 4,200 and 7,517 alone with a memory.

use glint_core::picture::Size;
use glint_model::line::{Line, Segment};
use litex_pac::triangle::{Counters, Error};

/// Number of cycles of a pass that is refused, from its request to its end.
pub const REFUSAL: u64 = 20;
/// Number of cycles from `cancel` until the engine is ready again: the band buffer is cleared, one row per clock.
pub const RECOVERY: u64 = 2_100;

/// Number of cycles of any geometry pass: parameters are copied, and lists emptied and closed.
const GEOMETRY: u64 = 400;
/// Number of cycles of any raster pass.
const RASTER: u64 = 250;
/// Number of cycles between the last group of a band and its flush.
const BAND: u64 = 16;
/// Number of cycles of a triangle's entry into a band.
const ENTRY: u64 = 8;

/// Statistics of a pass.
pub struct Work {
    /// Error with which it ends.
    pub error: Error,
    /// Clock cycles that it takes.
    pub cycles: u64,
    /// Growth of the counters, without those of all cycles.
    pub counters: Counters,
}

/// Quantities that determine the time of a geometry pass.
#[derive(Default)]
pub struct GeometryTime {
    /// Number of triangles of the mesh.
    pub triangles: u32,
    /// Triangles drawn.
    pub drawn: u32,
    /// Vertices fetched.
    pub vertices: u32,
    /// Number of cycles of the set-up of lines.
    lines: u64,
}

impl GeometryTime {
    /// Adds a segment with a number of pieces: 31 cycles, 28 more for a depth step, one for each pixel and each piece.
    pub fn add_line(&mut self, segment: &Segment, pieces: u64) {
        let line = Line::new(&segment.ends);
        let division = line.is_some_and(|line| line.depth_step != 0);
        let pixels = line.map_or(0, |line| line.count as u64);
        self.lines += 31 + if division { 28 } else { 0 } + pixels + pieces;
    }

    /// The cycles of the slowest part: 11 for a triangle drawn, 3 for each one, 6 for a vertex; and an eighth of the others, which do not
    /// overlap with it wholly.
    pub fn cycles(&self) -> u64 {
        let parts = [
            11 * u64::from(self.drawn),
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
    /// Number of cycles in which groups of pixels are drawn.
    pub walking: u64,
    cycles: u64,
    /// Number of cycles of drawing the current band.
    band: u64,
    /// Number of cycles of the flush of the previous band.
    flush: u64,
}

impl RasterTime {
    /// Adds a triangle or a piece of a line with a number of groups in the current band.
    pub fn add(&mut self, groups: u32) {
        self.walking += u64::from(groups);
        self.band += u64::from(groups).max(ENTRY);
    }

    /// Ends a band, whose flush writes a number of words, and takes a cycle more for each empty line.
    pub fn end_band(&mut self, size: Size, words: u32) {
        self.cycles += self.band.max(self.flush) + BAND;
        self.band = 0;
        self.flush = u64::from(words.max(size.band_lines()));
    }

    /// Adds the cycles of a field: the rays of a band are drawn while those of the band before are written.
    pub const fn add_field(&mut self, cycles: u64) {
        self.cycles += cycles;
    }

    /// The cycles of the pass.
    pub const fn cycles(&self) -> u64 {
        RASTER + self.cycles + self.flush
    }
}
