//! Errors and cycles of the computation of matrices, normals and projections with different word lengths.

use glint_core::fixed::{Q8_24, Turns};
use glint_core::matrix::{Axis, Matrix};
use glint_variants::matrix::{Rows, product_32, product_64, product_128};
use glint_variants::normal::{cofactors, turned};
use glint_variants::reciprocal::reciprocal;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};

use crate::camera::{dot, length, normalised};
use crate::errors::Errors;
use crate::report::cycles::Cycles;

/// Error and cycles of a kernel: a line of `geometry-precision.csv`.
#[derive(Debug, Serialize, Deserialize)]
pub struct Row {
    /// Kind of kernel: `matrix`, `normal` or `projection`.
    pub family: String,
    /// Name of the kernel in the firmware's `bench`.
    pub kernel: String,
    /// Word length and method of the kernel.
    pub config: String,
    /// Whether Glint uses the method.
    pub shipped: bool,
    /// Largest error of an entry of a matrix, of a component of a normal, or of a position (in 1/256 pixel).
    pub max_err: f64,
    /// Root mean square of the errors.
    pub rms: f64,
    /// Number of errors.
    pub samples: u64,
    /// Cycles of the fastest call on the soft core; `None` if not measured.
    pub cycles_min: Option<u64>,
    /// Median of the cycles of the calls on the soft core.
    pub cycles_median: Option<u64>,
    /// Cycles of the slowest call on the soft core.
    pub cycles_max: Option<u64>,
}

/// Number of chains of matrices, and number of transformed normals.
const ROUNDS: u32 = 20_000;
/// Number of rotations in a chain.
const CHAIN: u32 = 8;
/// Half the width of the largest picture, in pixels.
const HALF_WIDTH: f64 = 640.0;

/// Measures the errors of all kernels. `cycles` is the result of the console command `bench geometry`.
pub fn measure(cycles: &Cycles) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut add = |family: &str, kernel: String, config: String, shipped, errors: Errors| {
        let cycles = cycles.get(&kernel);
        rows.push(Row {
            family: family.to_owned(),
            kernel,
            config,
            shipped,
            max_err: errors.max,
            rms: errors.rms(),
            samples: errors.count,
            cycles_min: cycles.map(|cycles| cycles.min),
            cycles_median: cycles.map(|cycles| cycles.median),
            cycles_max: cycles.map(|cycles| cycles.max),
        });
    };
    for (bits, width, errors) in [
        (10, 32, chains(10, product_32::<10>)),
        (16, 64, chains(16, product_64::<16>)),
        (20, 64, chains(20, product_64::<20>)),
        (24, 64, chains(24, product_64::<24>)),
        (32, 128, chains(32, product_128::<32>)),
    ] {
        let config = format!("{bits} fraction bits, products of {width} bits");
        add(
            "matrix",
            format!("matrix_{bits}"),
            config,
            bits == 24,
            errors,
        );
    }
    let turned_8 = |matrix: &Matrix, normal| turned::<8>(&cofactors(&bits(matrix)), normal);
    let turned_14 = |matrix: &Matrix, normal| turned::<14>(&cofactors(&bits(matrix)), normal);
    let shipped = |matrix: &Matrix, normal| matrix.normals().apply(normal);
    for (kernel, bits, width, errors) in [
        ("normal_8", 8, 32, normals(8, turned_8)),
        ("normal_14_in_32", 14, 32, normals(14, turned_14)),
        ("normal_14_in_64", 14, 64, normals(14, shipped)),
    ] {
        let config = format!("{bits} fraction bits, in {width} bits");
        add("normal", kernel.to_owned(), config, width == 64, errors);
    }
    for (steps, config, errors) in [
        (0, "table of 256 reciprocals", positions(reciprocal::<0>)),
        (1, "table, one Newton step", positions(reciprocal::<1>)),
        (2, "table, two Newton steps", positions(reciprocal::<2>)),
    ] {
        let kernel = format!("reciprocal_{steps}");
        add("projection", kernel, config.to_owned(), steps == 2, errors);
    }
    rows
}

fn bits(matrix: &Matrix) -> Rows<i32> {
    matrix.linear().map(|row| row.map(Q8_24::to_bits))
}

/// Type of a matrix entry.
trait Entry: Copy {
    fn rounded(x: f64) -> Self;
    fn value(self) -> f64;
}

impl Entry for i32 {
    fn rounded(x: f64) -> Self {
        x.round() as Self
    }
    fn value(self) -> f64 {
        self.into()
    }
}

impl Entry for i64 {
    fn rounded(x: f64) -> Self {
        x.round() as Self
    }
    fn value(self) -> f64 {
        self as f64
    }
}

/// Measures the errors of the matrix entries of chains: a chain is the product of rotations about random axes.
fn chains<T: Entry>(bits: i32, product: fn(&Rows<T>, &Rows<T>) -> Rows<T>) -> Errors {
    let unit = 2f64.powi(bits);
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut errors = Errors::default();
    for _ in 0..ROUNDS {
        let mut rotations = (0..CHAIN).map(|_| {
            let angle = random.random_range(0.0..std::f64::consts::TAU);
            rotation(random.random_range(0..3), angle)
        });
        let rounded = |rows: Rows<f64>| rows.map(|row| row.map(|x| T::rounded(x * unit)));
        let Some(first) = rotations.next() else {
            continue;
        };
        let (mut exact, mut found) = (first, rounded(first));
        for next in rotations {
            let columns = [0, 1, 2].map(|j| [exact[0][j], exact[1][j], exact[2][j]]);
            exact = next.map(|row| columns.map(|column| dot(row, column)));
            found = product(&rounded(next), &found);
        }
        for (found, exact) in found.as_flattened().iter().zip(exact.as_flattened()) {
            errors.add(found.value() / unit - exact);
        }
    }
    errors
}

fn rotation(axis: usize, angle: f64) -> Rows<f64> {
    let (sin, cos) = angle.sin_cos();
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut rows = [[0.0; 3]; 3];
    rows[axis][axis] = 1.0;
    (rows[i][i], rows[j][j]) = (cos, cos);
    (rows[i][j], rows[j][i]) = (-sin, sin);
    rows
}

/// Measures the errors of the components of transformed unit normals. The model matrix scales each of the three axes by 0.5 to 2. Errors
/// include the conversion of the normals from f64.
fn normals(bits: i32, turn: fn(&Matrix, [i16; 3]) -> [i16; 3]) -> Errors {
    let unit = 2f64.powi(bits);
    let mut random = Pcg64Mcg::seed_from_u64(2);
    let mut errors = Errors::default();
    while errors.count < 3 * u64::from(ROUNDS) {
        let scales = [0; 3].map(|_| Q8_24::from_num(random.random_range(-1.0..1.0f64).exp2()));
        let [a, b, c] = [0; 3].map(|_| Turns(random.random()));
        let matrix = Matrix::rotation(Axis::X, a)
            .then(&Matrix::rotation(Axis::Y, b))
            .and_then(|matrix| matrix.then(&Matrix::scale(scales)?))
            .and_then(|matrix| matrix.then(&Matrix::rotation(Axis::Z, c)));
        let Ok(matrix) = matrix else { continue };
        let direction = [0; 3].map(|_| random.random_range(-1.0..1.0f64));
        if !(0.1..1.0).contains(&length(direction)) {
            continue;
        }
        let normal = normalised(direction);
        let rows = matrix.linear().map(|row| row.map(Q8_24::to_num::<f64>));
        let at = |i: usize, j: usize| rows[i % 3][j % 3];
        let exact = [0, 1, 2].map(|i| {
            let row = [0, 1, 2]
                .map(|j| at(i + 1, j + 1) * at(i + 2, j + 2) - at(i + 1, j + 2) * at(i + 2, j + 1));
            dot(row, normal)
        });
        let exact = normalised(exact);
        let found = turn(&matrix, normal.map(|x| (x * unit).round() as i16));
        for (found, exact) in found.into_iter().zip(exact) {
            errors.add(f64::from(found) / unit - exact);
        }
    }
    errors
}

/// Measures the errors, in 1/256 pixel, of step 7 of the vertex stage (docs/formats/triangle.md) with its rounding, for all mantissas of
/// the depth. The screen positions are up to half the width of a picture of 1280 pixels from its middle.
fn positions(reciprocal: fn(u32) -> u32) -> Errors {
    let mut random = Pcg64Mcg::seed_from_u64(3);
    let mut errors = Errors::default();
    for m in 1 << 23..1 << 24 {
        let pixels = random.random_range(-HALF_WIDTH..HALF_WIDTH);
        // X' (docs/formats/triangle.md) has 11 fraction bits at the mantissa 2^23.
        let x = (pixels * f64::from(m) / 4096.0).round() as i64;
        let found = (x * i64::from(reciprocal(m)) + (1 << 26)) >> 27;
        errors.add(found as f64 - x as f64 * 2f64.powi(20) / f64::from(m));
    }
    errors
}
