//! Sphere tracing (J. C. Hart 1996): each step along a ray is as long as the field's distance at the ray's point, because no
//! surface is nearer.

use super::{Face, Field, Hit};
use crate::camera::{Ray, Vector, length, normalised, subtract};

/// Distance from the surface at which a trace ends, in world units.
const NEAR: f64 = 1e-9;

/// Distance, in world units, from a point to the two points of a central difference for the gradient.
const STEP: f64 = 1e-6;

/// Step limit, which is sufficient unless the ray runs close and nearly parallel to a face.
const MOST_STEPS: u32 = 1 << 20;

/// Error: the trace did not end within 2^20 steps, because the ray runs close and nearly parallel to a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unconverged {
    /// Parameter of the ray at the last step.
    pub t: f64,
}

impl Field {
    /// Finds the point of [`Self::hit`] from the field's distance alone, by one method for all fields.
    ///
    /// A trace ends 1e-9 world units from the surface. So a ray that passes a surface at a smaller distance also hits, and a ray
    /// that starts on a surface hits immediately. The hit is before the surface by 1e-9 world units divided by the cosine of the
    /// angle of incidence.
    ///
    /// # Errors
    /// When the trace has not ended after 2^20 steps, because the ray runs close to a surface.
    pub fn traced(
        &self,
        origin: Vector,
        direction: Vector,
        t_min: f64,
        t_max: f64,
    ) -> Result<Option<Hit>, Unconverged> {
        let ray = Ray { origin, direction };
        let speed = length(direction);
        if self.distance(ray.at(t_min)) < -NEAR {
            return Ok(Some(Hit::inside(t_min)));
        }
        let mut t = t_min;
        for _ in 0..MOST_STEPS {
            if t > t_max {
                return Ok(None);
            }
            let point = ray.at(t);
            let distance = self.distance(point);
            if distance <= NEAR {
                let (face, normal, member) = self.surface(point);
                return Ok(Some(Hit {
                    t,
                    normal,
                    face,
                    member,
                }));
            }
            t += distance / speed;
        }
        Err(Unconverged { t })
    }

    /// Returns the face, the outward normal and the solid's part (`Hit::member`) at a point of the surface.
    pub(super) fn surface(&self, p: Vector) -> (Face, Vector, usize) {
        match self {
            Self::Menger { .. } | Self::Box { .. } | Self::Boxes { .. } | Self::Planes { .. } => {
                let slope = self.slope(p);
                let axis = (0..3).fold(0, |best, axis| {
                    if slope[axis].abs() > slope[best].abs() {
                        axis
                    } else {
                        best
                    }
                });
                let mut normal = [0.0; 3];
                normal[axis] = slope[axis].signum();
                let positive = normal[axis] > 0.0;
                (Face::Axis { axis, positive }, normal, 0)
            }
            Self::Convex(_) => {
                let normal = normalised(self.slope(p));
                (Face::of_normal(normal), normal, 0)
            }
            Self::Cone { .. } => {
                let normal = normalised(self.slope(p));
                match normal[2] < 0.0 {
                    true => (Face::of_normal(normal), normal, 0),
                    false => (Face::Round, normal, 0),
                }
            }
            Self::Lattice { .. } => (Face::Round, normalised(self.slope(p)), 0),
            Self::Spheres(spheres) => {
                let distance =
                    |i: usize| length(subtract(p, spheres[i].centre)) - spheres[i].radius;
                let member = (0..spheres.len())
                    .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
                    .unwrap_or(0);
                (Face::Round, normalised(self.slope(p)), member)
            }
            Self::Union(a, b) => {
                let member = nearer(a, b, p);
                let (face, normal, _) = [a, b][member].surface(p);
                (face, normal, member)
            }
            Self::SmoothUnion { a, b, .. } => {
                (Face::Round, normalised(self.slope(p)), nearer(a, b, p))
            }
        }
    }

    /// Computes the gradient of the field's distance at a point, by central differences.
    fn slope(&self, p: Vector) -> Vector {
        [0, 1, 2].map(|axis| {
            let beside = |step: f64| {
                let mut p = p;
                p[axis] += step;
                self.distance(p)
            };
            (beside(STEP) - beside(-STEP)) / (2.0 * STEP)
        })
    }
}

/// Returns the index of the field nearer to a point: 0 for `a`, 1 for `b`.
fn nearer(a: &Field, b: &Field, p: Vector) -> usize {
    usize::from(b.distance(p) < a.distance(p))
}
