//! Sine and cosine, computed together from one table.
//!
//! An octant of the circle has 64 equal steps; `NODES` holds both functions at the ends of the steps, the nodes (512 bytes). A
//! Taylor polynomial about the nearest node gives the values between nodes. With S and C as sine and cosine of the node, d as the
//! angle from the node in radians (at most π/512 in magnitude), e = d − d³/6 and h = d²/2:
//!
//! ```text
//! sin(node + d) = S + C·e − S·h        cos(node + d) = C − S·e − C·h
//! ```
//!
//! Other octants are mirrored onto the first one, and the signs are set at the end, so the symmetries hold bit for bit:
//! sin(−x) = −sin x, cos(−x) = cos x, sin(x + ¼) = cos x, and quarter turns are exact.
//!
//! [`sin_cos_q30_order`] offers polynomials of lower order, which take less time and have larger errors.

use crate::fixed::{Q2_30, Turns};

/// Number of steps in an octant. The table has the same number of nodes, because node 0 (sin = 0, cos = 1) is not stored.
const STEPS: u32 = 64;
/// Length of one step, in units of 2^−32 turns.
const STEP: u32 = (1 << 29) / STEPS;

/// The table of nodes: sin(k·π/256) and 1 − cos(k·π/256) for k = 1…64, in u0.32, rounded to nearest.
static NODES: [[u32; 2]; STEPS as usize] = nodes();

/// Computes sine and cosine in Q2.30. The error is at most 0.68 units in the last place (2^−30), over all 2^32 angles.
pub fn sin_cos_q30(angle: Turns) -> (Q2_30, Q2_30) {
    sin_cos_q30_order::<3>(angle)
}

/// Computes sine and cosine in Q2.30 with a Taylor polynomial of order 0 to 3 (higher orders saturate to 3).
///
/// For order n the omitted terms are at most d^(n + 1)/(n + 1)! with d = π/512.
/// For n = 0…3 this is 6.1e-3, 1.9e-5, 3.9e-8 and 5.9e-11.
pub fn sin_cos_q30_order<const ORDER: u32>(angle: Turns) -> (Q2_30, Q2_30) {
    let (sin, cos) = unfold(angle, octant::<ORDER>);
    (Q2_30::from_bits(sin), Q2_30::from_bits(cos))
}

/// Computes sine and cosine of any angle from the function `octant`, which computes them for angles in 0…2^29 (the first octant).
fn unfold(angle: Turns, octant: impl Fn(u32) -> [i32; 2]) -> (i32, i32) {
    let number = angle.0 >> 29;
    let offset = angle.0 & ((1 << 29) - 1);
    let phase = if number & 1 == 0 {
        offset
    } else {
        (1 << 29) - offset
    };
    let [mut sin, mut cos] = octant(phase);
    // Octants 1, 2, 5 and 6 lie nearer to the vertical axis, so sine and cosine are exchanged.
    if (number + 1) & 2 != 0 {
        (sin, cos) = (cos, sin);
    }
    if number & 4 != 0 {
        sin = -sin;
    }
    if (number + 2) & 4 != 0 {
        cos = -cos;
    }
    (sin, cos)
}

/// Computes sine and cosine, with 30 fraction bits, of an angle in the first octant: `phase` is 0…2^29 in units of 2^−32 turns.
///
/// No operation overflows: |d| ≤ π/512 < 2^−7.3, so `d` and `e` (38 fraction bits) stay below 2^30.7, and `h` (45 fraction bits)
/// below 2^29.4. The products with the node's `s` and `versine` are smaller, because both factors are below 1.
fn octant<const ORDER: u32>(phase: u32) -> [i32; 2] {
    let node = (phase + STEP / 2) / STEP;
    let [s, versine] = node
        .checked_sub(1)
        .and_then(|k| NODES.get(k as usize))
        .copied()
        .unwrap_or([0, 0]);
    // |steps| ≤ 2^22, so d = steps·2π/2^32 with 38 fraction bits is at most 2π·2^28 < 2^30.7.
    let steps = phase as i32 - (node * STEP) as i32;
    let d = if ORDER < 1 {
        0
    } else {
        ((steps as i64 * TAU_Q28) >> 22) as i32
    };
    let h = if ORDER < 2 {
        0
    } else {
        mul_high(d.unsigned_abs() as i32, d.unsigned_abs()) as u32
    };
    // d·h is d³/2 with 51 fraction bits; a third of d·h, shifted by 13 bits, is d³/6 with 38 fraction bits.
    let e = if ORDER < 3 {
        d
    } else {
        d - mul_high(mul_high(d, h), (1 << 19) / 3)
    };

    // The polynomial's additions to the node's sine and cosine, with 38 fraction bits; C·x is computed as x − versine·x.
    let sin = e - mul_high(e, versine) - (mul_high(h as i32, s) >> 7);
    let cos = -mul_high(e, s) - ((h as i32 - mul_high(h as i32, versine)) >> 7);
    // Two successive roundings down equal a single rounding down, so in effect the exact sum (node·2^6 + polynomial) is rounded
    // once, to the nearest 2^−30. Sines of the octant lie in [0, 0.71], so the unsigned sum does not wrap.
    let sin = s.wrapping_add_signed((sin + 128) >> 6) >> 2;
    let cos = (1 << 30) + ((((cos + 128) >> 6) - versine as i32) >> 2);
    [sin as i32, cos]
}

/// Computes the high word of a product, floor(a·b/2^32), which is one instruction `mulhsu` on the soft core.
fn mul_high(a: i32, b: u32) -> i32 {
    ((a as i64 * b as i64) >> 32) as i32
}

/// 2π with 28 fraction bits, rounded to nearest.
const TAU_Q28: i64 = (((PI_Q60 >> 30) + 1) >> 1) as i64;
/// π with 60 fraction bits.
pub(crate) const PI_Q60: u128 = 0x3243_F6A8_885A_308D;

/// Computes the table `NODES` by the Taylor series of sin x and 1 − cos x, with 60 fraction bits.
const fn nodes() -> [[u32; 2]; STEPS as usize] {
    let mut table = [[0; 2]; STEPS as usize];
    let mut k = 0;
    while k < STEPS as usize {
        let x = PI_Q60 * (k as u128 + 1) / (4 * STEPS as u128);
        table[k] = [alternating_series(x, 1), alternating_series(x, 2)];
        k += 1;
    }
    table
}

/// Computes the series x^n/n! − x^(n+2)/(n+2)! + … from n = `first` on, which is sin x for n = 1 and 1 − cos x for n = 2. `x` is
/// below 1 and has 60 fraction bits; the result has 32 fraction bits and is rounded to nearest.
const fn alternating_series(x: u128, first: u128) -> u32 {
    let (mut sum, mut term, mut n) = (0_i128, x, 1);
    let mut sign = 1;
    while term > 0 {
        if n >= first && (n - first).is_multiple_of(2) {
            sum += sign * term as i128;
            sign = -sign;
        }
        n += 1;
        term = ((term * x) >> 60) / n;
    }
    ((sum + (1 << 27)) >> 28) as u32
}
