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

/// Finds the hit of a ray on a cone about the z axis with the apex at z = height/2 and the base at z = −height/2.
///
/// Between the planes of apex and base, a point is in the cone where a quadratic function of the parameter is at most 0.
pub(super) fn cone_hit(radius: f64, height: f64, ray: &Ray, t_min: f64) -> Option<Hit> {
    let (d, k) = (ray.direction, radius / height);
    let q = subtract(ray.origin, [0.0, 0.0, height / 2.0]);
    // The part of the line between both planes.
    let (below, above) = match d[2] {
        0.0 if q[2] > 0.0 || q[2] < -height => return None,
        0.0 => (f64::NEG_INFINITY, f64::INFINITY),
        d => {
            let [base, apex] = [(-height - q[2]) / d, -q[2] / d];
            (base.min(apex), base.max(apex))
        }
    };
    let a = d[0] * d[0] + d[1] * d[1] - k * k * d[2] * d[2];
    // The negative zero gives a ray parallel to a generator its other solution at the correct infinity.
    let a = if a == 0.0 { -0.0 } else { a };
    let b = q[0] * d[0] + q[1] * d[1] - k * k * q[2] * d[2];
    let c = q[0] * q[0] + q[1] * q[1] - k * k * q[2] * q[2];
    // The discriminant in this form has no cancellation for rays far from the cone's outline.
    let turned = q[2] * d[0] - q[0] * d[2];
    let other = q[2] * d[1] - q[1] * d[2];
    let cross = q[0] * d[1] - q[1] * d[0];
    let square = k * k * (turned * turned + other * other) - cross * cross;
    if square < 0.0 {
        return None;
    }
    let root = -b - square.sqrt().copysign(b);
    let (t0, t1) = (root / a, c / root);
    let (first, second) = (t0.min(t1), t0.max(t1));
    // The ray is inside the double cone between the solutions, or outside of them if it is at least as steep as the cone.
    let parts = match a > 0.0 {
        true => [(first, second), (f64::INFINITY, f64::INFINITY)],
        false => [(f64::NEG_INFINITY, first), (second, f64::INFINITY)],
    };
    let (lateral, exit) = parts
        .into_iter()
        .map(|(first, second)| (first, second.min(above)))
        .find(|&(first, exit)| first.max(below) < exit)?;
    let enter = lateral.max(below);
    if exit <= t_min {
        return None;
    }
    if enter < t_min {
        return Some(Hit::inside(t_min));
    }
    if below > lateral {
        return Some(Hit::entered(enter, 2, d));
    }
    let point = ray.at(enter);
    let normal = [point[0], point[1], k * k * (height / 2.0 - point[2])];
    Some(Hit {
        t: enter,
        normal: normalised(normal),
        face: Face::Round,
        member: 0,
    })
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
