//! Other ways to march to the sponge than Glint's, in f64, to compare what they cost.

use super::distance::euclidean;
use super::metrics::Outcome;
use super::raymarched::RenderedRay;
use super::{Face, Field};
use crate::camera::{Ray, Vector, length};

/// How distances are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Norm {
    /// By the largest coordinate.
    Maximum,
    /// By the root of the squares.
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

/// A way to march.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// In which the sponge's distance is taken.
    pub distance: Norm,
    /// In which a ray's direction has length 1. A ray in the maximum norm goes as far as a distance in this norm allows, one
    /// in the Euclidean norm less far; Euclidean distances need the Euclidean norm.
    pub rays: Norm,
    /// A ray ends where the distance is below this, in world units, ...
    pub threshold: f64,
    /// ... and this part of the way gone.
    pub footprint: f64,
    /// The evaluations after which a ray is given up.
    pub cap: u32,
    /// Evaluations after each of which the threshold is twice as large, if ever.
    pub relax: Option<u32>,
    /// Whether the last step goes to the face, if the ray does: the distance over the direction's part along the normal.
    pub correct: bool,
}

impl Method {
    /// Marches to the sponge of a depth from a parameter of the ray on, its depth.
    ///
    /// The normal at the end is by the largest slope of the distance in the maximum norm.
    pub fn march(&self, depth: u32, ray: &Ray, start: f64) -> RenderedRay {
        let sponge = Field::Menger { depth };
        let speed = self.rays.of(ray.direction);
        let distance = |p| match self.distance {
            Norm::Maximum => sponge.distance(p),
            // What is not above 0 has no size in the other norm.
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

/// Whether a ray that is at a point goes away from the origin along an axis.
fn outward(ray: &Ray, axis: usize, p: Vector) -> bool {
    (p[axis] < 0.0) == (ray.direction[axis] < 0.0)
}

/// Where a ray comes to the cube around the sponge if it does; 0 for one that starts inside.
pub fn entry(ray: &Ray) -> f64 {
    (0..3)
        .filter(|&axis| !outward(ray, axis, ray.origin))
        .map(|axis| (ray.origin[axis].abs() - 1.0) / ray.direction[axis].abs())
        .fold(0.0, f64::max)
}

/// How a normal is found from distances beside a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taps {
    /// The point, and one beside it along each axis.
    Forward,
    /// The corners of a tetrahedron about it.
    Tetrahedron,
}

impl Taps {
    /// How many distances it takes.
    pub const COUNT: u32 = 4;

    /// The face across the axis of the largest slope, by distances `step` beside a point.
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
