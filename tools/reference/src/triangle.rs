//! References of the triangle engine.
//!
//! - [`exact`]: coverage and depth of a snapped triangle in integers.
//! - [`surface`]: the visible surface of each pixel of the unsnapped scene, and the pixels that depend on snapping.
//! - [`smooth`]: errors of light interpolated between vertices, in named scenes.

pub mod exact;
pub mod smooth;
pub mod surface;
