//! Signed distances from points to solids. A signed distance is negative inside the solid; outside, it is at most the true
//! distance to the surface.
//!
//! Distances to flat solids (with plane faces) are in the maximum norm, distances to balls in the Euclidean norm. The signed
//! distances of two points differ by at most the points' Euclidean distance. So the ball about a point with the signed distance
//! as radius does not intersect the solid.

use super::{Field, Plane};
use crate::camera::{Vector, dot, length, subtract};

impl Field {
    /// Returns the signed distance of the point `p` from the solid, in world units.
    ///
    /// For [`Field::SmoothUnion`] it is min(a, b) − h²k/4, with h = max(k − |a − b|, 0)/k and the signed distances a and b of
    /// the two members.
    pub fn distance(&self, p: Vector) -> f64 {
        match self {
            Self::Menger { depth } => {
                let (folded, unit) = fold(*depth, p);
                box_distance([0.5; 3], folded) * unit
            }
            Self::Box { half } => box_distance(*half, p),
            Self::Convex(planes) => planes
                .iter()
                .map(|plane| plane.distance(p))
                .fold(f64::NEG_INFINITY, f64::max),
            Self::Spheres(spheres) => spheres
                .iter()
                .map(|sphere| length(subtract(p, sphere.centre)) - sphere.radius)
                .fold(f64::INFINITY, f64::min),
            Self::Cone { radius, height } => {
                let from_axis = p[0].hypot(p[1]);
                let below_apex = height / 2.0 - p[2];
                let beside = (from_axis * height - below_apex * radius) / radius.hypot(*height);
                beside.max(-height / 2.0 - p[2])
            }
            Self::Lattice { period, radius } => length(about_nearest(*period, p)) - radius,
            Self::Boxes { period, half } => box_distance(*half, about_nearest(*period, p)),
            Self::Planes { half } => half - p[2].abs(),
            Self::Union(a, b) => a.distance(p).min(b.distance(p)),
            Self::SmoothUnion { k, a, b } => smooth_minimum(*k, a.distance(p), b.distance(p)),
        }
    }
}

impl Plane {
    /// Returns the signed distance of a point from the plane, in the maximum norm: the scalar product minus the offset, divided
    /// by the sum of the magnitudes of the normal's components. Within a cube of half side r about the point, the scalar product
    /// changes by up to r times this sum.
    fn distance(&self, p: Vector) -> f64 {
        let sum: f64 = self.normal.iter().map(|part| part.abs()).sum();
        (dot(self.normal, p) - self.offset) / sum
    }
}

/// Returns the signed distance of a point from a box about the origin, in the maximum norm. `half` contains half of the box's side length
/// along each axis.
fn box_distance(half: Vector, p: Vector) -> f64 {
    let beyond = |axis: usize| p[axis].abs() - half[axis];
    beyond(0).max(beyond(1)).max(beyond(2))
}

/// Returns the position of a point relative to the nearest lattice point, whose coordinates are integer multiples of the period.
fn about_nearest(period: f64, p: Vector) -> Vector {
    p.map(|c| c - (c / period).round() * period)
}

/// Returns the smooth minimum of `a` and `b`, by a quadratic polynomial
/// where they differ by less than `k` (I. Quilez, "smooth minimum").
fn smooth_minimum(k: f64, a: f64, b: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k / 4.0
}

/// Maps a point by reflections and shifts that move the centre of the nearest cube of the sponge's last level to the origin.
/// Returns the mapped point, in units of that cube's side, and the cube's side in world units.
///
/// Each level divides a cube into 27 cubes of side s, with centres at coordinates 0 and ±s. The point is mirrored to positive coordinates.
/// Then the centre of the corner cube at (s, s, s) becomes the origin and each axis is reversed, which moves the middle of the divided cube
/// to (s, s, s). An edge cube is in the middle along one axis. Of the three edge cubes, only the cube in the middle along the axis of the
/// largest coordinate can be nearest. This coordinate is therefore mirrored or shifted, which moves the centre of this edge cube or of the
/// corner cube, whichever is nearer, to the origin. The cubes in the middle along two or three axes are holes. Each step (a fold) keeps
/// lengths on either side of a plane and is continuous across the plane. So the mapped point's distance changes by at most the movement of
/// the original point.
fn fold(depth: u32, p: Vector) -> (Vector, f64) {
    let side = 3f64.powi(depth as i32);
    let mut p = p.map(|c| c * side / 2.0);
    for level in (0..depth).rev() {
        let s = 3f64.powi(level as i32);
        p = p.map(|c| s - c.abs());
        let largest = (0..3).fold(0, |best, axis| if p[axis] > p[best] { axis } else { best });
        p[largest] = (p[largest] - s / 2.0).abs() - s / 2.0;
    }
    (p, 2.0 / side)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raymarch::Sphere;

    #[test]
    fn the_sponge_has_its_holes() {
        let sponge = Field::Menger { depth: 2 };
        let close = |p, expected: f64| (sponge.distance(p) - expected).abs() < 1e-12;
        assert!(close([0.0; 3], 1.0 / 3.0));
        assert!(close([2.0, 0.0, 0.0], 1.0));
        assert!(close([-1.5, 3.0, 0.2], 2.0));
        // The middle of a small tunnel, and the middle of a small cube of the sponge beside this tunnel.
        assert!(close([2.0 / 3.0, 1.0, 2.0 / 3.0], 1.0 / 9.0));
        assert!(close([8.0 / 9.0, 8.0 / 9.0, 8.0 / 9.0], -1.0 / 9.0));
    }

    #[test]
    fn each_kind_has_its_distance() {
        let half = [1.0, 2.0, 3.0];
        let block = Field::Box { half };
        assert_eq!(block.distance([4.0, 4.0, 0.0]), 3.0);
        assert_eq!(block.distance([0.5, 0.0, 0.0]), -0.5);
        let (period, radius) = (2.0, 0.25);
        let lattice = Field::Lattice { period, radius };
        assert_eq!(lattice.distance([4.0, -2.75, 10.0]), 0.5);
        let half = [0.25, 0.5, f64::INFINITY];
        let pillars = Field::Boxes { period, half };
        assert_eq!(pillars.distance([4.5, -2.25, 10.0]), 0.25);
        assert_eq!(pillars.distance([4.75, -2.75, 9.0]), 0.5);
        let planes = Field::Planes { half: 1.5 };
        assert_eq!(planes.distance([9.0, 9.0, -1.0]), 0.5);
        assert_eq!(planes.distance([0.0, 0.0, 2.0]), -0.5);
        let either = Field::Union(Box::new(block.clone()), Box::new(lattice));
        assert_eq!(either.distance([4.0, 0.0, 0.0]), -0.25);
        assert_eq!(either.distance([0.0; 3]), -1.0);
    }

    #[test]
    fn a_smooth_union_is_fuller_by_a_quarter_of_k_where_both_are_equally_far() {
        let ball = |x| {
            let centre = [x, 0.0, 0.0];
            Box::new(Field::Spheres(vec![Sphere {
                centre,
                radius: 1.0,
            }]))
        };
        let (a, b) = (ball(-2.0), ball(2.0));
        let union = Field::SmoothUnion { k: 0.5, a, b };
        assert_eq!(union.distance([0.0; 3]), 1.0 - 0.125);
        // Where the distances to the balls differ by `k`/2, the fillet has a quarter of its largest thickness.
        assert_eq!(union.distance([0.125, 0.0, 0.0]), 0.875 - 0.03125);
        assert_eq!(union.distance([-4.0, 0.0, 0.0]), 1.0);
    }
}
