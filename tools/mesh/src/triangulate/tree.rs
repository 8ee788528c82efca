//! A k-d tree of the corners of a polygon in its plane, which finds the corners in a triangle.

/// A point of a polygon's plane.
pub type Point = [f64; 2];

/// Twice the signed area of a triangle in the plane.
pub fn area([ax, ay]: Point, [bx, by]: Point, [cx, cy]: Point) -> f64 {
    (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
}

/// Largest number of points in a leaf. The points of a leaf are tested one by one.
const LEAF: usize = 16;

/// The points of a polygon that are not clipped yet.
///
/// A node is a range of `order`, split in its middle. Its children have the numbers 2·n + 1 and 2·n + 2.
#[derive(Default)]
pub struct Tree {
    /// Indices of the points. The points of a node are contiguous.
    order: Vec<u32>,
    /// The position of each point in `order`.
    place: Vec<u32>,
    removed: Vec<bool>,
    nodes: Vec<Node>,
    /// Number of nodes visited by searches, a measure of the cost.
    #[cfg(test)]
    pub visited: std::cell::Cell<u64>,
}

#[derive(Clone, Copy, Default)]
struct Node {
    low: Point,
    high: Point,
    /// Number of remaining points.
    count: u32,
}

impl Tree {
    /// Builds the tree of all points.
    pub fn fill(&mut self, points: &[Point]) {
        self.order.clear();
        self.order.extend(0..points.len() as u32);
        self.removed.clear();
        self.removed.resize(points.len(), false);
        self.nodes.clear();
        self.split(points, 0, 0, points.len());
        self.place.clear();
        self.place.resize(points.len(), 0);
        for (place, &index) in (0..).zip(&self.order) {
            self.place[index as usize] = place;
        }
    }

    fn split(&mut self, points: &[Point], node: usize, first: usize, end: usize) {
        let part = &mut self.order[first..end];
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for &index in &*part {
            for (axis, c) in points[index as usize].into_iter().enumerate() {
                low[axis] = low[axis].min(c);
                high[axis] = high[axis].max(c);
            }
        }
        if self.nodes.len() <= node {
            self.nodes.resize(node + 1, Node::default());
        }
        let count = part.len() as u32;
        self.nodes[node] = Node { low, high, count };
        if part.len() > LEAF {
            let axis = usize::from(high[1] - low[1] > high[0] - low[0]);
            let half = part.len() / 2;
            part.select_nth_unstable_by(half, |&a, &b| {
                points[a as usize][axis].total_cmp(&points[b as usize][axis])
            });
            self.split(points, 2 * node + 1, first, first + half);
            self.split(points, 2 * node + 2, first + half, end);
        }
    }

    /// Removes a point that has been clipped.
    pub fn remove(&mut self, index: usize) {
        self.removed[index] = true;
        let place = self.place[index] as usize;
        let (mut node, mut first, mut end) = (0, 0, self.order.len());
        loop {
            self.nodes[node].count -= 1;
            if end - first <= LEAF {
                return;
            }
            let middle = first + (end - first) / 2;
            if place < middle {
                (node, end) = (2 * node + 1, middle);
            } else {
                (node, first) = (2 * node + 2, middle);
            }
        }
    }

    /// Whether a point lies in a counter-clockwise triangle or on its edge; false for points equal to a corner.
    pub fn has_point_in(&self, points: &[Point], triangle: &[Point; 3]) -> bool {
        self.search(points, triangle, 0, 0, self.order.len())
    }

    fn search(
        &self,
        points: &[Point],
        triangle: &[Point; 3],
        node: usize,
        first: usize,
        end: usize,
    ) -> bool {
        #[cfg(test)]
        self.visited.update(|visited| visited + 1);
        let Node { low, high, count } = self.nodes[node];
        let box_corners = [low, [high[0], low[1]], [low[0], high[1]], high];
        if count == 0
            || is_outside(&box_corners, triangle)
            || low == high && triangle.contains(&low)
        {
            return false;
        }
        if end - first > LEAF {
            let middle = first + (end - first) / 2;
            return self.search(points, triangle, 2 * node + 1, first, middle)
                || self.search(points, triangle, 2 * node + 2, middle, end);
        }
        self.order[first..end].iter().any(|&index| {
            let point = points[index as usize];
            !self.removed[index as usize]
                && !triangle.contains(&point)
                && edges(triangle).all(|[a, b]| area(a, b, point) >= 0.0)
        })
    }
}

fn edges(&[a, b, c]: &[Point; 3]) -> impl Iterator<Item = [Point; 2]> {
    [[a, b], [b, c], [c, a]].into_iter()
}

/// Whether a box lies on the outer side of an edge of the triangle, or outside of the triangle's bounding box.
fn is_outside(corners: &[Point; 4], triangle: &[Point; 3]) -> bool {
    let [low, .., high] = corners;
    let beside = |axis: usize| {
        triangle.iter().all(|corner| corner[axis] < low[axis])
            || triangle.iter().all(|corner| corner[axis] > high[axis])
    };
    beside(0)
        || beside(1)
        || edges(triangle).any(|[a, b]| corners.iter().all(|&corner| area(a, b, corner) < 0.0))
}
