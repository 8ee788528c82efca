//! Products of 3×3 matrices whose entries are within ±16.

/// A 3×3 matrix as an array of rows.
pub type Rows<T> = [[T; 3]; 3];

/// a·b with `BITS` fraction bits, at most 10: all sums of products fit 32 bits. Each entry is rounded once, to nearest.
#[inline(never)]
pub fn product_32<const BITS: u32>(a: &Rows<i32>, b: &Rows<i32>) -> Rows<i32> {
    product(a, b, |row, column| {
        let sum = row[0] * column[0] + row[1] * column[1] + row[2] * column[2];
        (sum + (1 << (BITS - 1))) >> BITS
    })
}

/// a·b with `BITS` fraction bits, at most 26: all sums of products fit 64 bits. Each entry is rounded once, to nearest.
/// With 24 bits this is the product of `glint_core::matrix`.
#[inline(never)]
pub fn product_64<const BITS: u32>(a: &Rows<i32>, b: &Rows<i32>) -> Rows<i32> {
    product(a, b, |row, column| {
        let [x, y, z] = [0, 1, 2].map(|i| i64::from(row[i]) * i64::from(column[i]));
        ((x + y + z + (1 << (BITS - 1))) >> BITS) as i32
    })
}

/// a·b with `BITS` fraction bits, at most 58: all sums of products fit 128 bits. Each entry is rounded once, to nearest.
#[inline(never)]
pub fn product_128<const BITS: u32>(a: &Rows<i64>, b: &Rows<i64>) -> Rows<i64> {
    product(a, b, |row, column| {
        let [x, y, z] = [0, 1, 2].map(|i| i128::from(row[i]) * i128::from(column[i]));
        ((x + y + z + (1 << (BITS - 1))) >> BITS) as i64
    })
}

fn product<T: Copy>(a: &Rows<T>, b: &Rows<T>, entry: impl Fn([T; 3], [T; 3]) -> T) -> Rows<T> {
    let columns = [0, 1, 2].map(|j| [b[0][j], b[1][j], b[2][j]]);
    a.map(|row| columns.map(|column| entry(row, column)))
}
