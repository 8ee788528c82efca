//! The reciprocal of the vertex stage with fewer Newton steps.

use glint_model::triangle::reciprocal::{SEED, recip};

/// Approximates 2^47/m for a mantissa m in [2^23, 2^24) by the table of seeds and `STEPS` Newton steps, at most 2. Two steps are
/// the reciprocal in use, [`recip`]; the others are its intermediate results.
#[inline(never)]
pub fn reciprocal<const STEPS: u32>(m: u32) -> u32 {
    if STEPS == 2 {
        return recip(m);
    }
    let y0 = u32::from(SEED[(m >> 15 & 0xFF) as usize]);
    if STEPS == 0 {
        return y0 << 14;
    }
    let residue = m.wrapping_mul(y0).wrapping_neg() as i32 >> 8;
    let y1 = (y0 << 7).wrapping_add_signed((y0 as i32).wrapping_mul(residue) >> 18);
    y1.min((1 << 17) - 1) << 7
}
