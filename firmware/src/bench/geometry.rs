//! Benchmark of geometry kernels with several word lengths, for comparison with the kernels that the firmware uses.

use glint_core::fixed::{Q8_24, Turns};
use glint_core::matrix::{Axis, Matrix};
use glint_variants::matrix::{Rows, product_32, product_64, product_128};
use glint_variants::normal::{cofactors, turned};
use glint_variants::reciprocal::reciprocal;

use super::measure::{Report, measure};

/// Measures products of matrices, transformed normals and reciprocals, and reports them under the names that `cargo xtask report
/// geometry` gives them.
pub fn geometry(report: Report) {
    let sizes = ["0.5", "1.5", "0.75"].map(|x| x.parse().unwrap_or(Q8_24::ONE));
    let matrices = [1_u32, 3, 5, 7].map(|eighths| {
        let matrix = Matrix::scale(sizes)
            .and_then(|matrix| matrix.then(&Matrix::rotation(Axis::Z, Turns(eighths << 28))))
            .and_then(|matrix| matrix.then(&Matrix::rotation(Axis::X, Turns(eighths << 27))));
        matrix.unwrap_or(Matrix::IDENTITY)
    });
    let rows = matrices.each_ref().map(|matrix| {
        let linear = matrix.linear();
        linear.map(|row| row.map(Q8_24::to_bits))
    });
    let cut = |shift: u32| rows.map(|rows| rows.map(|row| row.map(|x| x >> shift)));
    let chosen = |phase: u32| (phase >> 30) as usize;
    let mut product = |name: &str, shift, kernel: fn(&Rows<i32>, &Rows<i32>) -> Rows<i32>| {
        let rows = cut(shift);
        measure(report, name, chosen, |i| kernel(&rows[i], &rows[3 - i]));
    };
    product("matrix_10", 14, product_32::<10>);
    product("matrix_16", 8, product_64::<16>);
    product("matrix_20", 4, product_64::<20>);
    product("matrix_24", 0, product_64::<24>);
    let long = rows.map(|rows| rows.map(|row| row.map(|x| i64::from(x) << 8)));
    measure(report, "matrix_32", chosen, |i| {
        product_128::<32>(&long[i], &long[3 - i])
    });

    let short = rows.each_ref().map(cofactors);
    let exact = matrices.each_ref().map(Matrix::normals);
    // Vectors of length about 1, with `bits` fraction bits.
    let normal = |phase: u32, bits: u32| {
        [0, 10, 20].map(|turn| (phase.rotate_left(turn).cast_signed() >> (31 - bits)) as i16)
    };
    measure(
        report,
        "normal_8",
        |phase| (chosen(phase), normal(phase, 8)),
        |(i, normal)| turned::<8>(&short[i], normal),
    );
    let long_normal = |phase| (chosen(phase), normal(phase, 14));
    measure(report, "normal_14_in_32", long_normal, |(i, normal)| {
        turned::<14>(&short[i], normal)
    });
    measure(report, "normal_14_in_64", long_normal, |(i, normal)| {
        exact[i].apply(normal)
    });

    let mantissa = |phase: u32| 1 << 23 | phase >> 9;
    measure(report, "reciprocal_0", mantissa, reciprocal::<0>);
    measure(report, "reciprocal_1", mantissa, reciprocal::<1>);
    measure(report, "reciprocal_2", mantissa, reciprocal::<2>);
}
