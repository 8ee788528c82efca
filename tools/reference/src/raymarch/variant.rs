//! Variants of the march to the sponge in f64, for comparisons of cost with Glint's.

use super::distance::euclidean;
use super::metrics::Outcome;
use super::raymarched::RenderedRay;
use super::{Face, Field};
use crate::camera::{Ray, Vector, length};

/// Norm of distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Norm {
    /// Largest coordinate.
    Maximum,
    /// Square root of the sum of squares.
    Euclidean,
}

impl Norm {
    fn of(self, a: Vector) -> f64 {
        match self {
            Self::Maximum => a.iter().fold(0.0, |most, c| c.abs().max(most)),
            Self::Euclidean => length(a),
        }
    }
}

/// A variant of the march.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// Norm of the sponge's distance.
    pub distance: Norm,
    /// Norm in which a ray's direction has length 1. With the maximum norm, steps are as long as distances in that norm
    /// allow; with the Euclidean norm, they are shorter. Euclidean distances require the Euclidean norm.
    pub rays: Norm,
    /// Constant part of the threshold, in world units.
    pub threshold: f64,
    /// Growth of the threshold per unit of distance travelled.
    pub footprint: f64,
    /// Step limit.
    pub cap: u32,
    /// Number of steps after each of which the threshold doubles; `None` for a constant threshold.
    pub relax: Option<u32>,
    /// Whether the last step of an approaching ray reaches the plane of the face: the distance over the direction's
    /// component along the normal.
    pub correct: bool,
}

impl Method {
    /// Marches to the sponge of a depth, from the parameter `start` of the ray.
    ///
    /// The normal at the end is that of the largest component of the gradient, in the maximum norm.
    pub fn march(&self, depth: u32, ray: &Ray, start: f64) -> RenderedRay {
        let sponge = Field::Menger { depth };
        let speed = self.rays.of(ray.direction);
        let distance = |p| match self.distance {
            Norm::Maximum => sponge.distance(p),
            // A distance of 0 or less needs no conversion to the Euclidean norm.
            Norm::Euclidean => euclidean(depth, p).max(sponge.distance(p).min(0.0)),
        };
        let mut t = start;
        let mut steps = 0;
        let outcome = loop {
            let point = ray.at(t);
            let left = distance(point);
            steps += 1;
            if (0..3).any(|axis| point[axis].abs() > 1.0 && outward(ray, axis, point)) {
                break Outcome::Miss;
            }
            let doubled = self.relax.map_or(0, |every| steps / every);
            let threshold = (self.threshold + self.footprint * t * speed) * f64::from(1 << doubled);
            let step = left.max(0.0);
            if left < threshold {
                let (face, normal, _) = sponge.surface(point);
                t += match face {
                    Face::Axis { axis, positive }
                        if self.correct && (ray.direction[axis] < 0.0) == positive =>
                    {
                        step / ray.direction[axis].abs()
                    }
                    _ => step / speed,
                };
                break Outcome::Hit { t, face, normal };
            }
            t += step / speed;
            if steps >= self.cap {
                break Outcome::Undecided;
            }
        };
        RenderedRay {
            outcome,
            coded: None,
            steps,
            cones: 0,
        }
    }
}

/// Whether a ray at a point moves away from the origin along an axis.
fn outward(ray: &Ray, axis: usize, p: Vector) -> bool {
    (p[axis] < 0.0) == (ray.direction[axis] < 0.0)
}

/// Parameter at which a ray enters the sponge's cube; 0 for a ray that starts inside.
pub fn entry(ray: &Ray) -> f64 {
    (0..3)
        .filter(|&axis| !outward(ray, axis, ray.origin))
        .map(|axis| (ray.origin[axis].abs() - 1.0) / ray.direction[axis].abs())
        .fold(0.0, f64::max)
}

/// Method of estimating a normal from distances near a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taps {
    /// The point, and one neighbour along each axis.
    Forward,
    /// The corners of a tetrahedron about the point.
    Tetrahedron,
}

impl Taps {
    /// Number of distances per normal.
    pub const COUNT: u32 = 4;

    /// The face perpendicular to the axis of the largest gradient component, from distances at `step` from a point.
    pub fn face(self, field: &Field, p: Vector, step: f64) -> Face {
        let beside = |offset: Vector| field.distance([0, 1, 2].map(|i| p[i] + step * offset[i]));
        let slope = match self {
            Self::Forward => {
                let here = field.distance(p);
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| beside(axis) - here)
            }
            Self::Tetrahedron => {
                const CORNERS: [Vector; 4] = [
                    [1.0, -1.0, -1.0],
                    [-1.0, -1.0, 1.0],
                    [-1.0, 1.0, -1.0],
                    [1.0, 1.0, 1.0],
                ];
                let distances = CORNERS.map(beside);
                [0, 1, 2].map(|axis| (0..4).map(|i| CORNERS[i][axis] * distances[i]).sum())
            }
        };
        let axis = (0..3).fold(0, |best, axis| {
            if slope[axis].abs() > slope[best].abs() {
                axis
            } else {
                best
            }
        });
        let positive = slope[axis] > 0.0;
        Face::Axis { axis, positive }
    }
}
