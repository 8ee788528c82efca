//! Triangulation of polygons.
//!
//! Ear clipping that always gives n − 2 triangles and uses every corner, so that a closed mesh stays closed: dropping a
//! collinear corner would leave a neighbour's vertex in the middle of an edge.

use crate::polygons::{Corner, Face, Polygons, Vector};

/// Buffers reused for each face.
#[derive(Default)]
pub struct Scratch {
    plane: Vec<[f64; 2]>,
    next: Vec<usize>,
    previous: Vec<usize>,
    is_ear: Vec<bool>,
    triangles: Vec<[Corner; 3]>,
}

/// Vector perpendicular to a triangle, with twice its area as length. From the side it points to, the
/// corners run counter-clockwise.
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

/// Vector of length 1 in the direction of `v`; `None` for zero and for infinite or invalid vectors. Very short and
/// very long vectors work too.
pub fn unit(v: Vector) -> Option<Vector> {
    let largest = v.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
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
    if let &[a, b, c] = corners {
        scratch.triangles.push([a, b, c]);
    } else {
        project(polygons, corners, &mut scratch.plane);
        clip_ears(corners, scratch);
    }
    &scratch.triangles
}

/// Projects a polygon along the axis nearest to its normal (Newell's method), so that it runs counter-clockwise in `plane`.
fn project(polygons: &Polygons, corners: &[Corner], plane: &mut Vec<[f64; 2]>) {
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
    let axis = (0..3)
        .max_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs()))
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
}

/// Twice the signed area of a triangle in the plane.
fn area([ax, ay]: [f64; 2], [bx, by]: [f64; 2], [cx, cy]: [f64; 2]) -> f64 {
    (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
}

/// Clips one ear after the other. Which corners are ears is stored, and clipping an ear updates its two neighbours only, so the
/// time grows with the square of the number of corners. If a self-intersecting polygon has no ears left, any corner is clipped.
fn clip_ears(corners: &[Corner], scratch: &mut Scratch) {
    let n = corners.len();
    scratch.next.clear();
    scratch.next.extend((1..n).chain([0]));
    scratch.previous.clear();
    scratch.previous.extend([n - 1].into_iter().chain(0..n - 1));
    scratch.is_ear.clear();
    for i in 0..n {
        let ear = is_ear(scratch, i);
        scratch.is_ear.push(ear);
    }
    let mut at = 0;
    for left in (3..=n).rev() {
        let mut steps = 0;
        while !scratch.is_ear[at] && steps < left {
            at = scratch.next[at];
            steps += 1;
        }
        let (before, after) = (scratch.previous[at], scratch.next[at]);
        scratch
            .triangles
            .push([corners[before], corners[at], corners[after]]);
        scratch.next[before] = after;
        scratch.previous[after] = before;
        for i in [before, after] {
            scratch.is_ear[i] = is_ear(scratch, i);
        }
        // The search for the next ear skips the corner `after`. Without this the triangles would often
        // form a fan of narrow triangles around one corner.
        at = scratch.next[after];
    }
}

/// Whether a corner is convex and no other corner lies in the triangle that it forms with its neighbours.
fn is_ear(scratch: &Scratch, i: usize) -> bool {
    let (before, after) = (scratch.previous[i], scratch.next[i]);
    let [a, b, c] = [before, i, after].map(|i| scratch.plane[i]);
    if area(a, b, c) <= 0.0 {
        return false;
    }
    let mut at = scratch.next[after];
    while at != before {
        let p = scratch.plane[at];
        // Where a hole is joined to the outline, the polygon passes the same points twice, so points equal to a corner of the
        // triangle do not count.
        let shared = p == a || p == b || p == c;
        if !shared && area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0 {
            return false;
        }
        at = scratch.next[at];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Place;

    fn polygon(points: &[Vector]) -> Polygons {
        let mut polygons = Polygons::default();
        let corners: Vec<Corner> = points
            .iter()
            .map(|&p| Corner::at(polygons.add_point(p, Place::Whole).unwrap()))
            .collect();
        polygons.add_face(&corners, None, Place::Whole).unwrap();
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
