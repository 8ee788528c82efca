//! Normals of vertices, where a file has none.

use crate::polygons::Vector;
use crate::triangulate::{dot, sub, unit};

/// Sums up the normals of the faces about each point, each weighted with the angle that its face has there, so that the
/// result does not depend on how the surface is cut into triangles (Thürmer and Wüthrich, 1998).
pub struct Smooth {
    sums: Vec<Vector>,
}

impl Smooth {
    /// For as many points.
    pub fn new(points: usize) -> Self {
        Self {
            sums: vec![[0.0; 3]; points],
        }
    }

    /// Adds a triangle between three points of the given numbers and places.
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

    /// The normal at a point; `None` where its faces cancel each other out.
    pub fn at(&self, number: usize) -> Option<Vector> {
        // Angles add up to a few turns at most: less than this is rounding.
        self.sums
            .get(number)
            .copied()
            .filter(|sum| dot(*sum, *sum) > 1e-18)
            .and_then(unit)
    }
}
