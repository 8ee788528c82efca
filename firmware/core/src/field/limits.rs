//! Ranges shared by several kinds of fields, in world units.

use crate::fixed::Q32_32;

/// The largest magnitude, in world units, of a coordinate that a bounded field may reach.
pub const MAX_EXTENT: Q32_32 = Q32_32::lit("12");
/// Smallest and largest accepted period of a periodic field, in world units.
pub const PERIOD: [Q32_32; 2] = [Q32_32::lit("0.25"), Q32_32::lit("16")];
/// The smallest accepted radius, half side or other length of a solid, in world units.
pub const SMALLEST: Q32_32 = Q32_32::lit("0.01");
/// The largest number of spheres of a field.
pub const MAX_SPHERES: usize = 8;
/// The largest radius of a sphere, in field units.
pub(in crate::field) const MAX_RADIUS: i32 = 1023;

/// The largest accepted half side or radius in a field with this period: half the period minus one unit of coordinates
/// (period/2^18), so that a gap between neighbours remains after rounding.
pub fn largest_half(period: Q32_32) -> Q32_32 {
    period / 2 - Q32_32::from_bits((period.to_bits() >> 18) + 1)
}
