//! Edges of meshes as lines, each in front of its own faces by a bias that follows from their slopes (docs/formats.md, "Lines").

use glint_core::colour::Rgb565;

use crate::line::{LineDepth, Segment};
use crate::triangle::clip::{clip, clip_edge};
use crate::triangle::vertex::{snap, transform};
use crate::triangle::{MeshSetup, ScreenVertex};

/// The biases, in depth codes, that keep lines at the border of a face in front of it: of a line with a pixel in each row, and of one
/// with a pixel in each column.
pub type Biases = [u16; 2];

/// The biases for a face with these corners, positions in a mesh; `None` if no part of it has an area on the screen, or for a back
/// face with `cull`.
///
/// A pixel of a line is up to half a pixel beside the edge, along its minor axis. There the face is nearer by at most half its slope,
/// and by at most the difference of its depths; the roundings of both depths add 1.52 codes.
#[must_use]
pub fn biases(frame: &MeshSetup, corners: [[i16; 3]; 3], cull: bool) -> Option<Biases> {
    let polygon = clip(frame, corners.map(|corner| transform(frame, corner)));
    let places = || polygon.vertices().iter().map(|vertex| snap(frame, vertex));
    let (first, rest) = (places().next()?, || places().skip(1));
    let parts = rest().zip(rest().skip(1)).map(|(b, c)| [first, b, c]);
    // The slopes are most exact in the largest part of the polygon.
    let [a, b, c] = parts.max_by_key(|part| doubled_area(part).unsigned_abs())?;
    let area = doubled_area(&[a, b, c]);
    // A front face is counter-clockwise on the screen.
    let is_back = (area > 0) != frame.mirrors;
    if area == 0 || cull && is_back {
        return None;
    }
    let ways = |x: fn(&ScreenVertex) -> i64| [x(&b) - x(&a), x(&c) - x(&a)];
    let [x, y, w] = [
        ways(|v| v.x.into()),
        ways(|v| v.y.into()),
        ways(|v| v.w.into()),
    ];
    let range = places().map(|v| v.w).max()? - places().map(|v| v.w).min()?;
    let bias = |along: [i64; 2]| {
        // Depths are in 2^-6 codes, ways in 2^-8 pixels, and the area in 2^-16 square pixels.
        let twice = 4 * (w[0] * along[1] - w[1] * along[0]).unsigned_abs();
        let half_slope = twice.div_ceil(2 * area.unsigned_abs());
        half_slope.min(u64::from(range.div_ceil(64))) + 2
    };
    Some([bias(y), bias(x)].map(|bias| u16::try_from(bias).unwrap_or(u16::MAX)))
}

/// Twice the area of a triangle on the screen, in 2^-16 square pixels, positive for a clockwise one.
fn doubled_area([a, b, c]: &[ScreenVertex; 3]) -> i64 {
    let way = |v: &ScreenVertex| [v.x - a.x, v.y - a.y].map(i64::from);
    let ([bx, by], [cx, cy]) = (way(b), way(c));
    bx * cy - cx * by
}

/// The line of an edge between two positions in a mesh; `None` if the edge is outside of the volume of the frame. `biases` are the
/// largest ones of the faces at the edge.
#[must_use]
pub fn edge(
    frame: &MeshSetup,
    ends: [[i16; 3]; 2],
    colour: Rgb565,
    biases: Biases,
) -> Option<Segment> {
    let ends = clip_edge(frame, ends.map(|end| transform(frame, end)))?;
    let [a, b] = ends.map(|end| snap(frame, &end));
    let x_major = (b.x - a.x).abs() >= (b.y - a.y).abs();
    let [row_major, column_major] = biases;
    Some(Segment {
        ends: [a, b],
        colour,
        depth: LineDepth::Tested {
            bias: if x_major { column_major } else { row_major },
        },
    })
}
