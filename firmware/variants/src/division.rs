//! Quotients a/b of two mantissas in [1, 2) with 23 fraction bits.

use fixed::types::I8F24;
use glint_core::gesture;

use crate::kernel::Format::{Fixed, Float};
use crate::kernel::{Kernel, other, shipped};
use crate::reciprocal::reciprocal;

/// All kernels, from fast to exact; kernels of other libraries are last.
pub const KERNELS: &[Kernel<[u32; 2], u64>] = &[
    other(
        "division_table",
        "times a reciprocal of 256 entries",
        Fixed(23),
        times::<0>,
    ),
    other(
        "division_newton",
        "times a reciprocal with one Newton step",
        Fixed(23),
        times::<1>,
    ),
    shipped(
        "division_reciprocal",
        "times the reciprocal with two Newton steps, of vertices",
        Fixed(23),
        times::<2>,
    ),
    other(
        "division_32",
        "32 bits, 8 fraction bits",
        Fixed(8),
        |[a, b]| ((a << 8) / b).into(),
    ),
    shipped(
        "division_32_twice",
        "32 bits, twice, 16 fraction bits, of a hand's place",
        Fixed(16),
        |[a, b]| gesture::quotient(a, b >> 4).into(),
    ),
    shipped(
        "division_64",
        "64 bits, 32 fraction bits, of cameras",
        Fixed(32),
        |[a, b]| ((u64::from(a) << 32) + u64::from(b / 2)) / u64::from(b),
    ),
    other(
        "division_fixed",
        "fixed: quotient of I8F24",
        Fixed(24),
        |[a, b]| {
            let [a, b] = [a, b].map(|x| I8F24::from_bits((x << 1).cast_signed()));
            u64::from((a / b).to_bits().unsigned_abs())
        },
    ),
    other("division_f32", "f32 division", Float, |[a, b]| {
        (f32::from_bits(a) / f32::from_bits(b)).to_bits().into()
    }),
];

/// Maps a phase, a number that a benchmark spreads over its range, to an input.
pub const fn input(phase: u32) -> [u32; 2] {
    [
        crate::reciprocal::input(phase.wrapping_mul(0x85EB_CA6B)),
        crate::reciprocal::input(phase),
    ]
}

fn times<const STEPS: u32>([a, b]: [u32; 2]) -> u64 {
    (u64::from(a) * u64::from(reciprocal::<STEPS>(b)) + (1 << 23)) >> 24
}
