//! Tests of model matrices against computations in f64.

use std::f64::consts::TAU;

use glint_core::fixed::{Q8_24, Turns};
use glint_core::matrix::{Axis, MAX_ENTRY, MIN_ROW, Matrix, MatrixError};
use proptest::prelude::*;

type Rows = [[f64; 3]; 3];

/// Half a unit of Q8.24.
const HALF_UNIT: f64 = 1.0 / 33_554_432.0;

fn number(x: f64) -> Q8_24 {
    Q8_24::from_num(x)
}

fn rows(matrix: &Matrix) -> Rows {
    matrix.linear().map(|row| row.map(Q8_24::to_num))
}

fn place(matrix: &Matrix) -> [f64; 3] {
    matrix.place().map(Q8_24::to_num)
}

fn times(a: Rows, b: Rows) -> Rows {
    a.map(|row| [0, 1, 2].map(|j| (0..3).map(|k| row[k] * b[k][j]).sum()))
}

fn applied(a: Rows, p: [f64; 3]) -> [f64; 3] {
    a.map(|row| (0..3).map(|k| row[k] * p[k]).sum())
}

/// The inverse transpose, by Cramer's rule.
fn inverse_transpose(a: Rows) -> Rows {
    let cofactor = |i: usize, j: usize| {
        let (p, q) = ((i + 1) % 3, (i + 2) % 3);
        let (r, s) = ((j + 1) % 3, (j + 2) % 3);
        a[p][r] * a[q][s] - a[p][s] * a[q][r]
    };
    let determinant: f64 = (0..3).map(|j| a[0][j] * cofactor(0, j)).sum();
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| cofactor(i, j) / determinant))
}

fn normalised(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

fn rotation(axis: Axis, angle: Turns) -> Rows {
    let (s, c) = (f64::from(angle.0) / 2f64.powi(32) * TAU).sin_cos();
    match axis {
        Axis::X => [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]],
        Axis::Y => [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]],
        Axis::Z => [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]],
    }
}

/// A product of rotations about z and x, a scale for each axis, rotations about y and z, and a translation.
fn any_matrix(scales: [f64; 3], angles: [u32; 4], by: [f64; 3]) -> Result<Matrix, MatrixError> {
    let [a, b, c, d] = angles.map(Turns);
    Matrix::rotation(Axis::Z, a)
        .then(&Matrix::rotation(Axis::X, b))?
        .then(&Matrix::scale(scales.map(number))?)?
        .then(&Matrix::rotation(Axis::Y, c))?
        .then(&Matrix::rotation(Axis::Z, d))?
        .then(&Matrix::translation(by.map(number))?)
}

fn factor() -> impl Strategy<Value = f64> {
    ((-9.0..3.5_f64), any::<bool>()).prop_map(|(log, negative)| {
        let size = log.exp2();
        if negative { -size } else { size }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4_000))]

    #[test]
    fn rotations_are_what_they_should_be(axis in 0..3_usize, angle in any::<u32>()) {
        let axis = Axis::ALL[axis];
        let found = rows(&Matrix::rotation(axis, Turns(angle)));
        let error = difference(found.as_flattened(), rotation(axis, Turns(angle)).as_flattened());
        prop_assert!(error <= 1.02 * HALF_UNIT, "{error:e}");
        // The rotation by the opposite angle is the transposed matrix.
        let back = rows(&Matrix::rotation(axis, -Turns(angle)));
        prop_assert_eq!(back, [0, 1, 2].map(|i| [0, 1, 2].map(|j| found[j][i])));
    }

    #[test]
    fn a_composition_is_rounded_once(
        scales in [factor(), factor(), factor()],
        angles in any::<[u32; 4]>(),
        by in [-8.0..8.0, -8.0..8.0, -8.0..8.0_f64],
        next in [factor(), factor(), factor()],
        turn in any::<u32>(),
    ) {
        let (Ok(first), Ok(next)) = (any_matrix(scales, angles, by), Matrix::scale(next.map(number))) else {
            return Ok(());
        };
        let Ok(next) = next.then(&Matrix::rotation(Axis::Y, Turns(turn))) else { return Ok(()) };
        let Ok(both) = first.then(&next) else { return Ok(()) };
        let error = difference(
            rows(&both).as_flattened(),
            times(rows(&next), rows(&first)).as_flattened(),
        );
        prop_assert!(error <= HALF_UNIT * 1.000_001, "{error:e}");
        let error = difference(&place(&both), &applied(rows(&next), place(&first)));
        prop_assert!(error <= HALF_UNIT * 1.000_001, "{error:e}");
        prop_assert_eq!(both.mirrors(), first.mirrors() != next.mirrors());
    }

    /// Normals are transformed by the inverse transpose and scaled to length 1.
    #[test]
    fn normals_go_by_the_inverse_transpose(
        scales in [factor(), factor(), factor()],
        angles in any::<[u32; 4]>(),
        normal in [any::<i16>(), any::<i16>(), any::<i16>()],
    ) {
        let Ok(matrix) = any_matrix(scales, angles, [0.0; 3]) else { return Ok(()) };
        let unit = normalised(normal.map(f64::from));
        prop_assume!(unit.iter().all(|x| x.is_finite()));
        let normal = unit.map(|x| (x * 16_384.0).round() as i16);
        let expected = normalised(applied(
            inverse_transpose(rows(&matrix)),
            normal.map(f64::from),
        ));
        let found = matrix.normals().apply(normal).map(f64::from);
        let error = difference(&found, &expected.map(|x| x * 16_384.0));
        prop_assert!(error <= 0.51, "{error}");
    }

    /// With a uniform scale, a light transformed to the mesh has the same angle to the mesh's normals. For a scale below 1/128,
    /// rounding errors may hide that the scale is uniform.
    #[test]
    fn a_light_comes_to_a_mesh_of_one_scale(
        scale in factor(),
        angles in any::<[u32; 4]>(),
        normal in [-1.0..1.0, -1.0..1.0, -1.0..1.0_f64],
        light in [-1.0..1.0, -1.0..1.0, -1.0..1.0_f64],
    ) {
        let Ok(matrix) = any_matrix([scale; 3], angles, [0.0; 3]) else { return Ok(()) };
        let (normal, light) = (normalised(normal), normalised(light));
        let Some(rotation) = matrix.normals().rotation().copied() else {
            prop_assert!(scale.abs() < 1.0 / 128.0, "one scale");
            return Ok(());
        };
        let rotation = rotation.map(|row| row.map(|x| f64::from(x) / 2f64.powi(30)));
        let turned = normalised(applied(inverse_transpose(rows(&matrix)), normal));
        let expected: f64 = (0..3).map(|i| turned[i] * light[i]).sum();
        let brought = applied([0, 1, 2].map(|i| [0, 1, 2].map(|j| rotation[j][i])), light);
        let found: f64 = (0..3).map(|i| brought[i] * normal[i]).sum();
        prop_assert!((found - expected).abs() <= 2f64.powi(-12), "{found} {expected}");
    }

    #[test]
    fn no_matrix_panics(entries in any::<[i32; 9]>(), by in any::<[i32; 3]>(), shift in 0..20_u32) {
        let [a, b, c] = [0, 3, 6].map(|i| [0, 1, 2].map(|j| Q8_24::from_bits(entries[i + j] >> shift)));
        match Matrix::new_checked([a, b, c], by.map(|x| Q8_24::from_bits(x >> shift))) {
            Ok(matrix) => {
                let _ = (matrix.normals().apply([i16::MIN; 3]), matrix.then(&matrix));
            }
            Err(error) => prop_assert!(error.to_string().starts_with("matrix row ")),
        }
    }
}

#[test]
fn a_negative_scale_mirrors() {
    let mirrors = |x, y, z| Matrix::scale([x, y, z].map(number)).unwrap().mirrors();
    assert!(!mirrors(1.0, 1.0, 1.0) && !mirrors(-1.0, -1.0, 1.0));
    assert!(mirrors(-1.0, 1.0, 1.0) && mirrors(-1.0, -1.0, -1.0));
    // The normal of a mirrored face still points outwards.
    let mirror = Matrix::scale([-2.0, 1.0, 1.0].map(number)).unwrap();
    assert_eq!(mirror.normals().apply([1 << 14, 0, 0]), [-1 << 14, 0, 0]);
    assert_eq!(mirror.normals().apply([0, 1 << 14, 0]), [0, 1 << 14, 0]);
    assert_eq!(mirror.normals().rotation(), None);
}

/// An object that turns by many small steps keeps its shape: lengths and angles of the matrix's columns, and its handedness.
#[test]
fn many_small_turns_keep_the_shape() {
    let scale = |factors: [f64; 3]| Matrix::scale(factors.map(number)).unwrap();
    let tilted = Matrix::rotation(Axis::X, Turns(123_456_789));
    let sheared = scale([0.5, 1.0, 2.0]).then(&tilted).unwrap();
    let sheared = sheared.then(&scale([1.0, 3.0, 0.25])).unwrap();
    let shapes = [
        Matrix::IDENTITY,
        scale([0.3; 3]),
        scale([4.0, 0.05, 1.0]),
        scale([-1.0, 2.0, 0.7]),
        sheared,
    ];
    // The scalar products of all pairs of columns.
    let products = |matrix: &Matrix| {
        let a = rows(matrix);
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[k][i] * a[k][j]).sum::<f64>()))
    };
    for shape in shapes {
        let mut matrix = shape;
        for i in 0..36_000 {
            let axis = Axis::ALL[i / 12_000];
            let step = Matrix::rotation(axis, Turns::from_degrees("0.1".parse().unwrap()));
            assert!(step.is_rotation());
            matrix = matrix.then(&step).unwrap().with_shape_of(&shape);
        }
        let (found, expected) = (products(&matrix), products(&shape));
        let size = expected
            .as_flattened()
            .iter()
            .fold(1.0, |a: f64, b| a.max(*b));
        let error = difference(found.as_flattened(), expected.as_flattened()) / size;
        println!("{error:.1e}");
        assert!(error < 2e-6, "{shape:?}: {error:e}");
        assert_eq!(matrix.mirrors(), shape.mirrors());
    }
    // A whole number of turns about each axis leads back to the start.
    let mut matrix = Matrix::IDENTITY;
    for _ in 0..36_000 {
        let step = Matrix::rotation(Axis::Z, Turns::from_degrees("0.1".parse().unwrap()));
        matrix = matrix.then(&step).unwrap().with_shape_of(&Matrix::IDENTITY);
    }
    let [[x, ..], [y, ..], _] = rows(&matrix);
    let turned = y.atan2(x).to_degrees();
    println!("{turned:.4}°");
    assert!(turned.abs() < 36_000.0 * 1.8e-6, "{turned}");
}

/// After a single rotation, `with_shape_of` leaves the product unchanged.
#[test]
fn one_turn_is_the_product() {
    for size in [0.002, 0.01, 0.3, 1.0, 5.0, 15.9] {
        let shape = Matrix::scale([number(size); 3]).unwrap();
        for i in 0..2_000_u32 {
            let axis = Axis::ALL[i as usize % 3];
            let turn = Matrix::rotation(axis, Turns(i.wrapping_mul(2_654_435_761)));
            let product = shape.then(&turn).unwrap();
            assert_eq!(product.with_shape_of(&shape), product, "{size} {i}");
        }
    }
}

#[test]
fn rotations_are_told_from_other_matrices() {
    let rotations = [
        Matrix::IDENTITY,
        Matrix::rotation(Axis::Y, Turns(99_999_999)),
    ];
    assert!(rotations.iter().all(Matrix::is_rotation));
    let [one, half] = [1.0, 0.5].map(number);
    let others = [
        Matrix::scale([-one, one, one]),
        Matrix::scale([-one; 3]),
        Matrix::scale([half; 3]),
        Matrix::scale([one, one, number(1.000_01)]),
        Matrix::new_checked(
            [[1.0, 0.0001, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|row| row.map(number)),
            [Q8_24::ZERO; 3],
        ),
    ];
    assert!(!others.iter().any(|matrix| matrix.unwrap().is_rotation()));
}

#[test]
fn scales_have_a_range() {
    let [zero, one] = [Q8_24::ZERO, Q8_24::ONE];
    for size in [MIN_ROW, MAX_ENTRY, -MIN_ROW, -MAX_ENTRY] {
        assert!(Matrix::scale([size, one, one]).is_ok());
    }
    for size in [MIN_ROW - Q8_24::DELTA, MAX_ENTRY + Q8_24::DELTA, zero] {
        assert!(Matrix::scale([one, size, one]).is_err());
    }
}
