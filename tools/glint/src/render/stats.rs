//! Cycles and counts of a frame.

use crate::console::ConsoleError;
use crate::counters::Counters;
use glint_model::FrameStats;
use serde::de::value::MapDeserializer;
use serde::{Deserialize, Serialize};

/// Cycles and counts of a frame. The option `--stats` writes this structure to its file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stats {
    /// Number of cycles of the board's clock that the frame took; `None` from the model, which has no clock.
    pub cycles: Option<u64>,
    /// Counts of the mesh; `None` for a frame without a mesh.
    #[serde(flatten)]
    pub mesh: Option<TriangleCounts>,
    /// Counts of the field; `None` for a frame without a field.
    #[serde(flatten)]
    pub rays: Option<RayCounts>,
    /// Counts of the wireframe; `None` for a frame without a wireframe.
    #[serde(flatten)]
    pub wireframe: Option<WireframeCounts>,
    /// Counts of the edges of a mesh; `None` for a frame without edges.
    #[serde(flatten)]
    pub edges: Option<EdgeCounts>,
    /// Frequency of the board's clock in Hz; `None` from the model.
    pub clock: Option<u64>,
    /// The backend of a board: `cpu` or `gateware`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub backend: Option<String>,
    /// Counters of the triangle engine; empty if the engine did not draw the frame.
    #[serde(flatten)]
    pub engine: Counters,
}

/// Counts of triangles and pixels of a frame with a mesh.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TriangleCounts {
    /// Number of triangles in the mesh.
    pub triangles_in: u32,
    /// Number of triangles that were culled before they reached the walker, which tests the pixels
    /// of triangles.
    pub triangles_culled: u32,
    /// Number of triangles that went through the clipper.
    pub triangles_clipped: u32,
    /// Number of triangles that reached the walker.
    pub triangles_drawn: u32,
    /// Pixels tested by the walker; `None` from the gateware, whose walker tests groups of eight pixels and counts them in
    /// `cycles_walking`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pixels_tested: Option<u64>,
    /// Pixels covered by triangles and by lines of edges. A pixel counts once for each triangle and
    /// line.
    pub pixels_covered: u64,
    /// Pixels written; `None` for a mesh in a field, where the gateware counts the pixels of the mesh and of the field together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pixels_drawn: Option<u64>,
}

/// Counts of rays and evaluations of a frame with a field.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RayCounts {
    /// Rays, one for each pixel and eye.
    pub rays: u32,
    /// Evaluations of the field.
    pub evaluations: u64,
    /// Number of rays that reached a surface.
    pub hits: u32,
    /// Number of rays that reached the far limit.
    pub misses: u32,
    /// Number of rays that reached the step limit.
    pub undecided: u32,
}

/// Counts of a frame with a wireframe.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WireframeCounts {
    /// Number of segments of the program.
    pub segments: u32,
    /// Number of segments that are drawn as lines because a part of them is behind the view plane
    /// and within the guard band.
    pub lines: u32,
    /// Pixels written; a pixel on several lines counts once for each line.
    pub line_pixels: u64,
}

/// Counts of the edges of a mesh.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EdgeCounts {
    /// Edges of the mesh.
    pub edges_in: u32,
    /// Edges that are drawn as lines because they are at least partly in the view volume.
    pub edges_drawn: u32,
}

impl RayCounts {
    /// Mean number of evaluations of the field per ray.
    pub fn evaluations_per_ray(&self) -> f64 {
        self.evaluations as f64 / f64::from(self.rays)
    }
}

impl Stats {
    /// Returns the counts of the mesh; all counts are 0 for a frame without a mesh.
    pub fn triangles(&self) -> TriangleCounts {
        self.mesh.clone().unwrap_or_default()
    }
}

/// Converts the statistics of a frame that the model has drawn.
impl From<FrameStats> for Stats {
    fn from(stats: FrameStats) -> Self {
        let FrameStats {
            mesh,
            field,
            wireframe,
            edges,
        } = stats;
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
        let wireframe = wireframe.map(|counts| WireframeCounts {
            segments: counts.segments,
            lines: counts.lines,
            line_pixels: counts.pixels,
        });
        let edges = edges.map(|counts| EdgeCounts {
            edges_in: counts.edges,
            edges_drawn: counts.drawn,
        });
        Self {
            cycles: None,
            mesh,
            rays,
            wireframe,
            edges,
            clock: None,
            backend: None,
            engine: Counters::default(),
        }
    }
}

/// Reads the statistics of a frame from a reply of the board, in which each line is a key and a value.
///
/// # Errors
/// [`ConsoleError::Reply`] if lines of the statistics are missing.
pub fn stats_of(lines: &[String]) -> Result<Stats, ConsoleError> {
    let values = lines
        .iter()
        .filter_map(|line| line.split_once(' '))
        .map(|(key, value)| {
            let number = value.parse::<u64>().map(serde_json::Value::from);
            (key, number.unwrap_or_else(|_| value.into()))
        });
    Stats::deserialize(MapDeserializer::new(values)).map_err(|error: serde_json::Error| {
        ConsoleError::Reply {
            command: "render".to_owned(),
            expected: format!("the statistics of a frame ({error})"),
            found: lines.join(", "),
        }
    })
}
