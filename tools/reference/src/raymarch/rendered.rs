//! Results of the model's rays as input of [`metrics`](super::metrics).

use glint_core::field::{FixedSpheres, Surface};
use glint_model::raymarch::{RayEnd, State};

use super::Face;
use super::metrics::RayOutcome;
use crate::camera::length;

/// Result of one ray of a picture, and its cost: the number of evaluations of the field's distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderedRay {
    /// Result of the ray. The depth of a hit (its distance along the camera's n, in world units) is computed from the ray's
    /// parameter t.
    pub outcome: RayOutcome,
    /// Depth of a hit in world units, computed from the depth code. `None` without a hit, or if the code has no depth.
    pub coded: Option<f64>,
    /// Number of evaluations of the field by the ray.
    pub steps: u32,
}

impl RenderedRay {
    /// Returns [`Self::outcome`] with the depth from the depth code, if available.
    pub fn by_code(&self) -> RayOutcome {
        match (self.outcome, self.coded) {
            (RayOutcome::Hit { face, normal, .. }, Some(t)) => RayOutcome::Hit { t, face, normal },
            (outcome, _) => outcome,
        }
    }
}

/// Converts `end`, the model's result of a ray, to an outcome. `t` is the depth of a hit in world units; `spheres` are the scene's spheres.
pub fn outcome(end: &RayEnd, t: f64, spheres: Option<&FixedSpheres>) -> RayOutcome {
    let surface = match end.state {
        State::Miss => return RayOutcome::Miss,
        State::Undecided => return RayOutcome::Undecided,
        State::Hit(surface) => surface,
    };
    let round = || {
        let place = end.normal.expect("a round surface");
        let cone = surface.number().and_then(|number| spheres?.cone(number));
        cone.map_or(place, |cone| cone.normal(place)).map(f64::from)
    };
    let (face, normal) = match surface {
        Surface::Face { axis, positive } => {
            let axis = usize::from(axis);
            let mut normal = [0.0; 3];
            normal[axis] = if positive { 1.0 } else { -1.0 };
            (Face::Axis { axis, positive }, normal)
        }
        Surface::Octant { signs } => {
            let sign = |i: usize| if signs >> i & 1 == 1 { 1.0 } else { -1.0 };
            let normal = [0, 1, 2].map(|i| sign(i) / 3.0_f64.sqrt());
            (Face::of_normal(normal), normal)
        }
        Surface::Round { .. } => (Face::Round, round()),
        Surface::Blended {
            axis,
            positive,
            share,
            ..
        } => {
            let round = round();
            let share = f64::from(share) / 256.0;
            let mut normal = round.map(|part| part / length(round) * share);
            normal[usize::from(axis)] += (1.0 - share) * if positive { 1.0 } else { -1.0 };
            (Face::Round, normal)
        }
    };
    RayOutcome::Hit { t, face, normal }
}
