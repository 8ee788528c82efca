//! Square roots of numbers x in [1, 4) with 22 fraction bits.

use fixed::types::{I8F24, U2F30};
use glint_core::root;
use micromath::F32Ext;

use crate::inverse_root::inverse_root;
use crate::kernel::Format::{Fixed, Float};
use crate::kernel::{Kernel, float, other, shipped};

/// All kernels, from fast to exact; kernels of other libraries are last.
pub const KERNELS: &[Kernel<u32, u64>] = &[
    other(
        "root_table",
        "x/√x by a table of 192 entries",
        Fixed(21),
        by_inverse::<0>,
    ),
    other(
        "root_newton",
        "x/√x, one Newton step",
        Fixed(21),
        by_inverse::<1>,
    ),
    shipped(
        "root_16",
        "x/√x, one Newton step, corrected to nearest 16 bits, of a hand's width",
        Fixed(15),
        |x| root::root(x << 8).into(),
    ),
    other("root_bits", "bit by bit, 32 bits", Fixed(15), |x| {
        bit_by_bit(x << 8).into()
    }),
    other("root_32", "u32::isqrt", Fixed(15), |x| {
        (x << 8).isqrt().into()
    }),
    shipped(
        "root_64",
        "u64::isqrt, of all lengths on the soft core",
        Fixed(31),
        |x| (u64::from(x) << 40).isqrt(),
    ),
    other("root_fixed", "fixed: U2F30::sqrt", Fixed(30), |x| {
        U2F30::from_bits(x << 8).sqrt().to_bits().into()
    }),
    other("root_cordic", "cordic: sqrt of I8F24", Fixed(24), |x| {
        let root = cordic::sqrt(I8F24::from_bits((x << 2).cast_signed()));
        root.to_bits().unsigned_abs().into()
    }),
    other(
        "root_micromath",
        "micromath: f32 sqrt",
        Float,
        float!(F32Ext::sqrt),
    ),
    other("root_libm", "libm: sqrtf", Float, float!(libm::sqrtf)),
];

/// √x as x·(1/√x), with 21 fraction bits.
fn by_inverse<const STEPS: u32>(x: u32) -> u64 {
    (u64::from(x) * u64::from(inverse_root::<STEPS>(x))) >> 32
}

/// The square root, rounded down.
#[inline(never)]
fn bit_by_bit(square: u32) -> u16 {
    let (mut rest, mut root, mut bit) = (square, 0, 1 << 30);
    // The number of iterations depends on the input, so that the compiler does not unroll the loops into sixteen copies.
    while bit > square {
        bit >>= 2;
    }
    while bit != 0 {
        let tried = root | bit;
        root >>= 1;
        if rest >= tried {
            rest -= tried;
            root |= bit;
        }
        bit >>= 2;
    }
    root as u16
}
