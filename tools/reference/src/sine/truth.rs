//! The reference values of sine and cosine in f64, and their error.

use std::f64::consts::PI;

/// Units of phase in a full turn. A phase is a `u32` in units of 2^-32 turns.
pub const TURN: f64 = 4_294_967_296.0;

/// Units of phase in an octant, an eighth of a turn.
pub const OCTANT: u32 = 1 << 29;

/// Sine and cosine of an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SinCos {
    /// The sine.
    pub sin: f64,
    /// The cosine.
    pub cos: f64,
}

impl SinCos {
    /// Sine and cosine of an angle in radians, computed by the standard library.
    pub fn of_radians(angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { sin, cos }
    }

    /// Sine and cosine of a phase in the first octant, from 0 to [`OCTANT`].
    pub fn of_octant(phase: u32) -> Self {
        Self::of_radians(f64::from(phase) * (2.0 * PI / TURN))
    }
}

/// A symmetry of the circle that maps an angle of the first octant to an angle of some octant, the image. Sine and cosine of the
/// image equal those of the first-octant angle apart from signs and order.
#[derive(Clone, Copy, Debug)]
pub struct Image {
    quarter: u32,
    mirrored: bool,
}

impl Image {
    /// Returns the images of a phase of the first octant, at most one in each octant.
    ///
    /// Each of the 2^32 angles is an image of exactly one phase from 0 to [`OCTANT`]: an angle at the border of two octants
    /// belongs to only one of these octants.
    pub fn all(phase: u32) -> impl Iterator<Item = Self> {
        (0..8)
            .map(|i| Self {
                quarter: i / 2,
                mirrored: i % 2 == 1,
            })
            .filter(move |image| phase != if image.mirrored { 0 } else { OCTANT })
    }

    /// Returns the angle of this image of the first-octant phase `phase`, in units of 2^-32 turns.
    pub fn angle(self, phase: u32) -> u32 {
        let start = self.quarter << 30;
        if self.mirrored {
            start.wrapping_add((1 << 30) - phase)
        } else {
            start.wrapping_add(phase)
        }
    }

    /// Converts a first-octant phase's sine and cosine to this image's, by exact identities.
    pub fn carry<T: Copy + std::ops::Neg<Output = T>>(self, sin: T, cos: T) -> (T, T) {
        let (sin, cos) = if self.mirrored {
            (cos, sin)
        } else {
            (sin, cos)
        };
        match self.quarter {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }
}

/// Measures the largest error of [`SinCos::of_octant`] over every `stride`-th phase. The reference is a series in integers of 62
/// fraction bits, with an error below 2^-56.
pub fn reference_error(stride: u32) -> f64 {
    let apart = |exact: i128, value: f64| (exact - (value * ONE as f64) as i128).abs();
    let worst = (0..=OCTANT)
        .step_by(stride.max(1) as usize)
        .map(|phase| {
            let (sin, cos) = series(phase);
            let got = SinCos::of_octant(phase);
            apart(sin, got.sin).max(apart(cos, got.cos))
        })
        .max();
    worst.unwrap_or(0) as f64 / ONE as f64
}

/// The number 1 with 62 fraction bits.
const ONE: i128 = 1 << 62;

/// π with 93 fraction bits, rounded to nearest.
const PI_Q93: i128 = 31_112_826_664_028_885_653_815_243_078;

/// Computes sine and cosine of a first-octant phase with 62 fraction bits by Taylor series. Each of the two series has about ten terms. A
/// term's truncation error is below four units in the last place.
fn series(phase: u32) -> (i128, i128) {
    // The angle is phase·2π/2^32 = phase·π/2^31. The product with `PI_Q93` stays below 2^124, so it fits an i128.
    let angle = (i128::from(phase) * PI_Q93) >> 62;
    let square = (angle * angle) >> 62;
    let sum = |first: i128, start: i128| {
        let (mut term, mut total, mut n) = (first, first, start);
        while term != 0 {
            // Shift and division of the magnitude truncate toward zero.
            term = -(term.signum() * (((term.abs() * square) >> 62) / (n * (n + 1))));
            total += term;
            n += 2;
        }
        total
    };
    (sum(angle, 2), sum(ONE, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_carry_sine_and_cosine_to_every_octant() {
        let mut angles = Vec::new();
        for phase in (0..=OCTANT).step_by(1 << 20) {
            let base = SinCos::of_octant(phase);
            for image in Image::all(phase) {
                let angle = image.angle(phase);
                let (sin, cos) = image.carry(base.sin, base.cos);
                let direct = SinCos::of_radians(f64::from(angle) * (2.0 * PI / TURN));
                assert!((sin - direct.sin).abs() < 1e-15, "sine at {angle:#x}");
                assert!((cos - direct.cos).abs() < 1e-15, "cosine at {angle:#x}");
                angles.push(angle);
            }
        }
        angles.sort_unstable();
        let expected: Vec<u32> = (0..1 << 12).map(|i| i << 20).collect();
        assert_eq!(angles, expected);
    }

    #[test]
    fn the_reference_is_accurate_to_an_f64s_last_place() {
        let error = reference_error((1 << 10) + 1);
        assert!(
            error > 0.0 && error < 2.3e-16,
            "error of the reference: {error:e}"
        );
    }
}
