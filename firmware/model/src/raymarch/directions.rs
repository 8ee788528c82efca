//! The directions of a frame's rays in full precision.

use glint_core::camera::View;
use glint_core::fixed::Q2_23;

/// The directions D of the rays, 51 fraction bits.
pub(super) struct Directions {
    /// D of the first pixel, for each eye.
    pub first: [[i64; 3]; 2],
    /// Change of D per pixel to the right.
    pub across: [i64; 3],
    /// Change of D per pixel down.
    pub down: [i64; 3],
    /// D is 2^−exponent times the direction whose component along n is 1.
    pub exponent: u32,
}

impl Directions {
    /// Directions of a view. `parallax`, 28 fraction bits, at most 1, is the share of u that the left eye's direction
    /// gains and the right eye's loses. `round` keeps D below 1 in the Euclidean norm, not only in the maximum norm.
    pub fn new(view: &View, width: u32, height: u32, parallax: i64, round: bool) -> Self {
        let half_width = i64::from(view.half_width().to_bits());
        // Twice the half width divided by the number of pixels: below 2^54 before the division.
        let step = |row: [Q2_23; 3]| {
            row.map(|x| (2 * half_width * i64::from(x.to_bits())) / i64::from(width))
        };
        let (across, down) = (step(view.u()), step(view.v()));
        let first = [1, -1].map(|sign| {
            [0, 1, 2].map(|i: usize| {
                (i64::from(view.n()[i].to_bits()) << 28)
                    + sign * parallax * i64::from(view.u()[i].to_bits())
                    - (i64::from(width - 1) * across[i] + i64::from(height - 1) * down[i]) / 2
            })
        });
        // D is linear over the picture, so its length is largest in a corner.
        let corners = first.iter().flat_map(|&first| {
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| {
                [0, 1, 2].map(|i: usize| {
                    (first[i]
                        + x * i64::from(width - 1) * across[i]
                        + y * i64::from(height - 1) * down[i])
                        .abs()
                })
            })
        });
        // Slightly below 1, because the steps are rounded.
        const ONE: i64 = (1 << 51) - (1 << 36);
        const SQUARE: i64 = (1 << 50) - (1 << 40);
        let exponent = if round {
            // 25 of the fraction bits, and 3 integer bits.
            let squares = corners.map(|d| d.map(|x| ((x >> 26) + 1).pow(2)).iter().sum());
            let longest: i64 = squares.max().unwrap_or(0);
            (0..3).find(|&e| longest >> (2 * e) < SQUARE).unwrap_or(3)
        } else {
            let largest = corners.flatten().max().unwrap_or(0);
            (0..3).find(|&e| largest >> e < ONE).unwrap_or(3)
        };
        Self {
            first,
            across,
            down,
            exponent,
        }
    }

    /// Narrows to 30 fraction bits, to nearest, times 2^−e.
    pub fn narrow(&self, x: i64) -> i32 {
        let shift = 21 + self.exponent;
        ((x + (1 << (shift - 1))) >> shift) as i32
    }
}
