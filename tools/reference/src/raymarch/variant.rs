//! Other methods to march rays to the Menger sponge, in f64, whose numbers of steps are compared with the number of Glint's method.

use super::distance::euclidean;
use super::metrics::RayOutcome;
use super::raymarched::RenderedRay;
use super::{Face, Field};
use crate::camera::{Ray, Vector, length};

/// A vector norm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Norm {
    /// Maximum norm.
    Maximum,
    /// Euclidean norm.
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

/// Number of steps after which the threshold grows.
pub const GROWTH_STEPS: u32 = 64;

/// A method to march rays to the Menger sponge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// Norm of the distance to the sponge.
    pub distance: Norm,
    /// Norm in which the length of a step equals the distance. With the norm of `distance`, steps have the maximum safe length.
    /// With distances in the maximum norm, Euclidean steps are shorter. Euclidean distances require Euclidean steps.
    pub rays: Norm,
    /// Constant part of the threshold, in world units. A ray hits where its distance from the sponge is below the threshold.
    pub threshold: f64,
    /// Increase of the threshold per unit of distance along the ray.
    pub footprint: f64,
    /// Limit of the number of steps of a ray.
    pub cap: u32,
    /// Growth factor of the threshold after each [`GROWTH_STEPS`] steps; 1 for a constant threshold.
    pub growth: f64,
    /// Whether the hit of a ray that approaches a face is moved forward onto the plane of the face. The ray's parameter grows by the
    /// remaining distance divided by the component of the ray's direction along the normal.
    pub correct: bool,
}

impl Method {
    /// Marches a ray to a sponge with `depth` levels of holes, from the ray's parameter `start`.
    ///
    /// The normal of a hit points along the axis of the largest component of the gradient of the distance in the maximum norm.
    pub fn march(&self, depth: u32, ray: &Ray, start: f64) -> RenderedRay {
        let sponge = Field::Menger { depth };
        let speed = self.rays.of(ray.direction);
        let distance = |p| match self.distance {
            Norm::Maximum => sponge.distance(p),
            // Inside the sponge the result is 0, which ends the ray like a negative distance.
            Norm::Euclidean => euclidean(depth, p).max(sponge.distance(p).min(0.0)),
        };
        let mut t = start;
        let mut steps = 0;
        let outcome = loop {
            let point = ray.at(t);
            let left = distance(point);
            steps += 1;
            if (0..3).any(|axis| point[axis].abs() > 1.0 && outward(ray, axis, point)) {
                break RayOutcome::Miss;
            }
            let grown = self.growth.powi((steps / GROWTH_STEPS) as i32);
            let threshold = (self.threshold + self.footprint * t * speed) * grown;
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
                break RayOutcome::Hit { t, face, normal };
            }
            t += step / speed;
            if steps >= self.cap {
                break RayOutcome::Undecided;
            }
        };
        RenderedRay {
            outcome,
            coded: None,
            steps,
        }
    }
}

/// Whether a ray at the point `p` moves away from the plane through the origin that is perpendicular to `axis`.
fn outward(ray: &Ray, axis: usize, p: Vector) -> bool {
    (p[axis] < 0.0) == (ray.direction[axis] < 0.0)
}

/// Returns the parameter of a ray's entry into the cube around the sponge, or 0 if the ray starts inside the cube.
pub fn entry(ray: &Ray) -> f64 {
    (0..3)
        .filter(|&axis| !outward(ray, axis, ray.origin))
        .map(|axis| (ray.origin[axis].abs() - 1.0) / ray.direction[axis].abs())
        .fold(0.0, f64::max)
}

/// Sample points of the distance for an estimate of the normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taps {
    /// The point itself, and a neighbour along each axis.
    Forward,
    /// The corners of a tetrahedron around the point.
    Tetrahedron,
}

impl Taps {
    /// Number of distance evaluations per normal.
    pub const COUNT: u32 = 4;

    /// Estimates the face at the point `p`, perpendicular to the axis of the gradient's largest component. The gradient is
    /// estimated from the distances of points whose coordinates differ from `p` by `step`, in world units.
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
