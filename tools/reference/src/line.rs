//! Exact pixels of a segment between snapped end points, by the diamond-exit rule of OpenGL and Vulkan.
//!
//! Each pixel is decided independently: it belongs to the segment if the segment intersects the open diamond |x| + |y| < 1/2 pixel about
//! the pixel's centre, and the second end point is not in the diamond. Both end points are first moved by (−ε, −ε²), which moves all end
//! points and parallel segments off the borders of diamonds. ε is so small that any smaller ε gives the same pixels.

use crate::triangle::exact::{DEPTH_STEPS, ExactDepth, SUBPIXELS, SnappedVertex};

/// Number of steps per subpixel: positions are computed in units of 2^-46 subpixel.
const STEPS: i128 = 1 << 46;
/// ε and ε² in units of 1/`STEPS`: 2^-23 and 2^-46 subpixel. Every decision is the sign of i + j·ε + k·ε² with integers i, j and k,
/// where |j|, |k| ≤ 2^22: a factor of ε is the sum of two differences of end points, of 21 bits each.
const EPSILON: [i128; 2] = [1 << 23, 1];

/// The four outward normals of a diamond's sides.
const NORMALS: [[i128; 2]; 4] = [[1, 1], [1, -1], [-1, 1], [-1, -1]];

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    /// First column and row.
    pub from: [i64; 2],
    /// Column and row after the last ones.
    pub to: [i64; 2],
}

/// A segment between two snapped end points, less than 2^20 grid steps apart in both directions.
#[derive(Clone, Copy, Debug)]
pub struct ExactSegment {
    ends: [SnappedVertex; 2],
    /// The first end point, moved by (−ε, −ε²).
    start: [i128; 2],
    /// The second end point, moved by (−ε, −ε²).
    end: [i128; 2],
    /// Vector from the first to the second end point, in grid steps.
    way: [i128; 2],
}

impl ExactSegment {
    /// Makes the segment between two end points.
    pub fn new(ends: [SnappedVertex; 2]) -> Self {
        let [from, to] = ends.map(|v| [v.x, v.y].map(i128::from));
        let moved =
            |point: [i128; 2]| [0, 1].map(|axis: usize| point[axis] * STEPS - EPSILON[axis]);
        Self {
            ends,
            start: moved(from),
            end: moved(to),
            way: [to[0] - from[0], to[1] - from[1]],
        }
    }

    /// Whether the pixel in this column and row belongs to the segment.
    pub fn leaves_diamond(&self, pixel: [i64; 2]) -> bool {
        let centre = pixel
            .map(|i| (i128::from(i) * i128::from(SUBPIXELS) + i128::from(SUBPIXELS) / 2) * STEPS);
        // Signed distance to a side of the diamond, positive inside.
        let distance = |point: [i128; 2], normal: [i128; 2]| {
            i128::from(SUBPIXELS) / 2 * STEPS
                - dot(normal, [point[0] - centre[0], point[1] - centre[1]])
        };
        if NORMALS.iter().all(|&normal| distance(self.end, normal) > 0) {
            return false;
        }
        // The open interval (low, high) of the segment's parameter within the diamond, in units of 2^-46.
        let mut low = Fraction(-STEPS, 1);
        let mut high = Fraction(2 * STEPS, 1);
        for normal in NORMALS {
            let inside = distance(self.start, normal);
            match dot(normal, self.way) {
                0 if inside <= 0 => return false,
                0 => {}
                outwards @ 1.. => high = high.lower(Fraction(inside, outwards)),
                outwards => low = low.higher(Fraction(-inside, -outwards)),
            }
        }
        low.is_below(high) && low.is_below(Fraction(STEPS, 1)) && Fraction(0, 1).is_below(high)
    }

    /// Calls `visit` for each pixel of the segment in a rectangle, in any order. Skips parts of the rectangle that the segment does not
    /// intersect.
    pub fn for_each_pixel(&self, rectangle: Rectangle, visit: &mut impl FnMut([i64; 2])) {
        let Rectangle { from, to } = rectangle;
        let size = [to[0] - from[0], to[1] - from[1]];
        if size.iter().any(|&n| n <= 0) || !self.meets(rectangle) {
            return;
        }
        if size == [1, 1] {
            if self.leaves_diamond(from) {
                visit(from);
            }
            return;
        }
        // Halves the longer side.
        let axis = usize::from(size[1] > size[0]);
        let middle = from[axis] + size[axis] / 2;
        let (mut first, mut second) = (rectangle, rectangle);
        first.to[axis] = middle;
        second.from[axis] = middle;
        self.for_each_pixel(first, visit);
        self.for_each_pixel(second, visit);
    }

    /// Whether the segment may intersect a pixel of a rectangle. If not, a side of the rectangle or the segment's line separates
    /// segment and rectangle.
    fn meets(&self, rectangle: Rectangle) -> bool {
        let [low, high] = [rectangle.from, rectangle.to]
            .map(|corner| corner.map(|i| i128::from(i) * i128::from(SUBPIXELS) * STEPS));
        let apart = [0, 1].iter().any(|&axis: &usize| {
            let (a, b) = (self.start[axis], self.end[axis]);
            a.max(b) < low[axis] || a.min(b) > high[axis]
        });
        let sides = [low, [low[0], high[1]], [high[0], low[1]], high].map(|corner| {
            let [x, y] = [corner[0] - self.start[0], corner[1] - self.start[1]];
            (self.way[0] * y - self.way[1] * x).signum()
        });
        !apart && sides.iter().any(|&side| side != sides[0] || side == 0)
    }

    /// Returns the depth at a pixel's centre, which is linear along the major axis. The major axis is horizontal if the end points differ
    /// at least as much horizontally as vertically. The end points must be at different positions.
    pub fn depth(&self, pixel: [i64; 2]) -> ExactDepth {
        let axis = usize::from(self.way[0].abs() < self.way[1].abs());
        let [from, to] = self.ends;
        let centre = i128::from(pixel[axis] * SUBPIXELS + SUBPIXELS / 2);
        let ahead = centre - i128::from([from.x, from.y][axis]);
        let sign = self.way[axis].signum();
        ExactDepth {
            numerator: sign
                * (i128::from(from.w) * self.way[axis] + i128::from(to.w - from.w) * ahead),
            denominator: sign * self.way[axis] * i128::from(DEPTH_STEPS),
        }
    }
}

/// A fraction with a positive denominator.
#[derive(Clone, Copy)]
struct Fraction(i128, i128);

impl Fraction {
    fn is_below(self, other: Self) -> bool {
        self.0 * other.1 < other.0 * self.1
    }

    fn lower(self, other: Self) -> Self {
        if other.is_below(self) { other } else { self }
    }

    fn higher(self, other: Self) -> Self {
        if self.is_below(other) { other } else { self }
    }
}

fn dot([a, b]: [i128; 2], [c, d]: [i128; 2]) -> i128 {
    a * c + b * d
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(from: [i64; 2], to: [i64; 2]) -> Vec<[i64; 2]> {
        let ends = [from, to].map(|[x, y]| SnappedVertex { x, y, w: 64 });
        let mut found = Vec::new();
        let picture = Rectangle {
            from: [0, 0],
            to: [8, 8],
        };
        ExactSegment::new(ends).for_each_pixel(picture, &mut |pixel| found.push(pixel));
        found.sort_unstable();
        found
    }

    #[test]
    fn between_centres_the_last_pixel_is_left_out() {
        assert_eq!(
            pixels([128, 128], [1152, 640]),
            [[0, 0], [1, 1], [2, 1], [3, 2]]
        );
        assert_eq!(
            pixels([1152, 640], [128, 128]),
            [[1, 1], [2, 1], [3, 2], [4, 2]]
        );
    }

    #[test]
    fn a_segment_within_a_diamond_has_no_pixel_and_one_out_of_it_has_one() {
        assert_eq!(pixels([128, 128], [128, 128]), [[0; 2]; 0]);
        assert_eq!(pixels([100, 100], [150, 150]), [[0; 2]; 0]);
        assert_eq!(pixels([100, 100], [210, 210]), [[0, 0]]);
    }

    #[test]
    fn an_end_on_the_border_counts_as_moved_to_the_left() {
        // The right corner of pixel (0, 0)'s diamond is inside, the left corner outside.
        assert_eq!(pixels([128, 128], [256, 128]), [[0; 2]; 0]);
        assert_eq!(pixels([256, 128], [300, 128]), [[0, 0]]);
        assert_eq!(pixels([128, 128], [0, 128]), [[0, 0]]);
    }
}
