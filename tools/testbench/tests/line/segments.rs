//! The pieces into which the bands of a picture cut lines.

use glint_model::line::{Line, LineDepth, LinePixel, Segment};
use glint_model::triangle::descriptor::band_rows;
use glint_model::triangle::setup::Bounds;
use glint_model::{SIZES, ScreenVertex};
use glint_testbench::{Bits, Layout};
use glint_vectors::segments::NEAREST;

/// Pictures by their size codes.
pub fn picture(size: usize) -> Bounds {
    let (width, height) = SIZES[size];
    Bounds {
        left: 0,
        right: width as i32,
        top: 0,
        bottom: height as i32,
    }
}

/// The bands of a picture, from the top.
pub fn bands(size: usize) -> Vec<Bounds> {
    let picture = picture(size);
    let rows = band_rows(SIZES[size].0) as i32;
    let tops = (0..picture.bottom).step_by(rows as usize);
    tops.map(|top| Bounds {
        top,
        bottom: top + rows,
        ..picture
    })
    .collect()
}

/// The end points of a segment as the set-up gets them, and the bias of their depths.
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

/// The piece of a line in a band, as `line_pkg::piece_t`.
pub fn piece(segment: &Segment, layout: &Layout, band: &Bounds) -> Option<Bits> {
    let (ends, bias) = placed(segment);
    let pixels = Line::new(&ends)?.pixels(band);
    let rest = *pixels.rest()?;
    let first = pixels.clone().next()?;
    let [major, minor] = rest.span;
    let [left, up] = if rest.x_major {
        rest.backward
    } else {
        [rest.backward[1], rest.backward[0]]
    };
    let piece = layout
        .record()
        .with("colour", segment.colour.0)
        .with("x_major", u8::from(rest.x_major))
        .with("left", u8::from(left))
        .with("up", u8::from(up))
        .with("column", first.column)
        .with("row", first.row)
        .with("count", rest.count)
        .with("error", rest.error + minor)
        .with("minor", minor)
        .with("fall", minor - major)
        .with("depth", rest.depth + (i64::from(bias) << 14) + (1 << 13))
        .with("depth_step", rest.depth_step);
    Some(piece.bits())
}

/// The pieces of a line in the order in which it meets the bands.
pub fn pieces(segment: &Segment, layout: &Layout, size: usize) -> Vec<Bits> {
    let mut bands = bands(size);
    if segment.ends[1].y < segment.ends[0].y {
        bands.reverse();
    }
    bands
        .iter()
        .filter_map(|band| piece(segment, layout, band))
        .collect()
}
