//! The reciprocals 1/Z of the vertex stage and 1/|2A| of the triangle setup.
//!
//! Both reciprocals use a table of 256 seeds and two Newton steps, in which each product fits a 25×18 multiplier.

/// `SEED[i]` is 2^10/(1 + (i + 1/2)/256), rounded to nearest, u0.10.
pub const SEED: [u16; 256] = seeds();

const fn seeds() -> [u16; 256] {
    let mut table = [0; 256];
    let mut i = 0;
    while i < table.len() {
        // The exact entry is 2^19/d.
        let d = 513 + 2 * i;
        table[i] = (((1 << 20) + d) / (2 * d)) as u16;
        i += 1;
    }
    table
}

/// Approximates 2^47/m for a mantissa m in [2^23, 2^24); the result is also in [2^23, 2^24).
///
/// The error is at most one unit: the result for m = 2^23 saturates to 2^24 − 1, and all other results are within 0.51 of the exact
/// quotient. A larger m never gives a larger result. An m outside the range gives a meaningless number.
pub const fn recip(m: u32) -> u32 {
    let y0 = SEED[(m >> 15 & 0xFF) as usize] as u32;
    let y1 = (y0 << 7).wrapping_add_signed((y0 as i32).wrapping_mul(residue(m, y0)) >> 18);
    let y1 = if y1 < 1 << 17 { y1 } else { (1 << 17) - 1 };
    let step = (y1 as i64 * residue(m, y1) as i64 + (1 << 24)) >> 25;
    let y = (y1 << 7).wrapping_add_signed(step as i32);
    if y < 1 << 24 { y } else { (1 << 24) - 1 }
}

/// The residue of an estimate y of the reciprocal: (P − m·y)/2^8, rounded down, s18. P is 2^33 if y is the seed, and 2^40
/// if y is the result of the first step.
///
/// The difference is smaller than 2^25, and P is 0 modulo 2^32, so the low word of the product is enough.
const fn residue(m: u32, y: u32) -> i32 {
    m.wrapping_mul(y).wrapping_neg() as i32 >> 8
}

/// The reciprocal 1/v of an integer v > 0, as `y`·2^−(24 + `lead`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reciprocal {
    /// The mantissa, u24 in [2^23, 2^24).
    pub y: u32,
    /// Exponent floor(log2 v).
    pub lead: u32,
}

impl Reciprocal {
    /// Computes the reciprocal of `v` after truncating `v` to its highest 24 bits. A `v` of 0 counts as 1.
    ///
    /// The relative error is below 2^−22: 2^−23 from the truncation of `v`, plus one unit in the last place of `y`.
    pub const fn of(v: u64) -> Self {
        let v = v | (v == 0) as u64;
        let lead = v.ilog2();
        let m = if lead < 23 {
            v << (23 - lead)
        } else {
            v >> (lead - 23)
        };
        Self {
            y: recip(m as u32),
            lead,
        }
    }
}
