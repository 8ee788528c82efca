//! Pictures of the model's rays by exits as input of [`metrics`](super::metrics).

use glint_model::raymarch::exits::{Beam, End, Exits, Rule};

use super::metrics::RayOutcome;
use super::rendered::{self, RenderedRay};
use crate::camera::Vector;

/// Draws the picture of one eye, row by row. Returns each ray with the number of spheres that it tested.
pub fn picture(exits: &Exits, eye: usize) -> Vec<(RenderedRay, u32)> {
    let cones = exits.cones();
    (0..exits.width * exits.height)
        .map(|i| {
            let beam = exits.ray(eye, i % exits.width, i / exits.width);
            let end = exits.end(&cones, &beam);
            let ray = RenderedRay {
                outcome: outcome(exits, &beam, &end),
                coded: None,
                steps: end.steps,
            };
            (ray, exits.meet(&cones, &beam).1)
        })
        .collect()
}

/// Converts the end of a ray to the form of the comparison.
pub fn outcome(exits: &Exits, beam: &Beam, end: &End) -> RayOutcome {
    rendered::outcome(
        &exits.seen(beam, end),
        depth(exits, end.t),
        Some(&exits.spheres),
    )
}

/// The depth along the camera's n of a ray's point at the parameter `t`, in world units.
pub fn depth(exits: &Exits, t: i64) -> f64 {
    let units = t as f64 * (-f64::from(exits.words.parameter + exits.exponent)).exp2();
    units / exits.scale.to_num::<f64>()
}

/// The largest depth of a hit by an eye's ray, in world units along the camera's n. `direction` is the ray's direction, whose component
/// along n is 1. A repeated solid ends 2^11 field units from the lower corner of the eye's cell along each axis; a surface exactly at the
/// end counts as beyond it.
pub fn reach(exits: &Exits, eye: usize, direction: Vector) -> f64 {
    let far = depth(exits, exits.far);
    let is_repeated = exits
        .solid
        .is_some_and(|solid| matches!(solid.rule, Rule::Repeated { .. }));
    if !is_repeated {
        return far;
    }
    let scale = exits.scale.to_num::<f64>();
    (0..3)
        .map(|axis| {
            let corner = exits.eyes[eye].corners[usize::from(direction[axis] < 0.0)][axis];
            (2048.0 - 1e-3 - corner as f64 / 4096.0) / (direction[axis].abs() * scale)
        })
        .fold(far, f64::min)
}
