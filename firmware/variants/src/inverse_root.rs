//! Reciprocal square roots 1/√x of numbers x in [1, 4) with 22 fraction bits.

use glint_core::root;
use micromath::F32Ext;

use crate::kernel::Format::{Fixed, Float};
use crate::kernel::{Kernel, float, other, shipped};

/// All kernels, from fast to exact; kernels of other libraries are last.
pub const KERNELS: &[Kernel<u32, u64>] = &[
    other(
        "inverse_root_0",
        "table of 192 entries of 10 bits",
        Fixed(31),
        |x| inverse_root::<0>(x).into(),
    ),
    other(
        "inverse_root_1",
        "192 entries, one Newton step",
        Fixed(31),
        |x| inverse_root::<1>(x).into(),
    ),
    shipped(
        "inverse_root_2",
        "192 entries, two Newton steps",
        Fixed(31),
        |x| inverse_root::<2>(x).into(),
    ),
    other(
        "inverse_root_3",
        "192 entries, three Newton steps",
        Fixed(31),
        |x| inverse_root::<3>(x).into(),
    ),
    other(
        "inverse_root_64",
        "division of 64 bits, u64::isqrt of the quotient",
        Fixed(20),
        |x| ((1_u64 << 62) / u64::from(x)).isqrt(),
    ),
    other(
        "inverse_root_micromath",
        "micromath: f32 invsqrt",
        Float,
        float!(F32Ext::invsqrt),
    ),
    other(
        "inverse_root_libm",
        "libm: sqrtf, f32 division",
        Float,
        float!(|x| 1.0 / libm::sqrtf(x)),
    ),
];

/// Maps a phase, a number that a benchmark spreads over its range, to an input.
pub const fn input(phase: u32) -> u32 {
    // Three quarters of the 24-bit numbers are in [1, 4).
    (1 << 22) + (phase >> 8) * 3 / 4
}

/// Approximates 2^31/√x for `x` with 22 fraction bits in [1, 4).
#[inline(never)]
pub fn inverse_root<const STEPS: u32>(x: u32) -> u32 {
    root::inverse_root::<STEPS>(x << 8)
}
