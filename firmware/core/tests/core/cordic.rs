//! Tests of the length and angle of vectors against computations in f64.

use std::f64::consts::TAU;

use glint_core::cordic::to_polar;
use glint_core::fixed::Turns;

/// Returns the difference between an angle and a number of turns, in units of 2^−32 turns.
fn apart(angle: Turns, turns: f64) -> f64 {
    let difference = f64::from(angle.0) - turns * 2f64.powi(32);
    let turn = 2f64.powi(32);
    (difference + turn / 2.0).rem_euclid(turn) - turn / 2.0
}

fn numbers() -> impl Iterator<Item = i64> + Clone {
    (0..1_500_i64).map(|k: i64| {
        let wild = k.wrapping_mul(0x9E37_79B9_7F4A_7C15_u64 as i64);
        wild >> (3 + k % 28)
    })
}

#[test]
fn angles_and_lengths_are_within_a_unit() {
    let (mut angle_error, mut length_error) = (0.0_f64, 0.0_f64);
    for x in numbers().step_by(3) {
        for y in numbers() {
            let (length, angle) = to_polar(x, y);
            // Vectors shorter than 2^32 are left out, because the errors are stated for lengths of at least 2^32. The relative
            // rounding error of f64 is 2^-53, which is negligible.
            let (fx, fy) = (x as f64, y as f64);
            if fx.hypot(fy) < 2f64.powi(32) {
                continue;
            }
            angle_error = angle_error.max(apart(angle, fy.atan2(fx) / TAU).abs());
            let expected = fx.hypot(fy);
            length_error = length_error.max((length as f64 - expected).abs() / expected);
        }
    }
    println!("angle {angle_error:.3} units, length {length_error:.2e}");
    assert!(angle_error <= 0.53, "{angle_error}");
    assert!(length_error <= 2f64.powi(-31), "{length_error:e}");
}
