//! Lengths of vectors of three integers, with components of at most 22 bits.

use glint_core::field;
use micromath::F32Ext;

use crate::kernel::Format::{Fixed, Float};
use crate::kernel::{Kernel, other, shipped};

/// All kernels, from fast to exact; kernels of other libraries are last.
pub const KERNELS: &[Kernel<[i32; 3], u64>] = &[
    other("length_sum", "max + 11/32·mid + 1/4·min", Fixed(0), |q| {
        let [a, b, c] = sorted(q.map(i32::unsigned_abs));
        u64::from(a + (11 * b + 8 * c) / 32)
    }),
    shipped(
        "length_table",
        "table of 512 roots, linear between them, of spheres",
        Fixed(0),
        |q| field::length(q).unsigned_abs().into(),
    ),
    shipped("length_64", "u64::isqrt of the squares", Fixed(0), |q| {
        let squares = q.map(|x| u64::from(x.unsigned_abs()).pow(2));
        squares.iter().sum::<u64>().isqrt()
    }),
    other("length_micromath", "micromath: f32 sqrt", Float, |q| {
        F32Ext::sqrt(square(q)).to_bits().into()
    }),
    other("length_libm", "libm: sqrtf", Float, |q| {
        libm::sqrtf(square(q)).to_bits().into()
    }),
];

/// Maps a phase, a number that a benchmark spreads over its range, to an input: pseudo-random directions and lengths.
pub fn input(phase: u32) -> [i32; 3] {
    let mixed = [0x85EB_CA6B, 0xC2B2_AE35, 0x27D4_EB2F_u32].map(|odd| {
        let x = phase.wrapping_mul(odd);
        (x ^ x >> 15).wrapping_mul(odd)
    });
    // The longest component has 16 to 22 bits.
    mixed.map(|x| x.cast_signed() >> (10 + phase % 7))
}

fn square(q: [i32; 3]) -> f32 {
    let [x, y, z] = q.map(|x| f32::from_bits(x.cast_unsigned()));
    x * x + y * y + z * z
}

/// Sorts three numbers, the largest first.
fn sorted([a, b, c]: [u32; 3]) -> [u32; 3] {
    let (high, low) = if a > b { (a, b) } else { (b, a) };
    let (most, middle) = if high > c { (high, c) } else { (c, high) };
    if middle > low {
        [most, middle, low]
    } else {
        [most, low, middle]
    }
}
