//! Reciprocals 1/x of mantissas x in [1, 2) with 23 fraction bits.

use fixed::types::U8F24;
use glint_model::triangle::quotient::INVERSE;
use glint_model::triangle::reciprocal::{SEED, recip};
use micromath::F32Ext;

use crate::kernel::Format::{Fixed, Float};
use crate::kernel::{Kernel, float, other, shipped};

/// All kernels, from fast to exact; kernels of other libraries are last.
pub const KERNELS: &[Kernel<u32, u64>] = &[
    other(
        "reciprocal_0",
        "table of 256 entries of 10 bits",
        Fixed(24),
        |m| reciprocal::<0>(m).into(),
    ),
    shipped(
        "reciprocal_pixel",
        "table of 1024 entries of 17 bits, of each pixel",
        Fixed(17),
        |m| INVERSE[(m >> 13 & 0x3FF) as usize].into(),
    ),
    other(
        "reciprocal_1",
        "256 entries, one Newton step",
        Fixed(24),
        |m| reciprocal::<1>(m).into(),
    ),
    shipped(
        "reciprocal_2",
        "256 entries, two Newton steps, of vertices and triangles",
        Fixed(24),
        |m| reciprocal::<2>(m).into(),
    ),
    other("reciprocal_32", "division of 32 bits", Fixed(16), |m| {
        (u32::MAX / (m >> 7)).into()
    }),
    other("reciprocal_64", "division of 64 bits", Fixed(24), |m| {
        ((1 << 47) + u64::from(m / 2)) / u64::from(m)
    }),
    other("reciprocal_fixed", "fixed: U8F24::recip", Fixed(24), |m| {
        U8F24::from_bits(m << 1).recip().to_bits().into()
    }),
    other(
        "reciprocal_micromath",
        "micromath: f32 recip",
        Float,
        float!(F32Ext::recip),
    ),
    other("reciprocal_f32", "f32 division", Float, float!(|x| 1.0 / x)),
];

/// Maps a phase, a number that a benchmark spreads over its range, to an input: a mantissa.
pub const fn input(phase: u32) -> u32 {
    1 << 23 | phase >> 9
}

/// Approximates 2^47/m for a mantissa m in [2^23, 2^24) by the table of seeds and `STEPS` Newton steps, at most 2. Two steps give the
/// reciprocal in use, [`recip`]; fewer steps give its intermediate results.
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
