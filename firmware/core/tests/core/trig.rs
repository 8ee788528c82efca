//! Tests of sine and cosine against f64, whose error of 2^-53 is negligible.

use std::f64::consts::TAU;

use glint_core::fixed::Turns;
use glint_core::trig::{sin_cos_q30, sin_cos_q30_order};

/// The errors of a function that computes sine and cosine, over a set of angles, in units in the last place of its results.
#[derive(Default)]
struct Errors {
    max: f64,
    argmax: u32,
    squares: f64,
    sum: f64,
    count: f64,
    /// The largest |sin² + cos² − 1|.
    norm: f64,
}

impl Errors {
    fn measure(
        fraction_bits: i32,
        phases: impl Iterator<Item = u32>,
        kernel: impl Fn(Turns) -> [i32; 2],
    ) -> Self {
        let one = 2f64.powi(fraction_bits);
        let mut errors = Self::default();
        for phase in phases {
            let (sin, cos) = (f64::from(phase) / 2f64.powi(32) * TAU).sin_cos();
            let bits = kernel(Turns(phase)).map(f64::from);
            for error in [bits[0] - sin * one, bits[1] - cos * one] {
                if error.abs() > errors.max {
                    (errors.max, errors.argmax) = (error.abs(), phase);
                }
                errors.squares += error * error;
                errors.sum += error;
                errors.count += 1.0;
            }
            let norm = (bits[0] / one).powi(2) + (bits[1] / one).powi(2) - 1.0;
            errors.norm = errors.norm.max(norm.abs());
        }
        println!(
            "max {:.4} ULP at {:#010x}, rms {:.4}, mean {:.1e}, norm {:.2e}",
            errors.max,
            errors.argmax,
            (errors.squares / errors.count).sqrt(),
            errors.sum / errors.count,
            errors.norm
        );
        errors
    }
}

fn q30(angle: Turns) -> [i32; 2] {
    let (sin, cos) = sin_cos_q30(angle);
    [sin.to_bits(), cos.to_bits()]
}

fn q30_order<const ORDER: u32>(angle: Turns) -> [i32; 2] {
    let (sin, cos) = sin_cos_q30_order::<ORDER>(angle);
    [sin.to_bits(), cos.to_bits()]
}

/// Test angles: near all nodes and all midpoints between nodes, and 2^21 angles over the whole circle.
fn dense() -> impl Iterator<Item = u32> {
    let edges = (0..1024_u32).flat_map(|half_step| {
        let phase = half_step << 22;
        (-3..=3).map(move |offset: i32| phase.wrapping_add_signed(offset))
    });
    edges.chain((0..1 << 21).map(|k: u32| k.wrapping_mul(2_654_435_769)))
}

#[test]
fn q30_is_within_one_ulp() {
    let errors = Errors::measure(30, dense(), q30);
    assert!(errors.max < 0.68, "{}", errors.max);
    assert!(errors.norm <= 4e-9, "{}", errors.norm);
    assert!(
        (errors.sum / errors.count).abs() < 1e-3,
        "{}",
        errors.sum / errors.count
    );
}

#[test]
fn lower_orders_are_as_far_off_as_their_remainder_says() {
    let one = 2f64.powi(30);
    // The error limit for order n is d^(n + 1)/(n + 1)! with d = π/512, plus one unit for rounding.
    for (errors, remainder) in [
        (Errors::measure(30, dense(), q30_order::<0>), 6.14e-3),
        (Errors::measure(30, dense(), q30_order::<1>), 1.89e-5),
        (Errors::measure(30, dense(), q30_order::<2>), 3.86e-8),
        (Errors::measure(30, dense(), q30_order::<3>), 5.9e-11),
    ] {
        assert!(
            errors.max <= remainder * one + 1.0,
            "{} {remainder}",
            errors.max
        );
        assert!(
            errors.max >= remainder * one * 0.9,
            "{} {remainder}",
            errors.max
        );
    }
}

#[test]
fn symmetries_hold_bit_for_bit() {
    for kernel in [q30, q30_order::<1>] {
        for phase in dense() {
            let [sin, cos] = kernel(Turns(phase));
            assert_eq!(kernel(-Turns(phase)), [-sin, cos]);
            assert_eq!(
                kernel(Turns(phase).wrapping_add(Turns::QUARTER)),
                [cos, -sin]
            );
            assert_eq!(
                kernel(Turns::QUARTER.wrapping_add(-Turns(phase))),
                [cos, sin]
            );
        }
    }
}

#[test]
fn sine_is_monotone_over_a_quarter_at_16_bits() {
    let sines = (0..=1 << 14).map(|phase: u32| q30(Turns(phase << 16))[0]);
    assert!(sines.clone().zip(sines.skip(1)).all(|(a, b)| a <= b));
}
