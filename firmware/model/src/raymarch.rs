//! The raymarcher: frames of a distance field (docs/formats/raymarch.md, "Distance fields").
//!
//! Distances are in the maximum norm: the distance at a point is half the side of an empty cube about the point. A
//! ray's direction is scaled so that its largest component is just below 1, so a step by the whole distance stays in this cube. Such a
//! step is up to √3 times as long as one with a Euclidean distance and a unit vector.
//!
//! Fields with spheres use the Euclidean norm for distances and for the length of rays, which is just below 1.
//!
//! [`Ray`] is a marching ray before its first step, and [`Marching::march`] finds its end. Only fields with fillets have marching rays:
//! [`exits`] finds the ends of all others. For both, [`FieldSetup`] has the constants of a frame, [`Tracer::trace`] finds the end of
//! a pixel's ray, and [`paint()`] computes the colour for this end.

mod blend;
mod directions;
mod end;
pub mod exits;
mod fog;
mod lights;
mod marching;
mod options;
mod paint;
mod palette;
mod ray;
mod render;
mod setup;
mod tracer;

pub use blend::{Beside, Blend};
pub use end::{RayEnd, State};
pub use glint_core::stereo::{Stereo, Tint};
pub use lights::{Light, Lights, Shine};
pub use marching::{Eye, Marching};
pub use options::{DEFAULT_TUNING, FieldOptions, ROUND_TUNING, Tuning};
pub use paint::paint;
pub use palette::Palette;
pub use ray::{ROUND_INVERSE, Ray, RayResult};
pub use render::{FieldStats, render_field, render_rows, rgb565};
pub use setup::{FieldSetup, Form};
pub use tracer::Tracer;
