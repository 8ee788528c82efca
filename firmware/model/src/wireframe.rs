//! Pictures of the wireframe simulator: each segment of a program is transformed, projected, and drawn as a line (docs/wireframe.md).

use glint_core::colour::Rgb565;
use glint_core::picture::{Samples, Window};
use glint_core::wireframe::{Pose, Program, Projection, Segment};

use crate::error::RenderError;
use crate::frame_buffer::FrameBuffer;
use crate::line::{self, LineDepth};
use crate::triangle::ScreenVertex;

/// The colour of the lines: green.
pub const LINE_COLOUR: Rgb565 = Rgb565(0x07E0);

/// Number of segments that are drawn between two calls of `progress`.
const SEGMENTS_PER_CALL: u32 = 16;

/// A program of the wireframe simulator, and the motion of its segments.
#[derive(Clone, Copy, Debug)]
pub struct WireframeSubject<'a> {
    /// The program, a list of segments and their viewing parameters.
    pub program: Program<'a>,
    /// The motion that transforms all segments.
    pub pose: Pose,
}

impl WireframeSubject<'_> {
    /// The line of a segment of the program, drawn without a depth test; `None` if no part of the line is on the screen.
    pub fn line(&self, projection: &Projection, segment: Segment) -> Option<line::Segment> {
        let ends = projection.line(self.pose.segment(segment))?;
        Some(line::Segment {
            ends: ends.map(|[x, y]| ScreenVertex { x, y, w: 0 }),
            colour: LINE_COLOUR,
            depth: LineDepth::Over,
        })
    }
}

/// Counts of the segments and pixels of a drawn wireframe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WireframeStats {
    /// Number of segments of the program.
    pub segments: u32,
    /// Number of segments with a part beyond the view plane and within the guard band.
    pub lines: u32,
    /// Number of pixels written, or of samples with several samples per pixel. A pixel on several lines counts once per line.
    pub pixels: u64,
}

impl WireframeStats {
    /// Adds the counts of another frame.
    pub const fn add(&mut self, other: &Self) {
        self.segments += other.segments;
        self.lines += other.lines;
        self.pixels += other.pixels;
    }
}

/// Clears the window of a picture with this number of samples per pixel to `clear`, and draws a program into the window. Pixels of lines
/// get the largest depth code, all other pixels the code 0. Calls `progress` at short intervals.
///
/// # Errors
/// [`RenderError`] for a buffer of the wrong size.
pub fn render_wireframe(
    subject: &WireframeSubject,
    clear: Rgb565,
    window: Window,
    samples: Samples,
    target: &mut FrameBuffer,
    progress: &mut dyn FnMut(),
) -> Result<WireframeStats, RenderError> {
    target.check()?;
    target.check_size(window.size.pixels().into())?;
    target.colour.fill(clear.0);
    target.depth.fill(0);
    let projection = Projection::new(subject.program.viewing(), window);
    let mut stats = WireframeStats::default();
    for segment in subject.program.segments() {
        if stats.segments % SEGMENTS_PER_CALL == 0 {
            progress();
        }
        stats.segments += 1;
        if let Some(line) = subject.line(&projection, segment) {
            stats.lines += 1;
            let strokes = line.strokes(samples);
            stats.pixels += strokes
                .map(|line| u64::from(line.draw(target)))
                .sum::<u64>();
        }
    }
    Ok(stats)
}
