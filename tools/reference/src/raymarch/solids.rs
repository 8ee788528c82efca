//! Hits of rays on a box, a convex solid or a ball from outside, and on two parallel planes from the room between them.

use super::surface::{Face, Hit, Plane, Sphere};
use crate::camera::{Ray, Vector, add_scaled, dot, length, normalised, subtract};

/// The part of a ray's line inside a box about the origin.
pub(super) struct Slabs {
    /// Parameter of the line where it enters the box.
    pub enter: f64,
    /// Parameter of the line where it leaves the box.
    pub exit: f64,
    /// Axis of the line's entry face.
    pub axis: usize,
}

impl Slabs {
    /// Computes the part of the ray's line inside the box with the half sides `half` (Kay and Kajiya 1986); `None` if the line
    /// misses the box.
    pub fn new(half: Vector, ray: &Ray) -> Option<Self> {
        let mut slabs = Self {
            enter: f64::NEG_INFINITY,
            exit: f64::INFINITY,
            axis: 0,
        };
        for (axis, h) in half.into_iter().enumerate() {
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            if d == 0.0 {
                if o.abs() >= h {
                    return None;
                }
                continue;
            }
            let (enter, exit) = ((-h * d.signum() - o) / d, (h * d.signum() - o) / d);
            if enter > slabs.enter {
                (slabs.enter, slabs.axis) = (enter, axis);
            }
            slabs.exit = slabs.exit.min(exit);
        }
        (slabs.enter < slabs.exit).then_some(slabs)
    }
}

/// Finds the hit of a ray on a box about the origin, from the parameter `t_min` on.
pub(super) fn box_hit(half: Vector, ray: &Ray, t_min: f64) -> Option<Hit> {
    let slabs = Slabs::new(half, ray)?;
    if slabs.enter >= t_min {
        Some(Hit::entered(slabs.enter, slabs.axis, ray.direction))
    } else {
        (slabs.exit > t_min).then(|| Hit::inside(t_min))
    }
}

/// Finds the hit of a ray on the intersection of the half-spaces behind the planes (Cyrus and Beck 1978).
pub(super) fn convex_hit(planes: &[Plane], ray: &Ray, t_min: f64) -> Option<Hit> {
    let (mut enter, mut exit, mut normal) = (f64::NEG_INFINITY, f64::INFINITY, [0.0; 3]);
    for plane in planes {
        let above = dot(plane.normal, ray.origin) - plane.offset;
        let speed = dot(plane.normal, ray.direction);
        if speed == 0.0 {
            if above >= 0.0 {
                return None;
            }
            continue;
        }
        let t = -above / speed;
        if speed > 0.0 {
            exit = exit.min(t);
        } else if t > enter {
            (enter, normal) = (t, plane.normal);
        }
    }
    if enter >= exit {
        None
    } else if enter >= t_min {
        Some(Hit {
            t: enter,
            normal: normalised(normal),
            face: Face::of_normal(normal),
            member: 0,
        })
    } else {
        (exit > t_min).then(|| Hit::inside(t_min))
    }
}

/// Finds the hit of a ray on a ball about the origin.
///
/// Solves the quadratic equation without differences of nearly equal numbers, after E. Haines, J. Günther and T. Akenine-Möller,
/// "Precision improvements for ray/sphere intersection" (Ray Tracing Gems, 2019).
pub(super) fn sphere_hit(radius: f64, ray: &Ray, t_min: f64) -> Option<Hit> {
    let (o, d) = (ray.origin, ray.direction);
    let a = dot(d, d);
    let b = -dot(o, d);
    // Distance between the ball's centre and the ray's line.
    let nearest = length(add_scaled(o, d, b / a));
    if nearest >= radius {
        return None;
    }
    let q = b
        + ((radius - nearest) * (radius + nearest) * a)
            .sqrt()
            .copysign(b);
    let distance = length(o);
    let (t0, t1) = ((distance - radius) * (distance + radius) / q, q / a);
    let (enter, exit) = (t0.min(t1), t0.max(t1));
    if enter >= t_min {
        Some(Hit {
            t: enter,
            normal: normalised(ray.at(enter)),
            face: Face::Round,
            member: 0,
        })
    } else {
        (exit > t_min).then(|| Hit::inside(t_min))
    }
}

/// Finds the first hit of a ray on any of several balls.
pub(super) fn spheres_hit(spheres: &[Sphere], ray: &Ray, t_min: f64) -> Option<Hit> {
    let hits = spheres.iter().enumerate().map(|(member, sphere)| {
        let ray = Ray {
            origin: subtract(ray.origin, sphere.centre),
            direction: ray.direction,
        };
        Some(sphere_hit(sphere.radius, &ray, t_min)?.of(member))
    });
    hits.fold(None, Hit::nearer)
}

/// Finds the hit of a ray from inside a room on the floor at z = −half or the ceiling at z = half.
pub(super) fn planes_hit(half: f64, ray: &Ray, t_min: f64) -> Option<Hit> {
    let (o, d) = (ray.origin[2], ray.direction[2]);
    if (o + t_min * d).abs() > half {
        return Some(Hit::inside(t_min));
    }
    if d == 0.0 {
        return None;
    }
    let t = (half * d.signum() - o) / d;
    Some(Hit::entered(t.max(t_min), 2, ray.direction))
}
