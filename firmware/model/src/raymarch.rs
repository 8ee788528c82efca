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

mod appearance;
mod blend;
mod cone;
mod field;
mod light;
mod paint;
mod ray;
mod render;
mod setup;
mod sphere;

pub use blend::{Beside, Blend};
pub use cone::{Cone, Cones, Prepass, Rays};
pub use field::{Sample, Solid, Surface};
pub use glint_core::stereo::{Stereo, Tint};
pub use light::{Light, Lights};
pub use paint::{Palette, paint};
pub use ray::{Ray, RayResult, State};
pub use render::{FieldStats, compose, render_field, rgb565};
pub use setup::{DEFAULT_TUNING, Eye, FieldOptions, FieldSetup, ROUND_TUNING, Tuning};
pub use sphere::{Ball, Balls};
