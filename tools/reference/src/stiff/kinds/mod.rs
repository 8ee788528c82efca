//! The kinds of cases: a function for each, which runs the code on the case's input and states the outcome.

mod cameras;
mod frames;
mod lines;
mod matrices;
mod objects;
mod volume;
mod wireframes;

use super::kind::Kind;

/// All kinds.
pub fn all() -> Vec<Kind> {
    [
        cameras::kinds(),
        lines::kinds(),
        matrices::kinds(),
        objects::kinds(),
        volume::kinds(),
        wireframes::kinds(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
