//! A mesh in a field: one scale of depth codes for both (formats.md, "A mesh in a field").

use glint_core::camera::View;
use glint_core::field::Field;

use crate::depth::DepthScale;
use crate::error::RenderError;
use crate::raymarch::{FieldOptions, FieldSetup};
use crate::triangle::MeshSetup;

/// Zero low bits of km, so that K times 40.5, the field units per world unit, fits 17 bits too.
const EVEN_BITS: u32 = 7;

/// The constants of a mesh with the given radius (u.14) and of a field, with one scale of depth codes.
///
/// [`trace_frame`](crate::trace_frame) draws the mesh first, [`render_field`](crate::raymarch::render_field) the field over it.
///
/// # Errors
/// [`RenderError::Size`], [`RenderError::Eye`], and [`RenderError::Stereo`] for two eyes.
pub fn constants(
    view: &View,
    size: (u32, u32),
    radius: u32,
    field: &Field,
    options: &FieldOptions,
) -> Result<(MeshSetup, FieldSetup), RenderError> {
    if options.stereo.is_some() {
        return Err(RenderError::Stereo);
    }
    let mut frame = MeshSetup::new(view, size.0, size.1, radius)?;
    let mut setup = FieldSetup::new(field, view, size, options)?;
    let shared = shared(frame.depth, setup.world_depth);
    frame.depth = shared;
    setup.world_depth = shared;
    setup.depth = shared.times(setup.scale, setup.exponent);
    Ok((frame, setup))
}

/// The smaller K, truncated to 10 bits: no depth code of mesh or field overflows.
fn shared(a: DepthScale, b: DepthScale) -> DepthScale {
    let smaller = if (a.exponent, a.mantissa) < (b.exponent, b.mantissa) {
        a
    } else {
        b
    };
    DepthScale {
        mantissa: smaller.mantissa >> EVEN_BITS << EVEN_BITS,
        ..smaller
    }
}
