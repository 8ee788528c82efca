//! Transformation of normals by the inverse transpose of a model matrix, in 32 bits.

use crate::matrix::Rows;
use crate::unit::unit_32;

/// The cofactors of a matrix with 24 fraction bits and entries within ±16, truncated so that the largest has 14 bits.
pub fn cofactors(rows: &Rows<i32>) -> Rows<i32> {
    let at = |i: usize, j: usize| i64::from(rows[i % 3][j % 3]);
    let exact = [0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| at(i + 1, j + 1) * at(i + 2, j + 2) - at(i + 1, j + 2) * at(i + 2, j + 1))
    });
    let entries = exact.as_flattened().iter();
    let largest = entries.fold(1, |largest, x| largest | x.unsigned_abs());
    let cut = (largest.ilog2() + 1).saturating_sub(14);
    exact.map(|row| row.map(|x| (x >> cut) as i32))
}

/// Transforms a normal with `BITS` fraction bits, at most 14, by [`cofactors`], and normalises it. The zero vector stays unchanged.
#[inline(never)]
pub fn turned<const BITS: u32>(cofactors: &Rows<i32>, normal: [i16; 3]) -> [i16; 3] {
    let [x, y, z] = normal.map(i32::from);
    // Each product is at most 2^28.
    let turned = cofactors.map(|[a, b, c]| a * x + b * y + c * z);
    // A component is at most 2^14.
    unit_32::<BITS>(turned).map(|x| x as i16)
}
