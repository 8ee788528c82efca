//! Vectors of three integers.

use crate::root::inverse_root;

/// Normalises a vector given in any unit; the result is in units of 2^−`BITS`. `None` for the zero vector. `BITS` is at most 30.
///
/// The error of each component is at most 0.501 units, plus 2^−29 for vectors with components of 2^31 or more, which lose bits. A
/// component of the result is at most 1 in magnitude.
///
/// The vector times a reciprocal y of its length s has the length s·y, which is 1 within 2.7e-5. With ε = 1 − (s·y)², the
/// correction factor 1 + ε/2 + 3·ε²/8 leaves an error of 5/16·ε³, less than 2^−44.
pub fn unit<const BITS: u32>(vector: [i64; 3]) -> Option<[i32; 3]> {
    let magnitudes = vector.map(i64::unsigned_abs);
    let [a, b, c] = magnitudes;
    if a | b | c == 0 {
        return None;
    }
    // The components are scaled so that the largest has 31 bits; the sum of their squares is then 2^60 to 3·2^62.
    let up = (a | b | c).leading_zeros();
    let scaled = magnitudes.map(|x| ((x << up) >> 33) as u32);
    let square: u64 = scaled.map(|x| u64::from(x).pow(2)).iter().sum();
    // The product of `scaled` and `inverse` has 62 fraction bits.
    let inverse = if square >> 62 == 0 {
        inverse_root::<1>((square >> 30) as u32).saturating_mul(2)
    } else {
        inverse_root::<1>((square >> 32) as u32)
    };
    // (s·y)² with 60 fraction bits, too small by less than 3 units.
    let [high, low] = halves(square);
    let [upper, lower] = halves(u64::from(inverse).pow(2));
    let found = high * upper + ((high * lower) >> 32) + ((low * upper) >> 32);
    // ε/2 with 46 fraction bits is below 2^31, and its square with 60 bits below 2^30.
    let half_error = (((1 << 60) - found.cast_signed()) >> 15) as i32;
    let second = ((i64::from(half_error) * i64::from(half_error)) >> 32) as u32;
    let factor = half_error + ((3 * second) >> 15) as i32;
    let scale = |x: u32| {
        let [whole, fraction] = halves(u64::from(x << 1) * u64::from(inverse));
        // `whole` has 31 fraction bits, its correction 45.
        let more = ((whole.cast_signed() * i64::from(factor)) >> 32) as i32;
        let more = (more + (fraction >> 18) as i32) >> 14;
        let scaled = (whole as u32).wrapping_add_signed(more);
        ((scaled + (1 << (30 - BITS))) >> (31 - BITS)) as i32
    };
    Some([0, 1, 2].map(|i| {
        let x = scale(scaled[i]);
        if vector[i] < 0 { -x } else { x }
    }))
}

/// The high and the low word of a number.
const fn halves(x: u64) -> [u64; 2] {
    [x >> 32, x & 0xFFFF_FFFF]
}

/// Computes a × b. The components of `a` and `b` are at most 2^30 in magnitude, so the components of the result are at most 2^61.
pub fn cross(a: [i32; 3], b: [i32; 3]) -> [i64; 3] {
    let product = |i: usize, j: usize| i64::from(a[i]) * i64::from(b[j]);
    [[1, 2], [2, 0], [0, 1]].map(|[i, j]| product(i, j) - product(j, i))
}

/// Computes a·b. The components of `a` and `b` are at most 2^30 in magnitude, so the result is below 2^62.
pub fn dot(a: [i32; 3], b: [i32; 3]) -> i64 {
    core::iter::zip(a, b)
        .map(|(a, b)| i64::from(a) * i64::from(b))
        .sum()
}
