//! References for the errors of the triangle engine.
//!
//! - [`exact`]: exact coverage and depth of a snapped triangle, in integers.
//! - [`surface`]: the visible surface of each pixel of a scene before snapping, and the pixels that snapping may change.
//! - [`smooth`]: errors of colours that are interpolated between vertices, in named scenes.

pub mod exact;
pub mod smooth;
pub mod surface;
