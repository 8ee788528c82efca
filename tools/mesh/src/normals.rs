//! Vertex normals for mesh files without normals.

use crate::polygons::Vector;
use crate::triangulate::{dot, sub, unit};

/// Sums of the face normals at each point. Each normal is weighted with the face's angle at the point, so that the result does
/// not depend on the triangulation (Thürmer and Wüthrich, 1998).
pub struct NormalSums {
    sums: Vec<Vector>,
}

impl NormalSums {
    /// Creates sums of zero for `points` points.
    pub fn new(points: usize) -> Self {
        Self {
            sums: vec![[0.0; 3]; points],
        }
    }

    /// Adds the normal of a triangle to the sums at its points; `numbers` are the indices and
    /// `places` the positions of the points.
    pub fn add(&mut self, numbers: [usize; 3], places: [Vector; 3], normal: Vector) {
        let [a, b, c] = places;
        for (number, [a, b, c]) in numbers.into_iter().zip([[a, b, c], [b, c, a], [c, a, b]]) {
            let (Some(ab), Some(ac)) = (unit(sub(b, a)), unit(sub(c, a))) else {
                continue;
            };
            let angle = dot(ab, ac).clamp(-1.0, 1.0).acos();
            for (sum, c) in self.sums[number].iter_mut().zip(normal) {
                *sum += angle * c;
            }
        }
    }

    /// Unit normal at a point; `None` if the normals of its faces cancel out.
    pub fn at(&self, number: usize) -> Option<Vector> {
        // The weights are angles in radians. The angles at a point add up to a few full turns at most, so a sum of normals shorter than
        // 1e-9 is only rounding error.
        self.sums
            .get(number)
            .copied()
            .filter(|sum| dot(*sum, *sum) > 1e-18)
            .and_then(unit)
    }
}
