//! References for the errors of the triangle engine.
//!
//! - [`exact`]: exact coverage and depth of a triangle with vertices snapped to the subpixel grid, in integers.
//! - [`surface`]: the visible surface of each pixel of a scene with unsnapped vertices, and the pixels that snapping may change.
//! - [`smooth`]: errors of colours interpolated between a triangle's vertices, in named scenes.
//! - [`textured`]: scenes with textures, and their pixels in drawing order.

pub mod exact;
pub mod smooth;
pub mod surface;
pub mod textured;
