//! Exact rasterization of a snapped triangle in integers: coverage by the top-left rule, and the plane of depth.
//!
//! This is the rule of Direct3D and Vulkan: a pixel is covered if its centre lies inside the triangle or on a *top* or *left*
//! edge. A top edge is exactly horizontal, with the triangle below it. A left edge is not horizontal and has the triangle to its
//! right. An edge's inner side is the side of the third vertex, so the winding does not matter.

/// Steps per pixel of the grid of snapped vertices.
pub const SUBPIXELS: i64 = 256;

/// Number of steps of a vertex's depth per depth code. Depth codes are the integer depths of pixels.
pub const DEPTH_STEPS: i64 = 64;

/// A vertex with its position snapped to the grid of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SnappedVertex {
    /// Distance to the right of the picture's left border, in steps of 1/256 pixel.
    pub x: i64,
    /// Distance below the picture's top border, in steps of 1/256 pixel.
    pub y: i64,
    /// Depth, proportional to 1/z, in steps of 1/64 depth code.
    pub w: i64,
}

/// An edge of a triangle as a linear function of the position. The function is positive on the side of the third vertex.
#[derive(Clone, Copy, Debug)]
struct Edge {
    x: i128,
    y: i128,
    dx: i128,
    dy: i128,
    /// Whether a pixel centre exactly on the edge belongs to the triangle (top-left rule).
    owns_its_line: bool,
}

impl Edge {
    /// Makes the edge from `a` to `b` of a triangle with the third vertex `opposite`, which must not lie on the edge's line.
    fn new(a: SnappedVertex, b: SnappedVertex, opposite: SnappedVertex) -> Self {
        let top = a.y == b.y && opposite.y > a.y;
        // From the upper to the lower end of the edge, a point right of the edge on the screen has a negative orientation.
        let (upper, lower) = if a.y < b.y { (a, b) } else { (b, a) };
        let left = a.y != b.y && orientation(upper, lower, opposite) < 0;
        let sign = orientation(a, b, opposite).signum();
        Self {
            x: i128::from(a.x),
            y: i128::from(a.y),
            dx: i128::from(b.x - a.x) * sign,
            dy: i128::from(b.y - a.y) * sign,
            owns_its_line: top || left,
        }
    }

    fn at(&self, x: i128, y: i128) -> i128 {
        self.dx * (y - self.y) - self.dy * (x - self.x)
    }

    fn holds(&self, x: i128, y: i128) -> bool {
        let value = self.at(x, y);
        value > 0 || (value == 0 && self.owns_its_line)
    }
}

/// Returns twice the signed area of the triangle with the vertices a, b and c. The area is positive for clockwise vertices on the
/// screen, where y points down.
fn orientation(a: SnappedVertex, b: SnappedVertex, c: SnappedVertex) -> i128 {
    let (abx, aby) = (i128::from(b.x - a.x), i128::from(b.y - a.y));
    let (acx, acy) = (i128::from(c.x - a.x), i128::from(c.y - a.y));
    abx * acy - aby * acx
}

/// A snapped triangle of nonzero area.
#[derive(Clone, Debug)]
pub struct ExactTriangle {
    vertices: [SnappedVertex; 3],
    /// The three edges; `edges[i]` is opposite to `vertices[i]`.
    edges: [Edge; 3],
    doubled_area: i128,
}

impl ExactTriangle {
    /// Makes the triangle of three snapped vertices in any order, or `None` if its area is zero.
    pub fn new(vertices: [SnappedVertex; 3]) -> Option<Self> {
        let [a, b, c] = vertices;
        let doubled_area = orientation(a, b, c).abs();
        (doubled_area != 0).then(|| Self {
            vertices,
            edges: [Edge::new(b, c, a), Edge::new(c, a, b), Edge::new(a, b, c)],
            doubled_area,
        })
    }

    /// Whether the triangle covers the pixel in this column and row.
    pub fn covers(&self, column: i64, row: i64) -> bool {
        let (x, y) = centre(column, row);
        self.edges.iter().all(|edge| edge.holds(x, y))
    }

    /// Calls `visit(column, row)` for each covered pixel of a `width` × `height` picture, row by row.
    pub fn for_each_pixel(&self, width: u32, height: u32, mut visit: impl FnMut(u32, u32)) {
        let range = |values: [i64; 3], size: u32| {
            let [a, b, c] =
                values.map(|value| value.div_euclid(SUBPIXELS).clamp(-1, i64::from(size)));
            let (first, last) = (
                a.min(b).min(c).max(0),
                a.max(b).max(c).min(i64::from(size) - 1),
            );
            first..=last
        };
        for row in range(self.vertices.map(|v| v.y), height) {
            for column in range(self.vertices.map(|v| v.x), width) {
                if self.covers(column, row) {
                    visit(column as u32, row as u32);
                }
            }
        }
    }

    /// Returns the depth at the centre of the pixel in this column and row, on the plane through the three vertices.
    pub fn depth(&self, column: i64, row: i64) -> ExactDepth {
        let (x, y) = centre(column, row);
        let weighted = |i: usize| self.edges[i].at(x, y) * i128::from(self.vertices[i].w);
        ExactDepth {
            numerator: weighted(0) + weighted(1) + weighted(2),
            denominator: self.doubled_area * i128::from(DEPTH_STEPS),
        }
    }
}

fn centre(column: i64, row: i64) -> (i128, i128) {
    let middle = |pixel: i64| i128::from(pixel * SUBPIXELS + SUBPIXELS / 2);
    (middle(column), middle(row))
}

/// A depth in depth codes, as an exact fraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExactDepth {
    pub(crate) numerator: i128,
    pub(crate) denominator: i128,
}

impl ExactDepth {
    /// Returns the depth in depth codes, rounded to f64 with a relative error below 2^-51.
    pub fn codes(&self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }

    /// Returns `code` minus this depth, in depth codes. The difference is exact before it is rounded to f64.
    pub fn error_of(&self, code: u32) -> f64 {
        (i128::from(code) * self.denominator - self.numerator) as f64 / self.denominator as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(points: [(i64, i64); 3]) -> ExactTriangle {
        ExactTriangle::new(points.map(|(x, y)| SnappedVertex { x, y, w: 64 })).expect("an area")
    }

    fn pixels(triangle: &ExactTriangle) -> Vec<(u32, u32)> {
        let mut found = Vec::new();
        triangle.for_each_pixel(8, 8, |column, row| found.push((column, row)));
        found
    }

    #[test]
    fn centres_on_top_and_left_edges_belong_and_those_on_right_and_bottom_edges_do_not() {
        // Two triangles that form the square between the centres of the pixels (0, 0) and (2, 2).
        let upper = triangle([(128, 128), (640, 128), (640, 640)]);
        let lower = triangle([(128, 128), (128, 640), (640, 640)]);
        assert_eq!(pixels(&upper), [(0, 0), (1, 0), (1, 1)]);
        assert_eq!(pixels(&lower), [(0, 1)]);
    }

    #[test]
    fn winding_and_first_vertex_do_not_matter() {
        let points = [(-300, 77), (1500, 128), (640, 1999)];
        let [a, b, c] = points;
        let expected = pixels(&triangle(points));
        assert!(expected.len() > 10);
        for order in [[b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]] {
            assert_eq!(pixels(&triangle(order)), expected);
        }
    }

    #[test]
    fn no_area_is_no_triangle() {
        let line = [(0, 0), (256, 256), (512, 512)].map(|(x, y)| SnappedVertex { x, y, w: 0 });
        assert!(ExactTriangle::new(line).is_none());
    }

    #[test]
    fn depth_is_the_plane_through_the_vertices() {
        // The depth of a vertex is 10 + column + 2·row, in depth codes.
        let vertex = |column: i64, row: i64| SnappedVertex {
            x: column * 256 + 128,
            y: row * 256 + 128,
            w: 64 * (10 + column + 2 * row),
        };
        let plane =
            ExactTriangle::new([vertex(0, 0), vertex(7, 1), vertex(2, 6)]).expect("an area");
        assert_eq!(plane.depth(3, 2).codes(), 17.0);
        assert_eq!(plane.depth(3, 2).error_of(19), 2.0);
    }
}
