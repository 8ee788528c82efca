//! The constants of a frame of a field, computed once from the field, the camera and the picture's size.

use glint_core::camera::View;
use glint_core::feature::{SPHERES, STEREO};
use glint_core::field::{Field, FixedSpheres};
use glint_core::fixed::Q32_32;
use glint_core::picture::Window;
use glint_core::stereo::Tint;

use super::directions::check;
use super::exits::{Exits, Words};
use super::marching::{Marching, extent};
use super::options::FieldOptions;
use crate::depth::DepthScale;
use crate::error::{RenderError, whole_picture};

/// The constants of a frame of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldSetup {
    /// Width of the window in pixels.
    pub width: u32,
    /// Height of the window in pixels.
    pub height: u32,
    /// Field units per world unit: 2 to 256.
    pub scale: Q32_32,
    /// Exponent e, 0 to 3: D is 2^−e times the direction whose component along the camera's forward axis n is 1.
    pub exponent: u32,
    /// Scale K of depth codes (a code is K/depth), for depths in field units times 2^e.
    pub depth: DepthScale,
    /// Scale K of depth codes (a code is K/depth), for depths in world units, with which the host converts codes to distances.
    pub world_depth: DepthScale,
    /// Colours in which the two eyes are shown in stereo; `None` for one eye.
    pub stereo: Option<Tint>,
    /// The kind of the rays, with the constants of this kind.
    pub form: Form,
}

/// The kind of the rays of a field, with the constants of the solid and of the rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(
    clippy::large_enum_variant,
    reason = "without an allocator the constants cannot be boxed"
)]
pub enum Form {
    /// Rays by exits, which step from exit to exit of empty prisms.
    Exits(Exits),
    /// Marching rays, which step by distances.
    Marching(Marching),
}

impl FieldSetup {
    /// Computes the constants for a field, a camera and one of the [`SIZES`](crate::SIZES).
    ///
    /// # Errors
    /// [`RenderError::Size`] for another size, [`RenderError::Orthographic`], and [`RenderError::HalfWidth`] for a camera that is too
    /// narrow or too wide.
    pub fn new(
        field: &Field,
        view: &View,
        size: (u32, u32),
        options: &FieldOptions,
    ) -> Result<Self, RenderError> {
        Self::in_window(field, view, whole_picture(size)?, options)
    }

    /// Computes the constants for a window of a picture.
    ///
    /// # Errors
    /// As [`new`](Self::new), but for the size.
    pub(crate) fn in_window(
        field: &Field,
        view: &View,
        window: Window,
        options: &FieldOptions,
    ) -> Result<Self, RenderError> {
        check(view)?;
        let stereo = options.stereo.filter(|_| STEREO.is_built);
        let extent = match field {
            Field::Primitive(primitive) => primitive.placed().extent,
            Field::Union(union) => extent(union),
        };
        let nearest = nearest(view, extent);
        let (form, exits) = match (field, extent) {
            (Field::Union(union), Some(half)) if SPHERES.is_built && !Exits::draws(field) => {
                let tuning = options.tuning;
                let marching = Marching::new(union, half, view, window, stereo, tuning)?;
                (Form::Marching(marching), marching.entry)
            }
            _ => {
                let exits = Exits::in_window(field, view, window, stereo, Words::CHOSEN)?;
                let exits = match options.sun {
                    Some(direction) => exits.with_shadows(direction),
                    None => exits,
                };
                (Form::Exits(exits), exits)
            }
        };
        let (scale, exponent) = (exits.scale, exits.exponent);
        let near = i64::from(view.near().to_bits()) << 9;
        let world_depth = DepthScale::from_nearest(nearest.max(near));
        let [width, height] = window.size.pixels();
        Ok(Self {
            width,
            height,
            scale,
            exponent,
            depth: world_depth.times(scale, exponent),
            world_depth,
            stereo: stereo.map(|stereo| stereo.tint),
            form,
        })
    }

    /// The constants of marching rays; `None` for rays by exits.
    pub const fn marching(&self) -> Option<&Marching> {
        match &self.form {
            Form::Marching(marching) => Some(marching),
            Form::Exits(_) => None,
        }
    }

    /// The constants of rays by exits; `None` for marching rays.
    pub const fn exits(&self) -> Option<&Exits> {
        match &self.form {
            Form::Exits(exits) => Some(exits),
            Form::Marching(_) => None,
        }
    }

    /// The spheres of the field, if any.
    pub fn spheres(&self) -> Option<&FixedSpheres> {
        match &self.form {
            Form::Exits(Exits { spheres, .. }) => {
                (SPHERES.is_built && spheres.count > 0).then_some(spheres)
            }
            Form::Marching(marching) => Some(marching.spheres()),
        }
    }

    /// Whether an eye is in a solid, so that each of its rays ends at once.
    pub fn has_eye_inside(&self) -> bool {
        let eyes = if self.stereo.is_some() { 2 } else { 1 };
        (0..eyes).any(|eye| match &self.form {
            Form::Exits(exits) => exits.is_inside(eye),
            Form::Marching(marching) => marching.is_inside(eye),
        })
    }
}

/// Depth along the camera's forward axis n of the nearest corner of the bounding box, 37 fraction bits, rounded down;
/// negative for a corner behind the eye, and 0 for an unbounded field.
fn nearest(view: &View, extent: Option<[Q32_32; 3]>) -> i64 {
    extent.map_or(0, |half| -> i64 {
        (0..3)
            .map(|i| {
                let n = i64::from(view.n()[i].to_bits());
                // The products have 14 + 23 fraction bits. `reach` is enlarged slightly, because the length of n is not exactly 1.
                let place = n * (view.eye()[i].to_bits() >> 18);
                let reach = n.abs() * ((half[i].to_bits() >> 18) + 2);
                -place - reach - (reach >> 13)
            })
            .sum()
    })
}
