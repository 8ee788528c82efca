//! The kinds of cases: a function for each, which runs the code on the case's input and states the outcome.

mod attitudes;
mod cameras;
mod console;
mod decimals;
mod fields;
mod files;
mod frames;
mod hands;
mod kernels;
mod lines;
mod matrices;
mod objects;
mod texts;
mod triangles;
mod volume;
mod wireframes;

use super::kind::Kind;

/// All kinds.
pub fn all() -> Vec<Kind> {
    [
        attitudes::kinds(),
        cameras::kinds(),
        console::kinds(),
        decimals::kinds(),
        fields::kinds(),
        files::kinds(),
        hands::kinds(),
        kernels::kinds(),
        lines::kinds(),
        matrices::kinds(),
        objects::kinds(),
        texts::kinds(),
        triangles::kinds(),
        volume::kinds(),
        wireframes::kinds(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
