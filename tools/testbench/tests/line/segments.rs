//! Pieces of lines, cut at the bands of a picture.

use glint_core::picture::Size;
use glint_model::ScreenVertex;
use glint_model::line::{Line, LineDepth, LinePixel, Piece, Segment, band_bounds};
use glint_model::triangle::setup::Bounds;
use glint_testbench::{Bits, Layout};
use glint_vectors::segments::NEAREST;

/// The bands of a picture, from the top.
pub fn bands(size: usize) -> Vec<Bounds> {
    let size = Size::ALL[size];
    (0..size.bands())
        .map(|band| band_bounds(size, band))
        .collect()
}

/// The set-up's input for a segment: its end points, and the bias of their depths.
pub fn placed(segment: &Segment) -> ([ScreenVertex; 2], u16) {
    match segment.depth {
        LineDepth::Over => (
            segment.ends.map(|end| ScreenVertex { w: NEAREST, ..end }),
            0,
        ),
        LineDepth::Tested { bias } => (segment.ends, bias),
    }
}

/// The pixels of a segment in a band.
pub fn pixels(segment: &Segment, band: &Bounds) -> Vec<LinePixel> {
    let pixels = Line::new(&segment.ends).map(|line| line.pixels(band));
    pixels.into_iter().flatten().collect()
}

/// The piece of a line in a band, as `records_pkg::piece_t`.
pub fn piece(segment: &Segment, layout: &Layout, size: usize, band: &Bounds) -> Option<Bits> {
    let is_inside = |piece: &Piece| (band.top..band.bottom).contains(&piece.first()[1]);
    let mut pieces = segment.pieces(Size::ALL[size]).filter(is_inside);
    pieces.next().map(|piece| packed(&piece, layout))
}

/// The pieces of a line, in the order of the bands along the line.
pub fn pieces(segment: &Segment, layout: &Layout, size: usize) -> Vec<Bits> {
    let pieces = segment.pieces(Size::ALL[size]);
    pieces.map(|piece| packed(&piece, layout)).collect()
}

fn packed(piece: &Piece, layout: &Layout) -> Bits {
    let rest = &piece.line;
    let [major, minor] = rest.span;
    let [left, up] = if rest.x_major {
        rest.backward
    } else {
        [rest.backward[1], rest.backward[0]]
    };
    let [column, row] = piece.first();
    let record = layout
        .record()
        .with("colour", piece.colour.0)
        .with("x_major", u8::from(rest.x_major))
        .with("left", u8::from(left))
        .with("up", u8::from(up))
        .with("column", column)
        .with("row", row)
        .with("count", rest.count)
        .with("error", rest.error + minor)
        .with("minor", minor)
        .with("fall", minor - major)
        .with("depth", rest.depth + (1 << 13))
        .with("depth_step", rest.depth_step);
    record.bits()
}
