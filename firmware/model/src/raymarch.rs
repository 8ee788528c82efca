//! The raymarcher: frames of a distance field (docs/formats/raymarch.md, "Distance fields").
//!
//! A ray is parametrised by depth: its direction D is not normalised. Most fields use rays *by exits*: each step advances a ray to the exit
//! of a whole empty prism ([`exits`]). Smooth and bent unions use *marching* rays: each step advances a ray by a distance
//! ([`Marching::march`]). For both kinds of rays, [`FieldSetup`] has the constants of a frame, [`Tracer::trace`] finds the end of a pixel's
//! ray, and [`paint()`] computes the pixel's colour.

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
pub(crate) use fog::{FULL, faded, product};
pub use glint_core::stereo::{Stereo, Tint};
pub use lights::{Light, Lights, Shine};
pub use marching::{MARCH_FRACTION, Marching};
pub use options::{FieldOptions, Tuning};
pub(crate) use paint::mixed;
pub use paint::paint;
pub use palette::Palette;
pub use ray::{Ray, RayResult};
pub use render::{FieldStats, render_field, render_rows};
pub use setup::{FieldSetup, Form};
pub use tracer::Tracer;
