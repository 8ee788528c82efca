//! Geometry passes of lines: descriptors and band lists of segments in memory (docs/formats.md, "Segments in memory").

use glint_core::picture::Size;
use glint_model::line::Segment;
use litex_pac::triangle::Geometry as GeometryStart;

use super::{Lists, Prepared, TriangleEngine, code};

/// Segments in memory, after their [`header`](Segment::header).
pub type SegmentWords = [u32; Segment::BYTES / 4];

impl TriangleEngine {
    /// Whether this gateware draws lines. If not, [`Error::Lines`](super::Error::Lines) ends each geometry pass of lines.
    #[must_use]
    pub fn draws_lines(&self) -> bool {
        self.registers.caps().read().lines()
    }

    /// Writes the registers of a geometry pass of lines, as [`prepare_geometry`](Self::prepare_geometry) does of a mesh. `segments`
    /// begins with the header, and must not be written until the pass has ended.
    pub fn prepare_lines(
        &mut self,
        segments: &[SegmentWords],
        size: Size,
        lists: Lists,
        list_shift: u8,
    ) -> Prepared {
        self.registers
            .mesh()
            .write(segments.as_ptr().addr() as u32);
        self.registers
            .mesh_bytes()
            .write(size_of_val(segments) as u32);
        // Lines have no exceptions.
        self.write_output(&lists, list_shift, lists.descriptors, 0);
        Prepared {
            start: GeometryStart::default()
                .with_start(true)
                .with_lines(true)
                .with_size(code(size)),
        }
    }
}
