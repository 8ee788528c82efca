//! Single rays by exits, from exact places in exact directions.

use anyhow::Result;
use glint_core::field::{Field, Surface};
use glint_model::raymarch::State;
use glint_model::raymarch::exits::Exits;
use glint_vectors::rays;
use serde::Deserialize;

use crate::stiff::kind::Kind;
use crate::stiff::outcome::Outcome;

pub fn kinds() -> Vec<Kind> {
    vec![Kind::new("ray", ray)]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Input {
    field: String,
    /// The eye in 2^-12 field units.
    eye: [i32; 3],
    /// The direction D in units of 2^-27. A component of 0 counts as positive.
    direction: [i32; 3],
    /// The far limit, relative to the parameter at which the ray ends with the default far limit, in units of the parameter.
    far: Option<i64>,
}

/// The surface that a ray meets, and its parameter T in 2^-12 field units.
fn ray(input: Input) -> Result<Outcome> {
    if let Err(error) = Field::parse(&input.field) {
        anyhow::bail!("{error}");
    }
    let mut exits = rays::frame(&input.field, input.eye, input.direction);
    let end = |exits: &Exits| exits.end(&exits.cones(), &exits.ray(0, 0, 0));
    if let Some(beyond) = input.far {
        exits.far = end(&exits).t + beyond;
    }
    let end = end(&exits);
    let t = end.t >> (exits.words.parameter - 12);
    Ok(Outcome::exact(match end.state {
        State::Hit(Surface::Face { axis, positive }) => {
            let sign = if positive { '+' } else { '-' };
            format!("{sign}{} at {t}/2^12", ['x', 'y', 'z'][usize::from(axis)])
        }
        State::Hit(Surface::Octant { signs }) => format!("octant {signs:03b} at {t}/2^12"),
        State::Hit(Surface::Round { number }) => format!("sphere {number} at {t}/2^12"),
        State::Miss => "miss".into(),
        other => format!("{other:?}"),
    }))
}
