//! Square roots and their reciprocals by a table and Newton steps, without a division.

/// `SEED[i]` is 2^10/√x to nearest, at most 2^10 − 1, for x = 1 + (i + 1/2)/64.
static SEED: [u16; 192] = seeds();

const fn seeds() -> [u16; 192] {
    let mut table = [0; 192];
    let mut i = 0;
    while i < table.len() {
        // With x = d/128, the entry is √(2^27/d), computed as half of √(2^29/d).
        let d = 129 + 2 * i as u64;
        let root = ((1 << 29) / d).isqrt().div_ceil(2);
        table[i] = if root < 1 << 10 {
            root as u16
        } else {
            (1 << 10) - 1
        };
        i += 1;
    }
    table
}

/// Approximates y = 1/√x for x in [1, 4), by a table and `STEPS` Newton steps y·(3 − x·y²)/2. `x` has 30 fraction bits, the result has
/// 31.
///
/// The relative error is at most 4.2e-3 without a step, 2.7e-5 after one, and 4e-9 after two, limited by the 31 bits of the
/// numbers.
pub fn inverse_root<const STEPS: u32>(x: u32) -> u32 {
    let seed = SEED[((x >> 24) as usize).saturating_sub(64).min(191)];
    let mut y = u32::from(seed) << 21;
    for _ in 0..STEPS {
        let square = (u64::from(y) * u64::from(y)) >> 32;
        // The product has 28 fraction bits and is near 1, so the difference is near 2.
        let product = (square * u64::from(x)) >> 32;
        let rest = (3 << 28) - product as u32;
        y = ((u64::from(y) * u64::from(rest)) >> 29).min(1 << 31) as u32;
    }
    y
}

/// Computes the square root, rounded to nearest, at most 65535.
///
/// The root is x·(1/√x) with one Newton step. The result is at most 2 too small, and comparing its square with x corrects this
/// error.
// Not inlined, because the linker script places this function with the code of camera frames.
#[inline(never)]
pub fn root(square: u32) -> u16 {
    if square == 0 {
        return 0;
    }
    // The number as x·4^n with x in [1, 4); x has 30 fraction bits.
    let (mut x, mut shift) = (square, 14);
    while x < 1 << 30 {
        x <<= 2;
        shift += 1;
    }
    let mut root = ((u64::from(x) * u64::from(inverse_root::<1>(x))) >> 32) as u32 >> shift;
    while root < u32::from(u16::MAX) && root * root + root < square {
        root += 1;
    }
    root as u16
}
