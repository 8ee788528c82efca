//! The result of drawing a frame.

use core::fmt;

use glint_core::feature::{CPU, STEREO};
use glint_hal::frequency::Frequency;
use glint_hal::triangle::Counters;
use glint_model::{FrameStats, RenderError};

use crate::gateware::{Fallback, Unsupported};

/// Statistics of the last frame.
#[derive(Clone, Copy)]
pub struct Drawn {
    /// Clock cycles of drawing the frame, without the wait for a free frame buffer.
    pub cycles: u64,
    /// Counts of triangles, rays and pixels.
    pub stats: FrameStats,
    /// Which renderer drew the frame, and why.
    pub by: RenderedBy,
    /// Whether the frame's depth codes are in memory.
    pub has_depth: bool,
}

impl Drawn {
    /// The reason why the CPU drew the frame in place of the gateware.
    pub const fn fallback(&self) -> Option<Fallback> {
        match self.by {
            RenderedBy::Cpu(fallback) => fallback,
            RenderedBy::Gateware(..) => None,
        }
    }

    /// The number of frames per second that this frame's drawing time allows.
    pub fn rate(&self, frequency: Frequency) -> u64 {
        u64::from(frequency.hertz()) / self.cycles.max(1)
    }
}

/// Which renderer drew a frame.
#[derive(Clone, Copy)]
pub enum RenderedBy {
    /// The CPU, with the reason if the gateware could not draw the frame.
    Cpu(Option<Fallback>),
    /// The gateware, with the triangle engine's counters, and the reason if the CPU made the descriptors.
    Gateware(Counters, Option<Unsupported>),
}

/// Reason why a frame is not drawn.
#[derive(Clone, Copy, Debug)]
pub enum DrawError {
    /// The CPU backend cannot draw the frame, for this reason.
    Render(RenderError),
    /// This build does not include the CPU backend, and the gateware cannot draw the frame for the given reason, or the backend is set to
    /// the CPU.
    NoCpu(Option<Fallback>),
}

impl fmt::Display for DrawError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            // Only these parts draw frames by the model.
            Self::Render(error) if CPU.is_built || STEREO.is_built => error.fmt(f),
            Self::Render(_) => f.write_str("the frame cannot be drawn"),
            Self::NoCpu(None) => CPU.fmt(f),
            Self::NoCpu(Some(fallback)) => write!(f, "{fallback}; {}", fallback.part()),
        }
    }
}
