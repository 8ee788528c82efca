//! Edges of meshes as lines, each moved in front of its adjacent faces by a depth bias computed from their slopes (docs/formats/line.md,
//! "Lines").
//!
//! [`EdgeList`] lists each edge of a mesh once, in the caller's memory, and makes the segments of a frame.

mod list;
mod table;

use glint_core::colour::Rgb565;
use heapless::Vec;

use crate::line::{LineDepth, Segment};
use crate::triangle::clip::{MAX_VERTICES, clip, clip_edge};
use crate::triangle::vertex::{snap, transform};
use crate::triangle::{MeshSetup, Projected, ScreenVertex};

pub use list::EdgeList;

/// The colour of the edges: white.
pub const EDGE_COLOUR: Rgb565 = Rgb565::WHITE;

/// The biases, in depth codes, that keep lines at the border of a face in front of the face: for a line with one pixel in each row, and for
/// a line with one pixel in each column. Both are 0 without a face.
type Biases = [u16; 2];

/// Counts of the edges of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EdgeStats {
    /// Number of edges of the mesh.
    pub edges: u32,
    /// Number of edges drawn as lines: those with a part in the view volume of the frame.
    pub drawn: u32,
}

impl EdgeStats {
    /// Adds the counts of another frame.
    pub const fn add(&mut self, other: &Self) {
        self.edges += other.edges;
        self.drawn += other.drawn;
    }
}

/// A corner of a face, or an end of an edge: the position in the mesh, and the output of the vertex stage.
type Corner<'a> = ([i16; 3], &'a Projected);

/// The biases for a face with these corners; 0 for a face without area on the screen, and with `cull` for a back face.
fn face(frame: &MeshSetup, corners: &[Corner; 3], cull: bool) -> Biases {
    let [
        (_, Projected::Visible(a)),
        (_, Projected::Visible(b)),
        (_, Projected::Visible(c)),
    ] = corners
    else {
        return clipped_face(frame, corners, cull);
    };
    let area = doubled_area([a, b, c]);
    if !is_drawn(frame, area, cull) {
        return Biases::default();
    }
    let (nearest, farthest) = (a.w.max(b.w).max(c.w), a.w.min(b.w).min(c.w));
    biases([a, b, c], area, nearest - farthest)
}

/// The biases for a face that may leave the view volume of the frame.
///
/// Not inlined, so that other faces do not load this code into the instruction cache.
#[inline(never)]
fn clipped_face(frame: &MeshSetup, corners: &[Corner; 3], cull: bool) -> Biases {
    let corners = corners.map(|(corner, _)| transform(frame, corner));
    let mut space = Default::default();
    let polygon = clip(frame, corners, &mut space);
    let places = polygon.iter().map(|vertex| snap(frame, vertex));
    let places: Vec<_, MAX_VERTICES> = places.collect();
    let Some((first, rest)) = places.split_first() else {
        return Biases::default();
    };
    let parts = rest.iter().zip(rest.iter().skip(1));
    let parts = parts.map(|(b, c)| [first, b, c]);
    // The largest triangle of the polygon gives the most exact slopes.
    let Some(part) = parts.max_by_key(|part| doubled_area(*part).unsigned_abs()) else {
        return Biases::default();
    };
    let area = doubled_area(part);
    if !is_drawn(frame, area, cull) {
        return Biases::default();
    }
    let depths = || places.iter().map(|v| v.w);
    let range = depths().max().unwrap_or(0) - depths().min().unwrap_or(0);
    biases(part, area, range)
}

/// Whether a face with this doubled signed area is drawn. A front face is counter-clockwise on the screen.
const fn is_drawn(frame: &MeshSetup, area: i64, cull: bool) -> bool {
    let is_back = (area > 0) != frame.mirrors;
    area != 0 && !(cull && is_back)
}

/// The biases for a face, from three vertices of the face, twice the area of the triangle of these vertices, and the depth range of all
/// vertices of the face.
///
/// A pixel of a line is up to half a pixel away from the edge, along the line's minor axis. At the pixel's centre the face is nearer than
/// the edge by at most half the slope of the face, and by at most the depth range of the face. Rounding of both depths adds up to 1.52
/// codes.
#[inline(never)]
fn biases([a, b, c]: [&ScreenVertex; 3], area: i64, range: u32) -> Biases {
    // Depths have 24 bits, so their differences fit 32 bits.
    let w = [b.w as i32 - a.w as i32, c.w as i32 - a.w as i32];
    let bias = |along: [i32; 2]| {
        // Depths are in 2^-6 codes, distances in 2^-8 pixels, and the area in 2^-16 square pixels.
        let twice = 4 * determinant(w, along).unsigned_abs();
        let double = 2 * area.unsigned_abs();
        // Rounded up. The soft core divides 64-bit numbers with a library function, which `div_ceil` would call twice.
        let quotient = twice / double;
        let half_slope = quotient + u64::from(quotient * double < twice);
        half_slope.min(u64::from(range.div_ceil(64))) + 2
    };
    let biases = [bias([b.y - a.y, c.y - a.y]), bias([b.x - a.x, c.x - a.x])];
    biases.map(|bias| u16::try_from(bias).unwrap_or(u16::MAX))
}

/// Twice the area of a triangle on the screen, in 2^-16 square pixels, positive if its vertices are clockwise.
fn doubled_area([a, b, c]: [&ScreenVertex; 3]) -> i64 {
    determinant([b.x - a.x, c.x - a.x], [b.y - a.y, c.y - a.y])
}

fn determinant([a, b]: [i32; 2], [c, d]: [i32; 2]) -> i64 {
    i64::from(a) * i64::from(d) - i64::from(b) * i64::from(c)
}

/// The line of an edge; `None` if the edge is outside of the view volume. `biases` are the largest biases of the faces at the edge.
fn segment(frame: &MeshSetup, ends: [&Corner; 2], biases: Biases) -> Option<Segment> {
    let [a, b] = if let [(_, Projected::Visible(a)), (_, Projected::Visible(b))] = ends {
        [*a, *b]
    } else {
        clipped_edge(frame, ends)?
    };
    let x_major = (b.x - a.x).abs() >= (b.y - a.y).abs();
    let [row_major, column_major] = biases;
    Some(Segment {
        ends: [a, b],
        colour: EDGE_COLOUR,
        depth: LineDepth::Tested {
            bias: if x_major { column_major } else { row_major },
        },
    })
}

/// The screen positions of the ends of an edge after clipping to the view volume.
///
/// Not inlined, so that other edges do not load this code into the instruction cache.
#[inline(never)]
fn clipped_edge(frame: &MeshSetup, ends: [&Corner; 2]) -> Option<[ScreenVertex; 2]> {
    let ends = clip_edge(frame, ends.map(|(end, _)| transform(frame, *end)))?;
    Some(ends.map(|end| snap(frame, &end)))
}
