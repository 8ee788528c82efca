//! The raymarcher: frames of a distance field (docs/formats/raymarch.md, "Distance fields").
//!
//! Distances are in the maximum norm: the distance at a point is half the side of an empty cube about the point. A
//! ray's direction is scaled so that its largest component is just below 1, so a step by the whole distance stays in this cube. Such a
//! step is up to √3 times as long as one with a Euclidean distance and a unit vector.
//!
//! Fields with spheres use the Euclidean norm for distances and for the length of rays, which is just below 1.
//!
//! [`FieldSetup`] has the constants of a frame, [`Ray`] is a pixel's ray before its first step,
//! [`FieldSetup::march`] finds the end of the ray, and [`paint()`] computes the colour for this end.

mod blend;
mod directions;
pub mod exits;
mod fog;
mod lights;
mod options;
mod paint;
mod palette;
mod ray;
mod render;
mod setup;

pub use blend::{Beside, Blend};
pub use glint_core::stereo::{Stereo, Tint};
pub use lights::{Light, Lights};
pub use options::{DEFAULT_TUNING, FieldOptions, ROUND_TUNING, Tuning};
pub use paint::paint;
pub use palette::Palette;
pub use ray::{ROUND_INVERSE, Ray, RayResult, State};
pub use render::{FieldStats, render_field, render_rows, rgb565};
pub use setup::{Eye, FieldSetup};
