//! Ranges that several kinds of fields share, in world units.

use crate::fixed::Q32_32;

/// The farthest from the origin that a bounded field may reach along an axis.
pub const MAX_EXTENT: Q32_32 = Q32_32::lit("12");
/// The periods of a field that repeats itself.
pub const PERIOD: [Q32_32; 2] = [Q32_32::lit("0.25"), Q32_32::lit("16")];
/// The smallest length of a solid.
pub const SMALLEST: Q32_32 = Q32_32::lit("0.01");
/// The most spheres of one field.
pub const MAX_SPHERES: usize = 8;
