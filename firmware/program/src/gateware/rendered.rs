//! The result and the cost of drawing a frame.

use glint_hal::triangle::Counters;
use glint_model::FrameStats;

use super::fallback::Unsupported;

/// Cost and counts of a frame that the gateware has drawn.
pub struct Rendered {
    /// Clock cycles from the first register write of the frame to the detection of its end.
    pub cycles: u64,
    /// In a benchmark, the part of `cycles` in which the soft core only waited for the gateware.
    pub waited: u64,
    /// Counts of the frame. In a benchmark, the triangle counts are those of the last frame only.
    pub stats: FrameStats,
    /// Increments of the triangle engine's counters during the frame.
    pub counters: Counters,
    /// The reason why the CPU made the descriptors of the frame; `None` if geometry passes made them.
    pub unsupported: Option<Unsupported>,
}

impl Rendered {
    /// The sum of the costs and counts of two frames, plus `cycles` clock cycles of further work.
    pub fn plus(self, other: Self, cycles: u64) -> Self {
        Self {
            cycles: self.cycles + other.cycles + cycles,
            waited: self.waited + other.waited,
            stats: self.stats + other.stats,
            counters: self.counters.plus(&other.counters),
            unsupported: self.unsupported.or(other.unsupported),
        }
    }
}
