//! A mesh in a field: both use the same scale of depth codes (docs/formats/raymarch.md, "A mesh in a field").

use glint_core::camera::View;
use glint_core::field::Field;
use glint_core::fixed::Q32_32;
use glint_core::picture::Window;

use crate::depth::DepthScale;
use crate::error::RenderError;
use crate::raymarch::{FieldOptions, FieldSetup};
use crate::triangle::MeshSetup;
use crate::triangle::mesh_setup::Scale;

/// Computes the constants of a mesh with the given `radius` (14 fraction bits) and of a field, with one scale of depth codes for both.
/// `options` must have one eye.
///
/// [`render_field`](crate::raymarch::render_field) draws the field first, then [`draw_parts`](crate::triangle::draw_parts) draws the mesh
/// over it.
///
/// # Errors
/// The errors of [`MeshSetup::new`] and [`FieldSetup::new`].
pub fn constants(
    view: &View,
    window: Window,
    radius: u32,
    field: &Field,
    options: &FieldOptions,
) -> Result<(MeshSetup, FieldSetup), RenderError> {
    let mut frame = MeshSetup::default();
    frame.update(view, window, radius, &mut Scale::default())?;
    let mut setup = FieldSetup::in_window(field, view, window, options)?;
    let shared = shared(frame.depth, setup.world_depth, setup.scale);
    frame.depth = shared;
    setup.world_depth = shared;
    setup.depth = shared.times(setup.scale, setup.exponent);
    Ok((frame, setup))
}

/// Returns the smaller of two scales of depth codes, with which the depth codes of neither mesh nor field overflow. Its mantissa is
/// truncated so that the product with `scale` has at most 17 bits, if clearing 10 low bits suffices for this.
fn shared(a: DepthScale, b: DepthScale, scale: Q32_32) -> DepthScale {
    let smaller = if (a.exponent, a.mantissa) < (b.exponent, b.mantissa) {
        a
    } else {
        b
    };
    let cleared = cleared_bits(scale);
    DepthScale {
        mantissa: smaller.mantissa >> cleared << cleared,
        ..smaller
    }
}

/// Number of low bits to clear in a mantissa of 17 bits: the number of bits of the scale's odd factor, for example 7 for 40.5 = 81/2 and 10
/// for 45.5625 = 729/16. A product with a longer odd factor is truncated in any case.
fn cleared_bits(scale: Q32_32) -> u32 {
    let scale = scale.to_bits().unsigned_abs();
    let odd = scale.checked_shr(scale.trailing_zeros()).unwrap_or(0);
    match u64::BITS - odd.leading_zeros() {
        length @ 8..=10 => length,
        _ => 7,
    }
}
