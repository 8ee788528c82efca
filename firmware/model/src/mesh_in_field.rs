//! A mesh in a field: one scale of depth codes for both (docs/formats/raymarch.md, "A mesh in a field").

use glint_core::camera::View;
use glint_core::field::Field;

use crate::depth::DepthScale;
use crate::error::RenderError;
use crate::raymarch::{FieldOptions, FieldSetup};
use crate::triangle::MeshSetup;

/// Number of low bits that are cleared in the mantissa of the shared scale. The conversion of the scale to depths in
/// field units multiplies it by up to 40.5 for fields without a period; with cleared bits the mantissa still fits 17 bits without
/// truncation.
const EVEN_BITS: u32 = 7;

/// Computes the constants of a mesh with the given `radius` (14 fraction bits) and of a field, with one scale of depth codes for both.
/// `options` must have one eye.
///
/// [`trace_frame`](crate::trace_frame) draws the mesh first, [`render_field`](crate::raymarch::render_field) the field over it.
///
/// # Errors
/// The errors of [`MeshSetup::new`] and [`FieldSetup::new`].
pub fn constants(
    view: &View,
    size: (u32, u32),
    radius: u32,
    field: &Field,
    options: &FieldOptions,
) -> Result<(MeshSetup, FieldSetup), RenderError> {
    let mut frame = MeshSetup::new(view, size.0, size.1, radius)?;
    let mut setup = FieldSetup::new(field, view, size, options)?;
    let shared = shared(frame.depth, setup.world_depth);
    frame.depth = shared;
    setup.world_depth = shared;
    setup.depth = shared.times(setup.scale, setup.exponent);
    Ok((frame, setup))
}

/// Returns the smaller of two scales of depth codes, with its mantissa truncated to 10 bits. With the smaller scale, the depth codes of
/// neither mesh nor field overflow.
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
