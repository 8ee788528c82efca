//! Bit-exact model of the line engine, which draws the pixels between two vertices on the screen (docs/formats/line.md, "Lines").
//!
//! A line has one pixel in each column if its end points are at least as far apart horizontally as vertically, otherwise one in each row.
//! The axis along which the line is longer is its *major* axis; the other axis is its *minor* axis. The diamond-exit rule selects its
//! pixels: a pixel is drawn if the path from the first to the second end point leaves the pixel's diamond,
//! |x| + |y| < 1/2 about its centre. [`Line::new`] is the setup, [`Line::pixels`] iterates over the pixels in a rectangle, and [`draw`]
//! writes them. The engine cuts lines into [`Piece`]s.

mod piece;

use glint_core::colour::Rgb565;
use glint_core::picture::Samples;
use glint_core::records::segment_end;

use crate::frame_buffer::FrameBuffer;
use crate::triangle::ScreenVertex;
use crate::triangle::rounding::nearest;
use crate::triangle::setup::Bounds;

pub use piece::{Piece, band_bounds};

/// Range of the coordinates of end points: −2048 ≤ x, y < 2048 pixels, s12.8.
const REACH: core::ops::Range<i32> = -(1 << 19)..1 << 19;

/// The largest depth code.
const NEAREST: i64 = (1 << 18) - 1;

/// How a line is hidden by other pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineDepth {
    /// No depth test: the line covers all other pixels. Its pixels get the largest depth code, so that only later lines cover them.
    Over,
    /// A pixel is drawn if its depth code is at least the stored code.
    Tested {
        /// Bias added to the depth codes of the line, so that it lies in front of the adjacent faces.
        bias: u16,
    },
}

/// A line segment on the screen, before the setup.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// The end points, in drawing order.
    pub ends: [ScreenVertex; 2],
    /// Colour of all pixels of the segment.
    pub colour: Rgb565,
    /// How the segment is hidden by other pixels.
    pub depth: LineDepth,
}

/// Writes an end of a segment, with the depth `w`, to `words`.
// A function that is called for each end, because the compiler would not unroll a loop over the ends in the firmware, which is optimised
// for size.
const fn put_end(words: &mut [u32], place: &ScreenVertex, w: u32, side: u16) {
    // Each field starts a word; the remaining bits of the word have no effect.
    words[segment_end::X.word()] = place.x as u32;
    words[segment_end::Y.word()] = place.y as u32;
    words[segment_end::W.word()] = w;
    words[segment_end::SIDE.word()] = side as u32;
}

impl Segment {
    /// Number of 32-bit words of a segment in memory.
    pub const WORDS: usize = 2 * Self::END;
    /// Number of 32-bit words of an end in memory.
    const END: usize = segment_end::BITS / 32;

    /// The words that represent the segment in memory (docs/formats/line.md, "Segments in memory").
    pub const fn words(&self) -> [u32; Self::WORDS] {
        let (w, bias) = match self.depth {
            LineDepth::Over => ([(NEAREST << 6) as u32; 2], 0),
            LineDepth::Tested { bias } => ([self.ends[0].w, self.ends[1].w], bias),
        };
        let [first, second] = &self.ends;
        let mut words = [0; Self::WORDS];
        let (start, end) = words.split_at_mut(Self::END);
        put_end(start, first, w[0], self.colour.0);
        put_end(end, second, w[1], bias);
        words
    }

    /// The segment with these [`words`](Self::words) in memory. Bits outside of the fields have no effect. A segment without a depth test
    /// is read as a segment with a depth test that draws the same pixels.
    pub fn from_words(words: [u32; Self::WORDS]) -> Self {
        let [first, second] = [0, segment_end::BITS].map(|start| {
            let end = ScreenVertex {
                x: segment_end::X.from(start).signed(&words) as i32,
                y: segment_end::Y.from(start).signed(&words) as i32,
                w: segment_end::W.from(start).get(&words) as u32,
            };
            (end, segment_end::SIDE.from(start).get(&words) as u16)
        });
        Self {
            ends: [first.0, second.0],
            colour: Rgb565(first.1),
            depth: LineDepth::Tested { bias: second.1 },
        }
    }

    /// The header of a chunk with one vertex and `segments` segments, and this vertex. Header and vertex together have the length of a
    /// segment.
    pub const fn header(segments: u32) -> [u32; Self::WORDS] {
        [1, 2 * segments, 0, 0, 0, 0, 0, 0]
    }

    /// The lines that draw the segment one pixel wide. With one sample per pixel this is the segment itself. With four samples per pixel
    /// there are two lines, each half a sample from the segment along its minor axis. Their pixels may be up to a whole sample from the
    /// segment, so their bias is twice the segment's bias (docs/formats/line.md, "Lines").
    pub fn strokes(self, samples: Samples) -> impl Iterator<Item = Self> {
        let [a, b] = self.ends;
        let is_flat = (b.x - a.x).abs() >= (b.y - a.y).abs();
        let offsets: &[i32] = match samples {
            Samples::One => &[0],
            Samples::Four => &[-128, 128],
        };
        offsets.iter().map(move |&offset| Self {
            ends: self.ends.map(|end| {
                // An end at the limit of the coordinates does not move; such an end is far outside of the picture.
                let moved = |place: i32| (place + offset).clamp(REACH.start, REACH.end - 1);
                let (x, y) = if is_flat {
                    (end.x, moved(end.y))
                } else {
                    (moved(end.x), end.y)
                };
                ScreenVertex { x, y, ..end }
            }),
            depth: match self.depth {
                LineDepth::Tested { bias } if samples == Samples::Four => LineDepth::Tested {
                    bias: bias.saturating_mul(2),
                },
                depth => depth,
            },
            ..self
        })
    }

    /// Number of pixels of the segment in the picture.
    pub fn covered(&self, target: &FrameBuffer) -> usize {
        pixels(&self.ends, target).count()
    }

    /// Draws the part of the segment in the picture. Returns the number of pixels written.
    pub fn draw(&self, target: &mut FrameBuffer) -> u32 {
        draw(&self.ends, self.colour, self.depth, target)
    }
}

/// A pixel of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinePixel {
    /// Column in the picture.
    pub column: i32,
    /// Row in the picture.
    pub row: i32,
    /// Depth accumulator, 14 fraction bits, s20.14.
    pub depth: i64,
}

impl LinePixel {
    /// The depth code: the accumulator rounded to nearest and saturated to 1…2^18 − 1.
    pub fn code(&self, depth: LineDepth) -> u32 {
        let code = match depth {
            LineDepth::Over => NEAREST,
            LineDepth::Tested { bias } => {
                (nearest(self.depth, 14) + i64::from(bias)).clamp(1, NEAREST)
            }
        };
        code as u32
    }
}

/// A line segment after the setup, which the engine walks pixel by pixel.
///
/// On an axis along which the segment runs backward, coordinates are mirrored: column or row i becomes −1 − i. Coordinates therefore always
/// increase from the first to the second end point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line {
    /// Whether the major axis is horizontal.
    pub x_major: bool,
    /// Whether the line runs to lower columns or rows, along its major axis and along its minor axis.
    pub backward: [bool; 2],
    /// Mirrored position of the first pixel on the major and the minor axis: its column and row, or its row and column.
    pub start: [i32; 2],
    /// Number of pixels, at least 1.
    pub count: i32,
    /// Distances of the end points along the major and the minor axis, in 1/256 pixel: 0 ≤ minor ≤ major < 2^20.
    pub span: [i32; 2],
    /// Error term of the first pixel, −major ≤ error < 0. Each pixel adds the minor distance; if the result is 0 or more, the walk takes
    /// one step along the minor axis and subtracts the major distance.
    pub error: i32,
    /// Depth accumulator of the first pixel, s20.14.
    pub depth: i64,
    /// Increment of the depth accumulator for one pixel, s20.14.
    pub depth_step: i64,
}

/// One coordinate of an end point, mirrored if the segment runs backward along this axis.
#[derive(Clone, Copy)]
struct Coordinate {
    /// Index of the column or row.
    pixel: i32,
    /// Distance from the lower border of the pixel, in 1/256 pixel; less 1 if the axis is not mirrored, because a point on the upper border
    /// then belongs to the pixel. On a mirrored axis, a point on the lower border does.
    place: i32,
}

impl Coordinate {
    /// Splits x − 1, or −x if the axis is mirrored, into the pixel and the position in the pixel.
    const fn new(x: i32, backward: bool) -> Self {
        let x = if backward { !(x - 1) } else { x - 1 };
        Self {
            pixel: x >> 8,
            place: x & 255,
        }
    }

    /// Distance to the centre of the pixel, in 1/256 pixel; less 1 below the centre if the axis is mirrored, otherwise above the centre.
    const fn distance(self) -> i32 {
        if self.place >= 128 {
            self.place - 128
        } else {
            127 - self.place
        }
    }
}

impl Line {
    /// The setup (docs/formats/line.md, "Lines") of a segment from the first to the second end point; `None` for a segment that
    /// leaves no diamond, or with an end point outside of the format s12.8.
    pub fn new([a, b]: &[ScreenVertex; 2]) -> Option<Self> {
        if [a.x, a.y, b.x, b.y].iter().any(|x| !REACH.contains(x)) {
            return None;
        }
        let [dx, dy] = [b.x - a.x, b.y - a.y];
        let x_major = dx.abs() >= dy.abs();
        let by_axis = |[x, y]: [i32; 2]| if x_major { [x, y] } else { [y, x] };
        let step = by_axis([dx, dy]);
        let backward = step.map(|d| d < 0);
        let [major, minor] = step.map(i32::abs);
        let split = |v: &ScreenVertex| {
            let [x, y] = by_axis([v.x, v.y]);
            [
                Coordinate::new(x, backward[0]),
                Coordinate::new(y, backward[1]),
            ]
        };
        let (from, to) = (split(a), split(b));
        let [passed, end_passed] = [(a, from), (b, to)].map(|(v, at)| i32::from(passed(v, at)));
        let first = from[0].pixel + passed;
        let count = to[0].pixel + end_passed - first;
        if count <= 0 {
            return None;
        }
        // `ahead` is the distance from the first end point to the first pixel's centre along the major axis. `above` is the distance from
        // the lower border of the end point's row or column to the end point along the minor axis. Both are in 1/256 pixel.
        let ahead = 256 * passed + 127 - from[0].place + i32::from(backward[0]);
        let above = from[1].place + i32::from(!backward[1]);
        let tie = if x_major { dx < 0 || dy == 0 } else { dx >= 0 };
        // The sum is at most 2^20·(256 + 256), so 32 bits suffice. Divided by `major`, it is 0 or 1.
        let moved = (major * above + minor * ahead - i32::from(tie)) >> 8;
        let up = i32::from(moved >= major);
        let depth_step = if major < 256 {
            0
        } else {
            ((i64::from(b.w) - i64::from(a.w)) << 16).div_euclid(i64::from(major))
        };
        Some(Self {
            x_major,
            backward,
            start: [first, from[1].pixel + up],
            count,
            span: [major, minor],
            error: moved - major * (1 + up),
            depth: (i64::from(a.w) << 8) + ((depth_step * i64::from(ahead)) >> 8),
            depth_step,
        })
    }

    /// The pixels of the line that are in a rectangle of the picture.
    pub fn pixels(mut self, rectangle: &Bounds) -> LinePixels {
        let columns = [rectangle.left, rectangle.right - 1];
        let rows = [rectangle.top, rectangle.bottom - 1];
        let mut limits = if self.x_major {
            [columns, rows]
        } else {
            [rows, columns]
        };
        for (limits, backward) in limits.iter_mut().zip(self.backward) {
            if backward {
                *limits = [!limits[1], !limits[0]];
            }
        }
        let [[major_first, major_last], [minor_first, minor_last]] = limits;
        self.skip(i64::from(major_first - self.start[0]));
        self.skip(self.steps_to(minor_first));
        LinePixels {
            line: self,
            last: [major_last, minor_last],
        }
    }

    /// Number of steps to the first pixel at `minor` on the minor axis, possibly 0.
    fn steps_to(&self, minor: i32) -> i64 {
        let [major_span, minor_span] = self.span.map(i64::from);
        let crossed = i64::from(minor - self.start[1]);
        if crossed <= 0 {
            return 0;
        }
        let distance = (crossed - 1) * major_span - i64::from(self.error);
        match minor_span {
            0 => i64::from(self.count),
            _ => (distance + minor_span - 1) / minor_span,
        }
    }

    /// Skips the next `steps` pixels, if `steps` is above 0. A line with fewer pixels becomes empty.
    fn skip(&mut self, steps: i64) {
        if steps <= 0 {
            return;
        }
        if steps >= i64::from(self.count) {
            self.count = 0;
            return;
        }
        let [major_span, minor_span] = self.span.map(i64::from);
        let moved = i64::from(self.error) + major_span + steps * minor_span;
        self.start[0] += steps as i32;
        self.start[1] += (moved / major_span) as i32;
        self.error = (moved % major_span - major_span) as i32;
        self.count -= steps as i32;
        self.depth += steps * self.depth_step;
    }

    fn pixel(&self) -> LinePixel {
        let [major, minor] = [0, 1].map(|axis: usize| {
            let (at, backward) = (self.start[axis], self.backward[axis]);
            if backward { !at } else { at }
        });
        let [column, row] = if self.x_major {
            [major, minor]
        } else {
            [minor, major]
        };
        LinePixel {
            column,
            row,
            depth: self.depth,
        }
    }
}

/// Whether an end point is beyond the diamond of its pixel along the major axis: in the upper half of the pixel on this axis, and outside
/// of the diamond. `at` has the coordinates of the end point on the major and the minor axis.
fn passed(v: &ScreenVertex, at: [Coordinate; 2]) -> bool {
    let below = Coordinate::new(v.y, false).place >= 128;
    let distance = at[0].distance() + at[1].distance() + i32::from(below);
    at[0].place >= 128 && distance >= 128
}

/// Iterator over the pixels of a line in a rectangle, from the first to the second end point.
#[derive(Clone, Debug)]
pub struct LinePixels {
    /// The remaining line from the next pixel on.
    line: Line,
    /// Last position in the rectangle on the major axis and on the minor axis, mirrored like the line.
    last: [i32; 2],
}

impl LinePixels {
    /// The rest of the line from the next pixel to the line's end, which may be outside of the rectangle; `None` if no further pixel is in
    /// the rectangle.
    pub fn rest(&self) -> Option<&Line> {
        let [major, minor] = self.line.start;
        let is_inside = major <= self.last[0] && minor <= self.last[1];
        (self.line.count > 0 && is_inside).then_some(&self.line)
    }
}

impl Iterator for LinePixels {
    type Item = LinePixel;

    fn next(&mut self) -> Option<LinePixel> {
        let pixel = self.rest()?.pixel();
        let line = &mut self.line;
        line.count -= 1;
        line.start[0] += 1;
        // The coordinates of a line from damaged memory may wrap.
        line.error = line.error.wrapping_add(line.span[1]);
        if line.error >= 0 {
            line.error = line.error.wrapping_sub(line.span[0]);
            line.start[1] += 1;
        }
        line.depth += line.depth_step;
        Some(pixel)
    }
}

/// The pixels of a segment in the picture.
fn pixels(
    ends: &[ScreenVertex; 2],
    target: &FrameBuffer,
) -> impl Iterator<Item = LinePixel> + use<> {
    let picture = Bounds {
        left: 0,
        right: target.width as i32,
        top: 0,
        bottom: target.height as i32,
    };
    let pixels = Line::new(ends).map(|line| line.pixels(&picture));
    pixels.into_iter().flatten()
}

/// Draws the part of a segment in the picture. Returns the number of pixels written.
pub fn draw(
    ends: &[ScreenVertex; 2],
    colour: Rgb565,
    depth: LineDepth,
    target: &mut FrameBuffer,
) -> u32 {
    let mut drawn = 0;
    for pixel in pixels(ends, target) {
        drawn += u32::from(target.draw_pixel(&pixel, depth, colour));
    }
    drawn
}

impl FrameBuffer<'_> {
    /// Draws a pixel of a line; the pixel must be in the picture. Returns whether it passed the depth test.
    #[inline]
    fn draw_pixel(&mut self, pixel: &LinePixel, depth: LineDepth, colour: Rgb565) -> bool {
        // Both coordinates are at least 0, and the pixel is in both buffers.
        let at = pixel.row as usize * self.width as usize + pixel.column as usize;
        let code = pixel.code(depth);
        if let (Some(stored), Some(place)) = (self.depth.get_mut(at), self.colour.get_mut(at))
            && code >= *stored
        {
            *stored = code;
            *place = colour.0;
            return true;
        }
        false
    }
}
