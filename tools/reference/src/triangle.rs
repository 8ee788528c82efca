//! References for the errors of the triangle engine.
//!
//! - [`exact`]: exact coverage and depth of a triangle whose vertices were snapped to the subpixel grid, in integers.
//! - [`surface`]: the visible surface of each pixel of a scene whose vertices are not snapped, and the pixels that snapping
//!   may change.
//! - [`smooth`]: errors of colours that are interpolated between the vertices of a triangle, in named scenes.

pub mod exact;
pub mod smooth;
pub mod surface;
