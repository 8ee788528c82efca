//! Triangle setup: facing, bounds, edge functions and the planes of depth and light.

use core::ops::Range;

pub use crate::triangle::facing::Facing;
use crate::triangle::reciprocal::Reciprocal;
use crate::triangle::rounding::nearest;
use crate::triangle::shade::{HALF_CODE, Lit};
use crate::triangle::vertex::ScreenVertex;

/// A triangle with a positive area, its vertices clockwise on the screen (y points down).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Oriented {
    /// The vertices; vertices 1 and 2 of a front face are swapped.
    pub vertices: [ScreenVertex; 3],
    /// The doubled area a = |2A| > 0, u40 with 16 fraction bits. It is at most the area of a square that contains the
    /// triangle.
    pub doubled_area: u64,
    /// The side that the camera sees.
    pub facing: Facing,
}

impl Oriented {
    /// Computes steps 1 to 3 of the setup (docs/formats/triangle.md, "Triangle setup"); `None` for a triangle without area.
    ///
    /// A difference of two positions is s21 (at most 4095 pixels), so a product is below 2^40.
    pub fn new(vertices: [ScreenVertex; 3]) -> Option<Self> {
        let [v0, v1, v2] = vertices;
        match cross(v0, v1, v2) {
            0 => None,
            area @ 1.. => Some(Self {
                vertices,
                doubled_area: area.unsigned_abs(),
                facing: Facing::Back,
            }),
            area => Some(Self {
                vertices: [v0, v2, v1],
                doubled_area: area.unsigned_abs(),
                facing: Facing::Front,
            }),
        }
    }

    /// The indices of the vertices of a triangle by their position on the screen: first the highest vertex, or of two equally high
    /// vertices the left one, then the others clockwise.
    pub fn screen_order(vertices: &[ScreenVertex; 3]) -> [usize; 3] {
        let [a, b, c] = vertices.each_ref().map(|v| (v.y, v.x));
        let order = if a <= b && a <= c {
            [0, 1, 2]
        } else if b <= c {
            [1, 2, 0]
        } else {
            [2, 0, 1]
        };
        let [v0, v1, v2] = vertices;
        if cross(*v0, *v1, *v2) < 0 {
            let [first, second, third] = order;
            [first, third, second]
        } else {
            order
        }
    }
}

/// The signed doubled area x10·y20 − x20·y10 of a triangle, positive if its vertices are clockwise.
fn cross(v0: ScreenVertex, v1: ScreenVertex, v2: ScreenVertex) -> i64 {
    let (x10, y10) = (i64::from(v1.x - v0.x), i64::from(v1.y - v0.y));
    let (x20, y20) = (i64::from(v2.x - v0.x), i64::from(v2.y - v0.y));
    x10 * y20 - x20 * y10
}

/// Bounding rows and columns of a triangle in the picture: `left`…`right` − 1 and `top`…`bottom` − 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// The first column of the bounds.
    pub left: i32,
    /// One past the last column.
    pub right: i32,
    /// The first row of the bounds.
    pub top: i32,
    /// One past the last row.
    pub bottom: i32,
}

impl Bounds {
    /// Returns the bounds of the pixels in the picture whose centres c have min ≤ c < max in both directions, where min and max are the
    /// limits of the (clockwise) vertices; `None` if no pixel has. Also `None` for a triangle that covers no pixel, and whose limits
    /// contain at most 2×2 pixel centres, inside or outside of the picture.
    ///
    /// The upper limits are exclusive, because the top-left rule acts as if pixel centres were moved slightly to the right and, by even
    /// less, down.
    pub fn new(vertices: &[ScreenVertex; 3], width: u32, height: u32) -> Option<Self> {
        let [x, y] = [
            columns(vertices.map(|v| v.x)),
            columns(vertices.map(|v| v.y)),
        ];
        let bounds = Self {
            left: x.start.max(0),
            right: x.end.min(width as i32),
            top: y.start.max(0),
            bottom: y.end.min(height as i32),
        };
        let has_pixel = bounds.left < bounds.right && bounds.top < bounds.bottom;
        let is_tiny = x.len() <= 2 && y.len() <= 2;
        (has_pixel && !(is_tiny && covers_none(vertices, [x.start, y.start]))).then_some(bounds)
    }
}

/// Returns the range of pixel indices i, inside or outside of the picture, with min ≤ 256·i + 128 < max, where min and max are the limits
/// of the three coordinates.
fn columns([a, b, c]: [i32; 3]) -> Range<i32> {
    let first_at_or_after = |x: i32| (x + 127) >> 8;
    first_at_or_after(a.min(b).min(c))..first_at_or_after(a.max(b).max(c))
}

/// Whether a triangle covers none of 2×2 pixels; `first` is the column and row of the upper left pixel.
///
/// Not inlined, because most triangles of most meshes are larger.
#[inline(never)]
fn covers_none(&[v0, v1, v2]: &[ScreenVertex; 3], first: [i32; 2]) -> bool {
    let edges = [(v0, v1), (v1, v2), (v2, v0)].map(|(a, b)| Edge::new(a, b, first));
    let covers = |column: i64, row: i64| {
        edges.iter().all(|edge| {
            edge.start + column * i64::from(edge.step_x) + row * i64::from(edge.step_y) >= 0
        })
    };
    ![(0, 0), (1, 0), (0, 1), (1, 1)]
        .iter()
        .any(|&(column, row)| covers(column, row))
}

/// An edge function E': the value at the start pixel, and the change per pixel. A pixel is inside the edge where E' ≥ 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Edge {
    /// Value at the start pixel: E' = floor((E − bias)/256), s34. The bias is 0 for a top or left edge, otherwise 1.
    pub start: i64,
    /// Change from a pixel to the next pixel on the right, −dy, s21: positive on the left side of a triangle, negative on the right side.
    pub step_x: i32,
    /// Change from a pixel to the pixel below, dx, s21.
    pub step_y: i32,
}

impl Edge {
    /// Computes steps 4 and 5 of the setup (docs/formats/triangle.md, "Triangle setup") for the edge from `a` to `b`, with the
    /// start pixel in column i and row j.
    ///
    /// |E| < 2^20·(2047.5 + 1280 + 2047.5 + 720)·2^8, which is below 2^41.
    fn new(a: ScreenVertex, b: ScreenVertex, [i, j]: [i32; 2]) -> Self {
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let (px, py) = (256 * i + 128 - a.x, 256 * j + 128 - a.y);
        let value = i64::from(dx) * i64::from(py) - i64::from(dy) * i64::from(px);
        let top_left = dy < 0 || dy == 0 && dx > 0;
        Self {
            start: (value - i64::from(!top_left)) >> 8,
            step_x: -dy,
            step_y: dx,
        }
    }
}

/// A linear function on the screen, for depth or light: the value at the start pixel, and the change per pixel, in the accumulator's format
/// 18.14 modulo 2^32.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Plane {
    /// The value at the start pixel.
    pub start: u32,
    /// Change from a pixel to the next pixel on the right.
    pub step_x: u32,
    /// Change from a pixel to the pixel below.
    pub step_y: u32,
}

impl Plane {
    /// Computes steps 6 to 8 of the setup (docs/formats/triangle.md, "Triangle setup") for the values w0, w1, w2 of depth or light
    /// at the vertices, u18.6.
    ///
    /// A difference of values is below 2^24 and a difference of positions below 2^20, so Nx and Ny are below 2^45. Inlined, because a flat
    /// triangle needs only this call.
    #[inline(always)]
    pub(super) fn new(triangle: &Oriented, [w0, w1, w2]: [u32; 3], [i, j]: [i32; 2]) -> Self {
        let [v0, v1, v2] = triangle.vertices;
        let (x10, y10, w10) = (
            i64::from(v1.x - v0.x),
            i64::from(v1.y - v0.y),
            i64::from(w1) - i64::from(w0),
        );
        let (x20, y20, w20) = (
            i64::from(v2.x - v0.x),
            i64::from(v2.y - v0.y),
            i64::from(w2) - i64::from(w0),
        );
        let reciprocal = Reciprocal::of(triangle.doubled_area);
        let gx = gradient(w10 * y20 - w20 * y10, reciprocal);
        let gy = gradient(w20 * x10 - w10 * x20, reciprocal);
        // The sum is computed modulo 2^64, so its bits 8 to 39, which the accumulator uses, are exact.
        let (px, py) = (
            i64::from(256 * i + 128 - v0.x),
            i64::from(256 * j + 128 - v0.y),
        );
        let from_v0 = gx.wrapping_mul(px).wrapping_add(gy.wrapping_mul(py)) >> 8;
        Self {
            start: (w0 << 8).wrapping_add(from_v0 as u32),
            step_x: gx as u32,
            step_y: gy as u32,
        }
    }
}

/// One gradient of a plane: nearest(N·y·2^−(lead + 8)) for a numerator N with |N| < 2^45. The result is exact, and at most
/// 2^62.
///
/// The product N·y has 69 bits. N is therefore split into two parts, and the product with the low part is shifted before the addition.
const fn gradient(numerator: i64, Reciprocal { y, lead }: Reciprocal) -> i64 {
    let shift = lead + 8;
    let high = (numerator >> 24) * y as i64;
    let low = (numerator & 0xFF_FFFF) * y as i64;
    if shift <= 24 {
        (high << (24 - shift)) + nearest(low, shift)
    } else {
        nearest(high + (low >> 24), shift - 24)
    }
}

/// The weight of light in orthographic projection, u18.6: 2^17 codes minus half a code, so that no bit of the light is lost.
pub const WEIGHT: u32 = (1 << 23) - HALF_CODE;

/// The input of the walker, which finds the pixels of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setup {
    /// Rows and columns that contain all covered pixels.
    pub bounds: Bounds,
    /// The column of the start pixel, in the bounds and near the topmost vertex. The row of the start pixel is the
    /// first row of the bounds.
    pub start_column: i32,
    /// The edges 0→1, 1→2 and 2→0.
    pub edges: [Edge; 3],
    /// Plane of the depth accumulator.
    pub depth: Plane,
    /// Planes of red, green and blue under smooth shading: light times depth in perspective, or light times `weight` in orthographic
    /// projection.
    pub light: Option<[Plane; 3]>,
    /// The constant weight of `light` in orthographic projection, in the format of the depth accumulator.
    pub weight: Option<u32>,
    /// Whether all edge functions E' fit 32 bits everywhere in the bounds and one pixel around them.
    pub narrow: bool,
}

impl Setup {
    /// Computes steps 4 to 8 of the setup (docs/formats/triangle.md, "Triangle setup"), for a flat triangle.
    pub fn new(triangle: &Oriented, bounds: Bounds) -> Self {
        let [v0, v1, v2] = triangle.vertices;
        let topmost = if v0.y <= v1.y && v0.y <= v2.y {
            v0
        } else if v1.y <= v2.y {
            v1
        } else {
            v2
        };
        let start_column = (topmost.x >> 8).clamp(bounds.left, bounds.right - 1);
        let start = [start_column, bounds.top];
        Self {
            bounds,
            start_column,
            edges: [
                Edge::new(v0, v1, start),
                Edge::new(v1, v2, start),
                Edge::new(v2, v0, start),
            ],
            depth: Plane::new(triangle, triangle.vertices.map(|v| v.w), start),
            light: None,
            weight: None,
            narrow: narrow(&triangle.vertices),
        }
    }

    /// Column and row of the start pixel, at which edges and planes have their start values.
    pub(super) const fn start(&self) -> [i32; 2] {
        [self.start_column, self.bounds.top]
    }

    /// Computes steps 4 to 9 of the setup (docs/formats/triangle.md, "Triangle setup"), for a triangle under smooth shading. `lit`
    /// is the light of its vertices, in the order of the vertices.
    ///
    /// Not inlined, so that flat triangles do not load this code into the instruction cache.
    #[inline(never)]
    pub fn smooth(triangle: &Oriented, bounds: Bounds, lit: &[Lit; 3]) -> Self {
        let setup = Self::new(triangle, bounds);
        setup.with_light(triangle, lit, triangle.vertices.map(|v| v.w))
    }

    /// As [`smooth`](Self::smooth), but in orthographic projection: light is linear on the screen, so all vertices have the same weight.
    #[inline(never)]
    pub fn linear(triangle: &Oriented, bounds: Bounds, lit: &[Lit; 3]) -> Self {
        let setup = Self::new(triangle, bounds);
        Self {
            weight: Some((WEIGHT + HALF_CODE) << 8),
            ..setup.with_light(triangle, lit, [WEIGHT; 3])
        }
    }

    /// Adds the light planes; `w` is the weight of the light at each vertex.
    fn with_light(self, triangle: &Oriented, lit: &[Lit; 3], w: [u32; 3]) -> Self {
        let start = self.start();
        let [a, b, c] = [0, 1, 2].map(|i| lit[i].weighted(w[i]));
        let light = [0, 1, 2]
            .map(|channel| Plane::new(triangle, [a[channel], b[channel], c[channel]], start));
        Self {
            light: Some(light),
            ..self
        }
    }
}

/// Whether all edge functions fit 32 bits. An edge function E is the doubled area of the triangle formed by an edge and
/// the pixel: at most the area of the bounding box enlarged by a pixel on each side. E' = E/256 fits 32 bits if this
/// area is below 2^39.
fn narrow(vertices: &[ScreenVertex; 3]) -> bool {
    let extent = |[a, b, c]: [i32; 3]| i64::from(a.max(b).max(c) - a.min(b).min(c) + 2 * 256);
    extent(vertices.map(|v| v.x)) * extent(vertices.map(|v| v.y)) < 1 << 39
}

#[cfg(test)]
mod tests {
    use super::gradient;
    use crate::triangle::reciprocal::Reciprocal;

    #[test]
    fn gradients_equal_the_product_in_128_bits() {
        let limit = (1i64 << 45) - 1;
        let numerators = [
            0,
            1,
            -1,
            12_345,
            -(1 << 24),
            (1 << 24) - 1,
            limit / 3,
            -limit / 5,
            limit,
            -limit,
        ];
        for lead in 0..=40 {
            for area in [1u64 << lead, (1 << lead) + (1 << lead) / 3, (2 << lead) - 1] {
                let reciprocal = Reciprocal::of(area);
                for n in numerators {
                    let shift = reciprocal.lead + 8;
                    let exact =
                        (i128::from(n) * i128::from(reciprocal.y) + (1 << (shift - 1))) >> shift;
                    assert_eq!(
                        i128::from(gradient(n, reciprocal)),
                        exact,
                        "{n} over {area}"
                    );
                }
            }
        }
    }
}
