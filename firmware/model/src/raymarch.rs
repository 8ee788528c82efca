//! The raymarcher: frames of a distance field (formats.md, "Distance fields").
//!
//! A ray's direction is scaled so that its largest component is just below 1. Distances in the maximum norm say how large a
//! cube about a point is empty, and such a ray leaves this cube exactly at its side: so a step is the whole distance, up to
//! √3 times what a Euclidean distance and a unit vector would allow.
//!
//! What is round is measured in the Euclidean norm, and then the rays are scaled so too: with spheres their Euclidean length is just
//! below 1.
//!
//! [`FieldSetup`] makes the constants of a frame, [`Ray`] is where a pixel's ray begins, [`FieldSetup::raymarch`] how it ends,
//! [`paint()`] what it shows. [`Rays`] begin farther on after a [`Cone`] for each block of pixels.

mod blend;
mod cone;
mod directions;
mod fog;
mod lights;
mod options;
mod paint;
mod palette;
mod prepass;
mod ray;
mod render;
mod setup;

pub use blend::{Beside, Blend};
pub use cone::{Cone, Rays};
pub use glint_core::stereo::{Stereo, Tint};
pub use lights::{Light, Lights};
pub use options::{DEFAULT_TUNING, FieldOptions, ROUND_TUNING, Tuning};
pub use paint::paint;
pub use palette::Palette;
pub use prepass::Cones;
pub use ray::{Ray, RayResult, State};
pub use render::{FieldStats, compose, render_field, rgb565};
pub use setup::{Eye, FieldSetup};
