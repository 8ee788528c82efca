//! Normalisation of vectors of three integers to length 1, with at most 30 fraction bits. Inputs are as in [`crate::length`].

use glint_core::vector;
use micromath::F32Ext;

use crate::inverse_root::inverse_root;
use crate::kernel::Format::{Fixed, Float};
use crate::kernel::{Kernel, other, shipped};

/// All kernels, from fast to exact; kernels of other libraries are last.
pub const KERNELS: &[Kernel<[i32; 3], [i32; 3]>] = &[
    other(
        "unit_32",
        "14 fraction bits, in 32 bits",
        Fixed(14),
        unit_32::<14>,
    ),
    other(
        "unit_newton_1",
        "192 entries, one Newton step",
        Fixed(30),
        by_inverse::<1>,
    ),
    other(
        "unit_newton_2",
        "192 entries, two Newton steps",
        Fixed(30),
        by_inverse::<2>,
    ),
    shipped(
        "unit_14",
        "192 entries, one Newton step, two terms, 14 fraction bits, of normals",
        Fixed(14),
        corrected::<14>,
    ),
    shipped(
        "unit_30",
        "192 entries, one Newton step, two terms, 30 fraction bits, of cameras",
        Fixed(30),
        corrected::<30>,
    ),
    other(
        "unit_divided_14",
        "14 fraction bits, 64-bit division",
        Fixed(14),
        divided::<14>,
    ),
    other(
        "unit_divided_30",
        "30 fraction bits, 64-bit division",
        Fixed(30),
        divided::<30>,
    ),
    other("unit_micromath", "micromath: f32 invsqrt", Float, |q| {
        float(q, F32Ext::invsqrt)
    }),
    other("unit_libm", "libm: sqrtf, one f32 division", Float, |q| {
        float(q, |square| 1.0 / libm::sqrtf(square))
    }),
];

fn corrected<const BITS: u32>(q: [i32; 3]) -> [i32; 3] {
    vector::unit::<BITS>(q.map(i64::from)).unwrap_or_default()
}

/// Scales to `BITS` fraction bits, at most 30, by a root and three quotients of 64 bits, rounded to nearest. The zero vector stays
/// unchanged.
fn divided<const BITS: u32>(q: [i32; 3]) -> [i32; 3] {
    let size = q.map(i32::unsigned_abs);
    let Some(lead) = (size[0] | size[1] | size[2]).checked_ilog2() else {
        return q;
    };
    // The largest component gets 31 bits, and the sum of the squares has at most 64 bits.
    let size = size.map(|x| u64::from(x) << 31 >> (lead + 1));
    let length = size.map(|x| x * x).iter().sum::<u64>().isqrt();
    [0, 1, 2].map(|i| {
        let quotient = (((size[i] << (BITS + 1)) / length + 1) >> 1) as i32;
        if q[i] < 0 { -quotient } else { quotient }
    })
}

/// Scales to `BITS` fraction bits, at most 14, with products and quotients of 32 bits, rounded to nearest. The zero vector stays
/// unchanged.
#[inline(always)]
pub fn unit_32<const BITS: u32>(q: [i32; 3]) -> [i32; 3] {
    let size = q.map(i32::unsigned_abs);
    let Some(lead) = (size[0] | size[1] | size[2]).checked_ilog2() else {
        return q;
    };
    // The largest component gets 15 bits, and the sum of the squares has at most 32 bits.
    let size = size.map(|x| {
        if lead < 14 {
            x << (14 - lead)
        } else {
            x >> (lead - 14)
        }
    });
    let length = (size[0] * size[0] + size[1] * size[1] + size[2] * size[2]).isqrt();
    [0, 1, 2].map(|i| {
        let quotient = (((size[i] << (BITS + 1)) / length + 1) >> 1) as i32;
        if q[i] < 0 { -quotient } else { quotient }
    })
}

/// Scales to 30 fraction bits by the reciprocal square root with `STEPS` Newton steps. The zero vector stays unchanged.
fn by_inverse<const STEPS: u32>(q: [i32; 3]) -> [i32; 3] {
    let size = q.map(i32::unsigned_abs);
    let Some(lead) = (size[0] | size[1] | size[2]).checked_ilog2() else {
        return q;
    };
    // The largest component has 30 bits, so the sum of the squares has at most 62 bits; it is written as x·4^n, where x has 22 fraction
    // bits.
    let up = 29_u32.saturating_sub(lead);
    let scaled = q.map(|x| x << up);
    let square: u64 = scaled
        .map(|x| u64::from(x.unsigned_abs()).pow(2))
        .iter()
        .sum();
    let half = square.ilog2() / 2;
    let inverse = inverse_root::<STEPS>((square >> (2 * half - 22)) as u32);
    scaled.map(|x| ((i64::from(x) * i64::from(inverse)) >> (half + 1)) as i32)
}

fn float(q: [i32; 3], inverse_root: fn(f32) -> f32) -> [i32; 3] {
    let q = q.map(|x| f32::from_bits(x.cast_unsigned()));
    let inverse = inverse_root(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
    q.map(|x| (x * inverse).to_bits().cast_signed())
}
