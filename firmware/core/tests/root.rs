//! Tests of roots, reciprocal roots and directions against f64.

use glint_core::root::{inverse_root, root};
use glint_core::vector::unit;
use proptest::prelude::*;

/// The largest relative error of a reciprocal root.
fn largest_error(inverse_root: fn(u32) -> u32) -> f64 {
    let inputs = (1 << 30..=u32::MAX).step_by(997);
    let errors = inputs.map(|x| {
        let exact = 2_f64.powi(31) / (f64::from(x) / 2_f64.powi(30)).sqrt();
        (f64::from(inverse_root(x)) / exact - 1.0).abs()
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn each_newton_step_doubles_the_bits_of_a_reciprocal_root() {
    assert!(largest_error(inverse_root::<0>) < 4.2e-3);
    assert!(largest_error(inverse_root::<1>) < 2.7e-5);
    assert!(largest_error(inverse_root::<2>) < 4e-9);
}

#[test]
fn a_root_is_the_nearest_number() {
    let between = (0..=u32::MAX).step_by(65_521);
    let squares = (1..=u32::from(u16::MAX)).flat_map(|x| [x * x - x, x * x - 1, x * x, x * x + x]);
    for square in between.chain(squares) {
        let exact = f64::from(square).sqrt().round().min(65_535.0);
        assert_eq!(f64::from(root(square)), exact, "{square}");
    }
    // From the square of 65,535.5 on, the rounded root does not fit 16 bits.
    assert_eq!([0, 1, u32::MAX].map(root), [0, 1, 65_535]);
}

#[test]
fn directions_along_an_axis_are_exact() {
    for shift in 0..63 {
        let lengths = [1_i64 << shift, (1 << shift) + (1 << (shift / 2)) - 1];
        for length in lengths.into_iter().chain([i64::MAX, i64::MIN]) {
            let one = if length < 0 { -1 } else { 1 };
            assert_eq!(unit::<30>([0, length, 0]), Some([0, one << 30, 0]));
            assert_eq!(unit::<14>([length, 0, 0]), Some([one << 14, 0, 0]));
        }
    }
    assert_eq!(unit::<30>([0; 3]), None);
}

/// Random numbers of all bit lengths.
fn component() -> impl Strategy<Value = i64> {
    (any::<i64>(), 0..64).prop_map(|(x, shift)| x >> shift)
}

proptest! {
    #[test]
    fn directions_are_within_their_bound(vector in [component(), component(), component()]) {
        let Some(found) = unit::<30>(vector) else {
            prop_assert_eq!(vector, [0; 3]);
            return Ok(());
        };
        let exact = vector.map(|x| x as f64);
        let length = exact.iter().map(|x| x * x).sum::<f64>().sqrt();
        let lost = if vector.iter().any(|x| x.unsigned_abs() >> 31 != 0) {
            2_f64.powi(-29)
        } else {
            0.0
        };
        for (found, exact) in core::iter::zip(found, exact) {
            let error = f64::from(found) / 2_f64.powi(30) - exact / length;
            prop_assert!(error.abs() < 0.501 * 2_f64.powi(-30) + lost, "{error:e}");
            prop_assert!(found.unsigned_abs() <= 1 << 30);
        }
    }
}
