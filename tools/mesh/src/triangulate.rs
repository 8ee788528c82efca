//! Triangulation of polygons.
//!
//! Ear clipping that always gives n − 2 triangles and uses every corner, so that a closed mesh
//! stays closed: without a collinear corner, a vertex of a neighbouring face would lie in the
//! middle of an edge.

mod tree;

use crate::polygons::{Corner, Face, Polygons, Vector};
use std::collections::VecDeque;
use tree::{Point, Tree, area};

/// Buffers that are reused for each face.
#[derive(Default)]
pub struct Scratch {
    plane: Vec<Point>,
    next: Vec<usize>,
    previous: Vec<usize>,
    is_ear: Vec<bool>,
    /// Queue of ears. It may also contain corners that are no longer ears.
    ears: VecDeque<usize>,
    tree: Tree,
    triangles: Vec<[Corner; 3]>,
    /// Whether the last face intersects itself, so that its triangles overlap.
    pub crosses: bool,
}

/// Overlapping area above which a polygon counts as self-intersecting, as a fraction of the square
/// around the polygon. A smaller overlap is a rounding error.
const OVERLAP: f64 = 1e-6;
/// Area of a polygon below which its normal is only rounding error, as a fraction of the square around the polygon.
const NO_AREA: f64 = 1e-12;

/// Vector perpendicular to a triangle; its length is twice the triangle's area. The corners are
/// counter-clockwise as seen from the side to which it points.
pub fn area_vector([a, b, c]: [Vector; 3]) -> Vector {
    cross(sub(b, a), sub(c, a))
}

/// The difference of two vectors.
pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The cross product.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The scalar product.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector of length 1 in the direction of `v`; `None` for a zero vector and for infinite or NaN
/// components. The result is also correct for very short and very long vectors.
pub fn unit(v: Vector) -> Option<Vector> {
    let largest = v.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    if largest == 0.0 || v.iter().any(|c| !c.is_finite()) {
        return None;
    }
    let v = v.map(|c| c / largest);
    let length = dot(v, v).sqrt();
    Some(v.map(|c| c / length))
}

/// Cuts a face into triangles that have the face's winding.
pub fn face<'a>(polygons: &Polygons, face: &Face, scratch: &'a mut Scratch) -> &'a [[Corner; 3]] {
    let corners = polygons.corners_of(face);
    scratch.triangles.clear();
    scratch.crosses = false;
    if let &[a, b, c] = corners {
        scratch.triangles.push([a, b, c]);
    } else {
        let square = project(polygons, corners, &mut scratch.plane);
        let reversed = clip_ears(corners, scratch);
        scratch.crosses = reversed > OVERLAP * square;
    }
    &scratch.triangles
}

/// Projects a polygon along the axis nearest to its normal (Newell's method), so that it is counter-clockwise in `plane`. Returns the
/// area of the square around the polygon.
fn project(polygons: &Polygons, corners: &[Corner], plane: &mut Vec<Point>) -> f64 {
    let origin = corners
        .first()
        .map_or([0.0; 3], |&corner| polygons.point(corner));
    let local = |corner: &Corner| sub(polygons.point(*corner), origin);
    let mut normal = [0.0; 3];
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let (a, b) = (local(a), local(b));
        for (i, sum) in normal.iter_mut().enumerate() {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            *sum += (a[j] - b[j]) * (a[k] + b[k]);
        }
    }
    let (mut low, mut high) = ([0.0_f64; 3], [0.0_f64; 3]);
    for point in corners.iter().map(local) {
        for (i, c) in point.into_iter().enumerate() {
            low[i] = low[i].min(c);
            high[i] = high[i].max(c);
        }
    }
    let extent = sub(high, low);
    let square = extent.iter().fold(0.0_f64, |m, c| m.max(*c)).powi(2);
    // The area vectors of a self-intersecting polygon can cancel out. The axis of the shortest
    // extent is then nearest to its normal.
    let cancels = normal.iter().all(|c| c.abs() <= NO_AREA * square);
    let length = if cancels {
        extent.map(|c| -c)
    } else {
        normal.map(f64::abs)
    };
    let axis = (0..3)
        .max_by(|&i, &j| length[i].total_cmp(&length[j]))
        .unwrap_or(0);
    let (x, y) = if normal[axis] >= 0.0 {
        ((axis + 1) % 3, (axis + 2) % 3)
    } else {
        ((axis + 2) % 3, (axis + 1) % 3)
    };
    plane.clear();
    plane.extend(corners.iter().map(|corner| {
        let p = local(corner);
        [p[x], p[y]]
    }));
    square
}

/// Clips one ear after the other. The ears wait in a queue, and clipping an ear updates only its
/// two neighbours. If a self-intersecting polygon has no ears left, an arbitrary corner is clipped.
/// Returns twice the area of the clockwise triangles; only a self-intersecting polygon has such
/// triangles.
fn clip_ears(corners: &[Corner], scratch: &mut Scratch) -> f64 {
    let n = corners.len();
    scratch.next.clear();
    scratch.next.extend((1..n).chain([0]));
    scratch.previous.clear();
    scratch.previous.extend([n - 1].into_iter().chain(0..n - 1));
    scratch.tree.fill(&scratch.plane);
    scratch.is_ear.clear();
    scratch.ears.clear();
    for i in 0..n {
        let ear = is_ear(scratch, i);
        scratch.is_ear.push(ear);
        scratch.ears.extend(ear.then_some(i));
    }
    let mut at = 0;
    let mut reversed = 0.0;
    for _ in 3..=n {
        at = next_ear(scratch).unwrap_or(at);
        let (before, after) = (scratch.previous[at], scratch.next[at]);
        let [a, b, c] = [before, at, after].map(|i| scratch.plane[i]);
        reversed += (-area(a, b, c)).max(0.0);
        scratch
            .triangles
            .push([corners[before], corners[at], corners[after]]);
        scratch.next[before] = after;
        scratch.previous[after] = before;
        scratch.is_ear[at] = false;
        scratch.tree.remove(at);
        for i in [before, after] {
            let ear = is_ear(scratch, i);
            if ear && !scratch.is_ear[i] {
                scratch.ears.push_back(i);
            }
            scratch.is_ear[i] = ear;
        }
        // The next ear is not the corner `after` if possible, because the result would otherwise
        // often be a fan of narrow triangles around one corner.
        if scratch.ears.front() == Some(&after) {
            scratch.ears.rotate_left(1);
        }
        at = scratch.next[after];
    }
    reversed
}

/// Takes the next ear from the queue.
fn next_ear(scratch: &mut Scratch) -> Option<usize> {
    while let Some(corner) = scratch.ears.pop_front() {
        if scratch.is_ear[corner] {
            return Some(corner);
        }
    }
    None
}

/// Whether a corner is convex and no other corner lies in the triangle that it forms with its neighbours. Points equal to a corner of the
/// triangle are ignored, because a polygon passes the same points twice where a hole is joined to the outline.
fn is_ear(scratch: &Scratch, i: usize) -> bool {
    let corners = [scratch.previous[i], i, scratch.next[i]];
    let [a, b, c] = corners.map(|i| scratch.plane[i]);
    area(a, b, c) > 0.0 && !scratch.tree.has_point_in(&scratch.plane, &[a, b, c])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Location;

    fn polygon(points: &[Vector]) -> Polygons {
        let mut polygons = Polygons::default();
        let corners: Vec<Corner> = points
            .iter()
            .map(|&p| Corner::at(polygons.add_point(p, Location::Whole).unwrap()))
            .collect();
        polygons.add_face(&corners, None, Location::Whole).unwrap();
        polygons
    }

    /// Twice the signed area of each triangle of a polygon in the plane x, y.
    fn areas(points: &[Vector]) -> Vec<f64> {
        let polygons = polygon(points);
        face(&polygons, &polygons.faces[0], &mut Scratch::default())
            .iter()
            .map(|triangle| area_vector(triangle.map(|c| polygons.point(c)))[2])
            .collect()
    }

    #[test]
    fn concave_polygons_keep_their_area() {
        let arrow = [
            [0.0, 0.0, 0.0],
            [2.0, 1.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.5, 1.0, 0.0],
        ];
        for turn in 0..4 {
            let mut points = arrow;
            points.rotate_left(turn);
            let areas = areas(&points);
            assert!(areas.iter().all(|&a| a > 0.0), "{areas:?}");
            assert_eq!(areas.iter().sum::<f64>(), 3.0);
        }
    }

    #[test]
    fn a_polygon_that_crosses_itself_in_every_plane() {
        for axis in 0..3 {
            let points = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
            let mut points = points.map(|[x, y]| {
                let mut point = [x / 3.0; 3];
                (point[axis], point[(axis + 1) % 3]) = (x, y);
                point
            });
            let mut scratch = Scratch::default();
            for crosses in [true, false] {
                let polygons = polygon(&points);
                face(&polygons, &polygons.faces[0], &mut scratch);
                assert_eq!(scratch.crosses, crosses, "{axis}");
                points.swap(1, 2);
            }
        }
    }

    #[test]
    fn a_comb_both_ways_round_and_in_every_plane() {
        let mut comb: Vec<[f64; 2]> = vec![[20.0, -1.0], [0.0, -1.0]];
        for i in 0..10 {
            comb.extend([[2.0 * f64::from(i), 5.0], [2.0 * f64::from(i) + 1.0, 0.0]]);
        }
        comb.reverse();
        for axis in 0..3 {
            for mirrored in [false, true] {
                let points: Vec<Vector> = comb
                    .iter()
                    .map(|&[x, y]| {
                        let mut p = [0.0; 3];
                        (p[axis], p[(axis + 1) % 3]) = if mirrored { (y, x) } else { (x, y) };
                        p
                    })
                    .collect();
                let polygons = polygon(&points);
                let mut scratch = Scratch::default();
                let triangles = face(&polygons, &polygons.faces[0], &mut scratch);
                assert_eq!(triangles.len(), points.len() - 2);
                let signed: Vec<f64> = triangles
                    .iter()
                    .map(|t| area_vector(t.map(|c| polygons.point(c)))[(axis + 2) % 3])
                    .collect();
                let sign = if mirrored { -1.0 } else { 1.0 };
                assert!(signed.iter().all(|a| a * sign > 0.0), "{signed:?}");
            }
        }
    }

    #[test]
    fn collinear_corners_stay() {
        let areas = areas(&[
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [3.0, 0.0, 0.0],
            [0.0, 3.0, 0.0],
        ]);
        assert_eq!(areas.len(), 3);
        assert_eq!(areas.iter().sum::<f64>(), 9.0);
        assert!(areas.iter().all(|&a| a > 0.0), "{areas:?}");
    }

    #[test]
    fn a_hole_by_a_bridge() {
        let points = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ];
        let areas = areas(&points.map(|[x, y]| [x, y, 0.0]));
        assert_eq!(areas.iter().sum::<f64>(), 24.0);
        assert!(areas.iter().all(|&a| a >= 0.0), "{areas:?}");
    }

    /// Polygons of `n` corners in which the ears are hard to find: teeth, spikes around a centre, and a spiral.
    fn hard(n: usize) -> [(&'static str, Vec<Vector>); 3] {
        let part = |i: usize| i as f64 / n as f64;
        let teeth = (0..n - 2)
            .map(|i| {
                [
                    part(i) * 1e3,
                    if i % 2 == 0 { 0.0 } else { 1.0 + part(i) },
                    0.0,
                ]
            })
            .chain([[2e3, 9.0, 0.0], [-1e3, 9.0, 0.0]]);
        let around = |i: usize, radius: f64, turns: f64| {
            let (sin, cos) = (part(i) * turns * std::f64::consts::TAU).sin_cos();
            [radius * cos, radius * sin, 0.0]
        };
        let spikes = (0..n).map(|i| around(i, if i % 2 == 0 { 1.0 } else { 100.0 }, 1.0));
        let spiral = (0..n).map(|i| match i < n / 2 {
            true => around(i, 1.0 + part(i), 40.0),
            false => around(n - 1 - i, 1.005 + part(n - 1 - i), 40.0),
        });
        [
            ("teeth", teeth.collect()),
            ("spikes", spikes.collect()),
            ("spiral", spiral.collect()),
        ]
    }

    #[test]
    fn large_concave_polygons() {
        let n = 8192;
        for (name, points) in hard(n) {
            let areas = areas(&points);
            assert_eq!(areas.len(), n - 2, "{name}");
            let whole: f64 = (0..n)
                .map(|i| (points[i], points[(i + 1) % n]))
                .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
                .sum();
            // The triangles of a simple polygon add up to its area, and none is clockwise.
            let sum: f64 = areas.iter().map(|area| area.abs()).sum();
            assert!(
                (sum - whole.abs()).abs() < 1e-9 * sum,
                "{name}: {sum} {whole}"
            );
        }
    }

    /// The searches for corners in ears visit few nodes of the tree: 20 to 56 per corner of a
    /// polygon, in up to three searches. An exhaustive search would visit 8,000 nodes.
    #[test]
    fn the_work_of_260_polygons_of_8000_corners_is_bounded() {
        let n = 8000;
        let mut scratch = Scratch::default();
        for (name, points) in hard(n) {
            let polygons = polygon(&points);
            for _ in 0..260_usize.div_ceil(3) {
                let triangles = face(&polygons, &polygons.faces[0], &mut scratch);
                assert_eq!(triangles.len(), n - 2, "{name}");
            }
            let visited = scratch.tree.visited.take() / (260_u64.div_ceil(3) * n as u64);
            assert!(visited < 100, "{name}: {visited} nodes for a corner");
        }
    }

    #[test]
    fn degenerate_polygons_end() {
        for points in [
            vec![[0.0; 3]; 50],
            (0..50).map(|i| [f64::from(i), 0.0, 0.0]).collect(),
        ] {
            assert_eq!(areas(&points).len(), 48);
        }
        let star: Vec<Vector> = (0..5)
            .map(|i| f64::from(i) * 2.513)
            .map(|t| [t.cos(), t.sin(), 0.0])
            .collect();
        assert_eq!(areas(&star).len(), 3);
    }

    #[test]
    fn unit_of_the_smallest() {
        assert_eq!(unit([0.0; 3]), None);
        assert_eq!(unit([0.0, 1e-320, 0.0]), Some([0.0, 1.0, 0.0]));
    }
}
