//! Pictures of the model's rays by exits as input of [`metrics`](super::metrics).

use glint_core::field::Surface;
use glint_model::raymarch::State;
use glint_model::raymarch::exits::{Beam, End, Exits, Rule};

use super::Face;
use super::metrics::RayOutcome;
use super::raymarched::RenderedRay;
use crate::camera::Vector;

/// Draws the picture of one eye, row by row. With each ray, returns the number of tested spheres.
pub fn picture(exits: &Exits, eye: usize) -> Vec<(RenderedRay, u32)> {
    (0..exits.width * exits.height)
        .map(|i| {
            let beam = exits.ray(eye, i % exits.width, i / exits.width);
            let end = exits.follow(&beam);
            let ray = RenderedRay {
                outcome: outcome(exits, &beam, &end),
                coded: None,
                steps: end.steps,
            };
            (ray, end.tests)
        })
        .collect()
}

/// Converts the end of a ray to the form of the comparison.
pub fn outcome(exits: &Exits, beam: &Beam, end: &End) -> RayOutcome {
    let State::Hit(surface) = end.state else {
        return RayOutcome::Miss;
    };
    let sign = |is_positive| if is_positive { 1.0 } else { -1.0 };
    let (face, normal) = match surface {
        Surface::Face { axis, positive } => {
            let axis = usize::from(axis);
            let mut normal = [0.0; 3];
            normal[axis] = sign(positive);
            (Face::Axis { axis, positive }, normal)
        }
        Surface::Octant { signs } => {
            let normal = [0, 1, 2].map(|i| sign(signs >> i & 1 == 1));
            (Face::of_normal(normal), normal)
        }
        Surface::Round { .. } | Surface::Blended { .. } => {
            let normal = exits.normal(beam, end).expect("a sphere");
            (Face::Round, normal.map(|part| part as f64))
        }
    };
    RayOutcome::Hit {
        t: depth(exits, end.t),
        face,
        normal,
    }
}

/// The depth along the camera's n of a ray's point at the parameter `t`, in world units.
pub fn depth(exits: &Exits, t: i64) -> f64 {
    let units = t as f64 * (-f64::from(exits.words.parameter + exits.exponent)).exp2();
    units / exits.scale.to_num::<f64>()
}

/// Whether a point of an eye's ray is beyond the end of a repeated solid, 2^11 field units from the lower corner of the eye's cell along
/// some axis. `t` is the point's parameter. A surface at the end is beyond.
pub fn is_beyond(exits: &Exits, eye: usize, direction: Vector, t: f64) -> bool {
    let is_repeated = exits
        .solid
        .is_some_and(|solid| matches!(solid.rule, Rule::Repeated { .. }));
    let scale = exits.scale.to_num::<f64>();
    is_repeated
        && (0..3).any(|axis| {
            let corner = exits.eyes[eye].corners[usize::from(direction[axis] < 0.0)][axis];
            let place = corner as f64 / 4096.0 + direction[axis].abs() * t * scale;
            place > 2048.0 - 1e-3
        })
}
