//! The kinds of cases: for each kind a function that runs the code on a case's input and states the outcome.

mod attitudes;
mod cameras;
mod console;
mod decimals;
mod fields;
mod files;
mod frames;
mod gateware;
mod gestures;
mod kernels;
mod lines;
mod matrices;
mod memory;
mod motions;
mod objects;
mod panel;
mod rays;
mod samples;
mod steering;
mod texts;
mod textures;
mod transfers;
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
        gateware::kinds(),
        gestures::kinds(),
        kernels::kinds(),
        lines::kinds(),
        matrices::kinds(),
        memory::kinds(),
        motions::kinds(),
        objects::kinds(),
        panel::kinds(),
        rays::kinds(),
        samples::kinds(),
        steering::kinds(),
        texts::kinds(),
        textures::kinds(),
        transfers::kinds(),
        triangles::kinds(),
        volume::kinds(),
        wireframes::kinds(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
