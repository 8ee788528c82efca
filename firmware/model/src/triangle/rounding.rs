//! Rounding of fixed-point numbers.

/// Computes x·2^−shift rounded to nearest, ties up. `shift` is in 1…31, and adding half a unit of the result to x must not
/// overflow.
pub const fn nearest(x: i64, shift: u32) -> i64 {
    // The mask does not change the value. It shows the compiler that the shift is below 32, which is faster on a 32-bit processor.
    (x + (1u32 << (shift - 1)) as i64) >> (shift & 31)
}
