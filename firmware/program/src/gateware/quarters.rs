//! Progress of a frame that is drawn in quarters.

use glint_core::picture::Quarter;
use glint_hal::triangle::TriangleEngine;
use glint_model::Stats;

use super::rendered::Rendered;

/// Progress of a frame that is drawn in quarters.
#[derive(Default)]
pub struct Quarters {
    /// Number of quarters that have been drawn or, if passes overlap, whose raster pass has been started.
    pub count: usize,
    /// The result of the quarters drawn so far, in a frame with lines.
    pub rendered: Option<Rendered>,
    /// Triangle counts of the quarters whose raster pass has been started, except the last of these quarters.
    pub triangles: Stats,
    /// Whether the lists of quarter `count` are complete.
    pub is_listed: bool,
    /// Whether a raster pass runs.
    pub rasters: bool,
}

impl Quarters {
    /// Whether a quarter of a frame with lines has been drawn, and further quarters follow.
    pub const fn has_drawn(&self) -> bool {
        self.rendered.is_some()
    }

    /// Whether one of the running passes has ended, or no pass runs.
    pub fn is_ready(&self, engine: &TriangleEngine) -> bool {
        match (self.lists(), self.rasters) {
            (false, false) => true,
            (lists, rasters) => {
                lists && engine.geometry().is_some() || rasters && engine.raster().is_some()
            }
        }
    }

    /// Whether geometry passes run.
    pub const fn lists(&self) -> bool {
        !self.is_listed && self.count < Quarter::ALL.len()
    }
}
