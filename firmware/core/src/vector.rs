//! Vectors of three integers.

/// Scales a vector to length 1, in units of 2^−`BITS`, of any units before; `None` for the zero vector. `BITS` is at most 30.
///
/// The error of each component is at most half a unit plus 2^−29. A component is at most 1 in magnitude.
pub fn unit<const BITS: u32>(vector: [i64; 3]) -> Option<[i32; 3]> {
    let magnitudes = vector.map(i64::unsigned_abs);
    let [a, b, c] = magnitudes;
    let lead = (a | b | c).checked_ilog2()?;
    // The components are scaled so that the largest has 31 bits; the sum of their squares then has at most 64 bits.
    let scaled = magnitudes.map(|x| {
        if lead < 30 {
            x << (30 - lead)
        } else {
            x >> (lead - 30)
        }
    });
    let length = scaled.map(|x| x * x).iter().sum::<u64>().isqrt();
    let round = |x: u64| ((x << (BITS + 1)) / length + 1) >> 1;
    Some([0, 1, 2].map(|i| round(scaled[i]) as i32 * vector[i].signum() as i32))
}

/// Computes a × b. The components of both are at most 2^30 in magnitude, so those of the product are at most 2^61.
pub fn cross(a: [i32; 3], b: [i32; 3]) -> [i64; 3] {
    let product = |i: usize, j: usize| i64::from(a[i]) * i64::from(b[j]);
    [[1, 2], [2, 0], [0, 1]].map(|[i, j]| product(i, j) - product(j, i))
}

/// Computes a·b. The components of both are at most 2^30 in magnitude, so the product is below 2^62.
pub fn dot(a: [i32; 3], b: [i32; 3]) -> i64 {
    core::iter::zip(a, b)
        .map(|(a, b)| i64::from(a) * i64::from(b))
        .sum()
}
