//! Ranges shared by several kinds of fields, in world units.

use crate::fixed::Q32_32;

/// The largest extent of a bounded field from the origin along an axis.
pub const MAX_EXTENT: Q32_32 = Q32_32::lit("12");
/// The accepted periods of a periodic field.
pub const PERIOD: [Q32_32; 2] = [Q32_32::lit("0.25"), Q32_32::lit("16")];
/// The smallest accepted length of a solid.
pub const SMALLEST: Q32_32 = Q32_32::lit("0.01");
/// The largest number of spheres of a field.
pub const MAX_SPHERES: usize = 8;
