//! Signed distances of fields: negative inside a solid; outside, never larger than the true distance to the surface.
//!
//! Distances to flat fields are in the maximum norm, distances to round fields in the Euclidean
//! norm. From one point to another a field's distance changes by at most the Euclidean length
//! of the way, so a ball about a point whose radius is the point's distance is empty.

use super::{Field, Plane};
use crate::camera::{Vector, dot, length, subtract};

impl Field {
    /// The signed distance of a point, in world units.
    ///
    /// For [`Field::SmoothUnion`] it is min(a, b) − h²k/4, with h = max(k
    /// − |a − b|, 0)/k and the distances a and b to the two members.
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
            Self::Lattice { period, radius } => length(about_nearest(*period, p)) - radius,
            Self::Cubes { period, half } => box_distance([*half; 3], about_nearest(*period, p)),
            Self::Planes { half } => half - p[2].abs(),
            Self::Union(a, b) => a.distance(p).min(b.distance(p)),
            Self::SmoothUnion { k, a, b } => smooth_minimum(*k, a.distance(p), b.distance(p)),
        }
    }
}

impl Plane {
    /// The distance of a point to the plane in the maximum norm. Within a cube of half side
    /// r about a point, the scalar product with the normal changes by up to r times the sum
    /// of the magnitudes of the normal's components. So the distance is divided by that sum.
    fn distance(&self, p: Vector) -> f64 {
        let sum: f64 = self.normal.iter().map(|part| part.abs()).sum();
        (dot(self.normal, p) - self.offset) / sum
    }
}

/// The distance of a point to a box about the origin, in the maximum norm.
fn box_distance(half: Vector, p: Vector) -> f64 {
    let beyond = |axis: usize| p[axis].abs() - half[axis];
    beyond(0).max(beyond(1)).max(beyond(2))
}

/// The position of a point relative to the nearest point whose coordinates are all integer multiples of the period.
fn about_nearest(period: f64, p: Vector) -> Vector {
    p.map(|c| c - (c / period).round() * period)
}

/// The smooth minimum of `a` and `b` by a quadratic polynomial (I. Quilez, "smooth minimum").
fn smooth_minimum(k: f64, a: f64, b: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k / 4.0
}

/// Moves a point by reflections and shifts so that the nearest cube of the sponge's last level has its centre at the
/// origin. Returns the moved point, in units of the cube's side, and the side in world units.
///
/// At each level, 27 cubes of side s meet, with centres at 0 and ±s. The point is mirrored into the corner where all
/// coordinates are at +s. It is then expressed relative to that corner with each axis reversed, so that the middle is at s.
/// Of the cubes with one coordinate in the middle, only the one along the largest coordinate can be the nearest. The cubes
/// with two coordinates in the middle are holes of the sponge. Every step keeps lengths on each side of a fold and is
/// continuous across it. So the distance still changes by at most the length of the way.
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

/// The Euclidean distance of a point outside the sponge to its surface.
pub(super) fn euclidean(depth: u32, p: Vector) -> f64 {
    let (folded, unit) = fold(depth, p);
    length(folded.map(|c| (c.abs() - 0.5).max(0.0))) * unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raymarch::Sphere;

    #[test]
    fn the_fold_gives_the_known_euclidean_distances() {
        // Points and their distances are in units of 1/162 of the sponge's half side.
        let cases = [
            ([0.0; 3], 76.37),
            ([0.0, 0.0, 80.0], 54.0),
            ([200.0; 3], 65.82),
        ];
        for (p, expected) in cases {
            let found = 162.0 * euclidean(4, p.map(|c| c / 162.0));
            assert!((found - expected).abs() < 0.005, "{p:?}: {found}");
        }
    }

    #[test]
    fn the_sponge_has_its_holes() {
        let sponge = Field::Menger { depth: 2 };
        let close = |p, expected: f64| (sponge.distance(p) - expected).abs() < 1e-12;
        assert!(close([0.0; 3], 1.0 / 3.0));
        assert!(close([2.0, 0.0, 0.0], 1.0));
        assert!(close([-1.5, 3.0, 0.2], 2.0));
        // The middle of a small tunnel, and then the middle of the small cube beside the tunnel.
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
        let cubes = Field::Cubes { period, half: 0.25 };
        assert_eq!(cubes.distance([4.5, -2.75, 10.0]), 0.5);
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
        // Where the distances differ by half of `k`, the fillet adds a quarter of its largest thickness.
        assert_eq!(union.distance([0.125, 0.0, 0.0]), 0.875 - 0.03125);
        assert_eq!(union.distance([-4.0, 0.0, 0.0]), 1.0);
    }
}
