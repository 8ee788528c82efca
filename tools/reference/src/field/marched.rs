//! Pictures of the model's raymarcher as [`metrics`](super::metrics) takes them, and what each ray cost.

use glint_model::march::{self, Setup, State};

use super::metrics::{self, Expected, Outcome};
use super::{Face, Field};
use crate::camera::{Camera, Size};

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
pub fn picture(setup: &Setup, eye: usize) -> Vec<Marched> {
    pixels(setup)
        .map(|(x, y)| {
            let ray = setup.ray(eye, x, y);
            marched(setup, &ray, &setup.march(&ray))
        })
        .collect()
}

/// The end of one ray.
pub fn marched(setup: &Setup, ray: &march::Ray, end: &march::Outcome) -> Marched {
    let (outcome, coded) = match end.state {
        State::Miss => (Outcome::Miss, None),
        State::Undecided => (Outcome::Undecided, None),
        State::Hit(surface) => {
            let axis = usize::from(surface.axis);
            let positive = surface.positive;
            let mut normal = [0.0; 3];
            normal[axis] = if positive { 1.0 } else { -1.0 };
            let hit = Outcome::Hit {
                t: depth(setup, ray, end.t),
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

/// The depth in world units at which a ray ends for its length, surface or not.
pub fn reach(setup: &Setup, ray: &march::Ray) -> f64 {
    depth(setup, ray, setup.tuning.far)
}

/// The depth at t in world units.
fn depth(setup: &Setup, ray: &march::Ray, t: u32) -> f64 {
    let units = setup.depth_of(ray, t) as f64 * (-21.0 - f64::from(setup.exponent)).exp2();
    units / setup.scale.to_num::<f64>()
}

/// What the reference shows of the picture of a camera that has no more digits than a view, as far as the model's rays reach.
pub fn expected(setup: &Setup, field: &Field, camera: &Camera) -> Vec<Expected> {
    let size = Size {
        width: setup.width,
        height: setup.height,
    };
    let rays = pixels(setup).map(|(x, y)| setup.ray(0, x, y));
    let reaches: Vec<f64> = rays.map(|ray| reach(setup, &ray)).collect();
    let farthest = reaches.iter().copied().fold(0.0, f64::max);
    let limits = (camera.near, farthest);
    let mut picture = metrics::expected(field, size, limits, |pixel| camera.ray(pixel, size));
    for (pixel, reach) in picture.iter_mut().zip(reaches) {
        pixel.hit = pixel.hit.filter(|hit| hit.t <= reach);
    }
    picture
}

/// All pixels, row by row.
fn pixels(setup: &Setup) -> impl Iterator<Item = (u32, u32)> {
    let width = setup.width;
    (0..setup.height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

impl From<&glint_core::field::Field> for Field {
    /// The solid with the numbers as they are.
    ///
    /// # Panics
    /// For a field that there is no reference of.
    fn from(scene: &glint_core::field::Field) -> Self {
        use glint_core::field::Field as Scene;
        match *scene {
            Scene::Menger { depth } => Self::Menger {
                depth: depth.into(),
            },
            Scene::Box { half } => Self::Box {
                half: half.map(|x| x.to_num()),
            },
            Scene::Cubes { period, half } => Self::Cubes {
                period: period.to_num(),
                half: half.to_num(),
            },
            Scene::Planes { half } => Self::Planes {
                half: half.to_num(),
            },
            _ => unimplemented!("a reference of {scene}"),
        }
    }
}
