//! Pictures of the model's raymarcher as [`metrics`](super::metrics) takes them, and what each ray cost.

use glint_model::march::{self, Setup, State};

use super::metrics::Outcome;
use super::{Face, Field};

/// What a ray of the model comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marched {
    /// With the depth along n in world units for its parameter, as it follows from t.
    pub outcome: Outcome,
    /// The same depth by its code, for a hit.
    pub coded: Option<f64>,
    /// Evaluations of the field.
    pub steps: u32,
}

impl Marched {
    /// [`Self::outcome`] with the depth of the code.
    pub fn by_code(&self) -> Outcome {
        match (self.outcome, self.coded) {
            (Outcome::Hit { face, normal, .. }, Some(t)) => Outcome::Hit { t, face, normal },
            (outcome, _) => outcome,
        }
    }
}

/// The picture of one eye, row by row; eye 0 is the left or the only one.
///
/// `scale` is how many field units a world unit has: [`units_per_world`].
pub fn picture(setup: &Setup, eye: usize, scale: f64) -> Vec<Marched> {
    let rows = 0..setup.height;
    rows.flat_map(|y| (0..setup.width).map(move |x| (x, y)))
        .map(|(x, y)| {
            let ray = setup.ray(eye, x, y);
            marched(setup, &ray, &setup.march(&ray), scale)
        })
        .collect()
}

/// The end of one ray.
pub fn marched(setup: &Setup, ray: &march::Ray, end: &march::Outcome, scale: f64) -> Marched {
    let (outcome, coded) = match end.state {
        State::Miss => (Outcome::Miss, None),
        State::Undecided => (Outcome::Undecided, None),
        State::Hit(surface) => {
            let axis = usize::from(surface.axis);
            let positive = surface.positive;
            let mut normal = [0.0; 3];
            normal[axis] = if positive { 1.0 } else { -1.0 };
            let depth =
                setup.depth_of(ray, end.t) as f64 * (-21.0 - f64::from(setup.exponent)).exp2();
            let hit = Outcome::Hit {
                t: depth / scale,
                face: Face::Axis { axis, positive },
                normal,
            };
            let coded = setup.world_depth.distance(setup.depth_code(ray, end.t));
            (hit, coded.map(|depth| depth.to_num()))
        }
    };
    Marched {
        outcome,
        coded,
        steps: end.steps,
    }
}

/// How many field units a world unit has.
pub fn units_per_world(field: &Field) -> f64 {
    match field {
        Field::Cubes { period, .. } => 64.0 / period,
        _ => 40.5,
    }
}
