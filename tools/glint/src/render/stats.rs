//! Cycles and counts of a frame.

use crate::console::ConsoleError;
use glint_model::FrameStats;
use serde::{Deserialize, Serialize};

/// Cycles and counts of a frame, the contents of the file of `--stats`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stats {
    /// Cycles of the board's clock; `None` from the model, which has no clock.
    pub cycles: Option<u64>,
    /// Counts of the mesh.
    #[serde(flatten)]
    pub mesh: Option<TriangleCounts>,
    /// Counts of the field.
    #[serde(flatten)]
    pub rays: Option<RayCounts>,
    /// The board's clock in Hz.
    pub clock: Option<u64>,
    /// The backend of a board: `cpu` or `gateware`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub backend: Option<String>,
    /// Counters of the triangle engine, if it rendered.
    #[serde(flatten)]
    pub engine: Option<EngineStats>,
}

/// Counts of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TriangleCounts {
    /// Triangles in the mesh.
    pub triangles_in: u32,
    /// Triangles that did not reach the walker.
    pub triangles_culled: u32,
    /// Triangles that went through the clipper.
    pub triangles_clipped: u32,
    /// Triangles that reached the walker.
    pub triangles_drawn: u32,
    /// Pixels tested by the walker; the gateware's tests eight at a time.
    pub pixels_tested: u64,
    /// Pixels covered, counted once for each triangle.
    pub pixels_covered: u64,
    /// Pixels written; `None` for a mesh in a field, whose pixels the gateware counts with them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pixels_drawn: Option<u64>,
}

/// Counts of a field.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RayCounts {
    /// Rays: one a pixel and eye.
    pub rays: u32,
    /// Evaluations of the field.
    pub evaluations: u64,
    /// Rays that reached a surface.
    pub hits: u32,
    /// Rays that reached the far limit.
    pub misses: u32,
    /// Rays that reached the step limit.
    pub undecided: u32,
}

impl RayCounts {
    /// Evaluations of the field a ray.
    pub fn evaluations_per_ray(&self) -> f64 {
        self.evaluations as f64 / f64::from(self.rays)
    }
}

impl Stats {
    /// Counts of the mesh, all zero without one.
    pub fn triangles(&self) -> TriangleCounts {
        self.mesh.clone().unwrap_or_default()
    }
}

/// Counters of the triangle engine for a frame: cycles, and words of 16 bytes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EngineStats {
    /// Cycles in which a pass ran.
    pub cycles_busy: u64,
    /// Cycles in which memory did not take a command.
    pub cycles_stalled: u64,
    /// Cycles in which memory did not take a read.
    pub stalled_reads: u64,
    /// Cycles in which memory did not take a write of the geometry pass.
    pub stalled_lists: u64,
    /// Cycles in which memory did not take a write of the raster pass.
    pub stalled_frame: u64,
    /// Words read from memory.
    pub words_read: u64,
    /// Words written to memory.
    pub words_written: u64,
    /// Cycles of the geometry pass.
    pub cycles_geometry: u64,
    /// Vertices transformed.
    pub vertices: u64,
    /// Cycles of the raster pass.
    pub cycles_raster: u64,
    /// Cycles in which a triangle was walked over.
    pub cycles_walking: u64,
    /// Those of them without a pixel.
    pub cycles_empty: u64,
    /// Groups of eight pixels of which some were covered.
    pub groups: u64,
    /// Cycles in which a group waited for the one before it.
    pub cycles_held: u64,
    /// Cycles in which the flush of a band waited for memory.
    pub cycles_memory: u64,
    /// Cycles in which a drawn band waited for the flush of the one before it.
    pub cycles_flush: u64,
}

/// The statistics of a frame by the model.
impl From<FrameStats> for Stats {
    fn from(FrameStats { mesh, field }: FrameStats) -> Self {
        let mesh = mesh.map(|counts| TriangleCounts {
            triangles_in: counts.triangles_in,
            triangles_culled: counts.culled,
            triangles_clipped: counts.clipped,
            triangles_drawn: counts.drawn,
            pixels_tested: counts.pixels_tested,
            pixels_covered: counts.pixels_covered,
            pixels_drawn: field.is_none().then_some(counts.pixels_drawn),
        });
        let rays = field.map(|counts| RayCounts {
            rays: counts.rays,
            evaluations: counts.evaluations,
            hits: counts.hits,
            misses: counts.misses,
            undecided: counts.undecided,
        });
        Self {
            cycles: None,
            mesh,
            rays,
            clock: None,
            backend: None,
            engine: None,
        }
    }
}

/// Reads the statistics of a frame from lines of a key and a value.
///
/// # Errors
/// [`ConsoleError::Reply`] without the lines of a frame.
pub fn stats_of(lines: &[String]) -> Result<Stats, ConsoleError> {
    let values = lines
        .iter()
        .filter_map(|line| line.split_once(' '))
        .map(|(key, value)| {
            let number = value.parse::<u64>().map(serde_json::Value::from);
            (key.to_owned(), number.unwrap_or_else(|_| value.into()))
        })
        .collect();
    serde_json::from_value(serde_json::Value::Object(values)).map_err(|error| ConsoleError::Reply {
        command: "render".to_owned(),
        expected: format!("the statistics of a frame ({error})"),
        found: lines.join(", "),
    })
}
